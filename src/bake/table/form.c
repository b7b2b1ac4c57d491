/* SPDX-License-Identifier: MIT */
#include "bake/table/form.h"

#include <math.h>
#include <string.h>

#include "engine/setup/degrees.h"

/* Max height, in semi-diameters, at which the sag is computed by the lens
 * table's formula. At larger heights the sag is a smooth continuation. */
#define GLASS_ENDS 1.1
/* The table's formula ends at the squared height end2. Beyond, the curvature
 * decreases to 0 over about this fraction of end2. */
#define FADES 0.25

/* Factor by which the max squared slope of the samples is raised, because
 * slopes between samples may be larger. */
#define STEEPER 1.1

enum { MOST_STEPS = 80, MOST_HALVINGS = 60, SLOPES = 64 };

bool glint_surface_is_shaped(const struct glint_surface *s)
{
    const struct glint_shape *const a = &s->shape;
    bool shaped = a->bend != GLINT_BEND_ROUND || a->conic != 0.0;

    for (int k = 0; k < GLINT_SHAPE_TERMS; k++)
        shaped |= a->term[k] != 0.0;
    for (int k = 0; k < 2; k++)
        shaped |= a->decentre_mm[k] != 0.0 || a->tilt_deg[k] != 0.0;
    return shaped;
}

bool glint_prescription_is_round(const struct glint_prescription *lens)
{
    for (int k = 0; k < lens->n_surfaces; k++) {
        const struct glint_shape *const a = &lens->surface[k].shape;

        if (a->bend != GLINT_BEND_ROUND || a->decentre_mm[0] != 0.0 ||
            a->decentre_mm[1] != 0.0 || a->tilt_deg[0] != 0.0 ||
            a->tilt_deg[1] != 0.0)
            return false;
    }
    return true;
}

/* --------------------------------------------------------------------- sag */

/* Evaluates the lens table's formula for the profile, which is the sag as a
 * function of the squared height. Sets AT to its value at H2 and to its first
 * and second derivative by H2. */
static void evaluate_table_profile(const struct glint_form *f, double h2,
                                   double at[3])
{
    const double c = f->curvature, a = (1.0 + f->conic) * c * c;
    const double root = sqrt(1.0 - a * h2);
    double p[3] = {0, 0, 0};

    for (int k = GLINT_SHAPE_TERMS - 1; k >= 0; k--) {
        p[2] = p[2] * h2 + 2.0 * p[1];
        p[1] = p[1] * h2 + p[0];
        p[0] = p[0] * h2 + f->term[k];
    }
    at[0] = c * h2 / (1.0 + root) + h2 * h2 * p[0];
    at[1] = 0.5 * c / root + h2 * (2.0 * p[0] + h2 * p[1]);
    at[2] = 0.25 * c * a / (root * root * root) + 2.0 * p[0] +
            h2 * (4.0 * p[1] + h2 * p[2]);
}

/* Returns the profile (sag) at squared height H2, with its smooth continuation
 * beyond end2. SLOPE receives the derivative by H2. */
static double evaluate_continued_profile(const struct glint_form *f, double h2,
                                         double *slope)
{
    const double beyond = h2 - f->end2;
    double at[3], fade;

    if (!(beyond > 0.0)) {
        evaluate_table_profile(f, h2, at);
        *slope = at[1];
        return at[0];
    }
    fade = 1.0 + beyond / (FADES * f->end2);
    *slope = f->end_at[1] +
             0.5 * f->end_at[2] * beyond * (1.0 + fade) / (fade * fade);
    return f->end_at[0] +
           beyond * (f->end_at[1] + 0.5 * f->end_at[2] * beyond / fade);
}

double glint_form_compute_sag(const struct glint_form *f, double x, double y,
                              double slope[2])
{
    const double along = f->bend == GLINT_BEND_X ? x : y;
    const double aside = f->bend == GLINT_BEND_X ? y : x;
    const int first = f->bend == GLINT_BEND_X ? 0 : 1;
    double by_h2, q, free, root;

    if (f->bend == GLINT_BEND_ROUND) {
        q = evaluate_continued_profile(f, x * x + y * y, &by_h2);
        slope[0] = 2.0 * x * by_h2;
        slope[1] = 2.0 * y * by_h2;
        return q;
    }
    /* Toric: solves (R - z)^2 + aside^2 = (R - q)^2 for the sag z. R is the
     * radius across the axis, q the sag of the profile along the axis. Only 1 /
     * R occurs in the solution, so that R may be infinite. */
    q = evaluate_continued_profile(f, along * along, &by_h2);
    free = 1.0 - f->across * q;
    root = free * free - f->across * f->across * aside * aside;
    if (!(free > 0.0 && root > 0.0))
        return (double)NAN;
    root = sqrt(root);
    slope[first] = 2.0 * along * by_h2 * free / root;
    slope[!first] = f->across * aside / root;
    return q + f->across * aside * aside / (free + root);
}

/* -------------------------------------------------------------------- rays */

/* a ray in the form's own frame */
struct line {
    const double *at, *direction;
};

/* Returns the height z - sag above the form, at parameter T of the ray LINE.
 * RATE receives the derivative of the height by T. */
static double compute_height_above_form(const struct glint_form *f,
                                        const struct line *line, double t,
                                        double *rate, double slope[2])
{
    const double *const d = line->direction;
    const double sag = glint_form_compute_sag(f, line->at[0] + t * d[0],
                                              line->at[1] + t * d[1], slope);

    *rate = d[2] - slope[0] * d[0] - slope[1] * d[1];
    return t * d[2] - sag;
}

/* Sets BRACKET to two parameters of the ray, the nearer first, between which
 * the ray crosses the form. Returns false if it does not cross the form near
 * the barrel. */
static bool bracket_ray_intersection(const struct glint_form *f,
                                     const struct line *line, double bracket[2])
{
    double slope[2] = {0, 0}, rate,
           g = compute_height_above_form(f, line, 0.0, &rate, slope);
    const double first = g, side = line->direction[2] < 0.0 ? -g : g;
    const double reach =
        8.0 * (f->semi_mm + fabs(line->at[0]) + fabs(line->at[1]));
    double step = (side < 0.0 ? 0.5 : -0.5) * fabs(g);

    bracket[0] = bracket[1] = 0.0;
    if (g == 0.0)
        return true;
    for (int k = 0; k < MOST_STEPS && fabs(bracket[1]) < reach; k++) {
        bracket[0] = bracket[1];
        bracket[1] += step;
        g = compute_height_above_form(f, line, bracket[1], &rate, slope);
        if (!isfinite(g))
            return false;
        if ((g < 0.0) != (first < 0.0) || g == 0.0)
            return true;
        step *= 1.5;
    }
    return false;
}

/* Returns the parameter, LOW .. HIGH, at which the ray crosses the form. */
static double refine_ray_intersection(const struct glint_form *f,
                                      const struct line *line, double low,
                                      double high)
{
    double slope[2] = {0, 0}, rate;
    const bool rises =
        compute_height_above_form(f, line, low, &rate, slope) < 0.0;
    double t = 0.5 * (low + high);

    for (int k = 0; k < MOST_HALVINGS; k++) {
        const double g = compute_height_above_form(f, line, t, &rate, slope);
        double next = t - g / rate;

        if ((g < 0.0) == rises)
            low = t;
        else
            high = t;
        /* bisects instead if the step is NaN or leaves the bracket */
        if (!((next > low && next < high) || (next < low && next > high)))
            next = g == 0.0 ? t : 0.5 * (low + high);
        if (fabs(next - t) <= 2e-16 * (fabs(t) + 0.01 * f->semi_mm))
            return next;
        t = next;
    }
    return t;
}

bool glint_form_intersect_ray(const struct glint_form *f, double at[3],
                              const double direction[3], double normal[3],
                              double *cosine)
{
    const struct line line = {at, direction};
    double bracket[2], slope[2] = {0, 0}, rate, t, size;

    normal[0] = normal[1] = 0.0;
    normal[2] = *cosine = 1.0;
    if (!bracket_ray_intersection(f, &line, bracket))
        return false;
    t = refine_ray_intersection(f, &line, bracket[0], bracket[1]);
    compute_height_above_form(f, &line, t, &rate, slope);
    for (int k = 0; k < 2; k++)
        at[k] += t * direction[k];
    at[2] = t * direction[2];
    size = sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
    normal[0] = -slope[0] / size;
    normal[1] = -slope[1] / size;
    normal[2] = 1.0 / size;
    if (!(rate * direction[2] > 0.0))
        return false; /* the ray comes from behind the surface */
    *cosine = rate / size;
    return true;
}

/* ------------------------------------------------------------------- frame */

void glint_form_enter_frame(const struct glint_form *f, double at[3],
                            double direction[3])
{
    double p[3], d[3], t;

    for (int k = 0; k < 3; k++) {
        const double *const r = f->turn[k];

        p[k] = r[0] * at[0] + r[1] * at[1] + r[2] * at[2] + f->shift[k];
        d[k] = r[0] * direction[0] + r[1] * direction[1] + r[2] * direction[2];
    }
    t = -p[2] / d[2];
    for (int k = 0; k < 3; k++) {
        at[k] = k < 2 ? p[k] + t * d[k] : 0.0;
        direction[k] = d[k];
    }
}

void glint_form_leave_frame(const struct glint_form *f, double at[3],
                            double direction[3])
{
    double p[3] = {0, 0, 0}, d[3] = {0, 0, 0};

    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            p[k] += f->turn[i][k] * (at[i] - f->shift[i]);
            d[k] += f->turn[i][k] * direction[i];
        }
    for (int k = 0; k < 3; k++) {
        at[k] = p[k];
        direction[k] = d[k];
    }
}

/* Returns end2, the squared height up to which the sag follows the lens table's
 * formula. */
static double compute_profile_end(const struct glint_form *f)
{
    const double c = f->curvature, a = (1.0 + f->conic) * c * c;
    const double semi2 = f->semi_mm * f->semi_mm;
    const double end2 = GLASS_ENDS * GLASS_ENDS * semi2;

    /* A conic has infinite slope at its equator, so the formula must end before
     * the equator. */
    return a * end2 < 0.5 * (1.0 + a * semi2) ? end2 : 0.5 * (1.0 / a + semi2);
}

/* Sets the transform from the light's frame, in which light lies in the x-z
 * plane, to the surface's own frame. The transform rotates by the azimuth
 * PHI_DEG of the light to the lens's frame, then undoes the decentre of the
 * surface and its tilts around the pivot. */
static void set_light_to_form_transform(struct glint_form *f,
                                        const struct glint_shape *s,
                                        double phi_deg)
{
    const double cx = glint_cos_deg(s->tilt_deg[0]);
    const double sx = glint_sin_deg(s->tilt_deg[0]);
    const double cy = glint_cos_deg(s->tilt_deg[1]);
    const double sy = glint_sin_deg(s->tilt_deg[1]);
    const double cp = glint_cos_deg(phi_deg), sp = glint_sin_deg(phi_deg);
    /* The rows are the axes of the surface in the lens's frame. Ry and Rx are
     * the rotations about y and x; the matrix is the transpose of Ry Rx. */
    const double lens[3][3] = {
        {cy, 0, -sy}, {sx * sy, cx, sx * cy}, {cx * sy, -sx, cx * cy}};
    const double from[3] = {-s->decentre_mm[0], -s->decentre_mm[1],
                            -s->pivot_mm};

    for (int k = 0; k < 3; k++) {
        const double *const r = lens[k];

        f->turn[k][0] = r[0] * cp + r[1] * sp;
        f->turn[k][1] = r[1] * cp - r[0] * sp;
        f->turn[k][2] = r[2];
        f->shift[k] = r[0] * from[0] + r[1] * from[1] + r[2] * from[2];
    }
    f->shift[2] += s->pivot_mm;
}

/* Sets the members that glint_beam_move_to_form() needs: level, along, round,
 * n_terms and steepest2. */
static void set_constants_for_beams(struct glint_form *f,
                                    const struct glint_shape *s)
{
    const double *const along = f->turn[f->bend == GLINT_BEND_Y];

    f->level = f->across == 0.0;
    for (int k = 0; k < 2; k++) {
        f->level &= s->decentre_mm[k] == 0.0 && s->tilt_deg[k] == 0.0;
        f->along[k] = along[k];
    }
    f->round = f->bend == GLINT_BEND_ROUND ? 1.0 : 0.0;
    for (int k = 0; k < GLINT_SHAPE_TERMS; k++)
        f->n_terms = f->term[k] != 0.0 ? k + 1 : f->n_terms;
    for (int k = 1; k <= SLOPES; k++) {
        const double h2 = f->end2 * k * k / (SLOPES * SLOPES);
        double at[3];

        evaluate_table_profile(f, h2, at);
        f->steepest2 = fmax(f->steepest2, STEEPER * 4.0 * h2 * at[1] * at[1]);
    }
}

void glint_form_init(struct glint_form *form, const struct glint_surface *s,
                     double phi_deg)
{
    const struct glint_shape *const shape = &s->shape;

    *form = (struct glint_form){
        .curvature = s->radius_mm != 0.0 ? 1.0 / s->radius_mm : 0.0,
        .conic = shape->conic,
        .bend = shape->bend,
        .across = shape->across_mm != 0.0 ? 1.0 / shape->across_mm : 0.0,
        .semi_mm = s->semi_mm};
    memcpy(form->term, shape->term, sizeof form->term);
    form->end2 = compute_profile_end(form);
    evaluate_table_profile(form, form->end2, form->end_at);
    set_light_to_form_transform(form, shape, phi_deg);
    set_constants_for_beams(form, shape);
}

bool glint_surface_point(const struct glint_surface *s, double phi_deg,
                         double x, double y, double at[3])
{
    double slope[2], direction[3] = {0, 0, 1};
    struct glint_form form;

    glint_form_init(&form, s, phi_deg);
    at[0] = x;
    at[1] = y;
    at[2] = glint_form_compute_sag(&form, x, y, slope);
    glint_form_leave_frame(&form, at, direction);
    return isfinite(at[2]);
}
