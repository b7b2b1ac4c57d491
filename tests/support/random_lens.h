/* SPDX-License-Identifier: MIT
 *
 * Lenses that nobody would build, but that are valid: what the checker accepts
 * and what forms an image.
 */
#ifndef GLINT_TESTS_RANDOM_LENS_H
#define GLINT_TESTS_RANDOM_LENS_H

#include "glint/bake.h"

enum { RANDOM_LENS_TEXT = 16384 };

/* Lens number NUMBER of SEED, as a table in TEXT and as the parser reads it:
 * 2 to 64 surfaces (a single one cannot be: both its sides are air), radii of
 * both signs and planes, cemented or not, glasses of the catalogue or of any
 * n and V, coatings or none, the stop anywhere, focal lengths of 1 mm to 10 m,
 * films of 1 to 100 mm as far as they suit that. Returns how many were thrown
 * away for it, refused by the checker; -1: none was found. */
int random_lens(struct glint_prescription *lens, uint64_t seed, int number,
                char text[RANDOM_LENS_TEXT]);

#endif
