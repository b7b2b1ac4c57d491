/* SPDX-License-Identifier: MIT
 *
 * Rays that are traced together.
 *
 *   in   rays in the vertex plane of a surface, in the light's frame
 *   out  the same rays on it, and beyond it
 *
 * Spheres are crossed in trace.c, all other surfaces in forms.c. */
#ifndef GLINT_BAKE_TRACE_BEAM_H
#define GLINT_BAKE_TRACE_BEAM_H

#include "base/compiler.h"
#include "glint/trace.h"

/* Rays are traced eight at a time: a root or a division waits for the previous
 * result of its own ray, but not of other rays. All code is loops over N lanes,
 * and conditions select between two values, so that compilers can use vectors;
 * an invalid ray continues with meaningless values. The operations of a ray do
 * not depend on N, and neither do its bits. */
enum { LANES = 8 };

struct beam {
    double x[LANES], y[LANES], z[LANES]; /* mm, from the vertex of the event */
    double l[LANES], m[LANES], n[LANES]; /* direction, unit length */
    double cosine[LANES];    /* cosine between ray and normal at the surface */
    double normal[3][LANES]; /* unit normal, of shaped surfaces only */
    double energy[LANES];
    /* Height and semi-diameter where their ratio was largest so far, squared.
     */
    double height2[LANES], semi2[LANES];
    double stop_x[LANES], stop_y[LANES];
    double status[LANES]; /* an enum glint_ray_status, as a number */
};

/* Returns SO_FAR if the ray is invalid already, else GLINT_RAY_OK if FINE, else
 * STATUS. */
static WHOLLY_INLINE double judge(double so_far, bool fine,
                                  enum glint_ray_status status)
{
    const double now = fine ? (double)GLINT_RAY_OK : (double)status;

    return so_far > GLINT_RAY_OK ? so_far : now;
}

/* Moves rays from the vertex plane to FORM, and into its frame unless that is
 * round or a cylinder on the axis. N is LANES or 1. */
void glint_beam_meet_form(struct beam *b, int n, const struct glint_form *form);

/* Refracts rays, or reflects them, where they have met a form. RATIO is the
 * ratio of the indices before it and behind it, OUT are the cosines behind
 * it. */
void glint_beam_cross_form(struct beam *b, int n, bool reflects, double ratio,
                           const double *out);

/* Moves rays back from the frame of FORM to the light's. */
void glint_beam_leave_form(struct beam *b, int n,
                           const struct glint_form *form);

#endif
