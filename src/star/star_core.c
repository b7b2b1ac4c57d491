/* SPDX-License-Identifier: MIT
 *
 * Draws the core of a starburst: the exact diffraction pattern near a light,
 * minus lines and halo. The core table is a lattice whose steps are smaller
 * than pixels. Light is interpolated between its nodes, so that the sum over
 * all pixels stays the same when the lamp moves. */
#include "base/q.h"
#include "star/parts.h"

/* Decodes channel C of node (I, J) of the core table; the lamp is at node (0,
 * 0). */
static int64_t decode_core_node_q40(const struct glint_star_tables *t, int i,
                                    int j, int c)
{
    const int turn = j < 0 ? -1 : 1;
    const uint16_t code = t->core[j * turn][i * turn + GLINT_STAR_CORE][c];
    const int e = code >> 10 & 31, m = code & 1023;
    const int64_t size = e ? (int64_t)(m + 1024) << (e - 1) : m;

    return code >> 15 ? -size : size;
}

/* Returns X 2^-SHIFT, |X| below 2^57, clamped to +-2^50. */
static int64_t shift_right_clamped(int64_t x, int shift)
{
    const uint64_t size = q_magnitude(x);

    if (shift >= 0)
        return shift < 63 ? x >> shift : 0;
    if (bit_length(size) - shift > 50)
        return x < 0 ? -(INT64_C(1) << 50) : x ? INT64_C(1) << 50 : 0;
    return x * (INT64_C(1) << -shift);
}

static void add_core_light_to_pixel(const struct glint_star *star,
                                    const struct glint_star_lamp *lamp,
                                    int64_t i_q8, int64_t j_q8,
                                    int64_t *const light_q20[3])
{
    const struct glint_star_tables *t = star->tables;
    const int i = (int)(i_q8 >> 8), j = (int)(j_q8 >> 8);
    const int64_t a_q8 = i_q8 & 255, b_q8 = j_q8 & 255;

    for (int c = 0; c < 3; c++) {
        const int64_t above = decode_core_node_q40(t, i, j, c) * (256 - a_q8) +
                              decode_core_node_q40(t, i + 1, j, c) * a_q8;
        const int64_t below =
            decode_core_node_q40(t, i, j + 1, c) * (256 - a_q8) +
            decode_core_node_q40(t, i + 1, j + 1, c) * a_q8;
        const int64_t light_q40 =
            ((above >> 8) * (256 - b_q8) + (below >> 8) * b_q8) >> 8;

        *light_q20[c] += shift_right_clamped(light_q40 * lamp->core[c],
                                             20 - lamp->core_exponent);
    }
}

void glint_star_add_core_row(const struct glint_star *star,
                             const struct glint_star_lamp *lamp,
                             struct glint_star_stretch *row)
{
    const int64_t steps_q16 = star->tables->core_per_pixel_q16;
    const int64_t end_q8 = (GLINT_STAR_CORE - 1) << 8;
    const int64_t j_q8 =
        ((int64_t)row->y * 256 + 128 - lamp->y_q8) * steps_q16 >> 16;

    if (!lamp->is_bare || j_q8 < -end_q8 || j_q8 > end_q8)
        return;
    for (int x = row->x0; x < row->x1; x++) {
        const int64_t i_q8 =
            ((int64_t)x * 256 + 128 - lamp->x_q8) * steps_q16 >> 16;
        const int at = x - row->x0;
        int64_t *const light_q20[3] = {&row->light_q20[0][at],
                                       &row->light_q20[1][at],
                                       &row->light_q20[2][at]};

        if (i_q8 < -end_q8 || i_q8 > end_q8)
            continue;
        glint_star_mark_lit_columns(row, x, x + 1);
        add_core_light_to_pixel(star, lamp, i_q8, j_q8, light_q20);
    }
}
