/* SPDX-License-Identifier: MIT
 *
 * Traces rays at surfaces that are not centred spheres.
 *
 * A form is such a surface, prepared for tracing (bake/table/form.h). At round
 * forms and at cylinders on the axis, Newton's method runs for all lanes at
 * once and starts at the vertex plane. It is certain to find the nearest
 * intersection if z - sag is monotone along the ray. This holds if the ray
 * stays within the glass and is steeper than the profile at every point. All
 * other rays are intersected one by one.
 */
#include "bake/trace/beam.h"

#include <math.h>

#include "bake/table/form.h"

enum { MOST_STEPS = 10 };
/* Max relative length of the last Newton step; the remaining error is about its
 * square. */
#define LAST_STEP 1e-7
/* max number of aspheric terms (A4 .. A14) of profiles that a faster loop
 * handles */
#define SHORT 6

static void set_beam_ray(struct beam *b, int k, const double at[3],
                         const double way[3])
{
    b->x[k] = at[0];
    b->y[k] = at[1];
    b->z[k] = at[2];
    b->l[k] = way[0];
    b->m[k] = way[1];
    b->n[k] = way[2];
}

/* Squared heights of rays above the axis, as polynomials of the ray parameter
 * T: q0 + 2 q1 T + q2 T^2. */
struct heights {
    double q0[LANES], q1[LANES], q2[LANES];
};

static WHOLLY_INLINE void compute_height_polynomials(const struct beam *b,
                                                     int n,
                                                     const struct glint_form *f,
                                                     struct heights *h)
{
    const double ax = f->along[0], ay = f->along[1], round = f->round;

    for (int k = 0; k < n; k++) {
        const double a = ax * b->x[k] + ay * b->y[k];
        const double da = ax * b->l[k] + ay * b->m[k];
        const double s = ax * b->y[k] - ay * b->x[k];
        const double ds = ax * b->m[k] - ay * b->l[k];

        h->q0[k] = a * a + round * s * s;
        h->q1[k] = a * da + round * s * ds;
        h->q2[k] = da * da + round * ds * ds;
    }
}

/* Sets SAG to the sags of form F at the squared heights Q, by the lens table's
 * formula, and SLOPE to the derivatives by Q. TERMS: a compile-time constant,
 * at least the number of terms of F, so that a ray's sums stay in registers. */
static WHOLLY_INLINE void evaluate_profiles_of_terms(const struct glint_form *f,
                                                     int n, int terms,
                                                     const double *q,
                                                     double *sag, double *slope)
{
    const double c = f->curvature, a = (1.0 + f->conic) * c * c;

    for (int k = 0; k < n; k++) {
        const double root = sqrt(1.0 - a * q[k]);
        const double inverse = 1.0 / (root * (1.0 + root));
        double p = 0.0, dp = 0.0;

        for (int i = terms - 1; i >= 0; i--) {
            dp = dp * q[k] + p;
            p = p * q[k] + f->term[i];
        }
        sag[k] = c * q[k] * root * inverse + q[k] * q[k] * p;
        slope[k] =
            0.5 * c * (1.0 + root) * inverse + q[k] * (2.0 * p + q[k] * dp);
    }
}

static WHOLLY_INLINE void evaluate_profiles(const struct glint_form *f, int n,
                                            const double *q, double *sag,
                                            double *slope)
{
    if (f->n_terms <= SHORT)
        evaluate_profiles_of_terms(f, n, SHORT, q, sag, slope);
    else
        evaluate_profiles_of_terms(f, n, GLINT_SHAPE_TERMS, q, sag, slope);
}

static WHOLLY_INLINE void evaluate_squared_heights(const struct heights *h,
                                                   int n, const double *t,
                                                   double *q)
{
    for (int k = 0; k < n; k++)
        q[k] = h->q0[k] + t[k] * (2.0 * h->q1[k] + t[k] * h->q2[k]);
}

static WHOLLY_INLINE double find_min_value(int n, const double *x)
{
    double least = x[0];

    for (int k = 1; k < n; k++)
        least = x[k] < least ? x[k] : least;
    return least;
}

/* Sets T to the ray parameters at which rays intersect the form. SURE: 1 for
 * rays whose result is certain to be the nearest intersection, else 0. */
static WHOLLY_INLINE void find_form_intersections(const struct beam *b, int n,
                                                  const struct glint_form *f,
                                                  const struct heights *h,
                                                  double *t, double *sure)
{
    double q[LANES], sag[LANES], slope[LANES], done[LANES] = {0};

    for (int k = 0; k < n; k++)
        t[k] = 0.0;
    for (int step = 0; step < MOST_STEPS && find_min_value(n, done) < 1.0;
         step++) {
        evaluate_squared_heights(h, n, t, q);
        evaluate_profiles(f, n, q, sag, slope);
        for (int k = 0; k < n; k++) {
            const double rate =
                b->n[k] - 2.0 * slope[k] * (h->q1[k] + t[k] * h->q2[k]);
            const double by = (t[k] * b->n[k] - sag[k]) / rate;
            const double to = t[k] - by;

            t[k] = done[k] > 0.0 ? t[k] : to;
            done[k] = fabs(by) <= LAST_STEP * (fabs(to) + 0.01 * f->semi_mm)
                          ? 1.0
                          : done[k];
        }
    }
    evaluate_squared_heights(h, n, t, q);
    for (int k = 0; k < n; k++) {
        const double aside2 = b->l[k] * b->l[k] + b->m[k] * b->m[k];
        const double over = h->q0[k] > q[k] ? h->q0[k] : q[k];
        const double found = over <= f->end2 ? done[k] : 0.0;

        sure[k] = b->n[k] * b->n[k] > f->steepest2 * aside2 ? found : 0.0;
    }
}

/* Transforms ray K to the frame of FORM and moves it to FORM. */
static void intersect_ray_with_form(struct beam *b, int k,
                                    const struct glint_form *form)
{
    double at[3] = {b->x[k], b->y[k], b->z[k]};
    double way[3] = {b->l[k], b->m[k], b->n[k]};
    double normal[3];
    bool met;

    glint_form_enter_frame(form, at, way);
    met = glint_form_intersect_ray(form, at, way, normal, &b->cosine[k]);
    b->status[k] = update_ray_status(b->status[k], met, GLINT_RAY_MISSED);
    set_beam_ray(b, k, at, way);
    for (int i = 0; i < 3; i++)
        b->normal[i][k] = normal[i];
}

/* Moves ray K from its position in the batch BEFORE to FORM; the result is in
 * the light's frame. */
static void intersect_form_in_light_frame(struct beam *b, int k,
                                          const struct beam *before,
                                          const struct glint_form *form)
{
    double normal[3];
    double at[3] = {before->x[k], before->y[k], before->z[k]};
    double way[3] = {before->l[k], before->m[k], before->n[k]};

    set_beam_ray(b, k, at, way);
    intersect_ray_with_form(b, k, form);
    for (int i = 0; i < 3; i++) {
        normal[i] = 0.0;
        for (int j = 0; j < 3; j++)
            normal[i] += form->turn[j][i] * b->normal[j][k];
    }
    at[0] = b->x[k], at[1] = b->y[k], at[2] = b->z[k];
    way[0] = b->l[k], way[1] = b->m[k], way[2] = b->n[k];
    glint_form_leave_frame(form, at, way);
    set_beam_ray(b, k, at, way);
    for (int i = 0; i < 3; i++)
        b->normal[i][k] = normal[i];
}

/* Moves rays by T to the form and sets their normals. SLOPE: derivative of the
 * profile by the squared height. */
static WHOLLY_INLINE void move_rays_to_form(struct beam *b, int n,
                                            const struct glint_form *f,
                                            const double *t,
                                            const double *slope)
{
    const double ax = f->along[0], ay = f->along[1];

    for (int k = 0; k < n; k++) {
        const double x = b->x[k] + t[k] * b->l[k];
        const double y = b->y[k] + t[k] * b->m[k];
        const double a = 2.0 * slope[k] * (ax * x + ay * y);
        const double s = 2.0 * slope[k] * f->round * (ax * y - ay * x);
        const double sx = a * ax - s * ay, sy = a * ay + s * ax;
        const double size = sqrt(1.0 + sx * sx + sy * sy);

        b->x[k] = x;
        b->y[k] = y;
        b->z[k] = t[k] * b->n[k];
        b->normal[0][k] = -sx / size;
        b->normal[1][k] = -sy / size;
        b->normal[2][k] = 1.0 / size;
        b->cosine[k] = (b->n[k] - sx * b->l[k] - sy * b->m[k]) / size;
    }
}

static WHOLLY_INLINE void move_rays_to_level_form(struct beam *b, int n,
                                                  const struct glint_form *form)
{
    double t[LANES], q[LANES], sag[LANES], slope[LANES], sure[LANES];
    struct heights heights;
    const struct beam before = *b;

    compute_height_polynomials(b, n, form, &heights);
    find_form_intersections(b, n, form, &heights, t, sure);
    evaluate_squared_heights(&heights, n, t, q);
    evaluate_profiles(form, n, q, sag, slope);
    move_rays_to_form(b, n, form, t, slope);
    for (int k = 0; k < n; k++)
        if (!(sure[k] > 0.0 || b->status[k] > GLINT_RAY_OK))
            intersect_form_in_light_frame(b, k, &before, form);
}

WIDE_VECTORS
void glint_beam_move_to_form(struct beam *b, int n,
                             const struct glint_form *form)
{
    if (!form->level)
        for (int k = 0; k < n; k++)
            intersect_ray_with_form(b, k, form);
    else if (n == LANES)
        move_rays_to_level_form(b, LANES, form);
    else
        move_rays_to_level_form(b, 1, form);
}

void glint_beam_leave_form_frame(struct beam *b, int n,
                                 const struct glint_form *form)
{
    if (form->level)
        return;
    for (int k = 0; k < n; k++) {
        double at[3] = {b->x[k], b->y[k], b->z[k]};
        double way[3] = {b->l[k], b->m[k], b->n[k]};
        glint_form_leave_frame(form, at, way);
        set_beam_ray(b, k, at, way);
    }
}

/* Refracts or reflects ray K at a form: new direction = S * direction + PART *
 * normal. Marks the ray as missed unless the z component of the direction keeps
 * its sign (WAY = 1: refraction) or changes it (WAY = -1: reflection). */
static WHOLLY_INLINE void deflect_ray_at_form(struct beam *b, int k, double s,
                                              double part, double way)
{
    const double before = b->n[k];

    b->l[k] = s * b->l[k] + part * b->normal[0][k];
    b->m[k] = s * b->m[k] + part * b->normal[1][k];
    b->n[k] = s * before + part * b->normal[2][k];
    b->status[k] = update_ray_status(b->status[k], way * before * b->n[k] > 0.0,
                                     GLINT_RAY_MISSED);
}

static WHOLLY_INLINE void refract_or_reflect_at_form(struct beam *b, int n,
                                                     bool reflects,
                                                     double ratio,
                                                     const double *out)
{
    for (int k = 0; k < n && reflects; k++)
        deflect_ray_at_form(b, k, 1.0, -2.0 * b->cosine[k], -1.0);
    for (int k = 0; k < n && !reflects; k++) {
        b->status[k] = update_ray_status(b->status[k], out[k] > 0.0,
                                         GLINT_RAY_TOTAL_REFLECTION);
        deflect_ray_at_form(
            b, k, ratio,
            (b->n[k] < 0.0 ? -out[k] : out[k]) - ratio * b->cosine[k], 1.0);
    }
}

WIDE_VECTORS
void glint_beam_deflect_at_form(struct beam *b, int n, bool reflects,
                                double ratio, const double *out)
{
    if (n == LANES)
        refract_or_reflect_at_form(b, LANES, reflects, ratio, out);
    else
        refract_or_reflect_at_form(b, 1, reflects, ratio, out);
}
