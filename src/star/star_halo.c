/* SPDX-License-Identifier: MIT
 *
 * Draws the halo of a starburst, the smooth component of the far field. A table
 * holds log2 of the light; its rows are distances from the lamp, its columns
 * distances from the nearest line. */
#include "base/log2.h"
#include "star/parts.h"

enum {
    SIDE = GLINT_HALO_SIDE,
    HALF_Q8 = (SIDE - 1) * 128 /* from the middle of a square to that of its
                                  outermost pixels */
};

/* Squared distances from the lamp to the nearest and the farthest pixel of a
 * square. */
struct range {
    uint64_t near_q16, far_q16;
};

/* Returns the range for the square whose middle is at (DX, DY) from the lamp.
 */
static struct range compute_r2_range(int64_t dx_q8, int64_t dy_q8)
{
    const int64_t x_q8 = (int64_t)q_magnitude(dx_q8);
    const int64_t y_q8 = (int64_t)q_magnitude(dy_q8);
    const int64_t x0_q8 = x_q8 > HALF_Q8 ? x_q8 - HALF_Q8 : 0;
    const int64_t y0_q8 = y_q8 > HALF_Q8 ? y_q8 - HALF_Q8 : 0;
    const int64_t x1_q8 = x_q8 + HALF_Q8, y1_q8 = y_q8 + HALF_Q8;

    return (struct range){(uint64_t)(x0_q8 * x0_q8 + y0_q8 * y0_q8),
                          (uint64_t)(x1_q8 * x1_q8 + y1_q8 * y1_q8)};
}

/* Returns the distance from the nearest line up to which the halo of LAMP may
 * be visible where the squared distance from the lamp is R2 or more. */
static int32_t find_visible_width(const struct glint_star_lamp *lamp,
                                  uint64_t r2_q16)
{
    const uint64_t held_q16 =
        r2_q16 > lamp->inner_q16 ? r2_q16 : lamp->inner_q16;
    const int32_t row_q16 = (q_log2_q16(held_q16) - 20 * 65536) * 2;

    return lamp->halo_width_q8[q_clamp_sat(row_q16 >> 16, 0,
                                           GLINT_STAR_HALO_ROWS - 2)];
}

/* Returns whether the halo is visible at the squared distance R2 from the lamp,
 * and V from the nearest line. */
static int is_point_visible(const struct glint_star *star,
                            const struct glint_halo *h, uint64_t r2_q16,
                            int32_t v_q8)
{
    int32_t log2_q16[3];
    int is_visible = 0;

    glint_halo_compute_log2(h, r2_q16, v_q8, log2_q16);
    for (int c = 0; c < 3; c++)
        is_visible |= log2_q16[c] > star->faintest_log2_q16;
    return is_visible;
}

/* Sets V of H to the distances of the lines of T from the point (DX, DY) from
 * the lamp. Returns the smallest distance. */
static int64_t compute_line_distances(struct glint_halo *h,
                                      const struct glint_star_tables *t,
                                      int64_t dx_q8, int64_t dy_q8)
{
    int64_t least_q38 = INT64_MAX;

    for (int k = 0; k < t->n_lines; k++) {
        const int64_t v_q38 =
            dy_q8 * t->line[k].cos_q30 - dx_q8 * t->line[k].sin_q30;
        const int64_t size_q38 = v_q38 < 0 ? -v_q38 : v_q38;

        h->v_q38[k] = v_q38;
        least_q38 = size_q38 < least_q38 ? size_q38 : least_q38;
    }
    return least_q38;
}

/* Sets the lines of H to those of T whose distances V from the middle of the
 * square are at most MOST. */
static void choose_square_lines(struct glint_halo *h,
                                const struct glint_star_tables *t,
                                int64_t most_q38)
{
    h->n_lines = 0;
    for (int k = 0; k < t->n_lines; k++) {
        const int64_t v_q38 = h->v_q38[k];
        const int32_t cos_q30 = t->line[k].cos_q30,
                      sin_q30 = t->line[k].sin_q30;

        if ((v_q38 < 0 ? -v_q38 : v_q38) > most_q38)
            continue;
        h->v_q38[h->n_lines] = v_q38 - HALF_Q8 * ((int64_t)cos_q30 - sin_q30);
        h->cos_q30[h->n_lines] = cos_q30;
        h->sin_q30[h->n_lines++] = sin_q30;
    }
}

/* Prepares H for the square whose first pixel is at its dx and dy. Returns 0 if
 * the halo is invisible there. */
static int set_halo_square(struct glint_halo *h, const struct glint_star *star,
                           const struct glint_star_lamp *lamp)
{
    const int64_t dx_q8 = h->dx_q8 + HALF_Q8, dy_q8 = h->dy_q8 + HALF_Q8;
    /* at least from the middle to a corner pixel */
    const int64_t half_q38 = INT64_C(3) * HALF_Q8 / 2 << 30;
    const struct range r2 = compute_r2_range(dx_q8, dy_q8);
    const int64_t v_q38 = compute_line_distances(h, star->tables, dx_q8, dy_q8);
    const int32_t v_q8 =
        v_q38 > half_q38 ? (int32_t)((v_q38 - half_q38) >> 30) : 0;

    h->width_q8 = find_visible_width(lamp, r2.near_q16);
    if (v_q8 > h->width_q8)
        return 0;
    /* Beyond the reach of lines, light falls with v. It may rise with r where v
     * is the width of a fan. */
    if (v_q8 >= h->reach_q8 && !is_point_visible(star, h, r2.near_q16, v_q8) &&
        !is_point_visible(star, h, r2.far_q16, v_q8))
        return 0;
    choose_square_lines(h, star->tables, v_q38 + 2 * half_q38);
    return 1;
}

static void init_lamp_halo(struct glint_halo *h,
                           const struct glint_star_tables *t,
                           const struct glint_star_lamp *lamp)
{
    h->inner_q16 = lamp->inner_q16;
    h->reach_q8 = t->reach_q8;
    h->reach_log2_q16 = t->reach_log2_q16;
    h->table = lamp->halo;
    h->next = lamp->next_halo;
    h->next_q15 = lamp->halo_part_q15;
    for (int c = 0; c < 3; c++)
        h->log2_q16[c] = t->halo_log2_q16 + lamp->halo_log2_q16[c] + 4 * 65536;
}

void glint_star_add_halo_band(const struct glint_star *star,
                              const struct glint_star_lamp *lamp,
                              struct glint_star_band *band)
{
    const int64_t far = lamp->halo_reach;
    const int lamp_x = lamp->x_q8 >> 8, lamp_y = lamp->y_q8 >> 8;
    const int64_t near = q_clamp_sat(lamp_y, band->y, band->y + SIDE) - lamp_y;
    const int64_t left2 = far * far - near * near;
    const int n_y = q_smaller(SIDE, band->y1 - band->y);
    struct glint_halo *const h = &band->halo;
    int half, x0, x1;

    if (left2 <= 0)
        return;
    half = (int)q_root((uint64_t)left2) + 1;
    x0 = q_larger(band->x0, (lamp_x - half) & -SIDE);
    x1 = q_smaller(band->x1, lamp_x + half + 1);
    if (x0 >= x1)
        return;
    band->lo = q_smaller(band->lo, x0);
    band->hi = q_larger(band->hi, q_smaller(band->x1, (x1 + SIDE - 1) & -SIDE));
    init_lamp_halo(h, star->tables, lamp);
    h->dy_q8 = band->y * 256 + 128 - lamp->y_q8;
    for (int x = x0; x < x1; x += SIDE) {
        const int n_x = q_smaller(SIDE, band->x1 - x);

        h->dx_q8 = x * 256 + 128 - lamp->x_q8;
        if (set_halo_square(h, star, lamp))
            (n_x == SIDE ? star->kernels->add_halo : glint_halo_c)(
                h, n_x, n_y, &band->light_q20[0][0][x - band->x0]);
    }
}
