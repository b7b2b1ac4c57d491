/* SPDX-License-Identifier: MIT
 *
 * A zone: a range of angles of one ghost, and a box on the pupil that contains
 * the ghost's rays at each angle.
 *
 *   in   boxes of visible light at many angles and wavelengths
 *   out  centre and half sizes of the box as polynomials of s and w
 *
 * Coordinates in a zone, each -1 .. 1:
 *   u, v  position in the box; u lies in the plane of the light
 *   s     position of the sine of the light's angle within the range
 *   w     position of 1 / wavelength^2 within the band
 * A ghost is a smooth function of these coordinates. It is symmetric in v, so
 * only v >= 0 is traced.
 *
 * In lenses that are not round, zones are SKEW: they cover ranges of both
 * components of the light's direction, in the lens's own frame. A fifth
 * variable,
 *   p     position of the direction's y component within its range,
 * is added. The box may be centred at any height.
 */
#ifndef GLINT_BAKE_FIT_ZONE_H
#define GLINT_BAKE_FIT_ZONE_H

#include "bake/visible/visible.h"
#include "bake/regress/regress.h"
#include "glint/model.h"
#include "glint/trace.h"

struct glint_zone {
    double lo, hi; /* range of light angles, sines */
    /* polynomial of the box's centre along u, mm; terms as in a model */
    double middle[GLINT_BOX_TERMS];
    double half_x[GLINT_BOX_TERMS], half_y[GLINT_BOX_TERMS];
    bool skew;
    /* skew zones only: range of the y components of directions; lo .. hi is
     * then the range of x components */
    double y_lo, y_hi;
    /* skew zones only: polynomial of the box's centre along v, mm */
    double middle_y[GLINT_BOX_TERMS];
    double fill; /* mean fraction of the box that visible light fills */
    /* index of the ring of the pupil, as in struct glint_model_system */
    int annulus;
};

/* A part of a zone's box and band: u in u0 .. u1 and |v| up to top (-1 .. 1,
 * 0 .. 1), w in w0 .. w1. */
struct glint_zone_part {
    double u0, u1, top, w0, w1;
    int annulus;
};

/* Evaluates SIDE, a box polynomial of a round lens (centre or half size, mm),
 * at S and W. */
double
glint_zone_evaluate_round_box_polynomial(const double side[GLINT_BOX_TERMS],
                                         double s, double w);

/* Evaluates SIDE, a box polynomial of ZONE (centre or half size, mm), at X. */
double glint_zone_evaluate_box_polynomial(const struct glint_zone *zone,
                                          const double side[GLINT_BOX_TERMS],
                                          const double x[GLINT_VARIABLES]);

/* Fits a box to the visible boxes of PROFILE at the angles LO .. HI, sines.
 * BY_COLOUR: the box depends on the wavelength; else it contains the light of
 * all wavelengths. */
void glint_zone_init(struct glint_zone *zone,
                     const struct glint_visible_profile *profile, double lo,
                     double hi, bool by_colour);

/* Returns the inner radius |v| of the pupil's ring ANNULUS, as a fraction of
 * its outer radius. */
double glint_zone_get_inner_rim(int annulus);

/* Halves PART along v, into an inner and an outer half, or along u. */
void glint_zone_halve_part(const struct glint_zone_part *part, bool along_v,
                           struct glint_zone_part *first,
                           struct glint_zone_part *second);

/* Cuts box and band of ZONE to PART. */
void glint_zone_cut_to_part(struct glint_zone *zone,
                            const struct glint_zone_part *part);

/* Crops PART to its visible region, with a margin. ZONE must have been cut to
 * PART, and VISIBLE narrowed to its band. Returns the fraction of PART that
 * remains, 0 .. 1. */
double glint_zone_crop_part(const struct glint_zone *zone,
                            const struct glint_visible *visible,
                            struct glint_zone_part *part);

/* Returns node K of N nodes on -1 .. 1, both ends included. Nodes are denser
 * towards the ends. */
double glint_zone_compute_node(int k, int n);

/* A batch of rays of a zone that share a path (wavelength) and are traced
 * together.
 *
 * batch.path = &path;
 * for (batch.n = 0; batch.n < GLINT_ZONE_BATCH;)
 *     glint_zone_batch_add_ray(&batch, &zone, x);
 * glint_zone_batch_trace_rays(&batch, false); */
enum { GLINT_ZONE_BATCH = 32 };

struct glint_zone_batch {
    const struct glint_path *path;
    int n;
    /* zone coordinates of each ray */
    double x[GLINT_ZONE_BATCH][GLINT_VARIABLES];
    struct glint_launch from[GLINT_ZONE_BATCH];
    struct glint_ray ray[GLINT_ZONE_BATCH];
    enum glint_ray_status status[GLINT_ZONE_BATCH];
    /* positions at the events of the path, mm, if they were requested; -1, -1:
     * the ray does not reach the event */
    double hits[GLINT_ZONE_BATCH * (GLINT_MAX_EVENTS + 1)][2];
};

/* Adds the ray at zone coordinates X to BATCH. Its w must be the wavelength of
 * the path. v: 0 (centre or inner edge of the box) .. 1 (rim); in skew zones
 * -1 .. 1. */
void glint_zone_batch_add_ray(struct glint_zone_batch *batch,
                              const struct glint_zone *zone,
                              const double x[GLINT_VARIABLES]);

/* HITS: also sets the hits of BATCH. */
void glint_zone_batch_trace_rays(struct glint_zone_batch *batch, bool hits);

/* Returns the positions of ray K at the events of the path, mm, [n_events]. */
static inline double (*glint_zone_batch_get_hits(struct glint_zone_batch *batch,
                                                 int k))[2]
{
    return batch->hits + k * batch->path->n_events;
}

/* Sets X to point K of a low-discrepancy sequence that fills ZONE: four
 * dimensions with v >= 0; five if ZONE is skew. */
void glint_zone_set_scattered_point(const struct glint_zone *zone, int k,
                                    double x[GLINT_VARIABLES]);

#endif
