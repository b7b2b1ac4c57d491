/* SPDX-License-Identifier: MIT */
#include "engine/star/psf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/setup/spectrum.h"
#include "glint/view.h"

enum {
    ORDERS = 20,
    BLEND_FROM = 15,
    /* rows of a table at the shortest wavelength, 400 nm of 550, and two */
    MAX_ROWS = ORDERS * GLINT_PSF_STEPS * 11 / 8 + 4
};

/* range of the table of a line's profile, in units of width_px */
static const double span = 32;

/* --------------------------------------------------------------- transform */

static double evaluate_sinc(double x)
{
    const double t = GLINT_PI * x;

    return fabs(t) < 1e-4 ? 1 - t * t / 6 : sin(t) / t;
}

/* Returns the Bessel function J1(X), as an integral over a period. */
static double evaluate_bessel1(double x)
{
    const int n = 32 + (int)(fabs(x) * 0.7);
    double sum = 0;

    for (int i = 0; i < n; i++) {
        const double t = GLINT_PI * (i + 0.5) / n;

        sum += cos(t - x * sin(t));
    }
    return sum / n;
}

static double compute_circle_pattern(double q)
{
    const double x = 2 * GLINT_PI * q;
    const double f = x < 1e-3 ? 1 - x * x / 8 : 2 * evaluate_bessel1(x) / x;

    return f * f;
}

/* The sides of a polygonal stop with corners on the unit circle. */
struct sides {
    /* n: number of listed sides. n_pair: number of stop sides per listed side,
     * 2 if opposite sides are parallel, else 1. */
    int n, n_pair;
    double length, apothem, area;
    /* cosine and sine of the direction of each side's normal */
    double c[GLINT_MAX_BLADES], s[GLINT_MAX_BLADES];
};

static void set_polygon_sides(struct sides *p, int n, double rotation_deg)
{
    const double step = 2 * GLINT_PI / n;

    *p = (struct sides){.n = n % 2 ? n : n / 2,
                        .n_pair = n % 2 ? 1 : 2,
                        .length = 2 * sin(step / 2),
                        .apothem = cos(step / 2),
                        .area = 0.5 * n * sin(step)};
    for (int i = 0; i < p->n; i++) {
        const double a = rotation_deg * (GLINT_PI / 180) + (i + 0.5) * step;

        p->c[i] = cos(a);
        p->s[i] = sin(a);
    }
}

/* Returns |F|^2 / area^2 of a polygonal stop at the frequency (QX, QY), cycles
 * per stop radius. F is the Fourier transform of the stop. */
static double compute_polygon_pattern(const struct sides *p, double qx,
                                      double qy)
{
    const double q2 = qx * qx + qy * qy;
    double re = 0, im = 0;

    if (q2 < 1e-12)
        return 1;
    for (int i = 0; i < p->n; i++) {
        const double u = qx * p->c[i] + qy * p->s[i];
        const double v = qy * p->c[i] - qx * p->s[i];
        const double size = u * evaluate_sinc(v * p->length);
        const double phase = 2 * GLINT_PI * u * p->apothem;

        re += size * sin(phase);
        if (p->n_pair == 1)
            im += size * cos(phase);
    }
    re *= p->n_pair;
    return (re * re + im * im) * p->length * p->length /
           (4 * GLINT_PI * GLINT_PI * q2 * q2 * p->area * p->area);
}

double glint_psf_compute_pattern(int n, double rotation_deg, double qx,
                                 double qy)
{
    struct sides sides;

    if (n == 0)
        return compute_circle_pattern(hypot(qx, qy));
    set_polygon_sides(&sides, n, rotation_deg);
    return compute_polygon_pattern(&sides, qx, qy);
}

/* ---------------------------------------------------------------- spectrum */

static void set_spectrum_weights(struct glint_psf *p)
{
    double sum[3] = {0, 0, 0};

    for (int i = 0; i < GLINT_PSF_WAVES; i++) {
        const double nm = 400 + 300.0 * i / (GLINT_PSF_WAVES - 1);

        p->scale[i] = nm / 550;
        glint_observer_compute_rgb(nm, p->weight[i]);
        for (int c = 0; c < 3; c++)
            sum[c] += p->weight[i][c];
    }
    for (int i = 0; i < GLINT_PSF_WAVES; i++)
        for (int c = 0; c < 3; c++) {
            p->weight[i][c] /= sum[c];
            p->mean[c] += p->weight[i][c] * p->scale[i];
            p->square[c] += p->weight[i][c] * p->scale[i] * p->scale[i];
        }
}

static void compute_line_profile(struct glint_psf *p)
{
    for (int k = 0; k <= GLINT_PSF_PROFILE; k++) {
        const double v = span * k / GLINT_PSF_PROFILE;

        for (int i = 0; i < GLINT_PSF_WAVES; i++) {
            const double s = evaluate_sinc(v / p->scale[i]);

            for (int c = 0; c < 3; c++)
                p->profile[k][c] += p->weight[i][c] * s * s;
        }
    }
}

/* Sets the smooth profile of lines. Its value at a position is the mean of the
 * profile over one fringe around it. */
static void compute_smooth_line_profile(struct glint_psf *p)
{
    const int half = (int)(0.6 / span * GLINT_PSF_PROFILE);

    for (int k = 0; k <= GLINT_PSF_PROFILE; k++)
        for (int c = 0; c < 3; c++) {
            for (int i = -half; i <= half; i++) {
                const int at = abs(k + i);

                p->smooth[k][c] +=
                    p->profile[at < GLINT_PSF_PROFILE ? at : GLINT_PSF_PROFILE]
                              [c];
            }
            p->smooth[k][c] /= 2 * half + 1;
        }
}

static void interpolate_profile_table(const struct glint_psf *p, double v,
                                      const double (*table)[3], double rgb[3])
{
    const double size =
        p->n_pair * p->edge * p->edge / (4 * GLINT_PI * GLINT_PI * p->area);
    const double x = fabs(v) / p->width_px;
    const double at = x / span * GLINT_PSF_PROFILE;
    const int i = (int)fmin(at, GLINT_PSF_PROFILE - 1);

    for (int c = 0; c < 3; c++) {
        const double *a = table[i], *b = table[i + 1];
        const double s = x < span
                             ? a[c] + (b[c] - a[c]) * (at - i)
                             : p->square[c] / (2 * GLINT_PI * GLINT_PI * x * x);

        rgb[c] = p->n_blades && !p->fans ? size * fmax(s, 0) : 0;
    }
}

void glint_psf_interpolate_profile(const struct glint_psf *p, double v,
                                   double rgb[3])
{
    interpolate_profile_table(p, v, (const double(*)[3])p->profile, rgb);
}

/* -------------------------------------------------------------------- near */

/* Returns a table of the stop's diffraction pattern at one wavelength. It has
 * N_ROWS rows, one per 1 / GLINT_PSF_STEPS order of diffraction, and a column
 * per angle. Returns NULL if memory is short. The caller frees the table. */
static double *tabulate_patterns(const struct glint_psf *p, int n_rows)
{
    double *table =
        malloc((size_t)n_rows * (size_t)p->n_columns * sizeof *table);
    const double half = 0.5 * GLINT_PI / p->n_lines;
    double q[MAX_ROWS], pattern[MAX_ROWS];
    struct sides sides;

    for (int i = 0; i < n_rows; i++)
        q[i] = 0.5 * i / GLINT_PSF_STEPS;
    if (p->n_blades)
        set_polygon_sides(&sides, p->n_blades, 0);
    for (int k = 0; k < p->n_columns && table; k++) {
        /* The table is for a stop without rotation. Its first angle is that of
         * the normal of a side, which is half a side away from a corner. */
        const double angle =
            p->n_blades ? GLINT_PI / p->n_blades + half * k / (p->n_columns - 1)
                        : 0;
        const double x = cos(angle), y = sin(angle);

        if (p->fans)
            glint_arcs_compute_patterns(&p->arcs, angle, q, n_rows, pattern);
        for (int i = 0; i < n_rows; i++)
            table[i * p->n_columns + k] =
                (p->fans ? pattern[i]
                 : p->n_blades
                     ? compute_polygon_pattern(&sides, q[i] * x, q[i] * y)
                     : compute_circle_pattern(q[i])) *
                glint_psf_compute_soft_edge_factor(p->soft, q[i]);
    }
    return table;
}

static void add_wave_to_near_table(struct glint_psf *p, int wave,
                                   const double *table)
{
    const double s = p->scale[wave];

    for (int i = 0; i < p->n_rows; i++) {
        const double row = i / s;
        const int at = (int)row;

        for (int k = 0; k < p->n_columns; k++) {
            const double *a = table + at * p->n_columns + k;
            const double f = *a + (a[p->n_columns] - *a) * (row - at);

            for (int c = 0; c < 3; c++)
                p->near[i * p->n_columns + k][c] +=
                    p->weight[wave][c] * f * p->area / (4 * s * s);
        }
    }
}

enum glint_status glint_psf_make_near_table(struct glint_psf *p)
{
    const int n_rows = (int)(ORDERS * GLINT_PSF_STEPS / p->scale[0]) + 3;
    double *table;

    p->n_rows = ORDERS * GLINT_PSF_STEPS + 2;
    p->n_columns = p->n_blades
                       ? 2 + (int)(0.5 * GLINT_PI / p->n_lines * ORDERS *
                                   (p->draft ? 0.2 : 0.7) * GLINT_PSF_STEPS)
                       : 1;
    p->near = calloc((size_t)p->n_rows * (size_t)p->n_columns, sizeof *p->near);
    table = tabulate_patterns(p, n_rows);
    for (int i = 0; i < GLINT_PSF_WAVES && table && p->near; i++)
        add_wave_to_near_table(p, i, table);
    free(table);
    return table && p->near ? GLINT_OK : GLINT_E_MEMORY;
}

/* min curvature of the arcs for which fans are computed, 1 / stop radius */
static const double least_round = 0.02;

/* Blades with less curvature and softness than these are treated as straight
 * and hard, as their fans would be narrower than lines everywhere in a picture.
 * Blades with more curvature than circle_round are treated as a circle, into
 * which the fans of lower curvatures are blended. */
static const double straight_round = 0.01, straight_soft = 0.002;
static const double circle_round = 0.98;

/* Moves the outline of a stop with a soft edge to the middle of the edge:
 * scales airy_px to the smaller stop, and SOFT to its radius. */
static void move_soft_edge_to_slope_middle(struct glint_psf *p, double soft)
{
    const double apothem = p->n_blades ? cos(GLINT_PI / p->n_blades) : 1;
    const double size = fmax(1 - 0.5 * soft / apothem, 0.1);

    p->airy_px /= size;
    p->soft = soft / size;
}

static void set_fan_arcs(struct glint_psf *p, double round)
{
    p->fans = 1;
    p->round = round;
    glint_arcs_init(&p->arcs, p->n_blades, 0,
                    fmin(fmax(round, least_round), 0.9999));
    p->area = p->arcs.area;
    p->perimeter = p->arcs.perimeter;
}

enum glint_status glint_psf_init(struct glint_psf *psf, int n_blades,
                                 double rotation_deg, double airy_px)
{
    const enum glint_status status =
        glint_psf_init_iris(psf, n_blades, rotation_deg, airy_px, 0, 0, false);

    return status == GLINT_OK ? glint_psf_make_near_table(psf) : status;
}

enum glint_status glint_psf_init_iris(struct glint_psf *psf, int n_blades,
                                      double rotation_deg, double airy_px,
                                      double round, double soft, bool draft)
{
    const int n = round >= circle_round ? 0 : n_blades;
    const int is_straight = round < straight_round && soft < straight_soft;

    *psf = (struct glint_psf){.n_blades = n,
                              .rotation_deg = rotation_deg,
                              .airy_px = airy_px,
                              .draft = draft,
                              .n_lines = n == 0       ? 1
                                         : n % 2 == 0 ? n / 2
                                                      : n,
                              .n_pair = n % 2 == 0 ? 2 : 1,
                              .edge = n ? 2 * sin(GLINT_PI / n) : 1,
                              .area = n ? 0.5 * n * sin(2 * GLINT_PI / n)
                                        : GLINT_PI};
    psf->perimeter = n ? n * psf->edge : 2 * GLINT_PI;
    psf->width_px = 2 * airy_px / psf->edge;
    for (int i = 0; i < psf->n_lines && n; i++) {
        const double a =
            rotation_deg * (GLINT_PI / 180) + (i + 0.5) * 2 * GLINT_PI / n;

        psf->normal[i][0] = cos(a);
        psf->normal[i][1] = -sin(a);
    }
    set_spectrum_weights(psf);
    if (n && is_straight) {
        compute_line_profile(psf);
        compute_smooth_line_profile(psf);
    }
    if (soft > 0 && !(n && is_straight))
        move_soft_edge_to_slope_middle(psf, soft);
    if (n && !is_straight)
        set_fan_arcs(psf, round);
    return psf->fans ? glint_fans_make_table(psf) : GLINT_OK;
}

void glint_psf_finish(struct glint_psf *psf)
{
    free(psf->near);
    free(psf->far);
    psf->near = psf->far = NULL;
}

double glint_psf_compute_line_angle(const struct glint_psf *p, int i)
{
    const double step = 180.0 / p->n_lines;
    /* The direction of y is up in the stop and down in the picture, so rotation
     * is reversed. */
    const double one =
        p->n_blades ? -(p->rotation_deg + 180.0 / p->n_blades) : 0;

    return (one - floor(one / step) * step + i * step) * (GLINT_PI / 180);
}

/* --------------------------------------------------------------------- far */

/* Adds the light of all lines at (X, Y) to RGB, without the contribution of
 * corners. Sets SUM, on which the contribution of corners depends. It is the
 * sum over neighbouring edges of the product of the cotangents of the angles to
 * both. Cotangents are limited near lines. */
static void add_edge_light(const struct glint_psf *p, double x, double y,
                           glint_psf_window_fn *window, const void *self,
                           double rgb[3], double *sum)
{
    const double end = 0.25 * p->width_px * p->width_px;
    const double r2 = x * x + y * y;
    double first = 0, last = 0;

    *sum = 0;
    for (int i = 0; i < p->n_lines; i++) {
        const double *n = p->normal[i];
        const double u = x * n[0] + y * n[1], v = y * n[0] - x * n[1];
        const double slope = u * v / (v * v + end);
        const double part =
            (1 - (window ? window(v, self) : 0)) * u * u / (r2 * r2);
        double here[3];

        interpolate_profile_table(
            p, v, (const double(*)[3])(window ? p->smooth : p->profile), here);
        for (int c = 0; c < 3; c++)
            rgb[c] += part * here[c];
        *sum += last * slope;
        last = slope;
        if (i == 0)
            first = slope;
    }
    *sum = p->n_pair * (*sum + last * first);
}

void glint_psf_compute_far_light(const struct glint_psf *p, double x, double y,
                                 glint_psf_window_fn *window, const void *self,
                                 double rgb[3])
{
    const double pi2 = GLINT_PI * GLINT_PI;
    const double r2 = x * x + y * y, r = sqrt(r2);
    double size, sum;

    rgb[0] = rgb[1] = rgb[2] = 0;
    if (p->n_blades == 0) {
        const double soft = p->soft > 0 ? glint_psf_compute_soft_edge_factor(
                                              p->soft, r / (2 * p->airy_px))
                                        : 1;

        for (int c = 0; c < 3; c++)
            rgb[c] = soft * p->mean[c] * p->airy_px / (pi2 * GLINT_PI * r2 * r);
        return;
    }
    if (p->fans) {
        const struct glint_fans_row row = glint_fans_find_row(p, hypot(x, y));

        glint_fans_interpolate_light(
            &row, atan2(y, x) - glint_psf_compute_line_angle(p, 0), rgb);
        return;
    }
    add_edge_light(p, x, y, window, self, rgb, &sum);
    size = p->airy_px * p->airy_px / (2 * pi2 * pi2 * p->area * r2 * r2);
    for (int c = 0; c < 3; c++)
        rgb[c] = fmax(rgb[c] - size * p->square[c] * sum, 0.02 * rgb[c]);
}

double glint_psf_compute_light_beyond(const struct glint_psf *p, double r,
                                      int c)
{
    return p->perimeter / p->area * p->mean[c] * p->airy_px /
           (GLINT_PI * GLINT_PI * r);
}

/* ------------------------------------------------------------ near and far */

/* Returns the angle between the direction of (X, Y) and the nearest line,
 * radians. */
static double compute_angle_to_line(const struct glint_psf *p, double x,
                                    double y)
{
    const double step = GLINT_PI / p->n_lines;

    return fabs(
        remainder(atan2(y, x) - glint_psf_compute_line_angle(p, 0), step));
}

static void interpolate_near_light(const struct glint_psf *p, double x,
                                   double y, double rgb[3])
{
    const double row = hypot(x, y) / p->airy_px * GLINT_PSF_STEPS;
    const double column = p->n_columns > 1
                              ? compute_angle_to_line(p, x, y) * 2 *
                                    p->n_lines / GLINT_PI * (p->n_columns - 1)
                              : 0;
    const int i = (int)fmin(row, p->n_rows - 2);
    const int k = (int)fmin(column, p->n_columns > 1 ? p->n_columns - 2 : 0);
    const int next = p->n_columns > 1;
    const double(*a)[3] = (const double(*)[3])p->near + i * p->n_columns + k;
    const double(*b)[3] = a + p->n_columns;
    const double s = row - i, t = column - k;

    for (int c = 0; c < 3; c++)
        rgb[c] = fmax(0, (1 - s) * ((1 - t) * a[0][c] + t * a[next][c]) +
                             s * ((1 - t) * b[0][c] + t * b[next][c])) /
                 (p->airy_px * p->airy_px);
}

void glint_psf_compute_light(const struct glint_psf *p, double x, double y,
                             double rgb[3])
{
    const double order = hypot(x, y) / p->airy_px;
    const double t =
        fmin(fmax((order - BLEND_FROM) / (ORDERS - BLEND_FROM), 0), 1);
    const double part = t * t * (3 - 2 * t);
    double far[3] = {0, 0, 0}, near[3] = {0, 0, 0};

    if (part > 0)
        glint_psf_compute_far_light(p, x, y, NULL, NULL, far);
    if (part < 1)
        interpolate_near_light(p, x, y, near);
    for (int c = 0; c < 3; c++)
        rgb[c] = near[c] + part * (far[c] - near[c]);
}
