/* SPDX-License-Identifier: MIT
 *
 * Draws pictures on a panel (panel/panel.h). The loops read bytes, sum products
 * of 16 bits in 32 bits, and write bytes, so that compilers can vectorise them.
 */
#include "panel/panel.h"

#include <stdlib.h>
#include <string.h>

#include "posix/error.h"

void glint_split_byte_pairs(uint8_t *restrict a, uint8_t *restrict b,
                            const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        a[i] = from[2 * i];
        b[i] = from[2 * i + 1];
    }
}

/* Splits N pairs of pixels of four bytes into rows of luma, Cb and Cr. The
 * first luma is byte LUMA_AT, 0 or 1. */
static inline void split_packed_pairs(uint8_t *restrict luma,
                                      uint8_t *restrict cb,
                                      uint8_t *restrict cr,
                                      const uint8_t *restrict from, int n,
                                      int luma_at)
{
    for (int i = 0; i < n; i++) {
        luma[2 * i] = from[4 * i + luma_at];
        luma[2 * i + 1] = from[4 * i + 2 + luma_at];
        cb[i] = from[4 * i + 1 - luma_at];
        cr[i] = from[4 * i + 3 - luma_at];
    }
}

void glint_split_packed_pixels(enum glint_pixel_format format, uint8_t *luma,
                               uint8_t *cb, uint8_t *cr, const uint8_t *from,
                               int n)
{
    if (format == GLINT_YUYV)
        split_packed_pairs(luma, cb, cr, from, n, 0);
    else
        split_packed_pairs(luma, cb, cr, from, n, 1);
}

/* Splits N groups of BYTES bytes: the first three bytes of each group are
 * copied to A, B and C. */
static inline void split_pixel_groups(uint8_t *restrict a, uint8_t *restrict b,
                                      uint8_t *restrict c,
                                      const uint8_t *restrict from, int n,
                                      int bytes)
{
    for (int i = 0; i < n; i++) {
        a[i] = from[bytes * i];
        b[i] = from[bytes * i + 1];
        c[i] = from[bytes * i + 2];
    }
}

static void split_565_pixels(uint8_t *restrict r, uint8_t *restrict g,
                             uint8_t *restrict b, const uint8_t *restrict from,
                             int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t low = from[2 * i], high = from[2 * i + 1];
        const uint8_t green = (uint8_t)((high & 7) << 3 | low >> 5);

        r[i] = (uint8_t)((high & 0xf8) | high >> 5);
        g[i] = (uint8_t)(green << 2 | green >> 4);
        b[i] = (uint8_t)(low << 3 | (low >> 2 & 7));
    }
}

enum { HALF_Q13 = 1 << 12 };

struct rgb_matrix {
    int black; /* code of Y' = 0 */
    int16_t luma_q13, red_cr_q13, green_cb_q13, green_cr_q13, blue_cb_q13;
};

/* clang-format off */
#define Q13(x) ((int16_t)((x) * 8192 + ((x) < 0 ? -0.5 : 0.5)))
#define MATRIX(black, luma, chroma, kr, kb) {                                  \
    black, Q13(luma), Q13((chroma) * 2 * (1 - (kr))),                          \
    Q13(-(chroma) * 2 * (1 - (kb)) * (kb) / (1 - (kr) - (kb))),                \
    Q13(-(chroma) * 2 * (1 - (kr)) * (kr) / (1 - (kr) - (kb))),                \
    Q13((chroma) * 2 * (1 - (kb))) }

static const struct rgb_matrix rgb_matrices[2][2] = {
    [GLINT_MATRIX_BT601] = {
        [GLINT_RANGE_FULL] = MATRIX(0, 1., 1., .299, .114),
        [GLINT_RANGE_LIMITED] = MATRIX(16, 255. / 219, 255. / 224, .299, .114)},
    [GLINT_MATRIX_BT709] = {
        [GLINT_RANGE_FULL] = MATRIX(0, 1., 1., .2126, .0722),
        [GLINT_RANGE_LIMITED] =
            MATRIX(16, 255. / 219, 255. / 224, .2126, .0722)},
};
/* clang-format on */

/* Constant terms of the sums that convert Y', Cb, Cr to R', G', B'. They
 * subtract the products of the codes that stand for zero (black, and Cb = Cr =
 * 0) and add 1/2 for rounding. */
struct bias {
    int32_t red, green, blue, grey;
};

static struct bias compute_rounding_bias(const struct rgb_matrix *m)
{
    const int32_t grey = HALF_Q13 - m->black * m->luma_q13;

    return (struct bias){
        .red = grey - 128 * m->red_cr_q13,
        .green = grey - 128 * (m->green_cb_q13 + m->green_cr_q13),
        .blue = grey - 128 * m->blue_cb_q13,
        .grey = grey,
    };
}

/* Returns SUM as a code, clamped to 0 .. 255. |SUM| must be below 2^23. The
 * code then fits 16 bits before it is clamped, so that vectors hold twice as
 * many codes as with 32 bits. */
static inline uint8_t convert_to_code(int32_t sum_q13)
{
    const int16_t code = (int16_t)(sum_q13 >> 13);

    return (uint8_t)(code < 0 ? 0 : code > 255 ? 255 : code);
}

/* Computes R', G', B' of N pixels that each have Y', Cb and Cr. */
static void convert_pixels_to_rgb(const struct rgb_matrix *m,
                                  uint8_t *restrict r, uint8_t *restrict g,
                                  uint8_t *restrict b,
                                  const uint8_t *restrict luma,
                                  const uint8_t *restrict cb,
                                  const uint8_t *restrict cr, int n)
{
    const int16_t ky = m->luma_q13, r_cr = m->red_cr_q13,
                  g_cb = m->green_cb_q13, g_cr = m->green_cr_q13,
                  b_cb = m->blue_cb_q13;
    const struct bias bias = compute_rounding_bias(m);

    for (int i = 0; i < n; i++) {
        const int32_t y = luma[i] * ky;

        r[i] = convert_to_code(y + cr[i] * r_cr + bias.red);
        g[i] = convert_to_code(y + cb[i] * g_cb + cr[i] * g_cr + bias.green);
        b[i] = convert_to_code(y + cb[i] * b_cb + bias.blue);
    }
}

/* Computes R', G', B' of N pairs of pixels that share Cb and Cr. */
static void convert_pairs_to_rgb(const struct rgb_matrix *m,
                                 uint8_t *restrict r, uint8_t *restrict g,
                                 uint8_t *restrict b,
                                 const uint8_t *restrict luma,
                                 const uint8_t *restrict cb,
                                 const uint8_t *restrict cr, int n)
{
    const int16_t ky = m->luma_q13, r_cr = m->red_cr_q13,
                  g_cb = m->green_cb_q13, g_cr = m->green_cr_q13,
                  b_cb = m->blue_cb_q13;
    const struct bias bias = compute_rounding_bias(m);

    for (int i = 0; i < n; i++) {
        const int32_t y0 = luma[2 * i] * ky, y1 = luma[2 * i + 1] * ky;
        const int32_t to_r = cr[i] * r_cr + bias.red;
        const int32_t to_g = cb[i] * g_cb + cr[i] * g_cr + bias.green;
        const int32_t to_b = cb[i] * b_cb + bias.blue;

        r[2 * i] = convert_to_code(y0 + to_r);
        r[2 * i + 1] = convert_to_code(y1 + to_r);
        g[2 * i] = convert_to_code(y0 + to_g);
        g[2 * i + 1] = convert_to_code(y1 + to_g);
        b[2 * i] = convert_to_code(y0 + to_b);
        b[2 * i + 1] = convert_to_code(y1 + to_b);
    }
}

static void convert_greys_to_rgb(const struct rgb_matrix *m,
                                 uint8_t *restrict grey,
                                 const uint8_t *restrict luma, int n)
{
    const int16_t ky = m->luma_q13;
    const int32_t bias = compute_rounding_bias(m).grey;

    for (int i = 0; i < n; i++)
        grey[i] = convert_to_code(luma[i] * ky + bias);
}

/* -------------------------------------------------------------------- rows */

struct ycc {
    const uint8_t *luma, *cb, *cr;
};

static const uint8_t *get_plane_row(const struct glint_image *image, int plane,
                                    int y)
{
    return image->plane[plane] + y * image->stride_bytes[plane];
}

/* Returns pointers to the Y', Cb, Cr samples of N pixels of row Y, from X to
 * the right. They point into the picture or, if the picture's samples are
 * interleaved, into ROW, to which the samples are split. */
static struct ycc get_ycc_samples(struct glint_row_rgb *row,
                                  const struct glint_image *image, int x, int y,
                                  int n)
{
    const int half = (n + 1) / 2;
    const int cx = image->format == GLINT_I444 ? x : x / 2;
    const int cy =
        glint_image_plane_height(image->format, 1, 2) == 1 ? y / 2 : y;
    const struct ycc moved = {row->luma, row->cb, row->cr};

    switch (image->format) {
    case GLINT_YUYV:
    case GLINT_UYVY:
        glint_split_packed_pixels(image->format, row->luma, row->cb, row->cr,
                                  get_plane_row(image, 0, y) + 2 * x, half);
        return moved;
    case GLINT_NV12:
        glint_split_byte_pairs(row->cb, row->cr,
                               get_plane_row(image, 1, cy) + x, half);
        return (struct ycc){get_plane_row(image, 0, y) + x, row->cb, row->cr};
    case GLINT_NV21:
        glint_split_byte_pairs(row->cr, row->cb,
                               get_plane_row(image, 1, cy) + x, half);
        return (struct ycc){get_plane_row(image, 0, y) + x, row->cb, row->cr};
    default:
        return (struct ycc){get_plane_row(image, 0, y) + x,
                            get_plane_row(image, 1, cy) + cx,
                            get_plane_row(image, 2, cy) + cx};
    }
}

static void read_ycc_row(struct glint_row_rgb *row,
                         const struct glint_image *image, int x, int y, int n)
{
    const struct rgb_matrix *const m =
        &rgb_matrices[image->matrix][image->range];
    const struct ycc s = get_ycc_samples(row, image, x, y, n);
    uint8_t *const r = row->rgb[0], *const g = row->rgb[1],
                   *const b = row->rgb[2];
    const int even = n & ~1;

    if (image->format == GLINT_I444) {
        convert_pixels_to_rgb(m, r, g, b, s.luma, s.cb, s.cr, n);
        return;
    }
    convert_pairs_to_rgb(m, r, g, b, s.luma, s.cb, s.cr, n / 2);
    if (n > even) /* The last pair lacks its second pixel if the width is
                     odd. */
        convert_pixels_to_rgb(m, r + even, g + even, b + even, s.luma + even,
                              s.cb + even / 2, s.cr + even / 2, 1);
}

void glint_row_rgb_read(struct glint_row_rgb *row,
                        const struct glint_image *image, int x, int y, int n)
{
    uint8_t *const *const c = row->rgb;
    const uint8_t *const from = get_plane_row(image, 0, y);

    for (int i = 0; i < 3; i++)
        row->channel[i] = c[i];
    switch (image->format) {
    case GLINT_GREY:
        convert_greys_to_rgb(&rgb_matrices[GLINT_MATRIX_BT601][image->range],
                             c[0], from + x, n);
        row->channel[1] = row->channel[2] = c[0];
        return;
    case GLINT_RGB24:
        split_pixel_groups(c[0], c[1], c[2], from + 3 * x, n, 3);
        return;
    case GLINT_BGR24:
        split_pixel_groups(c[2], c[1], c[0], from + 3 * x, n, 3);
        return;
    case GLINT_XRGB8888:
        split_pixel_groups(c[2], c[1], c[0], from + 4 * x, n, 4);
        return;
    case GLINT_XBGR8888:
        split_pixel_groups(c[0], c[1], c[2], from + 4 * x, n, 4);
        return;
    case GLINT_RGB565:
        split_565_pixels(c[0], c[1], c[2], from + 2 * x, n);
        return;
    default:
        read_ycc_row(row, image, x, y, n);
    }
}

/* ------------------------------------------------------------------- memory */

size_t glint_row_rgb_bytes(int width)
{
    return 6 * ((size_t)width + 1);
}

void glint_row_rgb_init(struct glint_row_rgb *row, void *mem, int width)
{
    /* Chroma needs an even number of samples, also if WIDTH is odd. */
    const ptrdiff_t each = (ptrdiff_t)width + 1;
    uint8_t *const at = mem;

    for (int i = 0; i < 3; i++)
        row->rgb[i] = at + i * each;
    row->luma = at + 3 * each;
    row->cb = at + 4 * each;
    row->cr = at + 5 * each;
}

/* ------------------------------------------------------------------- layout */

/* Returns the mask of FIELD in a word of N_BITS, or 0 if FIELD is empty, has
 * more than 16 bits or does not fit. */
static uint64_t compute_field_mask(const struct glint_pixel_field *field,
                                   int n_bits)
{
    if (field->length < 1 || field->offset < 0 || field->length > 16 ||
        field->offset > n_bits - field->length)
        return 0;
    return ((UINT64_C(1) << field->length) - 1) << field->offset;
}

bool glint_pixel_layout_is_valid(const struct glint_pixel_layout *layout)
{
    const struct glint_pixel_field *const field[] = {
        &layout->red, &layout->green, &layout->blue, &layout->transparency};
    uint64_t taken = 0;

    if (layout->bytes < 2 || layout->bytes > 4)
        return false;
    for (int i = 0; i < 4; i++) {
        const uint64_t bits = compute_field_mask(field[i], 8 * layout->bytes);

        if (i == 3 && field[i]->length == 0)
            continue;
        if (!bits || bits & taken)
            return false;
        taken |= bits;
    }
    return true;
}

static bool is_field_whole_byte(const struct glint_pixel_field *field)
{
    return field->length == 8 && field->offset % 8 == 0;
}

static enum glint_pack_way
choose_pack_method(const struct glint_pixel_layout *l)
{
    if (l->bytes > 2 && is_field_whole_byte(&l->red) &&
        is_field_whole_byte(&l->green) && is_field_whole_byte(&l->blue))
        return GLINT_PACK_BYTES;
    if (l->bytes == 2 && l->red.length <= 8 && l->green.length <= 8 &&
        l->blue.length <= 8)
        return GLINT_PACK_HALVES;
    return GLINT_PACK_TABLES;
}

/* ------------------------------------------------------------------ packing */

static bool is_little_endian(void)
{
    const uint16_t one = 1;
    uint8_t first;

    memcpy(&first, &one, 1);
    return first == 1;
}

static void pack_four_byte_pixels(uint8_t *restrict dst, const uint8_t *a,
                                  const uint8_t *b, const uint8_t *c,
                                  const uint8_t *d, int n)
{
    for (int i = 0; i < n; i++) {
        dst[4 * i] = a[i];
        dst[4 * i + 1] = b[i];
        dst[4 * i + 2] = c[i];
        dst[4 * i + 3] = d[i];
    }
}

static void pack_three_byte_pixels(uint8_t *restrict dst, const uint8_t *a,
                                   const uint8_t *b, const uint8_t *c, int n)
{
    for (int i = 0; i < n; i++) {
        dst[3 * i] = a[i];
        dst[3 * i + 1] = b[i];
        dst[3 * i + 2] = c[i];
    }
}

static void pack_byte_channels(const struct glint_row_pack *p, uint8_t *dst,
                               const uint8_t *const channel[3], int n)
{
    const uint8_t *byte[4];

    for (int i = 0; i < 4; i++)
        byte[i] = p->channel[i] < 3 ? channel[p->channel[i]] : p->rest;
    if (p->layout.bytes == 4)
        pack_four_byte_pixels(dst, byte[0], byte[1], byte[2], byte[3], n);
    else
        pack_three_byte_pixels(dst, byte[0], byte[1], byte[2], n);
}

/* Returns (CODE * MOST + 127) / 255. Uses no division; the result is exact if
 * CODE * MOST + 127 is below 65535. */
static inline uint16_t scale_code_to_max(uint8_t code, uint16_t most)
{
    const uint16_t sum = (uint16_t)(code * most + 127);

    return (uint16_t)((uint16_t)(sum + 1 + (sum >> 8)) >> 8);
}

static inline uint16_t shift_left(uint16_t bits, int offset)
{
    return (uint16_t)(bits << offset);
}

static void pack_16_bit_pixels(const struct glint_row_pack *p,
                               uint16_t *restrict dst, const uint8_t *r,
                               const uint8_t *g, const uint8_t *b, int n)
{
    const struct glint_pixel_layout *const l = &p->layout;
    const uint16_t max_r = (uint16_t)((1 << l->red.length) - 1),
                   max_g = (uint16_t)((1 << l->green.length) - 1),
                   max_b = (uint16_t)((1 << l->blue.length) - 1);
    const int to_r = l->red.offset, to_g = l->green.offset,
              to_b = l->blue.offset;
    const uint16_t opaque = (uint16_t)p->opaque;

    for (int i = 0; i < n; i++)
        dst[i] = (uint16_t)(opaque |
                            shift_left(scale_code_to_max(r[i], max_r), to_r) |
                            shift_left(scale_code_to_max(g[i], max_g), to_g) |
                            shift_left(scale_code_to_max(b[i], max_b), to_b));
}

static void pack_pixels_by_tables(const struct glint_row_pack *p, uint8_t *dst,
                                  const uint8_t *const channel[3], int n)
{
    const int bytes = p->layout.bytes,
              skip = is_little_endian() ? 0 : 4 - bytes;

    for (int i = 0; i < n; i++) {
        const uint32_t word = p->table[0][channel[0][i]] |
                              p->table[1][channel[1][i]] |
                              p->table[2][channel[2][i]] | p->opaque;
        uint8_t byte[4];

        memcpy(byte, &word, 4);
        memcpy(dst + (ptrdiff_t)i * bytes, byte + skip, (size_t)bytes);
    }
}

void glint_row_pack_write(const struct glint_row_pack *pack, void *dst,
                          const uint8_t *const channel[3], int n)
{
    switch (pack->way) {
    case GLINT_PACK_BYTES:
        pack_byte_channels(pack, dst, channel, n);
        return;
    case GLINT_PACK_HALVES:
        pack_16_bit_pixels(pack, dst, channel[0], channel[1], channel[2], n);
        return;
    case GLINT_PACK_TABLES:
        pack_pixels_by_tables(pack, dst, channel, n);
        return;
    }
}

/* ------------------------------------------------------------------- tables */

/* Sets p->channel to the index of the channel that each byte of a pixel holds,
 * in memory order. Fills p->rest. */
static void find_channel_of_each_byte(struct glint_row_pack *p, uint8_t *mem,
                                      int width)
{
    const struct glint_pixel_layout *const l = &p->layout;
    int free_byte = 0 + 1 + 2 + 3;

    for (int i = 0; i < 4; i++)
        p->channel[i] = 3;
    for (int i = 0; i < 3; i++) {
        const struct glint_pixel_field *const field[] = {&l->red, &l->green,
                                                         &l->blue};
        const int byte = field[i]->offset / 8;

        p->channel[is_little_endian() ? byte : l->bytes - 1 - byte] = i;
        free_byte -= byte;
    }
    p->rest = mem;
    memset(p->rest, (int)(p->opaque >> 8 * free_byte & 255), (size_t)width);
}

static void fill_tables_of_channels(struct glint_row_pack *p, void *mem)
{
    const struct glint_pixel_layout *const l = &p->layout;
    const struct glint_pixel_field *const field[] = {&l->red, &l->green,
                                                     &l->blue};

    for (int i = 0; i < 3; i++) {
        const uint32_t most = (UINT32_C(1) << field[i]->length) - 1;

        p->table[i] = (uint32_t *)mem + 256 * i;
        for (uint32_t code = 0; code < 256; code++)
            p->table[i][code] = (code * most + 127) / 255 << field[i]->offset;
    }
}

size_t glint_row_pack_bytes(int width)
{
    const size_t rest = (size_t)width, tables = 3 * 256 * sizeof(uint32_t);

    return rest > tables ? rest : tables;
}

void glint_row_pack_init(struct glint_row_pack *pack,
                         const struct glint_pixel_layout *layout, void *mem,
                         int width)
{
    *pack = (struct glint_row_pack){
        .layout = *layout,
        .way = choose_pack_method(layout),
        .opaque = (uint32_t)compute_field_mask(&layout->transparency,
                                               8 * layout->bytes),
    };
    switch (pack->way) {
    case GLINT_PACK_BYTES:
        find_channel_of_each_byte(pack, mem, width);
        return;
    case GLINT_PACK_HALVES:
        return;
    case GLINT_PACK_TABLES:
        fill_tables_of_channels(pack, mem);
        return;
    }
}

/* ----------------------------------------------------------------- geometry */

static int clamp_side_to_min_1(int side)
{
    return side < 1 ? 1 : side;
}

/* Sets the areas so that the whole picture is shown, scaled to the panel at its
 * aspect ratio. */
static void fit_picture_to_panel(struct glint_panel *p)
{
    const struct glint_panel_config *const c = &p->cfg;

    p->seen = (struct glint_panel_area){0, 0, c->image_width, c->image_height};
    p->shown.width = c->width;
    p->shown.height = c->height;
    if (c->width * c->image_height > c->height * c->image_width)
        p->shown.width = clamp_side_to_min_1(
            (c->height * c->image_width + c->image_height / 2) /
            c->image_height);
    else
        p->shown.height = clamp_side_to_min_1(
            (c->width * c->image_height + c->image_width / 2) / c->image_width);
}

/* Sets the areas so that the middle of the picture is shown, unscaled. */
static void centre_picture_on_panel(struct glint_panel *p)
{
    const struct glint_panel_config *const c = &p->cfg;
    const int width = c->image_width < c->width ? c->image_width : c->width;
    const int height =
        c->image_height < c->height ? c->image_height : c->height;

    p->seen = (struct glint_panel_area){(c->image_width - width) / 2,
                                        (c->image_height - height) / 2, width,
                                        height};
    p->shown.width = width;
    p->shown.height = height;
}

static void place_picture(struct glint_panel *p)
{
    if (p->cfg.fit == GLINT_PANEL_FIT)
        fit_picture_to_panel(p);
    else
        centre_picture_on_panel(p);
    p->shown.x = (p->cfg.width - p->shown.width) / 2;
    p->shown.y = (p->cfg.height - p->shown.height) / 2;
}

/* Returns the index, among FROM pixels, of the pixel whose centre is nearest
 * to the centre of pixel I of TO pixels that span the same length. */
static int find_nearest_pixel(int i, int from, int to)
{
    return (2 * i + 1) * from / (2 * to);
}

/* ------------------------------------------------------------------- memory */

/* Rounds BYTES up to a multiple of 64, so that consecutive arrays are aligned
 * as malloc aligns. */
static size_t round_up_to_64(size_t bytes)
{
    return (bytes + 63) & ~(size_t)63;
}

static enum glint_status allocate_panel_memory(struct glint_panel *p,
                                               struct glint_error *error)
{
    const int widest =
        p->cfg.width > p->cfg.image_width ? p->cfg.width : p->cfg.image_width;
    const size_t line = round_up_to_64(4 * (size_t)widest);
    const size_t map = round_up_to_64(sizeof *p->from_x * (size_t)p->cfg.width);
    const size_t rgb = round_up_to_64(glint_row_rgb_bytes(widest));
    uint8_t *const mem =
        malloc(2 * line + map + rgb + glint_row_pack_bytes(widest));

    if (!mem)
        return glint_error_report(error, GLINT_E_MEMORY, "panel",
                                  "no memory for a row of %d pixels", widest);
    p->mem = mem;
    p->line = mem;
    p->scaled = mem + line;
    p->from_x = (uint16_t *)(void *)(mem + 2 * line);
    glint_row_rgb_init(&p->rgb, mem + 2 * line + map, widest);
    glint_row_pack_init(&p->pack, &p->cfg.layout, mem + 2 * line + map + rgb,
                        widest);
    return GLINT_OK;
}

static bool is_side_in_range(int side)
{
    return side >= 1 && side <= GLINT_PANEL_SIDE;
}

enum glint_status glint_panel_open(struct glint_panel *panel,
                                   const struct glint_panel_config *cfg,
                                   struct glint_error *error)
{
    enum glint_status status;

    *panel = (struct glint_panel){.cfg = *cfg};
    if (!is_side_in_range(cfg->width) || !is_side_in_range(cfg->height) ||
        !is_side_in_range(cfg->image_width) ||
        !is_side_in_range(cfg->image_height))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, "panel",
                                  "width and height must be 1 to %d pixels",
                                  GLINT_PANEL_SIDE);
    if (!glint_pixel_layout_is_valid(&cfg->layout))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, "panel",
                                  "its pixels are not packed true colour of "
                                  "16, 24 or 32 bits");
    place_picture(panel);
    status = allocate_panel_memory(panel, error);
    if (status)
        return status;
    for (int x = 0; x < panel->shown.width; x++)
        panel->from_x[x] = (uint16_t)find_nearest_pixel(x, panel->seen.width,
                                                        panel->shown.width);
    if (panel->shown.width == panel->seen.width)
        panel->from_x = NULL;
    return GLINT_OK;
}

enum glint_status glint_panel_open_for_image(
    struct glint_panel *panel, const struct glint_panel_config *cfg,
    const struct glint_image *image, bool *is_new, struct glint_error *error)
{
    struct glint_panel_config sized = *cfg;

    *is_new = !panel->mem || panel->cfg.image_width != image->width ||
              panel->cfg.image_height != image->height;
    if (!*is_new)
        return GLINT_OK;
    sized.image_width = image->width;
    sized.image_height = image->height;
    glint_panel_close(panel);
    return glint_panel_open(panel, &sized, error);
}

void glint_panel_close(struct glint_panel *panel)
{
    free(panel->mem);
    panel->mem = NULL;
}

/* ------------------------------------------------------------------ drawing */

void glint_panel_clear(struct glint_panel *panel, uint8_t *mem,
                       ptrdiff_t stride)
{
    const int width = panel->cfg.width;
    const size_t bytes = (size_t)width * (size_t)panel->cfg.layout.bytes;
    const uint8_t *const black[] = {panel->scaled, panel->scaled,
                                    panel->scaled};

    memset(panel->scaled, 0, (size_t)width);
    glint_row_pack_write(&panel->pack, panel->line, black, width);
    for (int y = 0; y < panel->cfg.height; y++)
        memcpy(mem + y * stride, panel->line, bytes);
}

static void scale_row_of_2_byte_pixels(uint16_t *restrict to,
                                       const uint16_t *restrict from,
                                       const uint16_t *restrict from_x, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = from[from_x[i]];
}

static void scale_row_of_3_byte_pixels(uint8_t *restrict to,
                                       const uint8_t *restrict from,
                                       const uint16_t *restrict from_x, int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t *const px = from + 3 * from_x[i];

        to[3 * i] = px[0];
        to[3 * i + 1] = px[1];
        to[3 * i + 2] = px[2];
    }
}

static void scale_row_of_4_byte_pixels(uint32_t *restrict to,
                                       const uint32_t *restrict from,
                                       const uint16_t *restrict from_x, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = from[from_x[i]];
}

static const uint8_t *pack_panel_row(struct glint_panel *p,
                                     const struct glint_image *image, int y)
{
    const int from = p->seen.x & ~1, cut = p->seen.x - from;
    const int n = p->seen.width + cut, bytes = p->cfg.layout.bytes;

    glint_row_rgb_read(&p->rgb, image, from, y, n);
    glint_row_pack_write(&p->pack, p->line, p->rgb.channel, n);
    if (!p->from_x)
        return p->line + cut * bytes;
    if (bytes == 2)
        scale_row_of_2_byte_pixels((void *)p->scaled, (const void *)p->line,
                                   p->from_x, p->shown.width);
    else if (bytes == 3)
        scale_row_of_3_byte_pixels(p->scaled, p->line, p->from_x,
                                   p->shown.width);
    else
        scale_row_of_4_byte_pixels((void *)p->scaled, (const void *)p->line,
                                   p->from_x, p->shown.width);
    return p->scaled;
}

void glint_panel_draw(struct glint_panel *panel,
                      const struct glint_image *image, uint8_t *mem,
                      ptrdiff_t stride)
{
    const struct glint_panel_area *const to = &panel->shown;
    const int bytes = panel->cfg.layout.bytes;
    const uint8_t *row = NULL;
    int made = -1;

    for (int y = 0; y < to->height; y++) {
        const int from_y =
            panel->seen.y +
            find_nearest_pixel(y, panel->seen.height, to->height);

        if (!row || from_y != made)
            row = pack_panel_row(panel, image, from_y);
        made = from_y;
        memcpy(mem + (to->y + y) * stride + to->x * bytes, row,
               (size_t)to->width * (size_t)bytes);
    }
}
