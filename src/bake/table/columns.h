/* SPDX-License-Identifier: MIT
 *
 * Values of a table that a zoom has one of for each position, A/B/C. */
#ifndef GLINT_BAKE_TABLE_COLUMNS_H
#define GLINT_BAKE_TABLE_COLUMNS_H

#include "bake/table/check.h"
#include "bake/table/text.h"
#include "glint/prescription.h"

/* Reads a number in RANGE, or one for each position of ZOOM, into COLUMN; a
 * single one holds for all of them. PLACE receives its place. Returns false,
 * with the error written, if it is none, or not as many as those before. */
bool glint_columns_read(struct glint_text *text,
                        const struct glint_text_range *range,
                        struct glint_zoom *zoom,
                        double column[GLINT_MAX_POSITIONS],
                        struct glint_text_place *place);

/* The same for the gap behind ELEMENT. GAP_MM receives the first. */
bool glint_columns_gap(struct glint_text *text,
                       const struct glint_text_range *range,
                       struct glint_zoom *zoom, int element, double *gap_mm,
                       struct glint_text_place *place);

/* Checks LENS at each of its positions, and leaves it at the first. Its
 * surfaces and values are read; returns false if not all are good, with the
 * error written. */
bool glint_columns_check(struct glint_prescription *lens,
                         const struct glint_text *text,
                         const struct glint_places *places);

#endif
