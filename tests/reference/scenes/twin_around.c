/* SPDX-License-Identifier: MIT
 *
 * Environment light in the reference renderer, in double precision: lookups in
 * the baked environment, and Ward's lobe under the environment and under
 * lights. Light paths are those of the run time. Directions are in the axes of
 * baked scenes, whose z points away from the viewer.
 */
#include "reference/scenes/twin_around.h"

#include <string.h>

#include "glint/scene/ward.h"
#include "glint/view.h"
#include "support/models/texel.h"

#define LEAST_SPREAD 0x1p-26
#define LEAST_COSINE .0625
#define MOST_SLOPE   16
#define MOST_WEIGHT  8.0
#define LEAST_POLE   0x1p-24

/* ------------------------------------------------------------------ lookups */

/* Sets PLACE to the position of direction TOWARD in the octahedron map, each
 * coordinate 0 .. 1. */
static void compute_octahedron_position(const double toward[3], double place[2])
{
    const double sum = fabs(toward[0]) + fabs(toward[1]) + fabs(toward[2]);
    double p = fabs(toward[0]) / sum, q = fabs(toward[2]) / sum;

    if (toward[1] < 0) {
        const double unfolded = 1 - q;

        q = 1 - p;
        p = unfolded;
    }
    place[0] = .5 + .5 * (toward[0] < 0 ? -p : p);
    place[1] = .5 + .5 * (toward[2] < 0 ? -q : q);
}

/* Returns the index of texel (X, Y) in the octahedron map of SIDE x SIDE
 * texels. For a texel outside the map, returns its neighbour on the
 * octahedron. */
static int wrap_texel_index(int x, int y, int side)
{
    if (x < 0 || x >= side) {
        x = x < 0 ? 0 : side - 1;
        y = side - 1 - y;
    }
    if (y < 0 || y >= side) {
        y = y < 0 ? 0 : side - 1;
        x = side - 1 - x;
    }
    return y * side + x;
}

/* Sets RGB to the light in direction TOWARD, interpolated bilinearly from the
 * texels of mipmap LEVEL; LEVEL -1 is the irradiance map. */
static void interpolate_within_mipmap_level(const struct glint_environment *e,
                                            int level, const double toward[3],
                                            double rgb[3])
{
    const int side = 1 << (level < 0 ? GLINT_ENVIRONMENT_IRRADIANCE_LOG2
                                     : (int)e->level[level].side_log2);
    double place[2], x, y;

    compute_octahedron_position(toward, place);
    x = place[0] * side - .5;
    y = place[1] * side - .5;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int k = 0; k < 4; k++) {
        const int i = (int)floor(x) + (k & 1), j = (int)floor(y) + (k >> 1);
        const double share = (1 - fabs(x - i)) * (1 - fabs(y - j));
        const int at = wrap_texel_index(i, j, side);

        for (int c = 0; c < 3; c++)
            rgb[c] +=
                share * (level < 0 ? decode_rgb9e5(e, e->irradiance[at], c)
                                   : decode_texel(e, level, (size_t)at, c));
    }
}

/* Sets RGB to the light at a fractional mipmap LEVEL, blended from the two
 * nearest levels. The blur's variance, which is 4 times as large in the coarser
 * level, is interpolated. */
static void interpolate_between_mipmap_levels(const struct glint_environment *e,
                                              const double toward[3],
                                              double level, double rgb[3])
{
    const double last = e->header->n_levels - 1;
    const double held = fmin(fmax(level, 0), last);
    const int k = (int)held;
    double next[3];

    interpolate_within_mipmap_level(e, k, toward, rgb);
    if (held <= k)
        return;
    interpolate_within_mipmap_level(e, k + 1, toward, next);
    for (int c = 0; c < 3; c++)
        rgb[c] += (pow(4, held - k) - 1) / 3 * (next[c] - rgb[c]);
}

/* Rotates direction V from the axes of the scene text to those of the
 * environment. TO may be V. */
static void rotate_to_environment(const struct twin *twin, const double v[3],
                                  double to[3])
{
    const struct glint_description *s = twin->scene;
    const double angle = s->environment[0].turn_deg * GLINT_PI / 180;
    const double x = v[0], z = (s->left_handed ? 1 : -1) * v[2];

    to[0] = cos(angle) * x - sin(angle) * z;
    to[1] = v[1];
    to[2] = cos(angle) * z + sin(angle) * x;
}

/* -------------------------------------------------------------------- metal */

/* Returns the curvature of the surface at HIT: change of the normal, radians,
 * per unit of the scene. */
static double compute_normal_curvature(const struct twin *twin,
                                       const struct twin_hit *hit)
{
    const struct glint_description *s = twin->scene;
    const struct glint_described_object *o = &s->object[hit->object];
    const struct glint_described_triangle *t;
    double most = 0;

    if (o->kind == GLINT_DESCRIBED_SPHERE)
        return 1 / o->radius;
    if (o->kind == GLINT_DESCRIBED_PLANE || hit->triangle < 0)
        return 0;
    t = &s->triangle[hit->triangle];
    for (int k = 0; t->has_normals && k < 3; k++) {
        double way[3], bend[3];

        vec_add_scaled(t->place[k], -1, t->place[(k + 1) % 3], way);
        vec_add_scaled(t->normal[k], -1, t->normal[(k + 1) % 3], bend);
        most = fmax(most, vec_normalise(bend) / vec_normalise(way));
    }
    return most;
}

double reference_compute_alpha_widening(const struct twin *twin,
                                        const struct twin_hit *hit,
                                        const double toward[3])
{
    const double no = fmax(-vec_dot(hit->shading, toward), LEAST_COSINE);
    const double bend =
        fmin(compute_normal_curvature(twin, hit) * hit->t * twin->pixel_tan, 1);
    const double turns = fmin(bend / no + twin->pixel_tan, 1);

    return turns * turns / 2;
}

void reference_make_metal_frame(const struct twin *twin,
                                const struct twin_hit *hit, double frame[3][3])
{
    const struct glint_description *s = twin->scene;
    const struct glint_described_object *o = &s->object[hit->object];
    const double hand = s->left_handed ? 1 : -1;
    double axis[2][3] = {{1, 0, 0}, {0, 1, 0}};

    for (int k = 0; k < 2; k++) {
        double own[3];

        memcpy(own, axis[k], sizeof own);
        if (o->kind == GLINT_DESCRIBED_PLANE) {
            double upright[4];

            glint_described_upright(o->normal, upright);
            vec_rotate(upright, 1, axis[k], own);
        }
        vec_rotate(o->turn, 1, own, axis[k]);
        axis[k][2] *= hand;
    }
    memcpy(frame[2], hit->shading, sizeof frame[2]);
    frame[2][2] *= hand;
    vec_cross(axis[1], frame[2], frame[0]);
    if (vec_dot(frame[0], frame[0]) < LEAST_POLE * LEAST_POLE) {
        vec_cross(frame[2], axis[0], frame[1]);
        vec_cross(frame[1], frame[2], frame[0]);
    }
    vec_normalise(frame[0]);
    vec_cross(frame[2], frame[0], frame[1]);
}

/* Returns the weight of a lobe sample: the lobe times the cosine of incidence,
 * divided by the sampling density. The lobe has the normalisation that the
 * material states (1992 or later). */
static double compute_lobe_weight(const struct glint_described_material *m,
                                  double ho, double hn, double ni, double no)
{
    const double weight = m->norm == GLINT_DESCRIBED_1992
                              ? ho * hn * hn * hn * sqrt(ni / no)
                              : ni / (ho * hn);

    return fmin(weight, MOST_WEIGHT);
}

double reference_compute_metal_reflection(const struct twin *twin,
                                          const struct twin_hit *hit,
                                          const double toward[3],
                                          const double to_light[3],
                                          double radius)
{
    const struct glint_described_material *m =
        &twin->scene->material[hit->material];
    const double wider = radius * radius / 8 +
                         reference_compute_alpha_widening(twin, hit, toward);
    const double hand = twin->scene->left_handed ? 1 : -1;
    const double i[3] = {to_light[0], to_light[1], hand * to_light[2]};
    const double o[3] = {-toward[0], -toward[1], -hand * toward[2]};
    double frame[3][3], h[3], hn, ni, no, slope = 0, area = 4;

    reference_make_metal_frame(twin, hit, frame);
    vec_add_scaled(i, 1, o, h);
    vec_normalise(h);
    hn = vec_dot(h, frame[2]);
    ni = vec_dot(i, frame[2]);
    no = vec_dot(o, frame[2]);
    if (hn <= 0 || ni <= 0 || no <= 0)
        return 0;
    for (int k = 0; k < 2; k++) {
        const double square = m->alpha[k] * m->alpha[k] + wider;
        const double along = vec_dot(h, frame[k]) / hn;

        slope += along * along / square;
        area *= sqrt(square);
    }
    if (slope > MOST_SLOPE)
        return 0;
    return exp(-slope) * compute_lobe_weight(m, vec_dot(h, o), hn, ni, no) /
           (area * vec_dot(h, o) * hn * hn * hn);
}

/* Returns the blur of each of N lobe samples as a fraction of the lobe, like
 * compute_footprint_of_sample_q16() in scene/ward/ward_lobe.c. */
static double compute_footprint_factor(int n)
{
    static const int at[5] = {1, 4, 8, 16, 32};
    static const double kappa[5] = {1, 1.4, 2, 2, 3};
    int i = 0;

    while (i < 3 && n > at[i + 1])
        i++;
    return (kappa[i] +
            (kappa[i + 1] - kappa[i]) * (n - at[i]) / (at[i + 1] - at[i])) /
           n;
}

/* Returns the N lowest bits of I in reversed order, as a fraction 0 .. 1
 * (radical inverse). */
static double radical_inverse(unsigned i, int n)
{
    double v = 0;

    for (int bit = 0; bit < n; bit++)
        v += (i >> bit & 1) * ldexp(1, -1 - bit);
    return v;
}

/* Computes the slopes of N half vectors that sample Ward's lobe of alpha 1, and
 * scales them so that their mean square along each axis is SPREAD / 2. */
static void compute_lobe_sample_slopes(int n, const double spread[2],
                                       double slope[GLINT_WARD_SAMPLES][2])
{
    for (int k = 0; k < n; k++) {
        const double v = radical_inverse((unsigned)k, 5);

        slope[k][0] = sqrt(-log((k + .5) / n)) * cos(2 * GLINT_PI * v);
        slope[k][1] = sqrt(-log((k + .5) / n)) * sin(2 * GLINT_PI * v);
    }
    for (int axis = 0; axis < 2; axis++) {
        double mean = 0, square = 0;

        for (int k = 0; k < n; k++)
            mean += slope[k][axis] / n;
        for (int k = 0; k < n; k++) {
            slope[k][axis] -= mean;
            square += slope[k][axis] * slope[k][axis] / n;
        }
        for (int k = 0; k < n; k++)
            slope[k][axis] *=
                square > 1. / 256 ? sqrt(spread[axis] / 2 / square) : 0;
    }
}

/* Adds the light of one lobe sample to RGB. SLOPE: slopes of the sample's half
 * vector for alpha 1. LEVEL: mipmap level if the half vector is the view
 * direction; other half vectors use a finer level. */
static void add_lobe_sample(const struct twin *twin, const double slope[2],
                            const struct glint_described_material *m,
                            const double frame[3][3], const double out[3],
                            double level, double rgb[3])
{
    double h[3] = {m->alpha[0] * slope[0], m->alpha[1] * slope[1], 1};
    double in[3], toward[3] = {0, 0, 0}, light[3], ho, weight;

    vec_normalise(h);
    ho = vec_dot(h, out);
    for (int k = 0; k < 3; k++)
        in[k] = 2 * ho * h[k] - out[k];
    if (ho <= 0 || in[2] <= 0)
        return;
    weight = compute_lobe_weight(m, ho, h[2], fmin(in[2], 1), out[2]);
    for (int k = 0; k < 3; k++)
        vec_add_scaled(toward, in[k], frame[k], toward);
    interpolate_between_mipmap_levels(&twin->around, toward,
                                      level + .5 * log2(ho), light);
    for (int c = 0; c < 3; c++)
        rgb[c] += weight * light[c];
}

/* Adds N samples of the complete lobe from the finest mipmap level. The offset
 * of the samples depends on TOWARD, so that the rays of a pixel use different
 * samples. */
static void add_lobe_by_samples(const struct twin *twin, const double toward[3],
                                const struct glint_described_material *m,
                                const double frame[3][3], const double out[3],
                                double rgb[3])
{
    const int n = twin->ward_samples;
    const double off[2] = {fmod(fabs(toward[0]) * 7919.17, 1),
                           fmod(fabs(toward[1]) * 6271.83, 1)};

    for (int k = 0; k < n; k++) {
        const double u = fmod((k + .5) / n + off[0], 1);
        const double v = fmod(radical_inverse((unsigned)k, 16) + off[1], 1);
        const double r = sqrt(-log(fmax(u, 1e-9)));
        const double slope[2] = {r * cos(2 * GLINT_PI * v),
                                 r * sin(2 * GLINT_PI * v)};

        add_lobe_sample(twin, slope, m, frame, out, 0, rgb);
    }
}

static void add_metal_reflection(const struct twin *twin,
                                 const struct twin_hit *hit,
                                 const double toward[3], double rgb[3])
{
    const struct glint_description *s = twin->scene;
    const struct glint_described_material *m = &s->material[hit->material];
    const double hand = s->left_handed ? 1 : -1;
    const double a = m->alpha[0], b = m->alpha[1];
    const int n = twin->ward_samples;
    double slope[GLINT_WARD_SAMPLES][2], level;
    double frame[3][3] = {{0}}, out[3] = {0};
    double sum[3] = {0, 0, 0};
    const bool is_whole = n > GLINT_WARD_SAMPLES;
    const double f =
        compute_footprint_factor(is_whole ? GLINT_WARD_SAMPLES : n);
    const double blur = fmin(f * a * b, .75 * fmin(a * a, b * b));
    const double spread[2] = {(1 - f + fmax(1 - blur / (a * a), 0)) / 2,
                              (1 - f + fmax(1 - blur / (b * b), 0)) / 2};
    const double back[3] = {-toward[0], -toward[1], -hand * toward[2]};

    if (!is_whole)
        compute_lobe_sample_slopes(n, spread, slope);
    level = log2(2 * sqrt(2 * blur) / sqrt(4 * GLINT_PI) *
                 (1 << twin->around.header->side_log2));
    reference_make_metal_frame(twin, hit, frame);
    for (int k = 0; k < 3; k++) {
        out[k] = vec_dot(frame[k], back);
        /* converts from the axes of baked scenes to those of the scene text */
        frame[k][2] *= hand;
        rotate_to_environment(twin, frame[k], frame[k]);
    }
    if (is_whole && out[2] > 0)
        add_lobe_by_samples(twin, toward, m, (const double(*)[3])frame, out,
                            sum);
    for (int k = 0; !is_whole && k < n && out[2] > 0; k++)
        add_lobe_sample(twin, slope[k], m, (const double(*)[3])frame, out,
                        level, sum);
    for (int c = 0; c < 3; c++)
        rgb[c] += s->environment[0].scale * m->metal[c] * sum[c] / n;
}

/* ------------------------------------------------------- environment light */

void reference_add_irradiance(const struct twin *twin, const double shading[3],
                              double rgb[3])
{
    const struct glint_description *s = twin->scene;
    double normal[3], light[3];

    if (!s->n_environments)
        return;
    rotate_to_environment(twin, shading, normal);
    interpolate_within_mipmap_level(&twin->around, -1, normal, light);
    for (int c = 0; c < 3; c++)
        rgb[c] += s->environment[0].scale * light[c];
}

void reference_add_environment(const struct twin *twin,
                               const struct twin_hit *hit,
                               const double toward[3], const double colour[3],
                               double rgb[3])
{
    const struct glint_description *s = twin->scene;
    const struct glint_described_material *m = &s->material[hit->material];
    double light[3] = {0, 0, 0};

    if (!s->n_environments)
        return;
    reference_add_irradiance(twin, hit->shading, light);
    for (int c = 0; c < 3; c++)
        rgb[c] += m->diffuse * colour[c] * light[c];
    if (m->is_metal)
        add_metal_reflection(twin, hit, toward, rgb);
}

void reference_compute_background_light(const struct twin *twin,
                                        const double toward[3], double spread,
                                        double rgb[3])
{
    const struct glint_description *s = twin->scene;
    const struct glint_environment *e = &twin->around;
    const double seen = fmin(fmax(spread, LEAST_SPREAD), .25);
    const double width = 2 * sqrt(seen);
    double to[3];

    memcpy(rgb, s->background_colour, 3 * sizeof *rgb);
    if (s->background != GLINT_BEHIND_ENVIRONMENT)
        return;
    rotate_to_environment(twin, toward, to);
    interpolate_between_mipmap_levels(
        e, to,
        .5 * log2(seen * ldexp(1, 2 * (int)e->header->side_log2) / GLINT_PI),
        rgb);
    for (uint32_t i = 0; i < e->header->n_lights; i++) {
        const double r = fmax(e->light[i].radius_q30 * 0x1p-30, width);
        double off[3], share;

        for (int k = 0; k < 3; k++)
            off[k] = to[k] - e->light[i].toward_q30[k] * 0x1p-30;
        share = fmin(fmax((r - vec_normalise(off)) / width + .5, 0), 1);
        for (int c = 0; c < 3; c++)
            rgb[c] += share * glint_real_value(e->light[i].rgb[c]) / (r * r);
    }
    for (int c = 0; c < 3; c++)
        rgb[c] *= s->environment[0].scale;
}
