/* SPDX-License-Identifier: MIT */
#include "lamps/bright.h"

#include "base/arena.h"
#include "base/q.h"
#include "lamps/bright_code.h"

static size_t count_blocks(int width)
{
    return ((size_t)width + BRIGHT_BLOCK - 1) / BRIGHT_BLOCK;
}

void glint_bright_allocate(struct glint_bright *b, struct glint_arena *arena,
                           int width)
{
    b->curve = glint_arena_allocate(arena, 1, sizeof *b->curve);
    b->full_luma = glint_arena_allocate(arena, 256, 1);
    b->beyond = glint_arena_allocate(arena, 256, 1);
    b->value = glint_arena_allocate(arena, count_blocks(width), BRIGHT_BLOCK);
    b->block =
        glint_arena_allocate(arena, count_blocks(width), sizeof *b->block);
    b->marked =
        glint_arena_allocate(arena, count_blocks(width), sizeof *b->marked);
}

/* Sets the width of rows, marks the curve as not made, and clears the
 * brightness after pixel WIDTH - 1, as blocks are read in whole words. */
void glint_bright_init(struct glint_bright *b, int width)
{
    const int padded = (int)count_blocks(width) * BRIGHT_BLOCK;

    b->width = width;
    b->curve_tone = -1;
    for (int x = width; x < padded; x++)
        b->value[x] = 0;
}

/* Fills BEYOND, a table from the luma of a clipped pixel to the pixel's
 * brightness: 250 for luma below 192, then 1 more per 15 of luma, up to 255 for
 * luma of 252 or more. */
static void fill_clipped_brightness_table(uint8_t beyond[256])
{
    for (int luma = 0; luma < 256; luma++)
        beyond[luma] =
            (uint8_t)(BRIGHT_CLIPPED + (luma > 177 ? (luma - 177) / 15 : 0));
}

void glint_bright_begin_picture(struct glint_bright *b,
                                const struct glint_image *image)
{
    b->image = image;
    b->layout = glint_get_layout(image->format);
    b->n_codes = b->layout->kind == GLINT_LAYOUT_GREY  ? 1
                 : b->layout->kind == GLINT_LAYOUT_565 ? 2
                                                       : 3;
    if (b->curve_tone != (int)image->transfer)
        glint_curve_init(b->curve, image->transfer);
    b->curve_tone = (int)image->transfer;
    glint_ycc_init(&b->ycc, image->matrix, image->range);
    for (int code = 0; code < 256; code++)
        b->full_luma[code] = (uint8_t)q_clamp_sat(
            q_shift((int64_t)(code - b->ycc.black) * b->ycc.to_rgb_q16[0][0],
                    16),
            0, 255);
    fill_clipped_brightness_table(b->beyond);
}

/* Returns the min Y code whose full-range luma is at least LUMA; 256 if there
 * is none. */
static int find_min_luma_code(const struct glint_bright *b, int luma)
{
    int code = luma > 0 ? 1 : 0;

    while (code < 256 && b->full_luma[code] < luma)
        code++;
    return code;
}

void glint_bright_set_min_brightness(struct glint_bright *b, int low)
{
    const int channel = low < BRIGHT_CLIPPED ? low : BRIGHT_CLIPPED;

    b->low = low;
    b->low_code = bright_is_rgb(b) ? channel : find_min_luma_code(b, channel);
    b->low_sum_q16 = (channel - 1) * 65536;
}

/* -------------------------------------------------------------------- value */

void glint_bright_select_row(struct glint_bright *b, int y)
{
    const struct glint_layout *layout = b->layout;

    for (int i = 0; i < b->n_codes; i++)
        b->code[i] = (struct glint_bright_code){
            glint_layout_get_sample_address(layout, b->image, i, 0, y),
            layout->sample[i].step, i ? layout->log2_x : 0};
    for (int i = b->n_codes; i < 3; i++)
        b->code[i] = b->code[0];
    if (layout->kind == GLINT_LAYOUT_565)
        b->code[1].first = b->code[0].first + 1;
}

/* -------------------------------------------------------------------- light */

void glint_bright_read_pixel_light(const struct glint_bright *b, int x,
                                   int32_t rgb_q20[3])
{
    bright_read_pixel_light(b, x, rgb_q20);
}

int32_t glint_bright_compute_code_step_q20(const struct glint_bright *b, int c,
                                           int32_t light_q20)
{
    const int lost = b->layout->kind != GLINT_LAYOUT_565 ? 0 : c == 1 ? 2 : 3;
    const int step_q7 = 128 << lost;
    int code_q7 = 0;

    if (lost == 0)
        return 0;
    for (int bit = 1 << 14; bit > 0; bit >>= 1)
        if (code_q7 + bit <= CODE_WHITE_Q7 - step_q7 &&
            curve_decode_to_light(b->curve, code_q7 + bit) <= light_q20)
            code_q7 += bit;
    return curve_decode_to_light(b->curve, code_q7 + step_q7) -
           curve_decode_to_light(b->curve, code_q7);
}
