/* SPDX-License-Identifier: MIT
 *
 * Random valid lenses: not practical designs, but the parser accepts them and
 * they form an image.
 */
#ifndef GLINT_TESTS_RANDOM_LENS_H
#define GLINT_TESTS_RANDOM_LENS_H

#include "glint/bake.h"

enum { RANDOM_LENS_TEXT = 16384 };

/* Makes lens NUMBER of the random sequence SEED: its table in TEXT, the parsed
 * lens in LENS. It has 2 to 64 planes or spheres, cemented or not, of catalogue
 * glass or any n and V, with or without coatings. The stop is anywhere, the
 * focal length is 1 mm to 10 m, the image size 1 to 100 mm if possible. Returns
 * the number of invalid candidates before the lens, or -1 if no candidate was
 * valid. */
int make_random_lens(struct glint_prescription *lens, uint64_t seed, int number,
                     char text[RANDOM_LENS_TEXT]);

#endif
