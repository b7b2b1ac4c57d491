/* SPDX-License-Identifier: MIT
 *
 * Runs a new lamp finder on an image.
 */
#ifndef GLINT_TESTS_FINDER_H
#define GLINT_TESTS_FINDER_H

#include "glint/lamps.h"

enum { FINDER_SPOTS = 1024 };

/* lamps that the last search found */
extern struct glint_spot finder_spot[FINDER_SPOTS];

/* seed of the byte with which the memory of each new finder is filled */
extern uint32_t finder_seed;

/* finder_find_at_most_n_lamps() finds at most MAX lamps of IMAGE, stores them
 * in finder_spot and returns their number. The finder gets exactly the memory
 * that it requests, filled with a random byte. Sets *DROPPED to
 * glint_lamp_finder_dropped(); if DROPPED is NULL, that must be 0. */
int finder_find_at_most_n_lamps(const struct glint_lamp_finder_config *cfg,
                                const struct glint_image *image, int max,
                                int *dropped);

int finder_find_lamps(const struct glint_lamp_finder_config *cfg,
                      const struct glint_image *image);

/* Returns the threshold between the sRGB codes CODE - 1 and CODE, the mean of
 * their light: log2 of its ratio to white, Q8. */
int32_t finder_threshold_stops_q8(int code);

/* Returns a finder configuration that accepts regions of every size and merges
 * none. LOW and HIGH are the threshold codes, HIGH at most 250. */
struct glint_lamp_finder_config
finder_config_without_filters(const struct glint_image *image, int low,
                              int high);

struct finder_case {
    struct glint_image image;
    struct glint_lamp_finder_config cfg;
};

/* Returns a black image of FORMAT with finder_config_without_filters(). The
 * caller frees plane[0]. */
struct finder_case finder_open_case(enum glint_pixel_format format, int width,
                                    int height, int low, int high);

struct glint_lamp_finder_config
finder_default_config(const struct glint_image *image);

double finder_centroid_x_of_spot(int i);

double finder_centroid_y_of_spot(int i);

#endif
