/* SPDX-License-Identifier: MIT */
#include "support/stars/any.h"

#include <string.h>

#include "base/log2.h"
#include "base/real.h"
#include "support/rng.h"

/* Cosine and sine, Q30, of 180 degrees / n, n = 1 .. STAR_ANY_LINES. */
/* clang-format off */
static const int32_t step_q30[STAR_ANY_LINES][2] = {
    {-1073741824, 0}, {0, 1073741824}, {536870912, 929887697},
    {759250125, 759250125}, {868675383, 631129609}, {929887697, 536870912},
    {967407956, 465879117}, {992008094, 410903207}, {1008987269, 367241333}};
/* clang-format on */

static int32_t clamp_line_weight_q30(int64_t x)
{
    const int64_t most = 1 << 28;

    return (int32_t)(x > most ? most : x < -most ? -most : x);
}

/* Sets LINE to the direction with cosine C and sine S. */
static void set_line_direction(struct glint_star_line *line, int32_t c_q30,
                               int32_t s_q30)
{
    const int64_t sine = s_q30 > 1 << 18 ? s_q30 : 1 << 18;

    line->cos_q30 = c_q30;
    line->sin_q30 = s_q30;
    line->cot_q16 = clamp_line_weight_q30(c_q30 * INT64_C(65536) / sine);
    line->across_q16 = clamp_line_weight_q30((INT64_C(1) << 46) / sine);
}

static void set_random_star_lines(struct star_any *to, uint32_t *seed)
{
    const int n = to->tables.n_lines;
    /* Cosine and sine of 2 atan(t / 2^15). */
    const int64_t one = INT64_C(1) << 30, t = rng_int_below(seed, 5000);
    int64_t c = ((one - t * t) << 30) / (one + t * t);
    int64_t s = (t << 46) / (one + t * t);

    for (int k = 0; k < n; k++) {
        struct glint_star_line *l = &to->line[k];
        const int64_t last = c;

        set_line_direction(l, (int32_t)c, (int32_t)s);
        for (int i = 0; i < GLINT_STAR_PROFILE; i++)
            for (int ch = 0; ch < 3; ch++) {
                const int steps =
                    rng_int_below(seed, 65536 / (1 + i * i / 16)) *
                    (GLINT_STAR_PROFILE - i) / GLINT_STAR_PROFILE;

                l->profile[i][ch] = (uint16_t)steps;
                if (steps > to->tables.line_max[i])
                    to->tables.line_max[i] = (uint16_t)steps;
            }
        c = (c * step_q30[n - 1][0] - s * step_q30[n - 1][1]) >> 30;
        s = (s * step_q30[n - 1][0] + last * step_q30[n - 1][1]) >> 30;
    }
}

static void set_random_star_halo(struct glint_star_tables *t, uint32_t *seed)
{
    for (int i = 0; i < GLINT_STAR_HALO_ROWS; i++)
        for (int k = 0; k < GLINT_STAR_HALO_COLUMNS; k++)
            for (int c = 0; c < 3; c++) {
                const int steps = 65000 - 300 * i - 900 * k;

                t->halo[i][k][c] = (uint16_t)(steps - rng_int_below(seed, 400));
                if (t->halo[i][k][c] > t->halo_max[i])
                    t->halo_max[i] = t->halo[i][k][c];
            }
}

static void set_random_star_core(struct glint_star_tables *t, uint32_t *seed)
{
    for (int i = 0; i <= GLINT_STAR_CORE; i++)
        for (int k = 0; k <= 2 * GLINT_STAR_CORE; k++)
            for (int c = 0; c < 3; c++) {
                const int x = k - GLINT_STAR_CORE;
                const int off = (i * i + x * x) / 100;

                t->core[i][k][c] = (uint16_t)((off < 26 ? 28 - off : 2) << 10 |
                                              rng_int_below(seed, 1024));
            }
}

void star_make_random(struct star_any *to, uint32_t *seed)
{
    struct glint_star_tables *t = &to->tables;
    const int reach_log2 = rng_int_below(seed, 6);

    memset(to, 0, sizeof *to);
    t->n_lines = 1 + rng_int_below(seed, STAR_ANY_LINES);
    t->line = to->line;
    t->step = real_of(1 + rng_int_below(seed, 1 << 20), -38);
    t->step.exponent -= rng_int_below(seed, 4);
    t->reach_q8 = 1024 << reach_log2;
    t->reach_log2_q16 = (10 + reach_log2) * 65536;
    t->per_pixel_q16 = (GLINT_STAR_PROFILE << 14) >> reach_log2;
    t->pixels_q16 = (1 << (18 + reach_log2)) / GLINT_STAR_PROFILE;
    t->core_per_pixel_q16 = 65536 << rng_int_below(seed, 3);
    t->width_q8 = 256 << reach_log2;
    t->inner_q8 = 512 + rng_int_below(seed, 2048);
    t->halo_log2_q16 = -(32 + rng_int_below(seed, 4)) * 65536;
    set_random_star_lines(to, seed);
    set_random_star_halo(t, seed);
    set_random_star_core(t, seed);
}

/* Returns a coordinate, Q8. Half of the time it is at a pixel corner or on
 * the border of the image, otherwise inside 0 .. SIDE or up to 1000 pixels
 * outside. */
static int32_t random_coordinate_q8(int side, uint32_t *seed)
{
    switch (rng_int_below(seed, 6)) {
    case 0:
        return 256 * rng_int_below(seed, side + 1);
    case 1:
        return rng_int_below(seed, 2) ? 0 : 256 * side;
    case 2:
        return -rng_int_below(seed, 256 * 1000);
    case 3:
        return 256 * side + rng_int_below(seed, 256 * 1000);
    default:
        return rng_int_below(seed, 256 * side);
    }
}

struct glint_star_light star_make_random_light(int width, int height,
                                               uint32_t *seed)
{
    struct glint_star_light l = {.radius_q8 = -1};

    l.x_q8 = random_coordinate_q8(width, seed);
    l.y_q8 = random_coordinate_q8(height, seed);
    if (rng_int_below(seed, 2))
        l.radius_q8 = rng_int_below(seed, 20000);
    l.power = real_of(1 + rng_int_below(seed, 1 << 24), -44);
    l.power.exponent += rng_int_below(seed, 51);
    for (int c = 0; c < 3; c++)
        l.rgb_q14[c] = rng_int_below(seed, 16385);
    return l;
}
