/* SPDX-License-Identifier: MIT
 *
 * A batch of rays that are traced together through one surface.
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

/* Eight rays are traced at a time: a square root or division depends on earlier
 * results of its own ray only, so the CPU can overlap them. All code consists
 * of loops over N lanes, and conditions select between two values, so that
 * compilers can vectorise; an invalid ray continues with meaningless values. A
 * ray's results are bit-identical for every N. */
enum { LANES = 16 };

struct beam {
    /* position, mm, relative to the vertex of the current surface */
    double x[LANES], y[LANES], z[LANES];
    double l[LANES], m[LANES], n[LANES]; /* direction, a unit vector */
    double cosine[LANES];    /* cosine between ray and normal at the surface */
    double normal[3][LANES]; /* unit normal; non-spherical surfaces only */
    double energy[LANES];
    /* squared height and squared semi-diameter at the event where the ray came
     * closest to the rim or exceeded it most (max height / semi-diameter) */
    double height2[LANES], semi2[LANES];
    double stop_x[LANES], stop_y[LANES];
    /* status of each ray, enum glint_ray_status as a double */
    double status[LANES];
};

/* Returns the new status of a ray: SO_FAR if the ray is already invalid.
 * Otherwise returns GLINT_RAY_OK if FINE is true, else STATUS. */
static WHOLLY_INLINE double update_ray_status(double so_far, bool fine,
                                              enum glint_ray_status status)
{
    const double now = fine ? (double)GLINT_RAY_OK : (double)status;

    return so_far > GLINT_RAY_OK ? so_far : now;
}

/* Moves N rays (LANES or 1) from the vertex plane to FORM. Also transforms them
 * to the form's own frame, unless FORM is level: round or a cylinder, without
 * decentre and tilt. */
void glint_beam_move_to_form(struct beam *b, int n,
                             const struct glint_form *form);

/* Refracts or reflects N rays at a form. RATIO: index of refraction in front of
 * the form / index behind it. OUT[N]: cosines between the normal and the
 * refracted rays. */
void glint_beam_deflect_at_form(struct beam *b, int n, bool reflects,
                                double ratio, const double *out);

/* Transforms rays from the frame of FORM back to the light's frame. */
void glint_beam_leave_form_frame(struct beam *b, int n,
                                 const struct glint_form *form);

#endif
