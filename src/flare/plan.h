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

/* Where the rays of a bundle come from. */
struct glint_bundle_plan {
    int32_t ghost, light, wave;
    uint8_t energy_up; /* see struct glint_transfer */
    /* Of two barrels and a round stop: how far, in the mean, the grid's
     * straight lines lie above (1 + r^2) / 2, which is bent between its rays */
    uint16_t sag_q16[3];
    struct glint_real flux; /* of the whole pupil, at the most energy seen;
                               display white times pixels */
    struct glint_real irradiance; /* the same over the pixels it falls on */
    int64_t peak_q20; /* no pixel gets more; 1 = what can be seen, 2^20 at most
                       */
};

struct glint_plan {
    const struct glint_flare_frame *frame;
    const struct glint_light *light;
    int n_lights, width, height; /* of the picture */
    unsigned sets;
    int half;  /* pixels are twice as wide and high as the picture's */
    int round; /* the stop is */
};

/* Where light lands: least and largest x on the sensor, and largest y. */
struct glint_plan_extent {
    int64_t low, high, wide;
};

/* What a few rays of a bundle say, in cells across the pupil and down half of
 * it: few, and more where these hardly find anything.
 */
enum { GLINT_PLAN_ACROSS = 16, GLINT_PLAN_DOWN = 8 };

struct glint_plan_node {
    int32_t at[GLINT_OUT_KINDS];
    int inside; /* of the stop and the barrels, and a little around */
};

/* How a quantity changes from ray to ray: sums of squares of differences, and
 * of second differences as they are, across the pupil and down. */
struct glint_plan_change {
    uint64_t first, second;
    int64_t bent[2];
};

struct glint_plan_survey {
    struct glint_plan_node row[3][GLINT_PLAN_ACROSS + 1]; /* the last three */
    struct glint_plan_change change[GLINT_OUT_KINDS];
    int across, down; /* cells */
    int n_rays;       /* of all surveys of the bundle */
    int n_bends, n_bent[2], n_inside, n_kinds;
    uint8_t kind[GLINT_OUT_KINDS];  /* of outputs that there are, but energy */
    int n_up, n_down;               /* cells by the way they are turned */
    struct glint_plan_extent seen;  /* of what is inside */
    struct glint_plan_extent reach; /* of cells that any of is, and so of what
                                       lies between rays, too */
    int64_t energy;
    uint64_t least_area;            /* of half a cell on the sensor */
    int64_t limit[GLINT_OUT_KINDS]; /* what counts as inside */
};

/* Of a worker. */
struct glint_plan_scratch {
    struct glint_transfer transfer;
    struct glint_plan_survey survey;
};

/* Whether the lens was never looked at from where LIGHT comes. */
int glint_plan_is_beyond(const struct glint_lens *lens,
                         const struct glint_light *light);

/* Plans one bundle: BUNDLE->n_cells is 0 where nothing of it can be seen, and
 * what is returned says why. PLANNED has ghost, light and wave set. */
enum glint_fate glint_plan_bundle(const struct glint_plan *plan,
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
