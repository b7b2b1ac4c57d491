/* SPDX-License-Identifier: MIT
 *
 * glint/bundle.h - the rays of one ghost, one light and one wavelength.
 *
 * A bundle is the interface between lens and rasteriser: its rays come from
 * the polynomials of a model or from exact tracing. */
#ifndef GLINT_BUNDLE_H
#define GLINT_BUNDLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_CELLS   1024 /* max cells per side of a ray grid */
#define GLINT_LEAST_CELLS 8    /* min cells per side that a plan chooses */

/* One ray of a grid: the point where it hits the sensor, and where it crosses
 * the stop and the barrels. */
struct glint_vertex {
    /* Point on the sensor, pixels from the top left corner of the picture, y
     * down; within +-GLINT_VERTEX_LIMIT_Q8. */
    int32_t x_q8, y_q8;
    int32_t stop_x_q16,
        stop_y_q16; /* position in the stop, in stop radii, within +-2^14 */
    /* (1 + r^2) / 2 at each of two barrels that may cut the ray, 0 .. 2^14; 0:
     * there is no such barrel. r is (distance of the ray from the axis) /
     * (semi-diameter of the barrel). The barrel cuts the ray if the value is
     * above 1. This function of r is used because it is smooth at r = 0 and has
     * the slope of r at r = 1. */
    int32_t barrel_q16[2];
    /* energy of the ray, 0 .. 65536; 65536 is the energy 1 to which flux_q31 of
     * the bundle refers. Below 0: the ray is invalid, and its other members are
     * undefined. */
    int32_t energy_q16;
};

#define GLINT_VERTEX_LIMIT_Q8 (INT32_C(1) << 28) /* 2^20 pixels */

/* The rays of one ghost, one light and one wavelength: a square grid of rays
 * over the part of the entrance pupil from which light forms the ghost. */
struct glint_bundle {
    int n_cells; /* number of cells per side, 1 .. GLINT_MAX_CELLS; there are
                    (n_cells + 1)^2 vertices, row by row */
    /* Flux of a cell whose energy is 1, display white x pixels: flux_q31 *
     * 2^(flux_exponent - 31). */
    int32_t flux_q31; /* mantissa, 2^30 .. 2^31 - 1, or 0 */
    int flux_exponent;
    int32_t rgb_q14[3]; /* colour of the wavelength times colour of the light,
                           linear BT.709, -4 .. 4 */
};

/* Callbacks that compute the vertices of bundles while glint_flare_bin() sorts
 * the bundles into tiles. The vertices are then never stored. Bundles are
 * numbered in the order in which they were added. Any worker may call both
 * callbacks, with its number WORKER; they must give the same result each
 * time. */
struct glint_flare_rays {
    /* Starts bundle I for WORKER. Returns 0 to skip the bundle, because all of
     * it lies outside the pixel rows Y0 .. Y1 - 1; else not 0. */
    int (*open)(void *ctx, int worker, int i, int y0, int y1);
    /* Sets ROW to row J, 0 .. n_cells, of the vertices of the bundle that
     * WORKER has opened. Called for increasing J. */
    void (*row)(void *ctx, int worker, int j, struct glint_vertex *row);
    void *ctx;
    int coded;         /* 1: the picture has integer codes, so faint light needs
                          less precision */
    int snap_codes_q8; /* as in struct glint_flare_frame */
};

#ifdef __cplusplus
}
#endif

#endif
