/* SPDX-License-Identifier: MIT */
#include "kernels/halo.h"

#include "base/log2.h"

enum { SIDE = GLINT_HALO_SIDE };

/* A fractional index into a table: the integer index AT, and the weight of
 * entry AT + 1.
 */
struct place {
    int at;
    uint32_t part_q15;
};

/* Splits X into index and weight, clamped so that the index is below LAST. */
static inline struct place compute_table_index(int32_t x_q16, int last)
{
    const int32_t clamped_q16 = q_clamp_sat(x_q16, 0, (last << 16) - 1);

    return (struct place){clamped_q16 >> 16,
                          (uint32_t)(clamped_q16 >> 1 & 32767)};
}

/* Sets V to the distances of the pixels of row Y from the nearest line. Returns
 * the smallest. */
static inline int32_t compute_line_distances(const struct glint_halo *h, int y,
                                             int32_t v_q8[SIDE])
{
    int32_t least_q8 = INT32_MAX;

    for (int x = 0; x < SIDE; x++)
        v_q8[x] = INT32_MAX;
    for (int k = 0; k < h->n_lines; k++) {
        int64_t here_q38 = h->v_q38[k] + y * 256 * (int64_t)h->cos_q30[k];

        for (int x = 0; x < SIDE; x++) {
            const int32_t v = (int32_t)(here_q38 >> 30);
            const int32_t size_q8 = v < 0 ? -v : v;

            v_q8[x] = size_q8 < v_q8[x] ? size_q8 : v_q8[x];
            least_q8 = size_q8 < least_q8 ? size_q8 : least_q8;
            here_q38 -= 256 * (int64_t)h->sin_q30[k];
        }
    }
    return least_q8;
}

/* Adds the entries at ROW and COLUMN of TABLE, and their neighbours, times
 * WEIGHT to SUM. */
static inline void add_table_entries(const glint_star_halo_row *table, int row,
                                     int column, const uint32_t weight_q15[4],
                                     uint32_t sum_q26[3])
{
    const uint16_t(*const near)[3] = &table[row][column];
    const uint16_t(*const far)[3] = &table[row + 1][column];

    for (int c = 0; c < 3; c++)
        sum_q26[c] += weight_q15[0] * near[0][c] + weight_q15[1] * near[1][c] +
                      weight_q15[2] * far[0][c] + weight_q15[3] * far[1][c];
}

void glint_halo_compute_log2(const struct glint_halo *h, uint64_t r2_q16,
                             int32_t v_q8, int32_t log2_q16[3])
{
    const uint64_t held_q16 = r2_q16 > h->inner_q16 ? r2_q16 : h->inner_q16;
    const int32_t r2_log2_q16 = q_log2_q16(held_q16) - 16 * 65536;
    /* log2 of 1 + 4 v / reach */
    const int32_t column_q16 =
        q_log2_q16((uint64_t)((int64_t)v_q8 * 4 + h->reach_q8)) -
        h->reach_log2_q16;
    const struct place row = compute_table_index((r2_log2_q16 - 4 * 65536) * 2,
                                                 GLINT_STAR_HALO_ROWS - 1);
    const struct place column =
        compute_table_index(column_q16 * 4, GLINT_STAR_HALO_COLUMNS - 1);
    const uint32_t down = row.part_q15, right = column.part_q15;
    const uint32_t both = down * right >> 15;
    uint32_t weight_q15[4] = {32768 + both - down - right, right - both,
                              down - both, both};
    uint32_t sum_q26[3] = {0, 0, 0};

    if (h->next_q15 > 0) {
        uint32_t next_q15[4];

        for (int k = 0; k < 4; k++) {
            next_q15[k] = weight_q15[k] * (uint32_t)h->next_q15 >> 15;
            weight_q15[k] -= next_q15[k];
        }
        add_table_entries(h->next, row.at, column.at, next_q15, sum_q26);
    }
    add_table_entries(h->table, row.at, column.at, weight_q15, sum_q26);
    for (int c = 0; c < 3; c++)
        log2_q16[c] =
            32 * (int32_t)(sum_q26[c] >> 15) + h->log2_q16[c] - r2_log2_q16;
}

void glint_halo_c(const struct glint_halo *h, int n_x, int n_y,
                  int64_t *light_q20)
{
    for (int y = 0; y < n_y; y++) {
        const int64_t dy_q8 = h->dy_q8 + 256 * y;
        int32_t v_q8[SIDE];

        if (compute_line_distances(h, y, v_q8) > h->width_q8)
            continue;
        for (int x = 0; x < n_x; x++) {
            const int64_t dx_q8 = h->dx_q8 + 256 * x;
            int64_t *const to_q20 = light_q20 + y * GLINT_HALO_STRIDE + x;
            int32_t log2_q16[3];

            glint_halo_compute_log2(h,
                                    (uint64_t)(dx_q8 * dx_q8 + dy_q8 * dy_q8),
                                    v_q8[x], log2_q16);
            for (int c = 0; c < 3; c++)
                to_q20[c * GLINT_HALO_CHANNEL] +=
                    q_exp2_q16(q_smaller(log2_q16[c], 34 * 65536));
        }
    }
}

int glint_move_light_c(int64_t *light_q20, int n, uint16_t *light_q16)
{
    int any = 0;

    for (int i = 0; i < n; i++) {
        light_q16[i] = (uint16_t)q_clamp_sat(light_q20[i] >> 4, 0, 65535);
        any |= light_q16[i];
        light_q20[i] = 0;
    }
    return any;
}
