/* SPDX-License-Identifier: MIT
 *
 * Plans a frame: which ghosts, lights and wavelengths are visible, and the
 * fineness of their grids.
 *
 *   in   a baked lens, lights, waves, the picture's size
 *   out  a bundle for each ghost, light and wave visible in the picture
 *
 * Method: a few rays of each bundle go through its polynomials. Their positions
 * on the sensor determine whether the ghost is in the picture and its max
 * brightness; the curvature of the map from pupil to sensor determines the
 * number of cells. A ghost too faint for the picture is left out. Integers
 * only. */
#ifndef GLINT_FLARE_PLAN_H
#define GLINT_FLARE_PLAN_H

#include "glint/flare.h"
#include "glint/transfer.h"
#include "flare/probe.h"
#include "flare/window.h"

/* A bundle before its grid is traced: its ghost, light and wave, and the
 * results of the plan. */
struct glint_bundle_plan {
    int32_t ghost, light, wave;
    /* Direction of the light that is drawn, as in struct glint_light: that
     * of light LIGHT, or of the merged light that replaces it. */
    int32_t sine_q30, cos_q30, sin_q30;
    /* Rotation of the ghost in the picture, see struct glint_place. */
    struct glint_azimuth turn;
    uint8_t energy_up; /* see struct glint_transfer */
    /* As in struct glint_planned. */
    uint8_t inside_q8, view_q8, contrast_q4;
    /* Subrange of the pupil box that the stop transmits. */
    struct glint_box_window window;
    /* For two barrels and a curved stop: mean height of the straight lines
     * between grid rays above the curve (1 + r^2) / 2 */
    uint16_t sag_q16[3];
    /* Light of the whole pupil if all rays had the max energy of the probed
     * rays, display white times pixels. */
    struct glint_real flux;
    /* wider: factor above 1 by which the ghost is enlarged, or 0 if it is
     * drawn at its own size. centre: fixed point of the enlargement, pixels
     * from the picture's middle along the light's azimuth and perpendicular
     * to it. */
    int32_t wider_q16, centre_q8[2];
    /* flux divided by the number of pixels that it falls on, display white */
    struct glint_real irradiance;
    int64_t peak_q20; /* max light of a pixel, in units of the min visible
                         light; clamped to 2^20 units */
};

struct glint_plan {
    const struct glint_flare_frame *frame;
    const struct glint_light *light;
    /* number of lights, and size of the picture in pixels */
    int n_lights, width, height;
    unsigned sets;
    int half; /* 1: the flare's pixels are twice as wide and high as the
                 picture's */
    int dims; /* 1: the table frame->dim is filled for all lights */
    int32_t round_q16; /* curvature of the stop's outline between its corners,
                          in 1 / stop radius: 0 is straight, 2^16 a circle */
    int shaded;        /* 1: the stop has a shade (soft edge, dust or masks) */
    /* stop radius / stop radius of the model, 2^20 .. 2^30 */
    int32_t opening_q30;
};

/* Scratch of one worker. */
struct glint_plan_scratch {
    struct glint_transfer transfer;
    struct glint_probe probe;
    struct glint_window_nodes window;
    int64_t n_rays; /* number of rays probed since the plan began */
};

/* Returns whether the angle of LIGHT exceeds the max angle that the model
 * was baked for. */
int glint_plan_is_light_outside_model(const struct glint_lens *lens,
                                      const struct glint_light *light);

/* Plans one bundle with light LIGHT; its ghost, light and wave must be set
 * in PLANNED. Returns the outcome; unless it is GLINT_OUTCOME_DRAWN, the
 * bundle is invisible and BUNDLE->n_cells is 0. */
enum glint_outcome glint_plan_bundle(const struct glint_plan *plan,
                                     const struct glint_light *light,
                                     struct glint_bundle_plan *planned,
                                     struct glint_bundle *bundle,
                                     struct glint_plan_scratch *scratch);

/* Sets TRANSFER to the polynomials of a planned bundle. */
void glint_plan_set_transfer(const struct glint_plan *plan,
                             const struct glint_bundle_plan *planned,
                             struct glint_transfer *transfer);

/* Returns the map from the sensor to the picture for the ghost of a planned
 * bundle. */
struct glint_place
glint_plan_map_sensor_to_picture(const struct glint_plan *plan,
                                 const struct glint_bundle_plan *planned);

#endif
