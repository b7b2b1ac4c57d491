/* SPDX-License-Identifier: MIT */
#include "image/cover.h"

#include "base/q.h"

enum { WIDTH = GLINT_CODES_WIDTH };

/* A run of pixels in one or two rows. */
struct stretch {
    const struct glint_layout *layout;
    int n_x, n_y, black;
    const struct glint_cover_rows *cover;
    struct glint_codes *codes;
    /* Sums of Cb and Cr over the pixels of each pair, interleaved. */
    int32_t sum_q7[WIDTH];
};

static void hide_background_of_rgb_pixels(const struct stretch *s,
                                          const struct glint_mix *mix)
{
    for (int row = 0; row < s->n_y; row++)
        for (int c = 0; c < 3; c++)
            glint_cover_code_c(s->codes->sample[c][row],
                               s->cover->cover_q8[row], s->n_x, &mix->tone);
}

/* Returns the row of interleaved Cb and Cr that belongs to pixel row ROW. */
static uint8_t *get_shared_chroma_row(const struct stretch *s, int row)
{
    return s->codes->chroma[s->layout->log2_y ? 0 : row];
}

/* Sets YCC to Y', Cb and Cr of every pixel of a row. */
static void expand_row_to_ycc(const struct stretch *s, int row,
                              int16_t *const ycc_q7[3])
{
    const uint8_t *restrict pairs = get_shared_chroma_row(s, row);

    for (int c = 0; c < (s->layout->log2_x ? 1 : 3); c++) {
        const uint8_t *restrict code = s->codes->sample[c][row];
        int16_t *restrict to_q7 = ycc_q7[c];

        for (int i = 0; i < s->n_x; i++)
            to_q7[i] = (int16_t)(128 * code[i]);
    }
    for (int c = 1; c < 3 && s->layout->log2_x; c++) {
        int16_t *restrict to_q7 = ycc_q7[c];

        for (int i = 0; i < (s->n_x + 1) >> 1; i++)
            to_q7[2 * i] = to_q7[2 * i + 1] =
                (int16_t)(128 * pairs[2 * i + c - 1]);
    }
}

static inline uint8_t round_mean_code(int32_t sum_q7, int log2)
{
    return (uint8_t)q_smaller(
        q_larger((sum_q7 + (1 << (6 + log2))) >> (7 + log2), 0), 255);
}

/* Adds the chroma of a row to the sums of its pixel pairs. In a row of odd
 * width, the last pixel counts twice. */
static void add_chroma_to_pair_sums(struct stretch *s, int16_t *const ycc_q7[3])
{
    const int end = s->n_x & ~1;

    for (int k = 0; k < 2; k++) {
        const int16_t *restrict at_q7 = ycc_q7[1 + k];
        int32_t *restrict sum_q7 = s->sum_q7 + k;

        for (int i = 0; i < end; i += 2)
            sum_q7[i] += at_q7[i] + at_q7[i + 1];
        if (end < s->n_x)
            sum_q7[end] += 2 * at_q7[end];
    }
}

/* Writes the chroma of each pixel pair: its mean over the two pixels, or over
 * four pixels if two rows share chroma. */
static void write_mean_chroma_of_pairs(struct stretch *s, int row)
{
    const int log2 = s->layout->log2_y && row ? 2 : 1;
    uint8_t *restrict pairs = get_shared_chroma_row(s, row);

    for (int i = 0; i < ((s->n_x + 1) & ~1); i++)
        pairs[i] = round_mean_code(s->sum_q7[i], log2);
}

static void write_ycc_row(const struct stretch *s, int row,
                          int16_t *const ycc_q7[3])
{
    for (int c = 0; c < (s->layout->log2_x ? 1 : 3); c++) {
        const int16_t *restrict from_q7 = ycc_q7[c];
        uint8_t *restrict code = s->codes->sample[c][row];

        for (int i = 0; i < s->n_x; i++)
            code[i] = round_mean_code(from_q7[i], 0);
    }
}

static void hide_background_of_ycc_pixels(struct stretch *s,
                                          const struct glint_mix *mix,
                                          struct glint_resolve_rows *rows)
{
    int16_t *const ycc_q7[3] = {rows->change[0], rows->change[1],
                                rows->change[2]};

    for (int row = 0; row < s->n_y; row++) {
        if (row == 0 || !s->layout->log2_y)
            for (int i = 0; i < WIDTH; i++)
                s->sum_q7[i] = 0;
        expand_row_to_ycc(s, row, ycc_q7);
        glint_cover_ycc_c(ycc_q7, s->cover->cover_q8[row], s->n_x, s->black,
                          mix);
        write_ycc_row(s, row, ycc_q7);
        if (!s->layout->log2_x)
            continue;
        add_chroma_to_pair_sums(s, ycc_q7);
        if (row == s->n_y - 1 || !s->layout->log2_y)
            write_mean_chroma_of_pairs(s, row);
    }
}

static int are_all_pixels_hidden(const struct stretch *s)
{
    unsigned shown = 0;

    for (int row = 0; row < s->n_y; row++)
        for (int i = 0; i < s->n_x; i++)
            shown |= s->cover->cover_q8[row][i] ^ GLINT_COVER_ALL;
    return !shown;
}

static void set_run_black(const struct stretch *s, int is_rgb)
{
    const uint8_t luma = (uint8_t)(is_rgb ? 0 : s->black);
    const uint8_t rest = is_rgb ? 0 : 128;

    for (int row = 0; row < s->n_y; row++)
        for (int i = 0; i < WIDTH; i++) {
            s->codes->sample[0][row][i] = luma;
            s->codes->sample[1][row][i] = s->codes->sample[2][row][i] = rest;
            s->codes->chroma[row][i] = rest;
        }
}

void glint_hide_background_of_run(const struct glint_resolve *resolve,
                                  const struct glint_image *image, int x, int y,
                                  int n_x, int n_y,
                                  const struct glint_cover_rows *cover,
                                  struct glint_light_rows *light,
                                  struct glint_resolve_rows *rows)
{
    struct stretch s = {.layout = glint_get_layout(image->format),
                        .n_x = n_x,
                        .n_y = n_y,
                        .black = image->range == GLINT_RANGE_LIMITED ? 16 : 0,
                        .cover = cover,
                        .codes = &rows->codes};
    const int is_rgb = s.layout->kind == GLINT_LAYOUT_RGB ||
                       s.layout->kind == GLINT_LAYOUT_565;

    if (are_all_pixels_hidden(&s)) {
        set_run_black(&s, is_rgb);
    } else {
        glint_codes_read_pixels(&rows->codes, image, x, y, n_x, n_y);
        if (is_rgb)
            hide_background_of_rgb_pixels(&s, &resolve->mix);
        else
            hide_background_of_ycc_pixels(&s, &resolve->mix, rows);
    }
    if (light)
        glint_resolve_add_to_codes(resolve, image, y, n_x, n_y, light, rows);
    glint_codes_write_pixels(&rows->codes, image, x, y, n_x, n_y);
}

void glint_hide_background_of_linear_run(const struct glint_image *image, int x,
                                         int y, int n, const uint16_t *cover_q8)
{
    int32_t *px_q20 =
        (int32_t *)(void *)(image->plane[0] + y * image->stride_bytes[0]) +
        3 * x;

    for (int i = 0; i < n; i++, px_q20 += 3)
        for (int c = 0; c < 3; c++)
            px_q20[c] = (int32_t)q_shift(
                px_q20[c] * (int64_t)(GLINT_COVER_ALL - cover_q8[i]), 8);
}
