/* SPDX-License-Identifier: MIT
 *
 * Computes the table of light that dust, scratches and smudges on the front
 * element of the lens scatter, in doubles.
 *
 * A grain of dust diffracts as much light around its shadow as it blocks,
 * whatever its material [vandeHulst57, 8.2: an efficiency of 2, half of it
 * diffraction]. So it scatters the light of a lamp over some degrees, as haze
 * does. The grain is far out of focus and appears as a disc with the shape of
 * the stop. The beam of a pixel, whose direction has the tangents U, crosses
 * the front element in the points
 *
 *     X = e - z U,   e in the entrance pupil, z its distance from the front
 *
 * and dirt covers the fraction C of these. So the pixel gets the haze of a
 * front element that is uniformly covered by C: the light of the lamps,
 * convolved with the scattering lobe p of the grains, times
 *
 *     C = mean over the stop of covered(X)
 *
 * All light that leaves the front element at one angle goes to one pixel, so p
 * is evaluated at the pixel, and C is a table over the picture that does not
 * depend on the lamps. The discs are sharp for a small stop and a wide-angle
 * lens, and blurred to uniformity for a large stop and a long lens, as in
 * photographs. The light that dirt blocks is treated as a change of exposure;
 * streaks of single scratches are not modelled. */
#ifndef GLINT_ENGINE_FRAME_FRONT_H
#define GLINT_ENGINE_FRAME_FRONT_H

#include <stddef.h>

#include "glint/model.h"
#include "glint/setup.h"
#include "glint/view.h"
#include "veil/glare.h"

/* Table of the cover for one lens, stop and picture size. */
struct glint_front_table {
    struct glint_veil_front front; /* header of the table; the nodes follow this
                                      struct in the same memory block */
    size_t bytes;
    /* covered fraction of the beam of a pixel: mean and max over the picture */
    double mean, most;
};

/* The settings of the optics on which a table depends. */
struct glint_front_optics {
    double tangent;    /* tangent of the angle that a pixel on the axis spans */
    double z, radius;  /* distance of the entrance pupil from the front vertex,
                          and its radius, in radii of the front element */
    int width, height; /* pixels */
    int n_blades;
    double rotation_deg, roundness;
};

/* Functions called through pointers, so that programs without dirt on the front
 * element do not link them. */
struct glint_front_method {
    void (*optics)(struct glint_front_optics *optics,
                   const struct glint_setup *setup,
                   const struct glint_lens *lens,
                   const struct glint_view *view);
    enum glint_status (*table)(struct glint_front_table **table,
                               const struct glint_front_dirt *dirt,
                               const struct glint_front_optics *optics,
                               const struct glint_setup *setup);
    void (*spread)(struct glint_veil *veil,
                   const struct glint_veil_front *front,
                   const struct glint_veil_spread *spreads, int n);
};

enum {
    GLINT_FRONT_SIDE = 512
}; /* number of cells per side of the square
      around the front element */

struct glint_front_dirt {
    const struct glint_front_method *method;
    /* [SIDE][SIDE + 1]: sum of the covered fractions of all cells to the left
     * in the same row; row 0 has the lowest y */
    float *along;
};

/* Returns the covered fraction for the pixel at (X, Y), pixels from the top
 * left, by summing over STEPS^2 points of the stop; a slow reference for tests.
 */
double glint_front_sum_pixel_cover(const struct glint_front_dirt *dirt,
                                   const struct glint_front_optics *optics,
                                   const struct glint_setup *setup, double x,
                                   double y, int steps);

#endif
