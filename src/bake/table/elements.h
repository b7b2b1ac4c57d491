/* SPDX-License-Identifier: MIT
 *
 * Access to a lens as a sequence of elements: surfaces and the stop, in the
 * order of the table. Element E is the stop if E == lens->stop_after.
 */
#ifndef GLINT_BAKE_TABLE_ELEMENTS_H
#define GLINT_BAKE_TABLE_ELEMENTS_H

#include "glint/prescription.h"

#define GLINT_MAX_ELEMENTS (GLINT_MAX_SURFACES + 1)

static inline int count_elements(const struct glint_prescription *lens)
{
    return lens->n_surfaces + 1;
}

/* Returns the index of the surface at element E; -1 if E is the stop. */
static inline int get_element_surface(const struct glint_prescription *lens,
                                      int e)
{
    return e == lens->stop_after ? -1 : e - (e > lens->stop_after);
}

/* Returns the index of the element at which surface K is. */
static inline int get_surface_element(const struct glint_prescription *lens,
                                      int k)
{
    return k + (k >= lens->stop_after);
}

/* Returns the gap from element E to the next element or the sensor, mm. */
static inline double get_element_gap_mm(const struct glint_prescription *lens,
                                        int e)
{
    const int k = get_element_surface(lens, e);

    return k < 0 ? lens->stop_thickness_mm : lens->surface[k].thickness_mm;
}

static inline double get_element_semi_mm(const struct glint_prescription *lens,
                                         int e)
{
    const int k = get_element_surface(lens, e);

    return k < 0 ? lens->stop_semi_mm : lens->surface[k].semi_mm;
}

/* Returns the curvature of element E, 1 / mm; 0 for a plane and the stop. */
static inline double
get_element_curvature(const struct glint_prescription *lens, int e)
{
    const int k = get_element_surface(lens, e);

    return k < 0 || lens->surface[k].radius_mm == 0.0
               ? 0.0
               : 1.0 / lens->surface[k].radius_mm;
}

/* Returns a pointer to the gap behind element E, mm. */
static inline double *glint_gap_get_pointer(struct glint_prescription *lens,
                                            int e)
{
    const int k = get_element_surface(lens, e);

    return k < 0 ? &lens->stop_thickness_mm : &lens->surface[k].thickness_mm;
}

/* Returns the distance behind the last surface, mm, of the paraxial image of a
 * point. The point lies on the axis, OBJECT_MM in front of the lens. */
double glint_image_compute_distance_mm(const struct glint_prescription *lens,
                                       double object_mm);

/* Checks that elements do not overlap and that the stop is large enough for the
 * f-number. Returns GLINT_E_ARGUMENT if not; ERROR names the element. */
enum glint_status
glint_prescription_check_gaps_and_stop(const struct glint_prescription *lens,
                                       struct glint_error *error);

#endif
