/* SPDX-License-Identifier: MIT
 *
 * Computes the core table of a starburst: the exact pattern near the lamp minus
 * lines and halo.
 *
 *   in   a pattern, and the tables of its far field
 *   out  the table of what these lack near the light
 *
 * Method: the pattern is integrated over cells of a quarter of a pixel, by
 * sample points whose density depends on the distance from the lamp. The four
 * cells in the middle also get the light that sampling has missed: 1 minus the
 * sum over all cells minus the light beyond them. A node of the core table is
 * the sum over the cells of a pixel around it, minus the far field; it fades
 * out towards the rim of the table. */
#include "engine/star/core_table.h"

#include <math.h>
#include <stdlib.h>

#include "engine/star/smear_table.h"
#include "glint/view.h"

enum { CELLS = 4 }; /* cells per pixel, across and down */

/* A square of cells around the lamp, and its summed-area table. */
struct cells {
    const struct glint_psf *psf;
    const struct glint_smear
        *smear;       /* diffraction by dirt in the stop, or NULL */
    double airy_px;   /* 550 nm times the f-number, pixels: the scale of the
                         smear */
    int half, side;   /* half: number of cells from the middle to a side of the
                         square; side: number of cells per side of the square */
    double (*sum)[3]; /* [side + 1][side + 1]: summed-area table of the light of
                         cells */
};

static double (*find_cell_sum(const struct cells *s, int i, int k))[3]
{
    return &s->sum[(i + s->half) * (s->side + 1) + k + s->half];
}

/* Returns the number of sample points per side of a cell R pixels from the
 * lamp. */
static int count_cell_samples(const struct glint_psf *psf, double r)
{
    const double fine = r < 12 * psf->airy_px + 0.5
                            ? psf->airy_px / 8
                            : fmin(psf->width_px, 1) / 5;
    const int most = (r < 1 ? 48 : 12) / (psf->draft ? 4 : 1);

    return (int)fmin(fmax(ceil(1.0 / CELLS / fine), 1), most);
}

static void integrate_cell_light(const struct cells *s, int i, int k,
                                 double rgb[3])
{
    const struct glint_psf *psf = s->psf;
    const double side = 1.0 / CELLS;
    const int n = count_cell_samples(psf, side * hypot(i + 0.5, k + 0.5));

    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int p = 0; p < n * n; p++) {
        const int row = p / n, column = p % n;
        const double x = side * (k + (column + 0.5) / n);
        const double y = side * (i + (row + 0.5) / n);
        double here[3];

        glint_psf_compute_light(psf, x, y, here);
        for (int c = 0; c < 3; c++)
            rgb[c] += here[c] * side * side / (n * n);
    }
    if (s->smear) {
        double more[3];

        glint_smear_compute_light(s->smear, psf, s->airy_px, side * (k + 0.5),
                                  side * (i + 0.5), side / 2, more);
        for (int c = 0; c < 3; c++)
            rgb[c] = rgb[c] * s->smear->clear + more[c] * side * side;
    }
}

/* Returns the fraction of the light of channel C that lies farther than R
 * pixels from the lamp. */
static double compute_light_beyond(const struct cells *s, double r, int c)
{
    const double all = glint_psf_compute_light_beyond(s->psf, r, c);

    return s->smear
               ? s->smear->clear * all + glint_smear_compute_light_beyond(
                                             s->smear, s->psf, s->airy_px, r, c)
               : all;
}

/* Stores the light of each cell in the memory of the summed-area table, which
 * is summed later. The half above the lamp is the point reflection of the half
 * below. */
static void compute_cell_lights(struct cells *s)
{
    double missing[3] = {0, 0, 0};
    const double r = (double)s->half / CELLS;

    for (int i = 0; i < s->half; i++)
        for (int k = -s->half; k < s->half; k++) {
            double rgb[3];

            integrate_cell_light(s, i, k, rgb);
            for (int c = 0; c < 3; c++) {
                (*find_cell_sum(s, i + 1, k + 1))[c] = rgb[c];
                (*find_cell_sum(s, -i, -k))[c] = rgb[c];
                if (hypot(i + 0.5, k + 0.5) < s->half)
                    missing[c] += 2 * rgb[c];
            }
        }
    for (int c = 0; c < 3; c++) {
        const double more =
            (1 - compute_light_beyond(s, r, c) - missing[c]) / 4;

        for (int p = 0; p < 4; p++)
            (*find_cell_sum(s, p / 2, p % 2))[c] += more;
    }
}

static void make_summed_area_table(struct cells *s)
{
    for (int i = -s->half; i < s->half; i++)
        for (int k = -s->half; k < s->half; k++)
            for (int c = 0; c < 3; c++)
                (*find_cell_sum(s, i + 1, k + 1))[c] +=
                    (*find_cell_sum(s, i, k + 1))[c] +
                    (*find_cell_sum(s, i + 1, k))[c] -
                    (*find_cell_sum(s, i, k))[c];
}

/* Sets RGB to the light of the pixel centred at (X, Y), the indices of a corner
 * of cells. */
static void sum_pixel_light(const struct cells *s, int y, int x, double rgb[3])
{
    const int h = CELLS / 2;

    for (int c = 0; c < 3; c++)
        rgb[c] = (*find_cell_sum(s, y + h, x + h))[c] -
                 (*find_cell_sum(s, y - h, x + h))[c] -
                 (*find_cell_sum(s, y + h, x - h))[c] +
                 (*find_cell_sum(s, y - h, x - h))[c];
}

/* --------------------------------------------------------------- far field */

static double interpolate_halo_log2(const struct glint_star_tables *t,
                                    double row, double column, int c)
{
    const double i = fmin(fmax(row, 0), GLINT_STAR_HALO_ROWS - 1.0001);
    const double k = fmin(fmax(column, 0), GLINT_STAR_HALO_COLUMNS - 1.0001);
    const int i0 = (int)i, k0 = (int)k;
    const double a = t->halo[i0][k0][c], b = t->halo[i0][k0 + 1][c];
    const double d = t->halo[i0 + 1][k0][c], e = t->halo[i0 + 1][k0 + 1][c];
    const double near = a + (b - a) * (k - k0), far = d + (e - d) * (k - k0);

    return (near + (far - near) * (i - i0)) / 2048 + t->halo_log2_q16 / 65536.0;
}

void glint_star_evaluate_far_tables(const struct glint_star_tables *t, double x,
                                    double y, double rgb[3])
{
    const double inner = t->inner_q8 / 256.0, reach = t->reach_q8 / 256.0;
    const double r2 = fmax(x * x + y * y, inner * inner);
    double nearest = HUGE_VAL;

    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int i = 0; i < t->n_lines; i++) {
        const struct glint_star_line *l = &t->line[i];
        const double v = fabs(y * l->cos_q30 - x * l->sin_q30) * 0x1p-30;
        const double at = v / reach * GLINT_STAR_PROFILE;
        const int k = (int)fmin(at, GLINT_STAR_PROFILE);
        const double less = fmin(v * v / r2, 1);

        nearest = fmin(nearest, v);
        for (int c = 0; c < 3 && k < GLINT_STAR_PROFILE; c++)
            rgb[c] += (l->profile[k][c] +
                       (l->profile[k + 1][c] - l->profile[k][c]) * (at - k)) *
                      glint_real_value(t->step) * (1 - less) / r2;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] +=
            exp2(interpolate_halo_log2(t, 2 * (log2(r2) - 4),
                                       4 * log2(1 + 4 * nearest / reach), c)) /
            r2;
}

/* -------------------------------------------------------------------- core */

static uint16_t encode_core_light(double light)
{
    const unsigned sign = light < 0 ? 1U << 15 : 0;
    double size = fabs(light) * 0x1p40;
    unsigned e = 1;

    if (size < 1023.5)
        return (uint16_t)(sign | (unsigned)lrint(size));
    for (; size >= 2047.5 && e < 31; e++)
        size /= 2;
    size = fmin(fmax(size, 1024), 2047);
    return (uint16_t)(sign | e << 10 | ((unsigned)lrint(size) - 1024));
}

/* Returns the distance between nodes of the core table, in cells: 1, 2 or 4. It
 * is small enough to resolve diffraction rings, and large enough that the table
 * extends to where rings have faded. */
static int count_cells_between_nodes(const struct glint_psf *psf)
{
    const double far = 9 * psf->airy_px / GLINT_STAR_CORE;

    return far > 0.5 ? 4 : far > 0.25 ? 2 : 1;
}

/* Adds the light that dirt in the stop diffracts to (X, Y), pixels from the
 * lamp, to RGB. */
static void add_smear_light(const struct glint_star_tables *t, double x,
                            double y, double rgb[3])
{
    double more[3];

    glint_smear_evaluate_table(t->smear, x, y, more);
    for (int c = 0; c < 3; c++)
        rgb[c] += more[c];
}

static void set_core_nodes(struct glint_star_tables *t, const struct cells *s,
                           int step)
{
    for (int i = 0; i <= GLINT_STAR_CORE; i++)
        for (int k = -GLINT_STAR_CORE; k <= GLINT_STAR_CORE; k++) {
            const double from = 0.7;
            const double r = hypot(i, k) / (GLINT_STAR_CORE - 1);
            const double in = fmin(fmax((1 - r) / (1 - from), 0), 1);
            const double part = in * in * (3 - 2 * in);
            double light[3], far[3];

            sum_pixel_light(s, i * step, k * step, light);
            glint_star_evaluate_far_tables(t, (double)k * step / CELLS,
                                           (double)i * step / CELLS, far);
            if (t->smear)
                add_smear_light(t, (double)k * step / CELLS,
                                (double)i * step / CELLS, far);
            for (int c = 0; c < 3; c++)
                t->core[i][k + GLINT_STAR_CORE][c] =
                    encode_core_light(part * (light[c] - far[c]));
        }
}

enum glint_status glint_star_make_core_table(struct glint_star_tables *tables,
                                             const struct glint_psf *psf,
                                             const struct glint_smear *smear,
                                             double airy_px)
{
    const int step = count_cells_between_nodes(psf);
    struct cells s = {.psf = psf,
                      .smear = smear,
                      .airy_px = airy_px,
                      .half = GLINT_STAR_CORE * step + CELLS};

    s.side = 2 * s.half;
    s.sum = calloc((size_t)(s.side + 1) * (size_t)(s.side + 1), sizeof *s.sum);
    if (!s.sum)
        return GLINT_E_MEMORY;
    tables->core_per_pixel_q16 = 65536 * CELLS / step;
    compute_cell_lights(&s);
    make_summed_area_table(&s);
    set_core_nodes(tables, &s, step);
    free(s.sum);
    return GLINT_OK;
}
