/* SPDX-License-Identifier: MIT
 *
 * A range of angles of one ghost, and the box on the pupil that follows the
 * visible part through it.
 *
 *   in   boxes of visible light at many angles and wavelengths
 *   out  the box's middle and half sizes as polynomials of s and w
 *
 * Coordinates of a zone, each -1 .. 1:
 *   u, v  place in the box, the light's plane along u
 *   s     the sine of the light's angle within the range
 *   w     1 / wavelength^2 within the band
 * In these coordinates a ghost varies smoothly. It is symmetric in v, so only v
 * >= 0 is traced.
 *
 * A zone of a lens that is not round is SKEW: it covers ranges of both
 * components of the light's direction, in the lens's own frame, and
 *   p     the y component of the direction within its range
 * is a fifth variable. Its box lies at any height. */
#ifndef GLINT_BAKE_FIT_ZONE_H
#define GLINT_BAKE_FIT_ZONE_H

#include "bake/visible/visible.h"
#include "bake/regress/regress.h"
#include "glint/model.h"
#include "glint/trace.h"

struct glint_zone {
    double lo, hi;                  /* range of the sine of the angle */
    double middle[GLINT_BOX_TERMS]; /* mm; terms as in a model */
    double half_x[GLINT_BOX_TERMS], half_y[GLINT_BOX_TERMS];
    bool skew;
    double y_lo, y_hi; /* range of the y component of a skew zone's directions;
                          lo .. hi is the range of x */
    double middle_y[GLINT_BOX_TERMS]; /* mm; of a skew zone */
    double fill; /* mean fraction of the box that the ghost needs */
    int annulus; /* as in struct glint_model_system */
};

/* A part of a zone's box and band: u from U0 to U1, v up to TOP, w from W0 to
 * W1. */
struct glint_zone_part {
    double u0, u1, top, w0, w1;
    int annulus;
};

/* Returns the middle or a half size of the box, SIDE, at S and W. */
double glint_zone_at(const double side[GLINT_BOX_TERMS], double s, double w);

/* Returns the same of ZONE, skew or not, at X. */
double glint_zone_side(const struct glint_zone *zone,
                       const double side[GLINT_BOX_TERMS],
                       const double x[GLINT_VARIABLES]);

/* Sets the box for LO .. HI of PROFILE. BY_COLOUR: the box moves with the
 * wavelength and has more terms; else one box contains all colours. */
void glint_zone_init(struct glint_zone *zone,
                     const struct glint_visible_profile *profile, double lo,
                     double hi, bool by_colour);

/* Returns |v| at which an annular box begins, as a fraction of its half height.
 */
double glint_zone_rim(int annulus);

/* Halves PART along v (inner and outer half) or along u. */
void glint_zone_part_halve(const struct glint_zone_part *part, bool along_v,
                           struct glint_zone_part *first,
                           struct glint_zone_part *second);

/* Cuts the box of ZONE to PART. */
void glint_zone_cut(struct glint_zone *zone,
                    const struct glint_zone_part *part);

/* Crops PART to its visible region, with a margin. ZONE must have been cut to
 * PART and VISIBLE narrowed to its band. Returns the fraction of PART that is
 * left, 0 .. 1. */
double glint_zone_crop(const struct glint_zone *zone,
                       const struct glint_visible *visible,
                       struct glint_zone_part *part);

/* Returns node K of N over -1 .. 1, with nodes at both ends. */
double glint_zone_node(int k, int n);

/* Rays of a zone that share a path and are traced together.
 *
 *     batch.path = &path;
 *     for (batch.n = 0; batch.n < GLINT_ZONE_BATCH;)
 *         glint_zone_batch_add(&batch, &zone, x);
 *     glint_zone_batch_trace(&batch); */
enum { GLINT_ZONE_BATCH = 32 };

struct glint_zone_batch {
    const struct glint_path *path;
    int n;
    /* coordinates in the zone, each -1 .. 1 */
    double x[GLINT_ZONE_BATCH][GLINT_VARIABLES];
    struct glint_launch from[GLINT_ZONE_BATCH];
    struct glint_ray ray[GLINT_ZONE_BATCH];
    enum glint_ray_status status[GLINT_ZONE_BATCH];
    double hits[GLINT_ZONE_BATCH * (GLINT_MAX_EVENTS + 1)]
               [2]; /* mm; -1: not reached */
};

/* Adds the ray at X of the zone. X must have the w of the path; v is 0 .. 1
 * from the middle, or the inner end, of the box to its rim, or of a skew zone
 * -1 .. 1. */
void glint_zone_batch_add(struct glint_zone_batch *batch,
                          const struct glint_zone *zone,
                          const double x[GLINT_VARIABLES]);

void glint_zone_batch_trace(struct glint_zone_batch *batch);

/* Returns the position of ray K at each event of the path, [n_events]. */
static inline double (*glint_zone_batch_hits(struct glint_zone_batch *batch,
                                             int k))[2]
{
    return batch->hits + k * batch->path->n_events;
}

/* Sets X to point number K of a sequence that fills ZONE evenly, in five
 * dimensions if ZONE is skew, else with v >= 0. */
void glint_zone_scatter(const struct glint_zone *zone, int k,
                        double x[GLINT_VARIABLES]);

#endif
