/* SPDX-License-Identifier: MIT
 *
 * Synthetic night scenes: lamps with a blurred rim in camera noise, as an 8-bit
 * grey image, and the spots and tracks found in them.
 */
#ifndef GLINT_TESTS_NIGHT_H
#define GLINT_TESTS_NIGHT_H

#include <stdint.h>

#include "glint/lamps.h"
#include "glint/profile.h"
#include "glint/lamp_tracker.h"

enum { NIGHT_MAX = 1024, NIGHT_NOISE = 1 << 16 };

struct night_lamp {
    double x, y, radius;
    /* light of the lamp's disc, 1 = white; outside the disc it falls by a
     * factor e per 1.5 pixels */
    double light;
};

struct night {
    struct glint_image image;
    double sigma; /* standard deviation of the camera noise, codes */
    /* first and last column of a pole that hides lamps, pixels */
    double pole_x0, pole_x1;
    struct glint_lamp_finder *finder;
    struct glint_lamp_finder_config lights;
    struct glint_lamp_tracker *tracks;
    struct glint_lamp_tracker_config cfg;
    struct glint_profile *profile;
    void *mem[3];
    struct glint_spot spot[NIGHT_MAX];
    struct glint_lamp_track track[NIGHT_MAX];
    int n_spots, n_tracks;
    uint32_t seed;
    int8_t noise[NIGHT_NOISE]; /* noise values in units of sigma / 16 */
    /* index in `noise` of the first pixel of each row */
    int row_noise[GLINT_MAX_SIDE];
};

/* Sets NIGHT to a size, default parameters and a table of nearly Gaussian
 * noise, sums of twelve uniform numbers. */
void night_init_parameters(struct night *night, int width, int height);

/* Opens the finder, profile and tracker with the configurations in N. Returns
 * whether this succeeded. */
int night_open_tracker(struct night *n);

void night_close_tracker(struct night *night);

/* Draws the N lamps of LAMP on a dark background. The noise has a standard
 * deviation of n->sigma codes around lamps and of one code elsewhere. */
void night_draw_lamps(struct night *night, const struct night_lamp *lamp,
                      int n);

/* Finds and tracks the lamps of the image, ELAPSED_US microseconds after the
 * previous one. */
void night_track_lamps(struct night *n, int32_t elapsed_us);

void night_draw_and_track(struct night *n, const struct night_lamp *lamp,
                          int n_lamps, int32_t elapsed_us);

double night_track_power(const struct glint_lamp_track *t);

double night_sum_track_energies(const struct night *n);

double night_spot_power(const struct glint_spot *s);

/* Return the index of the track or spot (lamp found in one frame) nearest to
 * (X, Y), or -1 if there is none. */
int night_find_track(const struct night *n, double x, double y);

int night_find_spot(const struct night *n, double x, double y);

#endif
