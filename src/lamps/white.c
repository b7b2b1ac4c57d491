/* SPDX-License-Identifier: MIT */
#include "lamps/white.h"

#include "base/q.h"
#include "lamps/bright_code.h"

/* log2(1 + f) is approximated by f + f (1 - f) (0.4273 - 0.175 f), where f is
 * the fraction that follows the leading bit of the light. The error is below
 * 0.002. */
int32_t glint_compute_light_log2_q8(int64_t light_q20)
{
    const uint64_t v = light_q20 > 0 ? (uint64_t)light_q20 : 1;
    const int bits = bit_length(v) - 1;
    const int32_t f_q12 =
        (int32_t)((bits >= 12 ? v >> (bits - 12) : v << (12 - bits)) - 4096);
    const int32_t bent_q12 = q_mul(f_q12, 4096 - f_q12, 12);
    const int32_t by_q12 =
        Q_CONST(0.4273, 12) - q_mul(Q_CONST(0.175, 12), f_q12, 12);

    return (bits - 20) * 256 +
           (int32_t)q_shift(f_q12 + q_mul(bent_q12, by_q12, 12), 4);
}

/* Returns the min code, at most BRIGHT_CLIPPED, whose linear light is at least
 * 2^(STOPS / 256) times white. */
static int find_min_code_of_light(const struct glint_bright *b,
                                  int32_t stops_q8)
{
    int code = 1;

    while (code < BRIGHT_CLIPPED &&
           glint_compute_light_log2_q8(b->curve->decode_q20[code]) < stops_q8)
        code++;
    return code;
}

/* Iterates over the N columns or rows of a grid of samples over SIDE pixels.
 * Number i is at pixel (2 i + 1) SIDE / (2 N), rounded down. */
struct grid {
    int at, past, step, step_past, whole;
};

static struct grid begin_grid_iteration(int side, int n)
{
    return (struct grid){side / (2 * n), side % (2 * n), side / n,
                         2 * side % (2 * n), 2 * n};
}

static WHOLLY_INLINE void advance_grid(struct grid *g)
{
    g->at += g->step;
    g->past += g->step_past;
    if (g->past >= g->whole) {
        g->past -= g->whole;
        g->at++;
    }
}

static void count_grid_pixels_by_brightness(struct glint_white *w,
                                            struct glint_bright *b, int height)
{
    const int nx = b->width < WHITE_GRID_X ? b->width : WHITE_GRID_X;
    const int ny = height < WHITE_GRID_Y ? height : WHITE_GRID_Y;
    struct grid row = begin_grid_iteration(height, ny);

    for (int j = 0; j < ny; j++) {
        struct grid column = begin_grid_iteration(b->width, nx);

        glint_bright_select_row(b, row.at);
        for (int i = 0; i < nx; i++) {
            w->at_least[bright_compute_pixel_brightness(b, column.at)]++;
            advance_grid(&column);
        }
        advance_grid(&row);
    }
    w->n = nx * ny;
}

void glint_white_measure_picture(struct glint_white *white,
                                 struct glint_bright *bright, int height)
{
    int code;

    *white = (struct glint_white){0};
    count_grid_pixels_by_brightness(white, bright, height);
    for (int value = 255; value >= 0; value--)
        white->at_least[value] += white->at_least[value + 1];
    code = glint_white_find_top_quantile(white, WHITE_PART_LOG2);
    if (code >= BRIGHT_CLIPPED)
        white->light_q20 = LINEAR_WHITE_Q20;
    else
        white->light_q20 =
            bright->curve->decode_q20[code > WHITE_LEAST ? code : WHITE_LEAST];
}

int glint_white_find_code(const struct glint_bright *bright, int32_t light_q20,
                          int32_t ev_q8)
{
    return find_min_code_of_light(
        bright, glint_compute_light_log2_q8(light_q20) + ev_q8);
}

int glint_white_find_top_quantile(const struct glint_white *white,
                                  int part_log2)
{
    int value = 0;

    while (value < 256 && white->at_least[value] > white->n >> part_log2)
        value++;
    return value < 256 ? value : 255;
}

int32_t glint_white_compute_fraction_q15(const struct glint_white *white,
                                         int value)
{
    return (int32_t)(((int64_t)white->at_least[value] << 15) / white->n);
}
