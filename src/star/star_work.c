/* SPDX-License-Identifier: MIT
 *
 * Predicts the work of a star: how many pixels its lines, halos, smears and
 * cores light. */
#include "base/divide.h"
#include "base/q.h"
#include "star/parts.h"

/* Returns how many pixels from A to B - 1 are within HALF of X. */
static int64_t common(int a, int b, int x, int half)
{
    const int from = q_larger(a, x - half), to = q_smaller(b, x + half);

    return to > from ? to - from : 0;
}

/* Returns how many pixels of the picture are at most HALF from LAMP along x and
 * along y. */
static int64_t square(const struct glint_star *star,
                      const struct glint_star_lamp *lamp, int half)
{
    return common(0, star->cfg.width, lamp->x_q8 >> 8, half) *
           common(0, star->cfg.height, lamp->y_q8 >> 8, half);
}

/* Returns how many pixels all lines of LAMP light. In a zone a line has twice
 * the zone's width as length, and its visible width; the fraction of it in the
 * picture is taken to be that of the zone's area. */
static int64_t lines(const struct glint_star *star,
                     const struct glint_star_lamp *lamp)
{
    int64_t sum = 0;

    for (int i = 0; i < lamp->n_zones; i++) {
        const int near = lamp->start[i], far = lamp->start[i + 1];
        const int64_t wide_q16 =
            2 * (int64_t)lamp->seen[i] * lamp->pixels_q16 + 65536;
        const int64_t area = square(star, lamp, far) - square(star, lamp, near);

        if (lamp->seen[i] > 0 && far > near)
            sum += q_divide((wide_q16 >> 8) * area, 2 * (far + near)) >> 8;
    }
    return sum * star->tables->n_lines;
}

int64_t glint_star_pixels(const struct glint_star *star)
{
    int64_t sum = 0;

    for (int i = 0; i < star->n_lamps; i++) {
        const struct glint_star_lamp *lamp = &star->lamp[i];

        sum += lines(star, lamp);
        /* A circle has 201 / 256 of the area of its square. */
        sum += square(star, lamp, lamp->halo_reach) * 201 >> 8;
        sum += square(star, lamp, lamp->smear_reach);
        if (lamp->is_bare)
            sum += square(star, lamp, glint_star_core_reach(star));
    }
    return sum;
}
