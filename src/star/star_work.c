/* SPDX-License-Identifier: MIT
 *
 * Estimates the drawing cost of a starburst as the number of pixels that its
 * lines, halos, smears and cores light.
 */
#include "base/divide.h"
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

int64_t glint_star_estimate_pixels(const struct glint_star *star)
{
    int64_t sum = 0;

    for (int i = 0; i < star->n_lamps; i++) {
        const struct glint_star_lamp *lamp = &star->lamp[i];

        sum += count_pixels_lit_by_lines(star, lamp);
        /* a circle covers pi / 4, about 201 / 256, of its bounding square */
        sum += count_square_pixels(star, lamp, lamp->halo_reach) * 201 >> 8;
        sum += count_square_pixels(star, lamp, lamp->smear_reach);
        if (lamp->is_bare)
            sum += count_square_pixels(star, lamp,
                                       glint_star_compute_core_reach(star));
    }
    return sum;
}
