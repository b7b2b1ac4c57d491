/* SPDX-License-Identifier: MIT */
#include "lamps/row_light.h"

#include "base/arena.h"
#include "base/q.h"
#include "lamps/bright_code.h"

void glint_row_light_carve(struct glint_row_light *row,
                           struct glint_arena *arena, int width)
{
    row->sum = glint_arena_take(arena, (size_t)width + 1, sizeof *row->sum);
}

void glint_row_light_begin(struct glint_row_light *row)
{
    row->end = -1;
}

/* What a pixel of linear light RGB adds. A colour is known only where no
 * channel is clipped. */
static WHOLLY_INLINE void set_sums(int32_t of[ROW_LIGHT_SUMS],
                                   const int32_t rgb_q20[3],
                                   int32_t clipped_q20)
{
    const struct glint_region_light light = region_light_of(rgb_q20);
    const int is_clipped = rgb_q20[0] >= clipped_q20 ||
                           rgb_q20[1] >= clipped_q20 ||
                           rgb_q20[2] >= clipped_q20;

    of[ROW_LIGHT_W] = (int32_t)light.w_q14;
    for (int i = 0; i < 3; i++) {
        of[ROW_LIGHT_RGB + i] = light.rgb_q14[i];
        of[ROW_LIGHT_RIM_RGB + i] = is_clipped ? 0 : light.rgb_q14[i];
    }
}

/* SUM and a pixel of column X, in *NEXT. */
static WHOLLY_INLINE void add_pixel(struct glint_row_sum *restrict next,
                                    const struct glint_row_sum *restrict sum,
                                    const int32_t of[ROW_LIGHT_SUMS], int x)
{
    const int64_t wx_q14 = (int64_t)of[ROW_LIGHT_W] * x;

    for (int i = 0; i < ROW_LIGHT_SUMS; i++)
        next->of[i] = sum->of[i] + of[i];
    next->wx_q14 = sum->wx_q14 + wx_q14;
    next->wx2_q14 = sum->wx2_q14 + wx_q14 * x;
}

/* Linear light of CODES of pixel X, which are Y, Cb, Cr if IS_YCC. */
static WHOLLY_INLINE void decode(const struct glint_bright *b, int x,
                                 int32_t codes, int is_ycc, int32_t rgb_q20[3])
{
    int32_t rgb_q7[3];

    if (!is_ycc) {
        bright_read(b, x, rgb_q20);
        return;
    }
    ycc_to_rgb(&b->ycc, codes & 255, codes >> 8 & 255, codes >> 16, rgb_q7);
    for (int i = 0; i < 3; i++) {
        const int32_t held_q7 =
            rgb_q7[i] < CODE_WHITE_Q7 ? rgb_q7[i] : CODE_WHITE_Q7;

        rgb_q20[i] = curve_decode(b->curve, held_q7 > 0 ? held_q7 : 0);
    }
}

/* Sums pixels X0 .. X1 - 1, whose codes lie STEP and STEP_C bytes apart; those
 * of the second and the third are each of 1 << SHIFT pixels. */
static WHOLLY_INLINE void sum_pixels(struct glint_row_sum *sum,
                                     const struct glint_bright *b, int x0,
                                     int x1, int is_ycc, int step, int step_c,
                                     int shift)
{
    const int32_t clipped_q20 = b->curve->decode_q20[BRIGHT_CLIPPED];
    const uint8_t *c0 = b->code[0].first, *c1 = b->code[1].first;
    const uint8_t *c2 = b->code[2].first;
    int32_t of[ROW_LIGHT_SUMS] = {0}, codes = -1, rgb_q20[3];

    for (int x = x0; x < x1; x++) {
        const ptrdiff_t at_c = (ptrdiff_t)(x >> shift) * step_c;
        const int32_t here =
            c0[(ptrdiff_t)x * step] | c1[at_c] << 8 | c2[at_c] << 16;

        if (here != codes) {
            decode(b, x, here, is_ycc, rgb_q20);
            set_sums(of, rgb_q20, clipped_q20);
        }
        codes = here;
        add_pixel(&sum[x + 1], &sum[x], of, x);
    }
}

/* The same with constant steps where they are the usual ones. */
static void sum_stretch(struct glint_row_sum *sum, const struct glint_bright *b,
                        int x0, int x1)
{
    const struct glint_bright_code *c = b->code;
    const int is_ycc = b->layout->kind == GLINT_LAYOUT_YCC;

    if (c[0].step == 3)
        sum_pixels(sum, b, x0, x1, 0, 3, 3, 0);
    else if (is_ycc && c[0].step == 2)
        sum_pixels(sum, b, x0, x1, 1, 2, 4, 1);
    else if (is_ycc)
        sum_pixels(sum, b, x0, x1, 1, c[0].step, c[1].step, c[1].shift);
    else
        sum_pixels(sum, b, x0, x1, 0, c[0].step, c[1].step, c[1].shift);
}

void glint_row_light_extend(struct glint_row_light *row,
                            const struct glint_bright *bright, int x0, int x1)
{
    if (x0 <= row->end)
        x0 = row->end;
    else
        row->sum[x0] = (struct glint_row_sum){.wx_q14 = 0};
    sum_stretch(row->sum, bright, x0, x1);
    if (x1 > row->end)
        row->end = x1;
}

void glint_row_light_add(const struct glint_row_light *row,
                         struct glint_region *region, int x0, int x1, int width,
                         int y)
{
    const struct glint_row_sum *a = &row->sum[x0], *b = &row->sum[x1];
    const int rim0 = x0 > ROW_LIGHT_RIM ? x0 - ROW_LIGHT_RIM : 0;
    const int rim1 = x1 < width - ROW_LIGHT_RIM ? x1 + ROW_LIGHT_RIM : width;
    const struct glint_row_sum *c = &row->sum[rim0], *d = &row->sum[rim1];
    const int64_t w_q14 = b->of[ROW_LIGHT_W] - a->of[ROW_LIGHT_W];

    region->w_q14 += w_q14;
    region->wx_q14 += b->wx_q14 - a->wx_q14;
    region->wy_q14 += w_q14 * y;
    region->wr2_q14 += (uint64_t)(b->wx2_q14 - a->wx2_q14) +
                       (uint64_t)w_q14 * (uint64_t)((int64_t)y * y);
    for (int i = 0; i < 3; i++) {
        const int rgb = ROW_LIGHT_RGB + i, rim = ROW_LIGHT_RIM_RGB + i;

        region->rgb_q14[i] += b->of[rgb] - a->of[rgb];
        region->rim_rgb_q14[i] += d->of[rim] - c->of[rim];
    }
}
