/* SPDX-License-Identifier: MIT
 *
 * Parses the lines "coating" and "mixed-coating" of a lens table.
 */
#ifndef GLINT_BAKE_TABLE_COATINGS_H
#define GLINT_BAKE_TABLE_COATINGS_H

#include "bake/table/text.h"
#include "glint/prescription.h"

#define GLINT_MGF2_INDEX 1.38

/* Sets COATING to a single layer of magnesium fluoride, a quarter wave at
 * NM. */
void glint_coating_set_single_layer(struct glint_coating *coating, double nm);

/* Reads one coating from the rest of the line: "none", NAME [NM] or NM
 * [INDEX[:QUARTERS]]... Leaves words after it unread. On errors, sets the error
 * of TEXT and returns false. */
bool glint_coating_read(struct glint_text *text, struct glint_coating *coating);

/* Reads all remaining words of the line, at least one, as one coating each. */
bool glint_coatings_read(struct glint_text *text,
                         struct glint_coating coatings[GLINT_MAX_COATINGS],
                         int *n);

#endif
