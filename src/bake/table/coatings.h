/* SPDX-License-Identifier: MIT
 *
 * Reads coatings of a lens table: the words of a `coating` and of a
 * `mixed-coating`, one word per coating. */
#ifndef GLINT_BAKE_TABLE_COATINGS_H
#define GLINT_BAKE_TABLE_COATINGS_H

#include "bake/table/text.h"
#include "glint/prescription.h"

#define GLINT_MGF2_INDEX 1.38

/* Sets COATING to a layer of magnesium fluoride, a quarter of wavelength NM
 * thick. */
void glint_coating_single(struct glint_coating *coating, double nm);

/* Reads a coating from the rest of the line: "none", NAME [NM] or NM
 * [INDEX[:QUARTERS]]... Leaves a word that fits none of these unread. Returns
 * false with the error written. */
bool glint_coating_read(struct glint_text *text, struct glint_coating *coating);

/* Reads coatings from the rest of the line, at least one word, to its end. */
bool glint_coatings_read(struct glint_text *text,
                         struct glint_coating coatings[GLINT_MAX_COATINGS],
                         int *n);

#endif
