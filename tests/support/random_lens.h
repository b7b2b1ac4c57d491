/* SPDX-License-Identifier: MIT
 *
 * Random valid lenses: nobody would build them, but the checker accepts them
 * and they form an image.
 */
#ifndef GLINT_TESTS_RANDOM_LENS_H
#define GLINT_TESTS_RANDOM_LENS_H

#include "glint/bake.h"

enum { RANDOM_LENS_TEXT = 16384 };

/* Makes lens NUMBER of the sequence of SEED: its table in TEXT, the parsed lens
 * in LENS. A lens has 2 to 64 surfaces (a single one would have air on both
 * sides), radii of both signs and planes, cemented or not, catalogue glasses or
 * any n and V, with or without coatings, the stop anywhere, focal lengths of 1
 * mm to 10 m, films of 1 to 100 mm if possible. Returns the number of invalid
 * candidates before it, or -1 if all were invalid. */
int make_random_lens(struct glint_prescription *lens, uint64_t seed, int number,
                     char text[RANDOM_LENS_TEXT]);

#endif
