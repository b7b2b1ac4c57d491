/* SPDX-License-Identifier: MIT
 *
 * Parses the coatings of a lens table: lines `coating` and `mixed-coating`.
 */
#ifndef GLINT_BAKE_TABLE_COATINGS_H
#define GLINT_BAKE_TABLE_COATINGS_H

#include "bake/table/text.h"
#include "glint/prescription.h"

#define GLINT_MGF2_INDEX 1.38

/* Sets COATING to a quarter-wave layer of magnesium fluoride for wavelength
 * NM. */
void glint_coating_single(struct glint_coating *coating, double nm);

/* Reads a coating from the rest of the line: "none", NAME [NM] or NM
 * [INDEX[:QUARTERS]]... Does not consume a word that does not belong to it.
 * On errors, sets the error of TEXT and returns false. */
bool glint_coating_read(struct glint_text *text, struct glint_coating *coating);

/* Reads coatings, one word each and at least one, up to the end of the line. */
bool glint_coatings_read(struct glint_text *text,
                         struct glint_coating coatings[GLINT_MAX_COATINGS],
                         int *n);

#endif
