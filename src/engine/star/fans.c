/* SPDX-License-Identifier: MIT
 *
 * Computes the far field of stops with round blades or a soft edge, which
 * diffract light into fans instead of lines. It is a table over the distance
 * from the lamp and the angle to the nearest line. */
#include <math.h>
#include <stdlib.h>

#include "engine/star/psf.h"
#include "glint/view.h"

enum {
    COLUMNS = 129, /* number of columns of the table; their angles are from a
                      line to half-way to the next line */
    PER_OCTAVE = 4,
    EVERY = 2, /* every second wavelength is used */
    WAVES = (GLINT_PSF_WAVES + EVERY - 1) / EVERY,
    GROUP = 3,     /* number of rows that are computed together */
    DRAFT_STEP = 8 /* drafts: distance of the columns that are computed; those
                      between are interpolated */
};

/* distances from the lamp at which the table begins, in orders of diffraction,
 * and ends, in pixels */
static const double first_order = 12, last_px = 16384;

/* range of blade curvatures in which the far field changes from that of fans to
 * that of a circular stop */
static const double fade_from = 0.85, fade_to = 0.98;

double glint_psf_compute_soft_edge_factor(double soft, double q)
{
    const double p = GLINT_PI * q * soft;
    const double a =
        p < 0.01 ? 1 - p * p / 10 : 3 * (sin(p) - p * cos(p)) / (p * p * p);

    return a * a;
}

/* Sets RGB to the sum over the spectrum of PATTERN, at the frequencies Q of the
 * wavelengths: light times r^2. */
static void sum_fan_light(const struct glint_psf *p, const double *q,
                          const double *pattern, double rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int i = 0; i < WAVES; i++) {
        const double light = pattern[i] *
                             glint_psf_compute_soft_edge_factor(p->soft, q[i]) *
                             p->area * q[i] * q[i];

        for (int c = 0; c < 3; c++)
            rgb[c] += p->weight[i * EVERY][c] * light;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = fmax(rgb[c], 0);
}

static double compute_row_distance(double first, int row)
{
    return first * exp2((double)row / PER_OCTAVE);
}

/* Sets column K of the table to the light of fans (lines spread by curved
 * blades or a soft edge) times r^2. FIRST: distance of the first row, pixels.
 */
static void compute_fan_column(struct glint_psf *p, double first, int k)
{
    const double off = 0.5 * GLINT_PI / p->n_lines * k / (COLUMNS - 1);
    double q[GROUP * WAVES], pattern[GROUP * WAVES];

    for (int row = 0; row < p->n_far; row++) {
        const int group = row / GROUP * GROUP;
        const double *const light = pattern + (row - group) * WAVES;
        double *const rgb = p->far[row * COLUMNS + k];

        for (int i = 0; row == group && i < GROUP * WAVES; i++)
            q[i] = compute_row_distance(first, row + i / WAVES) /
                   (2 * p->airy_px * p->scale[i % WAVES * EVERY]);
        if (row == group)
            glint_arcs_compute_far_patterns(&p->arcs,
                                            GLINT_PI / p->n_blades + off, q,
                                            GROUP * WAVES, pattern);
        sum_fan_light(p, q + (row - group) * WAVES, light, rgb);
    }
}

/* Blends the far field of a circular stop into RGB, which has light times r^2
 * at R pixels from the lamp. For a nearly circular stop the gaps between fans
 * are as narrow as the blur of their sides. */
static void blend_circle_light(const struct glint_psf *p, double r,
                               double rgb[3])
{
    const double t =
        fmin(fmax((p->round - fade_from) / (fade_to - fade_from), 0), 1);
    const double part = t * t * (3 - 2 * t);
    const double soft =
        glint_psf_compute_soft_edge_factor(p->soft, r / (2 * p->airy_px));

    for (int c = 0; c < 3; c++) {
        const double circle = soft * p->mean[c] * p->airy_px /
                              (GLINT_PI * GLINT_PI * GLINT_PI * r);

        rgb[c] += part * (circle - rgb[c]);
    }
}

/* Interpolates column K of the table between the nearest columns whose numbers
 * are multiples of DRAFT_STEP. */
static void interpolate_fan_column(struct glint_psf *p, int k)
{
    const int rest = k % DRAFT_STEP;
    const double part = (double)rest / DRAFT_STEP;

    for (int row = 0; row < p->n_far; row++) {
        const int low = row * COLUMNS + k - rest;

        for (int c = 0; c < 3; c++)
            p->far[low + rest][c] = (1 - part) * p->far[low][c] +
                                    part * p->far[low + DRAFT_STEP][c];
    }
}

enum glint_status glint_fans_make_table(struct glint_psf *p)
{
    const int step = p->draft ? DRAFT_STEP : 1;
    const double first = first_order * p->airy_px;
    double sum[3] = {0, 0, 0};

    p->n_far = 2 + (int)ceil(PER_OCTAVE * log2(last_px / first));
    p->far = malloc((size_t)p->n_far * COLUMNS * sizeof *p->far);
    if (!p->far)
        return GLINT_E_MEMORY;
    for (int i = 0; i < GLINT_PSF_WAVES; i += EVERY)
        for (int c = 0; c < 3; c++)
            sum[c] += p->weight[i][c];
    for (int k = 0; k < COLUMNS; k += step)
        compute_fan_column(p, first, k);
    for (int k = 0; k < COLUMNS; k++)
        if (k % step)
            interpolate_fan_column(p, k);
    for (int k = 0; k < p->n_far * COLUMNS; k++) {
        const double r = compute_row_distance(first, k / COLUMNS);

        for (int c = 0; c < 3; c++)
            p->far[k][c] /= sum[c];
        blend_circle_light(p, r, p->far[k]);
    }
    return GLINT_OK;
}

struct glint_fans_row glint_fans_find_row(const struct glint_psf *p, double r)
{
    const double row =
        PER_OCTAVE * log2(fmax(r / (first_order * p->airy_px), 1));
    const int i = (int)fmin(row, p->n_far - 2);

    return (struct glint_fans_row){.light =
                                       (const double(*)[3])p->far + i * COLUMNS,
                                   .part = fmin(row - i, 1),
                                   .per_r2 = 1 / (r * r),
                                   .step = GLINT_PI / p->n_lines};
}

void glint_fans_interpolate_light(const struct glint_fans_row *row, double off,
                                  double rgb[3])
{
    const double magic = 0x1.8p52; /* rounds to integers */
    const double turns = (off / row->step + magic) - magic;
    const double column =
        fabs(off - turns * row->step) / (0.5 * row->step) * (COLUMNS - 1);
    const int k = column < COLUMNS - 2 ? (int)column : COLUMNS - 2;
    const double s = row->part, t = column - k < 1 ? column - k : 1;
    const double(*a)[3] = row->light + k, (*b)[3] = a + COLUMNS;

    for (int c = 0; c < 3; c++)
        rgb[c] = ((1 - s) * ((1 - t) * a[0][c] + t * a[1][c]) +
                  s * ((1 - t) * b[0][c] + t * b[1][c])) *
                 row->per_r2;
}
