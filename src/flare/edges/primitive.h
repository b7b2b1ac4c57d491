/* SPDX-License-Identifier: MIT
 *
 * What the tiles are filled with: convex quads and triangles over the vertices
 * of the ray grids, each with one irradiance.
 */
#ifndef GLINT_FLARE_PRIMITIVE_H
#define GLINT_FLARE_PRIMITIVE_H

#include <stdint.h>

#include "glint/bundle.h"
#include "tile/box.h"

enum {
    GLINT_CUT_STOP = 1,     /* the outline of the stop may cross it */
    GLINT_CUT_BARREL = 2,   /* a barrel may cross it */
    GLINT_CUT_LOWERED = 16, /* round cuts were lowered by their sag */
    GLINT_POINT = 4,  /* far smaller than a pixel: all its light goes to the
                         pixel its middle lies in */
    GLINT_SAMPLED = 8 /* the ghost has cells of a few pixels: 4 x 4 places of
                         each pixel are looked at */
};

struct glint_primitive {
    int32_t vertex[4]; /* corners in order, area positive; a triangle has -1
                          last */
    int32_t irradiance_q20; /* display white, at energy 1; of a point: what it
                               adds to its pixel */
    uint16_t bundle;
    int8_t share_log2; /* cells whose light it has; -1: half of one */
    uint8_t flags;     /* GLINT_CUT_, GLINT_POINT, GLINT_SAMPLED */
};

/* Largest light of a primitive in a pixel, display white. */
enum { GLINT_LIMIT_Q8 = 1 << 19 };

/* Fraction bits of a vertex position. */
enum { GLINT_VERTEX_FRAC = 8 };

/* A primitive's corners, gathered. */
struct glint_corners {
    int n; /* 3 or 4 */
    const struct glint_vertex *at[4];
    int64_t area2_q16; /* twice the area, pixels squared, > 0 */
};

/* (B - A) x (P - A), q16: positive where A, B, P turn to the positive side.
 * Within +-2^60 for coordinates inside GLINT_VERTEX_LIMIT_Q8. */
static inline int64_t glint_turn_q16(int32_t ax, int32_t ay, int32_t bx,
                                     int32_t by, int32_t px, int32_t py)
{
    return (int64_t)(bx - ax) * (py - ay) - (int64_t)(by - ay) * (px - ax);
}

/* Irradiance of 2^SHARE_LOG2 cells spread over AREA / 2^FRAC pixels, FRAC up to
 * 33 and AREA at least 1; held so that no pixel gets more than LIMIT, and then
 * counted in N_HELD. */
int64_t glint_irradiance_q22(const struct glint_bundle *bundle, int share_log2,
                             int64_t area, int frac, int32_t limit_q8,
                             int *n_held);

/* Every pixel that CORNERS, or the strip in their place, may cover. */
struct glint_box glint_corners_reach(const struct glint_corners *corners,
                                     int width, int height);

/* Sets the N (3 or 4) corners AT. */
static inline void glint_corners_set(struct glint_corners *corners,
                                     const struct glint_vertex *const *at,
                                     int n)
{
    const struct glint_vertex *const *p = corners->at;

    corners->n = n;
    for (int i = 0; i < 4; i++)
        corners->at[i] = at[i < n ? i : 0];
    /* The cross product of the diagonals, or of two sides. */
    if (n == 4)
        corners->area2_q16 =
            (int64_t)(p[2]->x_q8 - p[0]->x_q8) * (p[3]->y_q8 - p[1]->y_q8) -
            (int64_t)(p[2]->y_q8 - p[0]->y_q8) * (p[3]->x_q8 - p[1]->x_q8);
    else
        corners->area2_q16 = glint_turn_q16(p[0]->x_q8, p[0]->y_q8, p[1]->x_q8,
                                            p[1]->y_q8, p[2]->x_q8, p[2]->y_q8);
}

/* Returns the sum of the sizes of all components of two vectors. */
static inline int64_t glint_reach(const struct glint_vertex *a,
                                  const struct glint_vertex *b)
{
    const int64_t x = (int64_t)a->x_q8 - b->x_q8,
                  y = (int64_t)a->y_q8 - b->y_q8;

    return (x < 0 ? -x : x) + (y < 0 ? -y : y);
}

/* Surely not: its diagonals are longer than it is wide and high. */
static inline int glint_corners_stout(const struct glint_corners *c)
{
    return c->n == 4 && (c->area2_q16 < 0 ? -c->area2_q16 : c->area2_q16) >=
                            32 * (glint_reach(c->at[0], c->at[2]) +
                                  glint_reach(c->at[1], c->at[3]));
}

/* Returns whether CORNERS are thinner than a sixteenth of a pixel. The lean
 * variant gives the same for corners that are not stout. */
int glint_corners_lean(const struct glint_corners *corners);
static inline int glint_corners_thin(const struct glint_corners *corners)
{
    return corners->area2_q16 == 0 ||
           (!glint_corners_stout(corners) && glint_corners_lean(corners));
}

/* Gathers the N corners with the numbers VERTEX of V. */
void glint_corners_gather(struct glint_corners *corners,
                          const struct glint_vertex *v, const int32_t *vertex,
                          int n);

/* Returns whether all corners lie within 1/PART of a pixel of each other. */
int glint_corners_tiny(const struct glint_corners *corners, int part);

/* The pixel that the mean of CORNERS lies in, as a box; empty outside. */
struct glint_box glint_corners_pixel(const struct glint_corners *corners,
                                     int width, int height);

/* The pixels of a WIDTH x HEIGHT picture that CORNERS may cover. */
struct glint_box glint_corners_box(const struct glint_corners *corners,
                                   int width, int height);

/* The pixels of primitive P with CORNERS, by what it is. */
struct glint_box glint_primitive_box(const struct glint_primitive *p,
                                     const struct glint_corners *corners,
                                     int width, int height);

static inline int glint_primitive_corners(const struct glint_primitive *p)
{
    return p->vertex[3] < 0 ? 3 : 4;
}

#endif
