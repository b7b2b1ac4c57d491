/* SPDX-License-Identifier: MIT
 *
 * Sums the light of a picture and of lamps in each cell of a veil.
 */
#include "base/q.h"
#include "base/real.h"
#include "veil/parts.h"

struct look {
    struct glint_veil *veil;
    struct glint_light_sum sum;
    struct glint_real white;
};

/* Adds SUM to cell (X, Y), scaled to the cell's exact area. SUM is the light of
 * the pixels that were read in the cell. */
static void add_light_to_cell(const struct look *l, int x, int y,
                              const int64_t sum_q20[3])
{
    const struct glint_veil *v = l->veil;

    for (int c = 0; c < 3; c++) {
        /* The unit is 2^-11, so that 2^16 white pixels need 28 bits. Larger
         * sums are clamped to 31 bits. */
        const int64_t seen = q_clamp_sat(q_shift(sum_q20[c], 9), 0, INT32_MAX);
        const int64_t part =
            q_clamp_sat(q_shift(q_shift(seen * v->across.fill_q16[x], 16) *
                                    v->down.fill_q16[y],
                                16),
                        0, INT32_MAX);
        const int s = -l->white.exponent - 5;

        v->light_q16[(c * v->n_y + y) * v->n_x + x] +=
            s > 62  ? 0
            : s < 0 ? INT64_C(1) << 46
                    : q_shift(part * l->white.mantissa, s);
    }
}

/* Adds the light of pixel rows Y .. Y + N_Y - 1, N_Y at most 2, to SUM, the
 * cells of one row of cells. */
static void add_pixel_rows_to_cell_sums(const struct look *l,
                                        struct glint_codes *codes, int y,
                                        int n_y, int64_t (*sum_q20)[3])
{
    const struct glint_veil *v = l->veil;
    const int width = l->sum.image->width;
    struct glint_light_sum sum = l->sum;

    for (int at = 0; at < width; at += GLINT_CODES_WIDTH) {
        const int n = q_smaller(GLINT_CODES_WIDTH, width - at);

        glint_light_sum_read_pixels(&sum, codes, at, y, n, n_y);
        for (int x = at, to; x < at + n; x = to) {
            const int cell = v->across.cell[x];

            to = q_smaller(at + n, v->across.start[cell + 1]);
            for (int k = 0; k < n_y; k++)
                glint_light_sum_add_row(&sum, codes, k, x, to, sum_q20[cell]);
        }
    }
}

/* Worker function: sums the light of row JOB of cells. A pair of pixel rows
 * belongs to the row of cells that contains its first row. */
static void sum_cell_row_job(void *ctx, int job, int worker)
{
    const struct look *l = ctx;
    struct glint_veil *v = l->veil;
    int64_t(*sum_q20)[3] = v->worker[worker].sum_q20;

    for (int x = 0; x < v->n_x; x++)
        sum_q20[x][0] = sum_q20[x][1] = sum_q20[x][2] = 0;
    for (int y = 0; y < l->sum.image->height; y += 2)
        if (v->down.cell[y] == job)
            add_pixel_rows_to_cell_sums(l, &v->worker[worker].codes, y,
                                        q_smaller(2, l->sum.image->height - y),
                                        sum_q20);
    for (int x = 0; x < v->n_x; x++)
        add_light_to_cell(l, x, job, sum_q20[x]);
}

void glint_veil_read_picture(struct glint_veil *veil,
                             const struct glint_image *image,
                             struct glint_real white,
                             struct glint_workers *workers)
{
    struct look l = {.veil = veil, .white = white};

    for (int i = 0; i < 3 * veil->n_x * veil->n_y; i++)
        veil->light_q16[i] = 0;
    if (!image || white.mantissa <= 0)
        return;
    glint_light_sum_init(&l.sum, image, veil->curve);
    if (!veil->has_curve || veil->transfer != image->transfer)
        glint_light_curve_init(veil->curve, image->transfer);
    veil->has_curve = 1;
    veil->transfer = image->transfer;
    glint_workers_run(workers, veil->n_y, sum_cell_row_job, &l);
}

/* ------------------------------------------------------------------- lamps */

/* The cell that contains a position along one axis, and the spline weights of
 * the previous cell, this cell and the next. */
struct place {
    int cell;
    int32_t weight_q15[3];
};

static struct place find_cell_and_weights(int32_t at_q8, int side, int n)
{
    const int32_t along_q15 =
        (int32_t)((((int64_t)at_q8 * n) << 7) / side); /* position along the
                                                          axis in cells */
    struct place p = {.cell = q_smaller(along_q15 >> 15, n - 1)};
    const int32_t t_q15 = along_q15 - p.cell * 32768, rest_q15 = 32768 - t_q15;

    p.weight_q15[0] = (int32_t)((uint32_t)(rest_q15 * rest_q15) >> 16);
    p.weight_q15[2] = (int32_t)((uint32_t)t_q15 * (uint32_t)t_q15 >> 16);
    p.weight_q15[1] = 32768 - p.weight_q15[0] - p.weight_q15[2];
    return p;
}

/* Returns POWER times RGB in units of light_q16 (white times pixels, _q16),
 * clamped to 2^46. */
static int64_t compute_lamp_power_q16(struct glint_real power, int32_t rgb_q14)
{
    const int64_t part = (int64_t)power.mantissa * rgb_q14;
    const int down = 14 - 16 - power.exponent;

    if (down > 62 || part <= 0)
        return 0;
    if (down >= 0)
        return q_shift(part, down);
    return -down > 16 || part << -down > INT64_C(1) << 46 ? INT64_C(1) << 46
                                                          : part << -down;
}

void glint_veil_add_lamp(struct glint_veil *veil, int32_t x_q8, int32_t y_q8,
                         struct glint_real power, const int32_t rgb_q14[3])
{
    struct place x, y;

    if (x_q8 < 0 || y_q8 < 0 || x_q8 > veil->cfg.width * 256 ||
        y_q8 > veil->cfg.height * 256)
        return;
    x = find_cell_and_weights(x_q8, veil->cfg.width, veil->n_x);
    y = find_cell_and_weights(y_q8, veil->cfg.height, veil->n_y);
    for (int c = 0; c < 3; c++) {
        const int64_t all = compute_lamp_power_q16(power, rgb_q14[c]);

        for (int j = 0; j < 9; j++) {
            const int at_x =
                glint_veil_neighbour_index(x.cell, j % 3 - 1, veil->n_x);
            const int at_y =
                glint_veil_neighbour_index(y.cell, j / 3 - 1, veil->n_y);
            /* the light is below 2^47, a weight at most 2^15 */
            const int64_t part = q_shift(all * x.weight_q15[j % 3], 15);

            veil->light_q16[(c * veil->n_y + at_y) * veil->n_x + at_x] +=
                q_shift(part * y.weight_q15[j / 3], 15);
        }
    }
}
