/* SPDX-License-Identifier: MIT */
#include "flare/row_light.h"

#include "base/arena.h"
#include "base/q.h"
#include "flare/bright_code.h"

void glint_row_light_carve(struct glint_row_light *row,
                           struct glint_arena *arena, int width)
{
    row->sum = glint_arena_take(arena, (size_t)width + 1, sizeof *row->sum);
}

void glint_row_light_begin(struct glint_row_light *row)
{
    row->end = -1;
}

/* What a pixel adds. A colour is known only where no channel is clipped. */
struct pixel {
    int32_t w_q14, rgb_q14[3], rim_rgb_q14[3];
};

static WHOLLY_INLINE struct pixel pixel_of(const struct glint_bright *b, int x)
{
    const int32_t clipped_q20 = b->curve->decode_q20[BRIGHT_CLIPPED];
    struct glint_region_light light;
    struct pixel p;
    int32_t rgb_q20[3];
    int is_clipped;

    bright_read(b, x, rgb_q20);
    light = glint_region_light_of(rgb_q20);
    is_clipped = rgb_q20[0] >= clipped_q20 || rgb_q20[1] >= clipped_q20 ||
                 rgb_q20[2] >= clipped_q20;
    p.w_q14 = (int32_t)light.w_q14;
    for (int i = 0; i < 3; i++) {
        p.rgb_q14[i] = light.rgb_q14[i];
        p.rim_rgb_q14[i] = is_clipped ? 0 : light.rgb_q14[i];
    }
    return p;
}

/* Adds P, of column X, to what is left of it. */
static WHOLLY_INLINE void add_pixel(struct glint_row_sum *sum,
                                    const struct pixel *p, int x)
{
    const int64_t wx_q14 = (int64_t)p->w_q14 * x;

    sum->w_q14 += p->w_q14;
    sum->wx_q14 += wx_q14;
    sum->wx2_q14 += wx_q14 * x;
    for (int i = 0; i < 3; i++) {
        sum->rgb_q14[i] += p->rgb_q14[i];
        sum->rim_rgb_q14[i] += p->rim_rgb_q14[i];
    }
}

/* All codes of pixel X. */
static WHOLLY_INLINE int32_t codes_of(const struct glint_bright *b, int x)
{
    return code_at(b, 0, x) | code_at(b, 1, x) << 8 | code_at(b, 2, x) << 16;
}

void glint_row_light_extend(struct glint_row_light *row,
                            const struct glint_bright *bright, int x0, int x1)
{
    struct glint_row_sum sum = {0};
    struct pixel p = {0};
    int32_t codes = -1;

    if (x0 <= row->end) {
        x0 = row->end;
        sum = row->sum[x0];
    }
    row->sum[x0] = sum;
    for (int x = x0; x < x1; x++) {
        const int32_t here = codes_of(bright, x);

        if (here != codes)
            p = pixel_of(bright, x);
        codes = here;
        add_pixel(&sum, &p, x);
        row->sum[x + 1] = sum;
    }
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
    const int64_t w_q14 = b->w_q14 - a->w_q14;

    region->w_q14 += w_q14;
    region->wx_q14 += b->wx_q14 - a->wx_q14;
    region->wy_q14 += w_q14 * y;
    region->wr2_q14 += (uint64_t)(b->wx2_q14 - a->wx2_q14) +
                       (uint64_t)w_q14 * (uint64_t)((int64_t)y * y);
    for (int i = 0; i < 3; i++) {
        region->rgb_q14[i] += b->rgb_q14[i] - a->rgb_q14[i];
        region->rim_rgb_q14[i] += d->rim_rgb_q14[i] - c->rim_rgb_q14[i];
    }
}
