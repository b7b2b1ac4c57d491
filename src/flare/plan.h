/* SPDX-License-Identifier: MIT
 *
 * Plans a frame: which ghosts, lights and wavelengths are visible, and the
 * fineness of their grids.
 *
 *   in   a baked lens, lights, wavelengths, the picture's size
 *   out  a ray bundle for each ghost, light and wavelength visible in the
 *        picture
 *
 * Method: a few rays of each bundle are traced by its polynomials. Their
 * positions on the sensor determine whether the ghost is on-screen and how
 * bright it is at most; the curvature of the map from pupil to sensor
 * determines the number of grid cells. Ghosts too faint to be visible are left
 * out. Integers only. */
#ifndef GLINT_FLARE_PLAN_H
#define GLINT_FLARE_PLAN_H

#include "glint/flare.h"
#include "glint/transfer.h"
#include "flare/probe.h"
#include "flare/window.h"

/* The plan of one ray bundle, made before its grid of rays is traced: its
 * ghost, light and wavelength, and how to draw it. */
struct glint_bundle_plan {
    int32_t ghost, light, wave;
    /* direction from which light comes, as in struct glint_light: that of light
     * LIGHT, or of the merged light that replaces it */
    int32_t sine_q30, cos_q30, sin_q30;
    /* rotation of the ghost in the picture */
    struct glint_azimuth turn;
    uint8_t energy_up; /* left shift that scales energies up */
    /* inside: fraction of the probed rays that are not blocked; view: fraction
     * of the bounding box that is on-screen; contrast: log2 of max / mean
     * light */
    uint8_t inside_q8, view_q8, contrast_q4;
    /* rectangle of the pupil's bounding box that the stop transmits */
    struct glint_box_window window;
    /* mean height of the straight lines between grid rays above the function (1
     * + r^2) / 2, r in aperture radii, for barrel apertures 0 and 1 and a round
     * stop */
    uint16_t sag_q16[3];
    /* flux of the ray bundle if all its rays had the max energy of the probed
     * rays, display white times pixels */
    struct glint_real flux;
    /* Enlargement of the ghost of a lamp that is sampled by several lights.
     * wider: factor, above 1; 0: no enlargement. centre: fixed point of the
     * enlargement, in pixels from the picture's centre, along the light's
     * azimuth and perpendicular to it. */
    int32_t wider_q16, centre_q8[2];
    /* mean light of a pixel of the ghost: flux / area in pixels, 1 = display
     * white */
    struct glint_real irradiance;
    int64_t peak_q20; /* upper bound on the light of a pixel, in units of the
                         min visible light, at most 2^20 units */
};

struct glint_plan {
    const struct glint_flare_frame *frame;
    const struct glint_light *light;
    /* number of lights; size of the picture, pixels */
    int n_lights, width, height;
    unsigned sets;
    int half; /* 1: the flare is drawn at half resolution, with pixels twice as
                 wide and high as the picture's */
    int dims; /* 1: dim ghosts are drawn with the rays of one wavelength, and
                 the table frame->dim covers all lights */
    int32_t round_q16; /* curvature of the stop's outline between its corners,
                          in 1 / stop radius: 0 is straight, 2^16 a circle */
    int shaded;        /* 1: the light through the stop varies over its area, by
                          a soft edge, dust or masks */
    /* stop radius / stop radius of the model, 2^20 .. 2^30 */
    int32_t opening_q30;
};

/* Scratch memory of one worker. */
struct glint_plan_scratch {
    struct glint_transfer transfer;
    struct glint_probe probe;
    struct glint_window_nodes window;
    int64_t n_rays; /* number of rays probed since the plan began */
};

/* Returns whether the angle of LIGHT exceeds the max angle of the model. */
int glint_plan_is_light_outside_model(const struct glint_lens *lens,
                                      const struct glint_light *light);

/* Plans the ray bundle whose ghost, light and wavelength are set in PLANNED,
 * for light LIGHT. Sets the other members of PLANNED and BUNDLE. Returns
 * GLINT_OUTCOME_DRAWN, or the reason why the bundle is invisible. An invisible
 * bundle has n_cells = 0. */
enum glint_outcome glint_plan_bundle(const struct glint_plan *plan,
                                     const struct glint_light *light,
                                     struct glint_bundle_plan *planned,
                                     struct glint_bundle *bundle,
                                     struct glint_plan_scratch *scratch);

/* Sets TRANSFER to the polynomials of ray bundle PLANNED, restricted to its
 * window. */
void glint_plan_set_transfer(const struct glint_plan *plan,
                             const struct glint_bundle_plan *planned,
                             struct glint_transfer *transfer);

/* Returns the map from positions on the sensor to pixels for the ghost of
 * PLANNED, including its enlargement. */
struct glint_place
glint_plan_map_sensor_to_picture(const struct glint_plan *plan,
                                 const struct glint_bundle_plan *planned);

#endif
