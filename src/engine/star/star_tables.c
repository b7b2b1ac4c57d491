/* SPDX-License-Identifier: MIT */
#include "engine/star/star_tables.h"

#include <math.h>
#include <stdlib.h>

#include "glint/setup.h"
#include "engine/star/core_table.h"
#include "engine/star/psf.h"
#include "engine/star/smear_table.h"
#include "glint/view.h"

/* range of airy_px (550 nm times the f-number, pixels) for which tables are
 * made; values out of range are clamped */
static const double least_airy_px = 1.0 / 64, most_airy_px = 16;

/* Half width of the tabulated line profiles, in multiples of the profile's
 * width, or in pixels if a pixel is wider. In the outer half they fade into the
 * halo. */
static const double widths = 4;

/* Half the length of a pixel's diagonal, pixels. */
static const double filter_px = 0.7072;

/* total size of the halo tables of extended lamps, bytes */
static const size_t wide_bytes =
    GLINT_STAR_WIDE * GLINT_STAR_HALO_ROWS * sizeof(glint_star_halo_row);

struct window {
    double end; /* pixels */
};

static double evaluate_fade_window(double v, const void *self)
{
    const struct window *w = self;
    const double t = fmin(fmax(2 * fabs(v) / w->end - 1, 0), 1);

    return 0.5 + 0.5 * cos(GLINT_PI * t);
}

static int32_t round_and_clamp(double x, double most)
{
    return (int32_t)lrint(fmin(fmax(x, -most), most));
}

/* ------------------------------------------------------------------- lines */

static void set_line_direction(struct glint_star_line *line, double angle)
{
    const double c = cos(angle), s = sin(angle);
    const double held_s = fmax(fabs(s), 1.0 / 4096);

    line->cos_q30 = (int32_t)lrint(c * 0x1p30);
    line->sin_q30 = (int32_t)lrint(s * 0x1p30);
    line->cot_q16 = round_and_clamp(fabs(s) < 1e-9 ? 0 : 65536 * c / s, 0x1p28);
    line->across_q16 = round_and_clamp(65536 / held_s, 0x1p28);
}

/* Sets RGB to the profile of a line at V, averaged over the area of a pixel, by
 * a convolution with two boxes. ANGLE is the angle between the sides of the
 * pixel and the line. */
static void filter_profile_by_pixel(const struct glint_psf *psf,
                                    const struct window *window, double angle,
                                    double v, double rgb[3])
{
    const int n = psf->draft ? 24 : 192;
    const double a = fabs(cos(angle)), b = fabs(sin(angle));
    const double wide = fmax(a, b), narrow = fmin(a, b);
    double total = 0;

    rgb[0] = rgb[1] = rgb[2] = 0;
    if (psf->n_blades == 0 || psf->fans)
        return; /* there are no lines */
    for (int i = 0; i < n; i++) {
        const double at = (wide + narrow) * ((i + 0.5) / n - 0.5);
        const double rim = 0.5 * (wide + narrow) - fabs(at);
        const double part = rim < narrow ? rim / narrow : 1;
        double here[3];

        glint_psf_interpolate_profile(psf, v + at, here);
        for (int c = 0; c < 3; c++)
            rgb[c] += part * here[c] * evaluate_fade_window(v + at, window);
        total += part;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] /= total;
}

static void make_line_tables(struct glint_star_tables *t,
                             struct glint_star_line *line,
                             const struct glint_psf *psf,
                             const struct window *window)
{
    const double reach = t->reach_q8 / 256.0;
    double peak = 0x1p-60, rgb[3];

    for (int i = 0; i < psf->n_lines; i++) {
        filter_profile_by_pixel(psf, window,
                                glint_psf_compute_line_angle(psf, i), 0, rgb);
        peak = fmax(peak, glint_largest_channel(rgb) * 1.001);
    }
    t->step = glint_real_of(peak / 65535);
    for (int i = 0; i < psf->n_lines; i++) {
        const double angle = glint_psf_compute_line_angle(psf, i);

        set_line_direction(&line[i], angle);
        for (int k = 0; k < GLINT_STAR_PROFILE; k++) {
            filter_profile_by_pixel(psf, window, angle,
                                    reach * k / GLINT_STAR_PROFILE, rgb);
            for (int c = 0; c < 3; c++) {
                line[i].profile[k][c] =
                    (uint16_t)lrint(fmin(rgb[c] / peak, 1) * 65535);
                if (line[i].profile[k][c] > t->line_max[k])
                    t->line_max[k] = line[i].profile[k][c];
            }
        }
    }
}

/* -------------------------------------------------------------------- halo */

/* Weights of the chords of a lamp's disc: part[i] for the chord at i / (n + 1)
 * radii from its centre. All 2 n + 1 sum to 1. */
struct disc {
    int n;
    double radius; /* pixels */
    double part[100];
};

static struct disc make_lamp_disc(double radius, bool draft)
{
    struct disc d = {.n = (8 + (int)(radius / 1.5)) / (draft ? 4 : 1),
                     .radius = radius};
    double total = 0;

    for (int i = 0; i <= d.n; i++) {
        d.part[i] = sqrt(1 - (double)(i * i) / ((d.n + 1) * (d.n + 1)));
        total += (i ? 2 : 1) * d.part[i];
    }
    for (int i = 0; i <= d.n; i++)
        d.part[i] /= total;
    return d;
}

/* Adds to RGB the light of fans at R pixels from a lamp, and at V pixels and
 * the angle OFF from a line, as the mean over chords of the lamp's disc. Point
 * lights are blurred slightly, too, as a fan may be thinner than a pixel, and
 * its sides steeper than the table's columns resolve. */
static void add_blurred_fans(const struct glint_psf *psf, double r, double off,
                             double v, const struct disc *disc, double rgb[3])
{
    const struct glint_fans_row row = glint_fans_find_row(psf, r);
    const double half = hypot(disc->radius, 0.4 + 0.1 * v);
    const double turn = half / ((disc->n + 1) * fmax(r, disc->radius));

    for (int i = -disc->n; i <= disc->n; i++) {
        double here[3];

        glint_fans_interpolate_light(&row, off + turn * i, here);
        for (int c = 0; c < 3; c++)
            rgb[c] += disc->part[i < 0 ? -i : i] * here[c];
    }
}

/* Sets LOG2_OF to log2 of (light times r^2) at ROW and COLUMN of the halo table
 * for lamps with the disc DISC. */
static void compute_halo_node(const struct glint_psf *psf,
                              const struct window *window, double reach,
                              const struct disc *disc, int row, int column,
                              double log2_of[3])
{
    const double r = exp2(2 + 0.25 * row);
    const double v = 0.25 * reach * (exp2(0.25 * column) - 1);
    const double off = asin(fmin(v / r, sin(0.5 * GLINT_PI / psf->n_lines)));
    const double angle = glint_psf_compute_line_angle(psf, 0) + off;
    double rgb[3] = {0, 0, 0};

    if (psf->fans)
        add_blurred_fans(psf, r, off, v, disc, rgb);
    else
        glint_psf_compute_far_light(psf, r * cos(angle), r * sin(angle),
                                    evaluate_fade_window, window, rgb);
    for (int c = 0; c < 3; c++)
        log2_of[c] = log2(fmax(rgb[c] * r * r, 0x1p-60));
}

/* Computes and encodes row ROW of the halo table for lamps with the disc DISC.
 * Raises *MOST to the max code of the row. */
static void encode_halo_row(struct glint_star_tables *t,
                            const struct glint_psf *psf,
                            const struct window *window,
                            const struct disc *disc, int row,
                            glint_star_halo_row codes, uint16_t *most)
{
    double log2_of[3];

    for (int k = 0; k < GLINT_STAR_HALO_COLUMNS; k++) {
        compute_halo_node(psf, window, t->reach_q8 / 256.0, disc, row, k,
                          log2_of);
        for (int c = 0; c < 3; c++) {
            const double steps = 2048 * log2_of[c] - t->halo_log2_q16 / 32.0;

            codes[k][c] = (uint16_t)lrint(fmin(fmax(steps, 0), 65535));
            if (codes[k][c] > *most)
                *most = codes[k][c];
        }
    }
}

static void make_halo_table(struct glint_star_tables *t,
                            const struct glint_psf *psf,
                            const struct window *window)
{
    const double reach = t->reach_q8 / 256.0;
    const struct disc point = make_lamp_disc(0, psf->draft);
    double top = -60, log2_of[3];

    for (int i = 0; i < GLINT_STAR_HALO_ROWS; i++)
        for (int k = 0; k < GLINT_STAR_HALO_COLUMNS; k++) {
            compute_halo_node(psf, window, reach, &point, i, k, log2_of);
            top = fmax(top, glint_largest_channel(log2_of));
        }
    t->halo_log2_q16 = (int32_t)lrint((top - 31.99) * 65536);
    for (int i = 0; i < GLINT_STAR_HALO_ROWS; i++) {
        t->halo_max[i] = 0;
        encode_halo_row(t, psf, window, &point, i, t->halo[i], &t->halo_max[i]);
    }
}

/* Computes WIDE, the halo tables of extended lamps. */
static void make_wide_lamp_halos(struct glint_star_tables *t,
                                 const struct glint_psf *psf,
                                 const struct window *window,
                                 glint_star_halo_row *wide)
{
    for (int k = 0; k < GLINT_STAR_WIDE; k++) {
        const struct disc disc = make_lamp_disc(exp2(k - 1), psf->draft);

        for (int i = 0; i < GLINT_STAR_HALO_ROWS; i++)
            encode_halo_row(t, psf, window, &disc, i,
                            wide[k * GLINT_STAR_HALO_ROWS + i],
                            &t->halo_max[i]);
    }
    t->wide = (const glint_star_halo_row *)wide;
}

/* -------------------------------------------------------------- all tables */

static void set_profile_sizes(struct glint_star_tables *t,
                              const struct glint_psf *psf,
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

/* min fraction of lines and halo that dirt leaves; 0 has no logarithm */
static const double least_clear = 1e-6;

/* Adds dirt to the tables of the clear stop: scales lines and halo by the
 * fraction of light that dirt leaves, and makes the table of SMEAR. */
static enum glint_status make_dirt_smear_table(struct glint_star_tables *t,
                                               const struct glint_psf *psf,
                                               const struct glint_smear *smear,
                                               double airy_px,
                                               struct glint_star_smear *table)
{
    const double clear = fmax(smear->clear, least_clear);

    t->step = glint_real_of(glint_real_value(t->step) * clear);
    t->halo_log2_q16 += (int32_t)lrint(log2(clear) * 65536);
    table->part = glint_star_add_smear_row;
    t->smear = table;
    return glint_smear_make_table(table, smear, psf, airy_px);
}

enum glint_status glint_star_tables_make(struct glint_star_tables **tables,
                                         const struct glint_star_optics *o)
{
    const double airy_px =
        fmin(fmax(glint_star_compute_airy_px(o), least_airy_px), most_airy_px);
    struct glint_psf psf;
    struct window window;
    struct glint_star_tables *t = NULL;
    struct glint_star_line *line;
    enum glint_status status =
        glint_psf_init_iris(&psf, o->n_blades, o->rotation_deg, airy_px,
                            o->round, o->soft, o->draft);
    const size_t smear_bytes = o->smear ? sizeof *t->smear : 0;

    if (status == GLINT_OK)
        t = calloc(1, sizeof *t + smear_bytes +
                          (size_t)psf.n_lines * sizeof *line +
                          (psf.fans ? wide_bytes : 0));
    if (t) {
        line = (void *)((char *)(t + 1) + smear_bytes);
        t->n_lines = psf.n_lines;
        t->line = line;
        set_profile_sizes(t, &psf, &window);
        make_line_tables(t, line, &psf, &window);
        make_halo_table(t, &psf, &window);
        if (psf.fans)
            make_wide_lamp_halos(t, &psf, &window,
                                 (glint_star_halo_row *)(line + psf.n_lines));
        if (o->smear)
            status = make_dirt_smear_table(t, &psf, o->smear, airy_px,
                                           (struct glint_star_smear *)(t + 1));
        if (status == GLINT_OK && o->has_core)
            status = glint_psf_make_near_table(&psf);
        if (status == GLINT_OK && o->has_core)
            status = glint_star_make_core_table(t, &psf, o->smear, airy_px);
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

size_t glint_star_tables_count_bytes(const struct glint_star_tables *t)
{
    return sizeof *t + (size_t)t->n_lines * sizeof *t->line +
           (t->wide ? wide_bytes : 0) + (t->smear ? sizeof *t->smear : 0);
}
