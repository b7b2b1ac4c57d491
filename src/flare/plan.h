/* SPDX-License-Identifier: MIT
 *
 * Plans a frame: which ghosts, lights and wavelengths are visible, and the
 * fineness of their grids.
 *
 *   in   a baked lens, lights, waves, the picture's size
 *   out  a bundle for each ghost, light and wave that can be seen in it
 *
 * Method: a few rays of each bundle go through its polynomials. Their places
 * determine whether the ghost is in the picture and its max brightness; their
 * bend determines the number of cells. A ghost too faint for the picture is
 * left out. Integers only. */
#ifndef GLINT_FLARE_PLAN_H
#define GLINT_FLARE_PLAN_H

#include "glint/flare.h"
#include "glint/transfer.h"
#include "flare/probe.h"
#include "flare/window.h"

/* A bundle before its grid: the ghost, light and wave it is of, and what the
 * plan found. */
struct glint_bundle_plan {
    int32_t ghost, light, wave;
    /* Direction of the light that is drawn, as in struct glint_light: of LIGHT,
     * or of several that it stands for. */
    int32_t sine_q30, cos_q30, sin_q30;
    /* By which the ghost is turned, see struct glint_place. */
    struct glint_azimuth turn;
    uint8_t energy_up; /* see struct glint_transfer */
    /* As in struct glint_planned. */
    uint8_t inside_q8, view_q8, contrast_q4;
    /* part of the box that the stop lets through */
    struct glint_box_window window;
    /* For two barrels and a curved stop: mean height by which the grid's
     * straight lines lie above (1 + r^2) / 2, which is bent between its rays */
    uint16_t sag_q16[3];
    /* Light of the whole pupil if all rays had the highest energy seen, display
     * white times pixels. */
    struct glint_real flux;
    /* wider: factor by which the ghost is drawn larger, above 1; 0: it is drawn
     * in its own size. centre: the point about which it grows, pixels from the
     * picture's middle along the light's azimuth and across. */
    int32_t wider_q16, centre_q8[2];
    /* Flux over the pixels that it falls on, display white. */
    struct glint_real irradiance;
    int64_t peak_q20; /* max light of a pixel, clamped to 2^20; 1 is the least
                         visible light */
};

struct glint_plan {
    const struct glint_flare_frame *frame;
    const struct glint_light *light;
    /* number of lights, and size of the picture in pixels */
    int n_lights, width, height;
    unsigned sets;
    int half; /* 1: the flare's pixels are twice as wide and high as the
                 picture's */
    int dims; /* 1: the frame's DIM is filled for all lights */
    int32_t round_q16; /* curvature of the stop's outline between its corners,
                          1 / stop radius: 0 straight, 2^16 a circle */
    int shaded;        /* 1: the stop has a shade */
    /* opening of the stop over the model's, 2^20 .. 2^30 */
    int32_t opening_q30;
};

/* Scratch of one worker. */
struct glint_plan_scratch {
    struct glint_transfer transfer;
    struct glint_probe probe;
    struct glint_window_nodes window;
    int64_t n_rays; /* rays probed since the plan began */
};

/* Returns whether LIGHT comes from beyond the largest angle that the model was
 * baked for. */
int glint_plan_is_beyond(const struct glint_lens *lens,
                         const struct glint_light *light);

/* Plans one bundle, whose ghost, light and wave are set in PLANNED, as LIGHT
 * makes it. Returns what becomes of it; unless that is DRAWN, BUNDLE->n_cells
 * is 0 and nothing of it can be seen. */
enum glint_outcome glint_plan_bundle(const struct glint_plan *plan,
                                     const struct glint_light *light,
                                     struct glint_bundle_plan *planned,
                                     struct glint_bundle *bundle,
                                     struct glint_plan_scratch *scratch);

/* Sets TRANSFER to the polynomials of a bundle that was planned. */
void glint_plan_transfer(const struct glint_plan *plan,
                         const struct glint_bundle_plan *planned,
                         struct glint_transfer *transfer);

/* Returns the place in the picture of the ghost of a bundle that was planned.
 */
struct glint_place glint_plan_place(const struct glint_plan *plan,
                                    const struct glint_bundle_plan *planned);

#endif
