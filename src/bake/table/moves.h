/* SPDX-License-Identifier: MIT
 *
 * What moves in a lens: gaps that zooming and focusing change.
 *
 *   in   a lens, where it is to be
 *   out  the same lens with other gaps
 *
 * Limits: cams are not known. Between the columns of a table gaps follow
 * monotone cubics [Fritsch80], and the last one what is left of the focus. */
#ifndef GLINT_BAKE_TABLE_MOVES_H
#define GLINT_BAKE_TABLE_MOVES_H

#include "bake/table/elements.h"

/* Returns the gap from element E to the next one or the sensor. */
static inline double *glint_gap_of(struct glint_prescription *lens, int e)
{
    const int k = element_surface(lens, e);

    return k < 0 ? &lens->stop_thickness_mm : &lens->surface[k].thickness_mm;
}

/* Returns how far behind the last surface paraxial rays meet that come from the
 * axis OBJECT_MM before the front vertex. */
double glint_image_mm(const struct glint_prescription *lens, double object_mm);

/* Checks that elements do not collide and that the stop opens wide enough.
 * GLINT_E_ARGUMENT: they do, or it does not; ERROR says where. */
enum glint_status glint_prescription_fits(const struct glint_prescription *lens,
                                          struct glint_error *error);

#endif
