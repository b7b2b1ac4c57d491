/* SPDX-License-Identifier: MIT
 *
 * A batch of rays that is traced together through one surface.
 *
 *   in   rays in the vertex plane of a surface, in the light's frame
 *   out  the same rays at the surface, and behind it
 *
 * trace.c handles spheres, forms.c all other surfaces.
 */
#ifndef GLINT_BAKE_TRACE_BEAM_H
#define GLINT_BAKE_TRACE_BEAM_H

#include "base/compiler.h"
#include "glint/trace.h"

/* Rays are traced eight at a time: a square root or division depends on
 * earlier results of its own ray only, so the CPU can overlap them. All code
 * is loops over N lanes, and conditions select between two values, so that
 * compilers can vectorise; an invalid ray continues with meaningless values.
 * Results of a ray are bit-identical for every N. */
enum { LANES = 8 };

struct beam {
    /* mm, relative to the vertex of the event */
    double x[LANES], y[LANES], z[LANES];
    double l[LANES], m[LANES], n[LANES]; /* direction, unit length */
    double cosine[LANES];    /* cosine between ray and normal at the surface */
    double normal[3][LANES]; /* unit normal, only of surfaces that are not
                                spheres */
    double energy[LANES];
    /* squared height and squared semi-diameter at the event where their
     * ratio was largest so far */
    double height2[LANES], semi2[LANES];
    double stop_x[LANES], stop_y[LANES];
    double status[LANES]; /* enum glint_ray_status as a double */
};

/* Returns the new status of a ray: SO_FAR if the ray is invalid already,
 * else GLINT_RAY_OK if FINE is true, else STATUS. */
static WHOLLY_INLINE double judge(double so_far, bool fine,
                                  enum glint_ray_status status)
{
    const double now = fine ? (double)GLINT_RAY_OK : (double)status;

    return so_far > GLINT_RAY_OK ? so_far : now;
}

/* Moves rays from the vertex plane to FORM; also transforms them to its
 * frame, unless FORM is round or a cylinder, and on the axis. N is LANES or
 * 1. */
void glint_beam_meet_form(struct beam *b, int n, const struct glint_form *form);

/* Refracts or reflects rays at a form. RATIO is the index before / the index
 * behind it, OUT are the cosines behind it. */
void glint_beam_cross_form(struct beam *b, int n, bool reflects, double ratio,
                           const double *out);

/* Transforms rays from the frame of FORM back to the light's frame. */
void glint_beam_leave_form(struct beam *b, int n,
                           const struct glint_form *form);

#endif
