/* SPDX-License-Identifier: MIT
 *
 * Computes size and irradiance of primitives, which are the cells of a ray grid
 * (quads) or halves of cells (triangles). */
#ifndef GLINT_FLARE_PRIMITIVE_H
#define GLINT_FLARE_PRIMITIVE_H

#include <stdint.h>

#include "glint/bundle.h"
#include "tile/box.h"

enum {
    GLINT_CUT_STOP = 1,   /* the outline of the stop may cross the cell */
    GLINT_CUT_BARREL = 2, /* a barrel aperture may cross the cell */
    /* the functions of round cuts have already been corrected for interpolation
     * (sags) */
    GLINT_CUT_LOWERED = 16
};

/* Max light that a cell may add to a pixel, 1 = display white. */
enum { GLINT_LIMIT_Q8 = 1 << 19 };

/* Fraction bits of a vertex position. */
enum { GLINT_VERTEX_FRAC = 8 };

/* The corners of a primitive. */
struct glint_corners {
    int n; /* 3 or 4 */
    const struct glint_vertex *at[4];
    int64_t area2_q16; /* twice the signed area of the primitive, pixels^2 */
};

/* Returns the cross product (B - A) x (P - A). It is positive if the triangle
 * A, B, P turns from the x axis towards the y axis. It is within +-2^60 for
 * coordinates inside GLINT_VERTEX_LIMIT_Q8. */
static inline int64_t glint_compute_cross_product_q16(int32_t ax, int32_t ay,
                                                      int32_t bx, int32_t by,
                                                      int32_t px, int32_t py)
{
    return (int64_t)(bx - ax) * (py - ay) - (int64_t)(by - ay) * (px - ax);
}

/* Returns the irradiance of a primitive that covers AREA / 2^FRAC pixels and
 * has 2^SHARE_LOG2 times the flux of a cell. FRAC must be at most 33, AREA at
 * least 1. The result is clamped so that no pixel gets more than LIMIT_Q8. If
 * it was clamped, *N_HELD is incremented. */
int64_t glint_compute_irradiance_q22(const struct glint_bundle *bundle,
                                     int share_log2, int64_t area, int frac,
                                     int32_t limit_q8, int *n_held);

/* Returns the bounding box of all pixels that a primitive may cover, clipped to
 * a picture of WIDTH x HEIGHT pixels. A thin primitive covers the strip that
 * replaces it. */
struct glint_box
glint_corners_compute_pixel_box(const struct glint_corners *corners, int width,
                                int height);

/* Sets CORNERS to the N vertices AT (3 or 4), and computes the area. */
static inline void glint_corners_set(struct glint_corners *corners,
                                     const struct glint_vertex *const *at,
                                     int n)
{
    const struct glint_vertex *const *p = corners->at;

    corners->n = n;
    for (int i = 0; i < 4; i++)
        corners->at[i] = at[i < n ? i : 0];
    /* For a quad it is the cross product of the diagonals, for a triangle that
     * of two sides. */
    if (n == 4)
        corners->area2_q16 =
            (int64_t)(p[2]->x_q8 - p[0]->x_q8) * (p[3]->y_q8 - p[1]->y_q8) -
            (int64_t)(p[2]->y_q8 - p[0]->y_q8) * (p[3]->x_q8 - p[1]->x_q8);
    else
        corners->area2_q16 =
            glint_compute_cross_product_q16(p[0]->x_q8, p[0]->y_q8, p[1]->x_q8,
                                            p[1]->y_q8, p[2]->x_q8, p[2]->y_q8);
}

/* Returns the distance |x| + |y| between vertices A and B, pixels _q8. */
static inline int64_t
glint_vertex_compute_distance_q8(const struct glint_vertex *a,
                                 const struct glint_vertex *b)
{
    const int64_t x = (int64_t)a->x_q8 - b->x_q8,
                  y = (int64_t)a->y_q8 - b->y_q8;

    return (x < 0 ? -x : x) + (y < 0 ? -y : y);
}

/* Returns 1 if C is a quad that is certainly not thin: twice its area is at
 * least an eighth of the sum of its diagonals, |x| + |y| in pixels, and that
 * sum exceeds its width and height. Quick test for glint_corners_are_thin(). */
static inline int
glint_corners_are_certainly_thick(const struct glint_corners *c)
{
    return c->n == 4 &&
           (c->area2_q16 < 0 ? -c->area2_q16 : c->area2_q16) >=
               32 * (glint_vertex_compute_distance_q8(c->at[0], c->at[2]) +
                     glint_vertex_compute_distance_q8(c->at[1], c->at[3]));
}

/* Return whether a primitive is thinner than a sixteenth of a pixel.
 * glint_corners_are_thin() is the faster function, as it makes a quick test
 * first. */
int glint_corners_test_thinness(const struct glint_corners *corners);
static inline int glint_corners_are_thin(const struct glint_corners *corners)
{
    return corners->area2_q16 == 0 ||
           (!glint_corners_are_certainly_thick(corners) &&
            glint_corners_test_thinness(corners));
}

/* Returns whether all corners lie in a square whose sides are 1 / PART of a
 * pixel long. */
int glint_corners_fit_into_pixel_part(const struct glint_corners *corners,
                                      int part);

#endif
