/* SPDX-License-Identifier: MIT
 *
 * A lamp finder that is made anew for each picture.
 */
#ifndef GLINT_TESTS_FINDER_H
#define GLINT_TESTS_FINDER_H

#include "glint/lamps.h"

enum { FINDER_SPOTS = 1024 };

/* What was found last. */
extern struct glint_spot finder_spot[FINDER_SPOTS];

/* This seeds random bytes, one of which fills the memory of each new finder. */
extern uint32_t finder_seed;

/* What a new finder of exactly the bytes asked for finds, in dirty memory. */
int finder_find_at_most(const struct glint_lamp_finder_config *cfg,
                        const struct glint_image *image, int max, int *dropped);

int finder_find(const struct glint_lamp_finder_config *cfg,
                const struct glint_image *image);

/* Stops from white between sRGB codes CODE - 1 and CODE. */
int32_t finder_stops_q8(int code);

/* Every region counts: no smallest, no largest, nothing merges. LOW and HIGH
 * are codes, HIGH 250 at most. */
struct glint_lamp_finder_config finder_plain(const struct glint_image *image,
                                             int low, int high);

struct glint_lamp_finder_config
finder_defaults(const struct glint_image *image);

double finder_x(int i);

double finder_y(int i);

#endif
