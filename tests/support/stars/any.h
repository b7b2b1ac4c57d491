/* SPDX-License-Identifier: MIT
 *
 * Random starburst tables for tests. They are valid, but no real stop has
 * them. They are made with integers only, so that they are the same on every
 * machine.
 */
#ifndef GLINT_TESTS_STARS_ANY_H
#define GLINT_TESTS_STARS_ANY_H

#include "star/starburst.h"

enum { STAR_ANY_LINES = 9 };

struct star_any {
    struct glint_star_tables tables;
    struct glint_star_line line[STAR_ANY_LINES];
};

/* Sets TO to random tables of 1 to STAR_ANY_LINES lines. */
void star_make_random(struct star_any *to, uint32_t *seed);

/* Returns a random light of power 2^-20 to 2^30, inside an image of WIDTH x
 * HEIGHT or up to 1000 pixels off-screen. */
struct glint_star_light star_make_random_light(int width, int height,
                                               uint32_t *seed);

#endif
