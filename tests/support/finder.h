/* SPDX-License-Identifier: MIT
 *
 * A lamp finder that is rebuilt for each picture.
 */
#ifndef GLINT_TESTS_FINDER_H
#define GLINT_TESTS_FINDER_H

#include "glint/lamps.h"

enum { FINDER_SPOTS = 1024 };

/* Spots that the last search found. */
extern struct glint_spot finder_spot[FINDER_SPOTS];

/* Seeds the random byte that fills the memory of each new finder. */
extern uint32_t finder_seed;

/* finder_find_at_most() lists at most MAX lamps of IMAGE in finder_spot and
 * returns how many. Its finder is new, in exactly the bytes that it requests,
 * all of one random value. *DROPPED becomes glint_lamp_finder_dropped(), which
 * must be 0 where DROPPED is NULL. */
int finder_find_at_most(const struct glint_lamp_finder_config *cfg,
                        const struct glint_image *image, int max, int *dropped);

int finder_find(const struct glint_lamp_finder_config *cfg,
                const struct glint_image *image);

/* Returns the light midway between the sRGB codes CODE - 1 and CODE, in stops
 * from white, _q8. */
int32_t finder_stops_q8(int code);

/* Returns settings by which every region counts: none is too small or too
 * large, and none merge. LOW and HIGH are the codes of the thresholds, HIGH 250
 * at most. */
struct glint_lamp_finder_config finder_plain(const struct glint_image *image,
                                             int low, int high);

struct glint_lamp_finder_config
finder_defaults(const struct glint_image *image);

double finder_x(int i);

double finder_y(int i);

#endif
