/* SPDX-License-Identifier: MIT */
#include "image/quads.h"

enum {
    STEP = 2 * GLINT_LANES
}; /* step of the kernels: number of pixels that they process at a time */

/* A run of pixels of two rows of a picture, or of its last row alone. */
struct stretch {
    const struct glint_image *image;
    const struct glint_layout *layout;
    int x, y, n_x, n_y;
    const uint16_t *const *light_q16;
};

static int round_up_to_kernel_step(int n)
{
    return (n + STEP - 1) & -STEP;
}

/* ---------------------------------------------------------- pixel by pixel */

static void expand_quad_light_to_pixels(const uint16_t *restrict from, int n,
                                        uint16_t *restrict to)
{
    for (int i = 0; i < n; i++)
        to[2 * i] = to[2 * i + 1] = from[i];
}

static void add_light_per_pixel(const struct glint_resolve *r,
                                const struct stretch *s,
                                struct glint_quads_rows *rows)
{
    for (int c = 0; c < 3; c++)
        for (int row = 0; row < s->n_y; row++)
            expand_quad_light_to_pixels(s->light_q16[c],
                                        round_up_to_kernel_step(s->n_x) / 2,
                                        rows->light.rgb_q16[c][row]);
    glint_resolve_add_to_run(r, s->image, s->x, s->y, s->n_x, s->n_y,
                             &rows->light, &rows->rows);
}

/* ------------------------------------------------------------ shared chroma */

static void add_light_to_chroma_pairs(const struct glint_resolve *r,
                                      const struct stretch *s,
                                      struct glint_codes *codes)
{
    const int last = s->n_y - 1, c_last = s->layout->log2_y ? 0 : last;
    const int cy = s->y >> s->layout->log2_y;
    uint8_t *const luma[2] = {codes->sample[0][0], codes->sample[0][last]};
    uint8_t *const chroma[2] = {codes->chroma[0], codes->chroma[c_last]};
    const int16_t *const round[2] = {r->round_q7[s->y & 7],
                                     r->round_q7[(s->y + last) & 7]};
    const int16_t *const round_chroma[2] = {r->round_q7[cy & 7],
                                            r->round_q7[(cy + c_last) & 7]};

    glint_codes_read_pixels(codes, s->image, s->x, s->y, s->n_x, s->n_y);
    glint_choose_quad_kernels(r->sets)->add(luma, chroma, s->light_q16,
                                            round_up_to_kernel_step(s->n_x),
                                            &r->mix, round, round_chroma);
    glint_codes_write_pixels(codes, s->image, s->x, s->y, s->n_x, s->n_y);
}

/* Adds light in place to packed pictures like YUYV. The pixels of an incomplete
 * last step are copied, changed and copied back. */
static void add_light_to_packed_pixels(const struct glint_resolve *r,
                                       const struct stretch *s,
                                       struct glint_codes *codes)
{
    const struct glint_quad_kernels *kernels =
        glint_choose_quad_kernels(r->sets);
    const int luma_at = s->layout->sample[0].offset, last = s->n_y - 1;
    const int whole = s->n_x & -STEP, n_rest = 2 * (s->n_x - whole);
    const uint16_t *const light_rest[3] = {s->light_q16[0] + whole / 2,
                                           s->light_q16[1] + whole / 2,
                                           s->light_q16[2] + whole / 2};
    const int16_t *const round[2] = {r->round_q7[s->y & 7],
                                     r->round_q7[(s->y + last) & 7]};
    uint8_t *const rest[2] = {codes->sample[0][0], codes->sample[0][last]};
    uint8_t *px[2];

    for (int row = 0; row < 2; row++)
        px[row] = s->image->plane[0] +
                  (s->y + (row ? last : 0)) * s->image->stride_bytes[0] +
                  2 * (ptrdiff_t)s->x;
    kernels->add_packed(px, s->light_q16, whole, luma_at, &r->mix, round);
    if (n_rest == 0)
        return;
    for (int row = 0; row <= last; row++)
        for (int i = 0; i < 2 * STEP; i++)
            rest[row][i] = i < n_rest ? px[row][2 * whole + i] : 0;
    kernels->add_packed(rest, light_rest, STEP, luma_at, &r->mix, round);
    for (int row = 0; row <= last; row++)
        for (int i = 0; i < n_rest; i++)
            px[row][2 * whole + i] = rest[row][i];
}

void glint_resolve_add_to_quads(const struct glint_resolve *resolve,
                                const struct glint_image *image, int x, int y,
                                int n_x, int n_y,
                                const uint16_t *const light_q16[3],
                                struct glint_quads_rows *rows)
{
    const struct stretch s = {
        image, glint_get_layout(image->format), x, y, n_x, n_y, light_q16};

    if (glint_layout_is_packed(s.layout) && n_x % 2 == 0)
        add_light_to_packed_pixels(resolve, &s, &rows->rows.codes);
    else if (s.layout->log2_x)
        add_light_to_chroma_pairs(resolve, &s, &rows->rows.codes);
    else
        add_light_per_pixel(resolve, &s, rows);
}

const struct glint_half glint_half = {glint_resolve_add_to_quads};
