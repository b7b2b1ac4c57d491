/* SPDX-License-Identifier: MIT
 *
 * glass_map.h - which pairs of nd and Vd glasses have.
 */
#ifndef GLINT_TOOLS_LENS_CHECK_GLASS_MAP_H
#define GLINT_TOOLS_LENS_CHECK_GLASS_MAP_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/prescription.h"

/* Returns whether the glass behind surface K of LENS is another surface's, too,
 * or in the catalogue. */
bool glass_is_listed(const struct glint_prescription *lens, int k);

/* Returns the first surface of LENS whose glass is none, or has the nd of
 * another in the table, of four decimals or more, at a Vd that is apart, -1 if
 * all are well. TEXT[BYTES] says why. */
int glass_suspect(const struct glint_prescription *lens, char *text,
                  size_t bytes);

#endif
