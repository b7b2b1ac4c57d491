/* SPDX-License-Identifier: MIT */
#include "lamps/row_light.h"

#include "base/arena.h"
#include "base/q.h"
#include "lamps/bright_code.h"

void glint_row_light_allocate(struct glint_row_light *row,
                              struct glint_arena *arena, int width)
{
    row->sum = glint_arena_allocate(arena, (size_t)width + 1, sizeof *row->sum);
    row->from =
        glint_arena_allocate(arena, (size_t)width + 1, sizeof *row->from);
}

void glint_row_light_begin_row(struct glint_row_light *row)
{
    row->end = -1;
}

/* Sets OF to the amounts that a pixel of linear light RGB adds to the sums.
 * Pixels with a channel of CLIPPED or more add nothing to the sums for the
 * rim. */
static WHOLLY_INLINE void compute_pixel_sums(int32_t of[ROW_LIGHT_SUMS],
                                             const int32_t rgb_q20[3],
                                             int32_t clipped_q20)
{
    const struct glint_region_light light = region_compute_pixel_light(rgb_q20);
    const int is_clipped = rgb_q20[0] >= clipped_q20 ||
                           rgb_q20[1] >= clipped_q20 ||
                           rgb_q20[2] >= clipped_q20;

    of[ROW_LIGHT_W] = (int32_t)light.w_q14;
    for (int i = 0; i < 3; i++) {
        of[ROW_LIGHT_RGB + i] = light.rgb_q14[i];
        of[ROW_LIGHT_RIM_RGB + i] = is_clipped ? 0 : light.rgb_q14[i];
    }
}

/* Sets *NEXT to the prefix sum *SUM plus OF, the amounts of the pixel in column
 * X. */
static WHOLLY_INLINE void
add_pixel_to_prefix_sum(struct glint_row_sum *restrict next,
                        const struct glint_row_sum *restrict sum,
                        const int32_t of[ROW_LIGHT_SUMS], int x)
{
    const int64_t wx_q14 = (int64_t)of[ROW_LIGHT_W] * x;

    for (int i = 0; i < ROW_LIGHT_SUMS; i++)
        next->of[i] = sum->of[i] + of[i];
    next->wx_q14 = sum->wx_q14 + wx_q14;
    next->wx2_q14 = sum->wx2_q14 + wx_q14 * x;
}

static int64_t sum_integers_below(int64_t n)
{
    return n * (n - 1) / 2;
}

/* Sets *AT to the prefix sum over the pixels left of X + N. The last N of these
 * pixels are equal. SUM[0] is the prefix sum over the pixels left of X, SUM[1]
 * the prefix sum over the pixels left of X + 1. */
static void extend_sum_by_equal_pixels(struct glint_row_sum *at,
                                       const struct glint_row_sum *restrict sum,
                                       int x, int n)
{
    const struct glint_row_sum *one = sum + 1;
    const int64_t w_q14 = one->of[ROW_LIGHT_W] - sum->of[ROW_LIGHT_W];

    for (int i = 0; i < ROW_LIGHT_SUMS; i++)
        at->of[i] = sum->of[i] + n * (one->of[i] - sum->of[i]);
    at->wx_q14 = sum->wx_q14 +
                 w_q14 * (sum_integers_below(x + n) - sum_integers_below(x));
    at->wx2_q14 = sum->wx2_q14 + w_q14 * (region_sum_squares_below(x + n) -
                                          region_sum_squares_below(x));
}

/* Sets CHROMA to the amounts that Cb and Cr add to R, G and B, in full-range
 * codes, plus half a unit for the rounding in decode_ycc_to_linear(). Cb and Cr
 * are bits 8 .. 23 of CODES. */
static WHOLLY_INLINE void compute_chroma_terms(const struct glint_ycc *ycc,
                                               int32_t codes,
                                               int32_t chroma_q16[3])
{
    const int32_t(*m_q16)[3] = ycc->to_rgb_q16;
    const int cb = (codes >> 8 & 255) - 128, cr = (codes >> 16) - 128;

    for (int i = 0; i < 3; i++)
        chroma_q16[i] = cb * m_q16[i][1] + cr * m_q16[i][2] + (1 << 8);
}

/* Sets RGB to the linear light of a pixel of luma Y; CHROMA has the terms of
 * compute_chroma_terms(). The result equals that of convert_ycc_to_rgb() and
 * curve_decode_to_light(), as the first column of the matrix has the same value
 * in all rows. */
static WHOLLY_INLINE void decode_ycc_to_linear(const struct glint_bright *b,
                                               int y,
                                               const int32_t chroma_q16[3],
                                               int32_t rgb_q20[3])
{
    const int32_t luma_q16 = (y - b->ycc.black) * b->ycc.to_rgb_q16[0][0];

    for (int i = 0; i < 3; i++) {
        const int32_t code_q7 = (luma_q16 + chroma_q16[i]) >> 9;
        const int32_t held_q7 =
            code_q7 < CODE_WHITE_Q7 ? code_q7 : CODE_WHITE_Q7;

        rgb_q20[i] = curve_decode_to_light(b->curve, held_q7 > 0 ? held_q7 : 0);
    }
}

/* The memory layout of a row. Codes of the first channel are STEP bytes apart.
 * Codes of the second and third channel are STEP_C bytes apart, and 1 << SHIFT
 * pixels share each of them. */
struct packing {
    enum glint_layout_kind kind;
    int step, step_c, shift;
};

static WHOLLY_INLINE int32_t read_pixel_codes(const struct glint_bright *b,
                                              struct packing p, int x)
{
    const ptrdiff_t at = (ptrdiff_t)x * p.step;
    const ptrdiff_t at_c = (ptrdiff_t)(x >> p.shift) * p.step_c;

    return b->code[0].first[at] | b->code[1].first[at_c] << 8 |
           b->code[2].first[at_c] << 16;
}

/* Computes the prefix sums after each of the pixels X0 .. X1 - 1. In a run of
 * equal pixels, only the sums after the first and after the last pixel are
 * stored. */
static WHOLLY_INLINE void compute_prefix_sums(struct glint_row_light *row,
                                              const struct glint_bright *b,
                                              int x0, int x1, struct packing p)
{
    const int32_t clipped_q20 = b->curve->decode_q20[BRIGHT_CLIPPED];
    struct glint_row_sum *sum = row->sum;
    int32_t of[ROW_LIGHT_SUMS] = {0}, rgb_q20[3], chroma_q16[3] = {0};
    int32_t here = x0 < x1 ? read_pixel_codes(b, p, x0) : 0, chroma = -1;

    for (int x = x0; x < x1;) {
        int next = x + 1;

        if (p.kind == GLINT_LAYOUT_YCC) {
            if (here >> 8 != chroma)
                compute_chroma_terms(&b->ycc, here, chroma_q16);
            chroma = here >> 8;
            decode_ycc_to_linear(b, here & 255, chroma_q16, rgb_q20);
        } else if (p.kind == GLINT_LAYOUT_RGB) {
            for (int i = 0; i < 3; i++)
                rgb_q20[i] = b->curve->decode_q20[here >> 8 * i & 255];
        } else {
            bright_read_pixel_light(b, x, rgb_q20);
        }
        compute_pixel_sums(of, rgb_q20, clipped_q20);
        add_pixel_to_prefix_sum(&sum[next], &sum[x], of, x);
        row->from[next] = (uint16_t)next;
        for (int32_t last = here; next < x1; next++) {
            here = read_pixel_codes(b, p, next);
            if (here != last)
                break;
            row->from[next] = (uint16_t)x;
        }
        if (next > x + 1) {
            extend_sum_by_equal_pixels(&sum[next], &sum[x], x, next - x);
            row->from[x + 1] = (uint16_t)(x + 1);
            row->from[next] = (uint16_t)next;
        }
        x = next;
    }
}

/* Calls compute_prefix_sums(). For the common formats the memory layout is a
 * constant, so that the compiler optimises for it. */
static void compute_prefix_sums_by_layout(struct glint_row_light *row,
                                          const struct glint_bright *b, int x0,
                                          int x1)
{
    const struct glint_bright_code *c = b->code;
    const struct packing p = {b->layout->kind, c[0].step, c[1].step,
                              c[1].shift};

    if (p.kind == GLINT_LAYOUT_RGB && p.step == 3)
        compute_prefix_sums(row, b, x0, x1,
                            (struct packing){GLINT_LAYOUT_RGB, 3, 3, 0});
    else if (p.kind == GLINT_LAYOUT_YCC && p.step == 2)
        compute_prefix_sums(row, b, x0, x1,
                            (struct packing){GLINT_LAYOUT_YCC, 2, 4, 1});
    else
        compute_prefix_sums(row, b, x0, x1, p);
}

void glint_row_light_sum_pixels(struct glint_row_light *row,
                                const struct glint_bright *bright, int x0,
                                int x1)
{
    if (x0 <= row->end) {
        x0 = row->end;
    } else {
        row->sum[x0] = (struct glint_row_sum){.wx_q14 = 0};
        row->from[x0] = (uint16_t)x0;
    }
    compute_prefix_sums_by_layout(row, bright, x0, x1);
    if (x1 > row->end)
        row->end = x1;
}

/* Returns the prefix sum over the pixels left of X: a stored one, or *ROOM, in
 * which it is computed. */
static const struct glint_row_sum *
get_prefix_sum(const struct glint_row_light *row, int x,
               struct glint_row_sum *room)
{
    const int from = row->from[x];

    if (from == x)
        return &row->sum[x];
    extend_sum_by_equal_pixels(room, &row->sum[from], from, x - from);
    return room;
}

void glint_row_light_add_run_to_region(const struct glint_row_light *row,
                                       struct glint_region *region, int x0,
                                       int x1, int width, int y)
{
    struct glint_row_sum room[4];
    const struct glint_row_sum *a = get_prefix_sum(row, x0, &room[0]);
    const struct glint_row_sum *b = get_prefix_sum(row, x1, &room[1]);
    const int rim0 = x0 > ROW_LIGHT_RIM ? x0 - ROW_LIGHT_RIM : 0;
    const int rim1 = x1 < width - ROW_LIGHT_RIM ? x1 + ROW_LIGHT_RIM : width;
    const struct glint_row_sum *c = get_prefix_sum(row, rim0, &room[2]);
    const struct glint_row_sum *d = get_prefix_sum(row, rim1, &room[3]);
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
