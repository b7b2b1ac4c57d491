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
    EVERY = 2 /* every second wavelength is used */
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

/* Sets RGB to the light of fans (lines spread by curved blades or a soft edge)
 * times R^2, R pixels from the lamp, at the angle OFF from the nearest line. */
static void sum_fan_light(const struct glint_psf *p, double r, double off,
                          double rgb[3])
{
    const double at = GLINT_PI / p->n_blades + off;

    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int i = 0; i < GLINT_PSF_WAVES; i += EVERY) {
        const double s = p->scale[i], q = r / (2 * p->airy_px * s);
        const double light =
            glint_arcs_compute_far_pattern(&p->arcs, q * cos(at), q * sin(at)) *
            glint_psf_compute_soft_edge_factor(p->soft, q) * p->area * q * q;

        for (int c = 0; c < 3; c++)
            rgb[c] += p->weight[i][c] * light;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = fmax(rgb[c], 0);
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

enum glint_status glint_fans_make_table(struct glint_psf *p)
{
    const double first = first_order * p->airy_px;
    const double half = 0.5 * GLINT_PI / p->n_lines;
    double sum[3] = {0, 0, 0};

    p->n_far = 2 + (int)ceil(PER_OCTAVE * log2(last_px / first));
    p->far = malloc((size_t)p->n_far * COLUMNS * sizeof *p->far);
    if (!p->far)
        return GLINT_E_MEMORY;
    for (int i = 0; i < GLINT_PSF_WAVES; i += EVERY)
        for (int c = 0; c < 3; c++)
            sum[c] += p->weight[i][c];
    for (int k = 0; k < p->n_far * COLUMNS; k++) {
        const int row = k / COLUMNS;
        const double r = first * exp2((double)row / PER_OCTAVE);

        sum_fan_light(p, r, half * (k % COLUMNS) / (COLUMNS - 1), p->far[k]);
        for (int c = 0; c < 3; c++)
            p->far[k][c] /= sum[c];
        blend_circle_light(p, r, p->far[k]);
    }
    return GLINT_OK;
}

void glint_fans_interpolate_light(const struct glint_psf *p, double r,
                                  double off, double rgb[3])
{
    const double step = GLINT_PI / p->n_lines;
    const double row =
        PER_OCTAVE * log2(fmax(r / (first_order * p->airy_px), 1));
    const double column =
        fabs(remainder(off, step)) / (0.5 * step) * (COLUMNS - 1);
    const int i = (int)fmin(row, p->n_far - 2);
    const int k = (int)fmin(column, COLUMNS - 2);
    const double s = fmin(row - i, 1), t = fmin(column - k, 1);
    const double(*a)[3] = (const double(*)[3])p->far + i * COLUMNS + k;
    const double(*b)[3] = a + COLUMNS;

    for (int c = 0; c < 3; c++)
        rgb[c] = ((1 - s) * ((1 - t) * a[0][c] + t * a[1][c]) +
                  s * ((1 - t) * b[0][c] + t * b[1][c])) /
                 (r * r);
}
