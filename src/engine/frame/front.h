/* SPDX-License-Identifier: MIT
 *
 * Dust, scratches and smudges on the front element, in doubles.
 *
 * A grain throws as much light about its shadow as it takes from the beam
 * [vandeHulst57, 8.2: an efficiency of 2, half of it diffraction], whatever it
 * is made of, and so spreads a lamp's light over some degrees: haze. Since it
 * is far out of focus, it appears as a disc with the shape of the stop. A pixel
 * whose light comes at the tangents U looks through the part
 *
 *     X = e - z U,   e in the entrance pupil, z its distance from the front
 *
 * of the front, of which the fraction C is covered. So it gets the haze of a
 * front that is uniformly covered by C: the light of the lamps, spread by the
 * grains' lobe p, times
 *
 *     C = mean over the stop of covered(X)
 *
 * Light of one angle leaves towards one pixel, so that p is taken at the pixel;
 * C is a table of the picture that stays where it is as lamps move. It is sharp
 * where the stop is small and the lens wide, and even at a wide stop of a long
 * lens, as on photographs. The light that dirt blocks counts as a change of
 * exposure, and streaks of single scratches are left out. */
#ifndef GLINT_ENGINE_FRAME_FRONT_H
#define GLINT_ENGINE_FRAME_FRONT_H

#include <stddef.h>

#include "glint/model.h"
#include "glint/setup.h"
#include "glint/view.h"
#include "veil/glare.h"

/* The table of a lens, a stop and a picture. */
struct glint_front_table {
    struct glint_veil_front front; /* nodes are in the same block as this */
    size_t bytes;
    /* fraction that is covered: mean and max over the picture */
    double mean, most;
};

/* The settings for which a table is made. */
struct glint_front_optics {
    double tangent;    /* of a pixel on the axis */
    double z, radius;  /* of the entrance pupil / radius of the front element */
    int width, height; /* pixels */
    int n_blades;
    double rotation_deg, roundness;
};

/* Functions that a program without dirt does not link. */
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

enum { GLINT_FRONT_SIDE = 512 }; /* cells per side of the front's square */

struct glint_front_dirt {
    const struct glint_front_method *method;
    /* [SIDE][SIDE + 1]: sum of the cover from the left up to each cell, in
     * cells; row 0 has the lowest y */
    float *along;
};

/* Returns the cover for the pixel at (X, Y) from the top left, summed over
 * STEPS^2 points of the stop; for tests. */
double glint_front_sum_pixel_cover(const struct glint_front_dirt *dirt,
                                   const struct glint_front_optics *optics,
                                   const struct glint_setup *setup, double x,
                                   double y, int steps);

#endif
