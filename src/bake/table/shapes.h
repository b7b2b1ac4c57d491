/* SPDX-License-Identifier: MIT
 *
 * Reads what makes a surface other than a centred sphere. */
#ifndef GLINT_BAKE_TABLE_SHAPES_H
#define GLINT_BAKE_TABLE_SHAPES_H

#include "bake/table/text.h"
#include "glint/prescription.h"

/* Reads the rest of a line "shape [conic K] [A4 V] .. [A20 V]
 * [cylinder AXIS | toric AXIS RADIUS]" into SHAPE, whose other members stay.
 * Returns false with the error of TEXT, also if something is given twice. */
bool glint_shape_read(struct glint_text *text, struct glint_shape *shape);

/* Reads the rest of a line "group [decentre X Y] [tilt X Y]" likewise. */
bool glint_group_read(struct glint_text *text, struct glint_shape *shape);

/* Reads a radius, or "flat" as 0. */
bool glint_radius_read(struct glint_text *text, double *radius_mm);

#endif
