/* SPDX-License-Identifier: MIT
 *
 * What a frame has to draw of a lens: which ghosts, lights and wavelengths,
 * each with how fine a grid.
 *
 *   in   a baked lens, lights, waves, the picture's size
 *   out  a bundle for each ghost, light and wave that can be seen in it
 *
 * Method: a few rays of each bundle go through its polynomials. Where they land
 * says whether it is in the picture, how much its light bends how many cells it
 * takes, and how close they land how bright it can be: what stays below what
 * the picture can show is left out. Integers only.
 */
#ifndef GLINT_FLARE_PLAN_H
#define GLINT_FLARE_PLAN_H

#include "glint/flare.h"
#include "glint/transfer.h"
#include "flare/probe.h"
#include "flare/window.h"

/* Where the rays of a bundle come from. */
struct glint_bundle_plan {
    int32_t ghost, light, wave;
    uint8_t energy_up; /* see struct glint_transfer */
    /* part of the box that the stop lets through */
    struct glint_box_window window;
    /* Of two barrels and a round stop: how far, in the mean, the grid's
     * straight lines lie above (1 + r^2) / 2, which is bent between its rays */
    uint16_t sag_q16[3];
    struct glint_real flux; /* light of the whole pupil at the most energy seen,
                               in display white times pixels */
    struct glint_real irradiance; /* the same over the pixels it falls on */
    int64_t peak_q20; /* no pixel gets more; 1 = what can be seen, 2^20 at most
                       */
};

struct glint_plan {
    const struct glint_flare_frame *frame;
    const struct glint_light *light;
    /* number of lights; size of the picture in pixels */
    int n_lights, width, height;
    unsigned sets;
    int half;  /* 1: pixels are twice as wide and high as the picture's */
    int round; /* 1: the stop is round */
    /* opening of the stop over the model's, 2^20 .. 2^30 */
    int32_t opening_q30;
};

/* Of a worker. */
struct glint_plan_scratch {
    struct glint_transfer transfer;
    struct glint_probe probe;
    struct glint_window_nodes window;
};

/* Whether the lens was never looked at from where LIGHT comes. */
int glint_plan_is_beyond(const struct glint_lens *lens,
                         const struct glint_light *light);

/* Plans one bundle: BUNDLE->n_cells is 0 where nothing of it can be seen, and
 * what is returned says why. PLANNED has ghost, light and wave set. */
enum glint_outcome glint_plan_bundle(const struct glint_plan *plan,
                                     struct glint_bundle_plan *planned,
                                     struct glint_bundle *bundle,
                                     struct glint_plan_scratch *scratch);

/* The polynomials of a bundle that was planned. */
void glint_plan_transfer(const struct glint_plan *plan,
                         const struct glint_bundle_plan *planned,
                         struct glint_transfer *transfer);

/* Where light LIGHT's ghosts lie in the picture. */
struct glint_place glint_plan_place(const struct glint_plan *plan, int light);

#endif
