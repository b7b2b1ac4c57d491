/* SPDX-License-Identifier: MIT
 *
 * Estimates the drawing cost of a starburst as the number of pixels that its
 * lines, halos, smears and cores light.
 */
#include "base/divide.h"
#include "base/log2.h"
#include "base/q.h"
#include "star/parts.h"

/* Returns the number of pixels that the ranges A .. B - 1 and X - HALF .. X +
 * HALF - 1 have in common. */
static int64_t count_interval_overlap(int a, int b, int x, int half)
{
    const int from = q_larger(a, x - half), to = q_smaller(b, x + half);

    return to > from ? to - from : 0;
}

/* Returns the number of on-screen pixels in the square around LAMP whose sides
 * are 2 HALF pixels long. */
static int64_t count_square_pixels(const struct glint_star *star,
                                   const struct glint_star_lamp *lamp, int half)
{
    return count_interval_overlap(0, star->cfg.width, lamp->x_q8 >> 8, half) *
           count_interval_overlap(0, star->cfg.height, lamp->y_q8 >> 8, half);
}

/* Estimates the number of on-screen pixels that all lines of LAMP light. In
 * each distance zone a line has two pieces, each as long as the zone and as
 * wide as the line is visible. The on-screen fraction of the pieces is assumed
 * to equal that of the zone's area. */
static int64_t count_pixels_lit_by_lines(const struct glint_star *star,
                                         const struct glint_star_lamp *lamp)
{
    int64_t sum = 0;

    for (int i = 0; i < lamp->n_zones; i++) {
        const int near = lamp->start[i], far = lamp->start[i + 1];
        const int64_t wide_q16 =
            2 * (int64_t)lamp->seen[i] * lamp->pixels_q16 + 65536;
        const int64_t area = count_square_pixels(star, lamp, far) -
                             count_square_pixels(star, lamp, near);

        if (lamp->seen[i] > 0 && far > near)
            sum += q_divide((wide_q16 >> 8) * area, 2 * (far + near)) >> 8;
    }
    return sum * star->tables->n_lines;
}

/* Returns the fraction of a circle of R pixels around LAMP that is covered by
 * stripes along all lines, WIDTH to either side of each. */
static int32_t compute_stripe_fraction_q16(const struct glint_star *star,
                                           int32_t width_q8, int r)
{
    /* Each line passes the circle twice; 2 pi is about 402 / 64. */
    const int64_t stripes_q8 = 4 * (int64_t)star->tables->n_lines * width_q8;

    return q_clamp_sat(q_divide(stripes_q8 << 14, 402 * (int64_t)r), 0, 65536);
}

/* Estimates the number of pixels that the halo of LAMP lights, ring by ring; a
 * ring is a row of the halo tables. */
static int64_t count_pixels_lit_by_halo(const struct glint_star *star,
                                        const struct glint_star_lamp *lamp)
{
    int64_t sum = 0, inside = 0;
    int r = 0;

    for (int row = 0; row < GLINT_STAR_HALO_ROWS && r < lamp->halo_reach;
         row++) {
        /* the last row covers all larger distances */
        const int end =
            row == GLINT_STAR_HALO_ROWS - 1
                ? lamp->halo_reach
                : (int)(q_exp2_q16((2 << 16) + (row + 1) * 16384) >> 16);
        const int far = q_smaller(end, lamp->halo_reach);
        const int next = q_smaller(row + 1, GLINT_STAR_HALO_ROWS - 1);
        const int64_t fraction_q16 =
            (compute_stripe_fraction_q16(star, lamp->halo_width_q8[row], far) +
             compute_stripe_fraction_q16(star, lamp->halo_width_q8[next],
                                         far)) /
            2;
        const int64_t area = count_square_pixels(star, lamp, far);

        /* a circle covers pi / 4, about 201 / 256, of its bounding square */
        sum += ((area - inside) * 201 >> 8) * fraction_q16 >> 16;
        inside = area;
        r = far;
    }
    return sum;
}

int64_t glint_star_estimate_pixels(const struct glint_star *star)
{
    int64_t sum = 0;

    for (int i = 0; i < star->n_lamps; i++) {
        const struct glint_star_lamp *lamp = &star->lamp[i];

        sum += count_pixels_lit_by_lines(star, lamp);
        sum += count_pixels_lit_by_halo(star, lamp);
        sum += count_square_pixels(star, lamp, lamp->smear_reach);
        if (lamp->is_bare)
            sum += count_square_pixels(star, lamp,
                                       glint_star_compute_core_reach(star));
    }
    return sum;
}
