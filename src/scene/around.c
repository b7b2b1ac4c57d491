/* SPDX-License-Identifier: MIT */
#include "scene/around.h"

#include "base/q.h"

enum { MOST_CELLS = 320, MOST_Q15 = 65535 };

void glint_background_allocate(struct glint_around *around,
                               struct glint_arena *arena, int width, int height)
{
    const int longer = q_larger(width, height);

    *around = (struct glint_around){.width = width, .height = height};
    /* Cells have at least 2 x 2 pixels, as the picture is read in pairs of
     * rows. */
    around->cell_log2 = 1;
    while (longer >> around->cell_log2 > MOST_CELLS)
        around->cell_log2++;
    around->n_x = ((width - 1) >> around->cell_log2) + 1;
    around->n_y = ((height - 1) >> around->cell_log2) + 1;
    around->curve = glint_arena_allocate(arena, 1, sizeof *around->curve);
    around->light_q15 =
        glint_arena_allocate(arena, (size_t)around->n_x * (size_t)around->n_y,
                             3 * sizeof *around->light_q15);
}

/* -------------------------------------------------------------------- look */

struct look {
    struct glint_around *around;
    struct glint_light_sum sum;
};

/* Returns the mean of N pixels, 1 .. 2^12, whose light sums to SUM. A complete
 * cell has 2^WHOLE_LOG2 pixels, so a shift computes its mean. Only cells cut by
 * the picture's edge need a division. */
static uint16_t compute_cell_mean(int64_t sum_q20, int n, int whole_log2)
{
    const int64_t max_q20 = (int64_t)n << 21;
    const uint32_t sum_q15 =
        (uint32_t)q_shift(sum_q20 < max_q20 ? sum_q20 : max_q20, 5);
    const uint32_t rounded = sum_q15 + ((uint32_t)n >> 1);
    const uint32_t mean_q15 =
        n == 1 << whole_log2 ? rounded >> whole_log2 : rounded / (uint32_t)n;

    return (uint16_t)(mean_q15 < MOST_Q15 ? mean_q15 : MOST_Q15);
}

/* Adds the light of pixels X0 .. X0 + N - 1 of rows Y0 .. Y1 - 1 to RGB, the
 * sums of the cells that contain these pixels. Not inlined, as its local buffer
 * and its caller's sums are too large for one stack frame. */
static NEVER_INLINE void add_pixel_run_to_cells(const struct look *l, int x0,
                                                int n, int y0, int y1,
                                                int64_t (*rgb_q20)[3])
{
    const int side = 1 << l->around->cell_log2;
    struct glint_light_sum sum = l->sum;
    struct glint_codes codes;

    for (int y = y0; y < y1; y += 2) {
        const int n_y = q_smaller(2, y1 - y);

        glint_light_sum_read_pixels(&sum, &codes, x0, y, n, n_y);
        for (int x = 0; x < n; x += side)
            for (int k = 0; k < n_y; k++)
                glint_light_sum_add_row(&sum, &codes, k, x0 + x,
                                        x0 + q_smaller(x + side, n),
                                        rgb_q20[x >> l->around->cell_log2]);
    }
}

/* Sets row JOB of the cells to the mean light of their pixels. Called by the
 * worker pool. */
static void average_cell_row(void *ctx, int job, int worker)
{
    const struct look *l = ctx;
    const struct glint_around *a = l->around;
    const int side = 1 << a->cell_log2, y0 = job << a->cell_log2;
    const int y1 = q_smaller(y0 + side, a->height);
    uint16_t *to_q15 = a->light_q15 + (ptrdiff_t)job * 3 * a->n_x;

    (void)worker;
    for (int x0 = 0; x0 < a->width; x0 += GLINT_CODES_WIDTH) {
        const int n = q_smaller(GLINT_CODES_WIDTH, a->width - x0);
        int64_t rgb_q20[GLINT_CODES_WIDTH / 2][3] = {{0}};

        add_pixel_run_to_cells(l, x0, n, y0, y1, rgb_q20);
        for (int x = 0; x < n; x += side)
            for (int c = 0; c < 3; c++)
                *to_q15++ = compute_cell_mean(
                    rgb_q20[x >> a->cell_log2][c],
                    q_smaller(side, n - x) * (y1 - y0), 2 * a->cell_log2);
    }
}

void glint_background_store(struct glint_around *around,
                            const struct glint_image *image,
                            struct glint_workers *workers)
{
    struct look l = {.around = around};

    around->has_picture = image != NULL;
    if (!image)
        return;
    if (!around->has_curve || around->transfer != image->transfer)
        glint_light_curve_init(around->curve, image->transfer);
    around->has_curve = 1;
    around->transfer = image->transfer;
    glint_light_sum_init(&l.sum, image, around->curve);
    glint_workers_run(workers, around->n_y, average_cell_row, &l);
}

/* ------------------------------------------------------------------- light */

/* The two neighbouring cells between which light is interpolated on one
 * axis. */
struct between {
    int cell, next;
    int32_t part_q15; /* weight of cell NEXT, 0 .. 1; the other cell has 1 minus
                         this weight */
};

static struct between find_neighbour_cells(int32_t share_q16, int side, int n,
                                           int cell_log2)
{
    /* position on the axis, in cells from the middle of the first cell */
    const int64_t at_q15 =
        q_shift((int64_t)share_q16 * side, cell_log2 + 1) - (1 << 14);
    const int32_t held_q15 = q_clamp_sat(at_q15, 0, (n - 1) << 15);
    const int cell = held_q15 >> 15;

    return (struct between){cell, q_smaller(cell + 1, n - 1), held_q15 & 32767};
}

void glint_background_sample(const struct glint_around *around, int32_t x_q16,
                             int32_t y_q16, int32_t rgb_q15[3])
{
    const struct between x = find_neighbour_cells(
        x_q16, around->width, around->n_x, around->cell_log2);
    const struct between y = find_neighbour_cells(
        y_q16, around->height, around->n_y, around->cell_log2);
    const uint16_t *upper_q15 =
        around->light_q15 + (ptrdiff_t)3 * around->n_x * y.cell;
    const uint16_t *lower_q15 =
        around->light_q15 + (ptrdiff_t)3 * around->n_x * y.next;

    for (int c = 0; c < 3; c++) {
        const int i = 3 * x.cell + c, k = 3 * x.next + c;
        const int32_t above_q15 =
            upper_q15[i] + q_mul(upper_q15[k] - upper_q15[i], x.part_q15, 15);
        const int32_t below_q15 =
            lower_q15[i] + q_mul(lower_q15[k] - lower_q15[i], x.part_q15, 15);

        rgb_q15[c] = above_q15 + q_mul(below_q15 - above_q15, y.part_q15, 15);
    }
}
