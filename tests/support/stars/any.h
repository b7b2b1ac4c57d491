/* SPDX-License-Identifier: MIT
 *
 * Tables of a star by integers alone, the same on every machine: as those that
 * are made of a stop, but of no stop in particular. */
#ifndef GLINT_TESTS_STARS_ANY_H
#define GLINT_TESTS_STARS_ANY_H

#include "star/starburst.h"

enum { STAR_ANY_LINES = 9 };

struct star_any {
    struct glint_star_tables tables;
    struct glint_star_line line[STAR_ANY_LINES];
};

/* Sets TO, by SEED, to tables of 1 to STAR_ANY_LINES lines. */
void star_any(struct star_any *to, uint32_t *seed);

/* Returns a light in a picture of WIDTH x HEIGHT pixels or up to 1000 pixels
 * beside it, of a power of 2^-20 to 2^30, by SEED. */
struct glint_star_light star_any_light(int width, int height, uint32_t *seed);

#endif
