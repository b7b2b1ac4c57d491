/* SPDX-License-Identifier: MIT */
#include "engine/star/star_tables.h"

#include <math.h>
#include <stdlib.h>

#include "engine/star/core_table.h"
#include "engine/star/psf.h"
#include "glint/view.h"

/* Range of 550 nm times the f-number, in pixels, for which tables are made;
 * outside of it the nearest end is used. */
static const double least_airy_px = 1.0 / 64, most_airy_px = 16;

/* Widths of a profile, or pixels if these are wider, up to which it is tabled;
 * it fades into the halo in the outer half. */
static const double widths = 4;

/* Half of a pixel's diagonal. */
static const double filter_px = 0.7072;

struct window {
    double end; /* pixels */
};

static double window_at(double v, const void *self)
{
    const struct window *w = self;
    const double t = fmin(fmax(2 * fabs(v) / w->end - 1, 0), 1);

    return 0.5 + 0.5 * cos(GLINT_PI * t);
}

static int32_t held(double x, double most)
{
    return (int32_t)lrint(fmin(fmax(x, -most), most));
}

/* ------------------------------------------------------------------- lines */

static void set_direction(struct glint_star_line *line, double angle,
                          double border)
{
    const double c = cos(angle), s = sin(angle);
    const double held_s = fmax(fabs(s), 1.0 / 4096);

    line->cos_q30 = (int32_t)lrint(c * 0x1p30);
    line->sin_q30 = (int32_t)lrint(s * 0x1p30);
    line->cot_q16 = held(fabs(s) < 1e-9 ? 0 : 65536 * c / s, 0x1p28);
    line->across_q16 = held(65536 / held_s, 0x1p28);
    line->border_q16 =
        held(65536 * cos(border) / fmax(sin(border), 1e-9), 0x1p28);
}

/* Sets RGB to the profile at V averaged over a pixel that is turned by ANGLE,
 * which is a convolution with two boxes. */
static void filtered(const struct glint_psf *psf, const struct window *window,
                     double angle, double v, double rgb[3])
{
    enum { N = 192 };
    const double a = fabs(cos(angle)), b = fabs(sin(angle));
    const double wide = fmax(a, b), narrow = fmin(a, b);
    double total = 0;

    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int i = 0; i < N; i++) {
        const double at = (wide + narrow) * ((i + 0.5) / N - 0.5);
        const double rim = 0.5 * (wide + narrow) - fabs(at);
        const double part = rim < narrow ? rim / narrow : 1;
        double here[3];

        glint_psf_profile(psf, v + at, here);
        for (int c = 0; c < 3; c++)
            rgb[c] += part * here[c] * window_at(v + at, window);
        total += part;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] /= total;
}

static double largest(const double rgb[3])
{
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

static void set_lines(struct glint_star_tables *t, struct glint_star_line *line,
                      const struct glint_psf *psf, const struct window *window)
{
    const double reach = t->reach_q8 / 256.0;
    const double half = 0.5 * GLINT_PI / psf->n_lines;
    double peak = 0x1p-60, rgb[3];

    for (int i = 0; i < psf->n_lines; i++) {
        filtered(psf, window, glint_psf_angle(psf, i), 0, rgb);
        peak = fmax(peak, largest(rgb) * 1.001);
    }
    t->step = glint_real_of(peak / 65535);
    for (int i = 0; i < psf->n_lines; i++) {
        const double angle = glint_psf_angle(psf, i);

        set_direction(&line[i], angle, fmod(angle + half, GLINT_PI));
        for (int k = 0; k < GLINT_STAR_PROFILE; k++) {
            filtered(psf, window, angle, reach * k / GLINT_STAR_PROFILE, rgb);
            for (int c = 0; c < 3; c++) {
                line[i].profile[k][c] =
                    (uint16_t)lrint(fmin(rgb[c] / peak, 1) * 65535);
                if (line[i].profile[k][c] > t->line_most[k])
                    t->line_most[k] = line[i].profile[k][c];
            }
        }
    }
    t->first = glint_psf_angle(psf, psf->n_lines - 1) + half >= GLINT_PI
                   ? psf->n_lines - 1
                   : 0;
}

/* -------------------------------------------------------------------- halo */

/* Sets log2 of light times r^2 at ROW and COLUMN of the halo. */
static void halo_at(const struct glint_psf *psf, const struct window *window,
                    double reach, int row, int column, double log2_of[3])
{
    const double r = exp2(2 + 0.25 * row);
    const double v = 0.25 * reach * (exp2(0.25 * column) - 1);
    const double off = asin(fmin(v / r, sin(0.5 * GLINT_PI / psf->n_lines)));
    const double angle = glint_psf_angle(psf, 0) + off;
    double rgb[3];

    glint_psf_far(psf, r * cos(angle), r * sin(angle), window_at, window, rgb);
    for (int c = 0; c < 3; c++)
        log2_of[c] = log2(fmax(rgb[c] * r * r, 0x1p-60));
}

static void set_halo(struct glint_star_tables *t, const struct glint_psf *psf,
                     const struct window *window)
{
    const double reach = t->reach_q8 / 256.0;
    double top = -60, log2_of[3];

    for (int i = 0; i < GLINT_STAR_HALO_ROWS; i++)
        for (int k = 0; k < GLINT_STAR_HALO_COLUMNS; k++) {
            halo_at(psf, window, reach, i, k, log2_of);
            top = fmax(top, largest(log2_of));
        }
    t->halo_log2_q16 = (int32_t)lrint((top - 31.99) * 65536);
    for (int i = 0; i < GLINT_STAR_HALO_ROWS; i++) {
        t->halo_most[i] = 0;
        for (int k = 0; k < GLINT_STAR_HALO_COLUMNS; k++) {
            halo_at(psf, window, reach, i, k, log2_of);
            for (int c = 0; c < 3; c++) {
                const double steps =
                    2048 * log2_of[c] - t->halo_log2_q16 / 32.0;

                t->halo[i][k][c] = (uint16_t)lrint(fmax(steps, 0));
                if (t->halo[i][k][c] > t->halo_most[i])
                    t->halo_most[i] = t->halo[i][k][c];
            }
        }
    }
}

/* --------------------------------------------------------------------- all */

static void set_sizes(struct glint_star_tables *t, const struct glint_psf *psf,
                      struct window *window)
{
    window->end = widths * fmax(1, psf->n_blades ? psf->width_px : 0);
    t->reach_q8 = (int32_t)lrint(256 * fmin(window->end + filter_px, 16384));
    t->reach_log2_q16 = (int32_t)lrint(65536 * log2(t->reach_q8));
    t->per_pixel_q16 =
        (int32_t)lrint(65536.0 * 256 * GLINT_STAR_PROFILE / t->reach_q8);
    t->pixels_q16 =
        (int32_t)lrint(65536.0 * t->reach_q8 / 256 / GLINT_STAR_PROFILE);
    t->width_q8 = (int32_t)lrint(
        256 * (psf->n_blades ? hypot(1, 0.886 * psf->width_px) : 1));
    t->inner_q8 = (int32_t)lrint(256 * fmax(2, psf->airy_px));
}

enum glint_status glint_star_tables_make(struct glint_star_tables **tables,
                                         const struct glint_star_optics *o)
{
    const double airy_px = glint_star_airy_px(o);
    struct glint_psf psf;
    struct window window;
    struct glint_star_tables *t = NULL;
    struct glint_star_line *line;
    enum glint_status status =
        glint_psf_init(&psf, o->n_blades, o->rotation_deg,
                       fmin(fmax(airy_px, least_airy_px), most_airy_px));

    if (status == GLINT_OK)
        t = calloc(1, sizeof *t + (size_t)psf.n_lines * sizeof *line);
    if (t) {
        line = (struct glint_star_line *)(t + 1);
        t->n_lines = psf.n_lines;
        t->line = line;
        set_sizes(t, &psf, &window);
        set_lines(t, line, &psf, &window);
        set_halo(t, &psf, &window);
        status = glint_star_set_core(t, &psf);
    }
    glint_psf_finish(&psf);
    if (!t || status != GLINT_OK) {
        free(t);
        return GLINT_E_MEMORY;
    }
    *tables = t;
    return GLINT_OK;
}

void glint_star_tables_free(struct glint_star_tables *tables)
{
    free(tables);
}

size_t glint_star_tables_bytes(const struct glint_star_tables *t)
{
    return sizeof *t + (size_t)t->n_lines * sizeof *t->line;
}
