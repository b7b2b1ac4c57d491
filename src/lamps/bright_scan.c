/* SPDX-License-Identifier: MIT
 *
 * Computes the brightness of a row's pixels, block by block; dark blocks are
 * skipped.
 */
#include "base/compiler.h"

#include "base/bytes.h"
#include "lamps/bright.h"
#include "lamps/bright_code.h"

/* ------------------------------------------------------------ one threshold */

/* Tests N words at P for bytes of value CODE or more. Returns the OR of one
 * mask per word, in which the high bit of each such byte is set. */
static WHOLLY_INLINE uint64_t find_bytes_at_or_above_code(const uint8_t *p,
                                                          int n, int code,
                                                          int is_above_128)
{
    uint64_t found = 0;

    for (int i = 0; i < n; i++)
        found |=
            bytes_find_at_or_above(bytes_load(p + 8 * i), code, is_above_128);
    return found;
}

/* Returns the min RGB565 sample of N_BITS bits whose 8-bit code is CODE or
 * more. The 8-bit code is the sample followed by its highest bits. */
static int find_min_rgb565_sample(int code, int n_bits)
{
    int v = 0;

    while (v < (1 << n_bits) - 1 &&
           (v << (8 - n_bits) | v >> (2 * n_bits - 8)) < code)
        v++;
    return v;
}

/* Tests N words of four RGB565 pixels at P for pixels with a sample of CODE or
 * more. Returns the OR of one mask per word, in which a bit is set for each
 * such pixel. */
static uint64_t find_rgb565_samples_at_or_above_code(const uint8_t *p, int n,
                                                     int code)
{
    const uint64_t each = UINT64_C(0x0001000100010001);
    const uint64_t add_5 =
        (uint64_t)(32 - find_min_rgb565_sample(code, 5)) * each;
    const uint64_t add_6 =
        (uint64_t)(64 - find_min_rgb565_sample(code, 6)) * each;
    uint64_t found = 0;

    for (int i = 0; i < n; i++) {
        const uint64_t v = bytes_load(p + 8 * i);

        found |= ((v >> 11 & 31 * each) + add_5) & 32 * each;
        found |= (((v & 31 * each) + add_5) & 32 * each);
        found |= ((v >> 5 & 63 * each) + add_6) >> 1 & 32 * each;
    }
    return found;
}

/* Returns a mask of the bytes of a word that have colour samples; all other
 * bytes are padding. */
static uint64_t compute_sample_mask(const struct glint_layout *layout)
{
    const struct glint_layout_sample *s = &layout->sample[0];

    if (layout->kind == GLINT_LAYOUT_RGB && s->step == 4)
        return UINT64_C(0x00ffffff00ffffff);
    return UINT64_MAX;
}

static WHOLLY_INLINE uint64_t find_high_bytes(const uint8_t *p, int n, int code)
{
    return code > 128 ? find_bytes_at_or_above_code(p, n, code, 1)
                      : find_bytes_at_or_above_code(p, n, code, 0);
}

/* Returns a mask for a quick test of bytes. Bytes of CODE or more have a bit in
 * common with it. All eight bytes of the mask are equal. */
static uint64_t compute_bright_byte_mask(int code)
{
    const int highest = (1 << bit_length((uint64_t)code)) >> 1;

    return (uint64_t)(256 - (highest < 128 ? highest : 128)) * BYTES_EACH;
}

/* Returns the OR of N words at P. Load and OR are separate statements, as gcc
 * would load single bytes if they were one. */
static WHOLLY_INLINE uint64_t or_together_words(const uint8_t *p, int n)
{
    uint64_t bits = 0;

    for (int i = 0; i < n; i++) {
        uint64_t word = bytes_load(p + 8 * i);

        FORGET(word);
        bits |= word;
    }
    return bits;
}

/* Marks the complete blocks of a row without chroma at PX that may be bright.
 * STEP is the number of bytes per pixel. A block is dark if the OR of its bytes
 * has no bit in common with the mask of bright bytes. Most blocks are dark. */
static WHOLLY_INLINE int
mark_bright_blocks_without_chroma(struct glint_bright *b, const uint8_t *px,
                                  int step)
{
    const uint64_t bytes = compute_sample_mask(b->layout);
    const int n = b->width / BRIGHT_BLOCK, code = b->low_code;
    const uint64_t bits = compute_bright_byte_mask(code) & bytes;
    const int n_words = BRIGHT_BLOCK / 8 * step;
    int any = 0;

    for (int i = 0; i < n; i++) {
        b->block[i] = (or_together_words(px, n_words) & bits) &&
                      (find_high_bytes(px, n_words, code) & bytes);
        any |= b->block[i];
        px += BRIGHT_BLOCK * step;
    }
    return any;
}

/* Calls mark_bright_blocks_without_chroma() with a constant number of bytes per
 * pixel. So its inner loops have constant bounds. */
static int mark_bright_blocks_by_pixel_bytes(struct glint_bright *b,
                                             const uint8_t *px)
{
    switch (b->layout->sample[0].step) {
    case 1:
        return mark_bright_blocks_without_chroma(b, px, 1);
    case 3:
        return mark_bright_blocks_without_chroma(b, px, 3);
    default:
        return mark_bright_blocks_without_chroma(b, px, 4);
    }
}

static int mark_bright_rgb565_blocks(struct glint_bright *b, const uint8_t *px)
{
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        b->block[i] =
            find_rgb565_samples_at_or_above_code(
                px + i * 2 * BRIGHT_BLOCK, BRIGHT_BLOCK / 4, b->low_code) != 0;
        any |= b->block[i];
    }
    return any;
}

/* ------------------------------------------------------------- Y, Cb and Cr */

/* Max and min of bytes. Element i covers all bytes whose index modulo 4 is
 * i. */
struct extremes {
    uint8_t most[4], least[4];
};

static WHOLLY_INLINE uint8_t max_u8(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

static WHOLLY_INLINE uint8_t min_u8(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* Sets HALF[i] (i below 8) to the max and HALF[8 + i] to the max of 255 minus
 * the byte, over the bytes at P whose index modulo 8 is i. There are 16 N
 * bytes; N must be 1, 2 or 4. If N is below 4, some bytes are read twice.
 * Compilers vectorize these loops only if they are not nested in another
 * loop. */
static NEVER_INLINE void find_byte_max_and_inverted_min(uint8_t half[16],
                                                        const uint8_t *p, int n)
{
    const uint8_t *q = n > 1 ? p + 16 : p;
    const uint8_t *r = n > 2 ? p + 32 : p, *s = n > 2 ? p + 48 : q;
    uint8_t most[32];

    for (int i = 0; i < 16; i++)
        most[i] = max_u8(max_u8(p[i], q[i]), max_u8(r[i], s[i]));
    for (int i = 0; i < 16; i++)
        most[16 + i] =
            (uint8_t)(255 - min_u8(min_u8(p[i], q[i]), min_u8(r[i], s[i])));
    for (int i = 0; i < 8; i++)
        half[i] = max_u8(most[i], most[i + 8]);
    for (int i = 0; i < 8; i++)
        half[8 + i] = max_u8(most[16 + i], most[24 + i]);
}

static WHOLLY_INLINE void compute_extremes_modulo_4(struct extremes *e,
                                                    const uint8_t half[16])
{
    for (int i = 0; i < 4; i++)
        e->most[i] = max_u8(half[i], half[i + 4]);
    for (int i = 0; i < 4; i++)
        e->least[i] = (uint8_t)(255 - max_u8(half[8 + i], half[12 + i]));
}

static WHOLLY_INLINE void find_byte_extremes(struct extremes *e,
                                             const uint8_t *p, int n)
{
    uint8_t half[16];

    find_byte_max_and_inverted_min(half, p, n);
    compute_extremes_modulo_4(e, half);
}

static WHOLLY_INLINE int get_largest_byte(const struct extremes *e)
{
    return bright_larger(bright_larger(e->most[0], e->most[1]),
                         bright_larger(e->most[2], e->most[3]));
}

static WHOLLY_INLINE int get_smallest_byte(const struct extremes *e)
{
    return min_u8(min_u8(e->least[0], e->least[1]),
                  min_u8(e->least[2], e->least[3]));
}

/* Returns the max that chroma can add to luma in any of R, G and B. LEAST and
 * MOST are the ranges of Cb and Cr. */
static WHOLLY_INLINE int32_t compute_max_chroma_term_q16(
    const struct glint_bright *b, const int most[2], const int least[2])
{
    const int32_t(*m_q16)[3] = b->ycc.to_rgb_q16;
    const int32_t red_q16 = (most[1] - 128) * m_q16[0][2];
    const int32_t green_q16 =
        (least[0] - 128) * m_q16[1][1] + (least[1] - 128) * m_q16[1][2];
    const int32_t blue_q16 = (most[0] - 128) * m_q16[2][1];

    return bright_larger(red_q16, bright_larger(green_q16, blue_q16));
}

/* Returns whether a pixel can be bright if its luma is at most LUMA and its
 * chroma is in LEAST .. MOST. These limits bound its R, G and B. One code is
 * added for rounding. */
static WHOLLY_INLINE int can_pixel_be_bright(const struct glint_bright *b,
                                             int luma, const int most[2],
                                             const int least[2])
{
    return (luma - b->ycc.black) * b->ycc.to_rgb_q16[0][0] +
               compute_max_chroma_term_q16(b, most, least) >=
           b->low_sum_q16;
}

/* Returns whether a block of YUYV or UYVY can have bright pixels. HALF[i], i
 * below 8, is the max of its bytes whose index modulo 8 is i, HALF[8 + i] the
 * max of 255 minus these. */
static int can_packed_block_be_bright(const struct glint_bright *b,
                                      const uint8_t half[16])
{
    const int y = b->layout->sample[0].offset;
    const int cb = b->layout->sample[1].offset;
    const int cr = b->layout->sample[2].offset;
    struct extremes e;

    compute_extremes_modulo_4(&e, half);
    return can_pixel_be_bright(b, bright_larger(e.most[y], e.most[y + 2]),
                               (const int[]){e.most[cb], e.most[cr]},
                               (const int[]){e.least[cb], e.least[cr]});
}

/* Max distance of chroma from grey, codes, in a quiet block: a block that is
 * neither bright nor strongly coloured. */
enum { QUIET_CHROMA = 24 };

/* Returns the min luma code, 0 .. 256, of a bright pixel whose chroma is within
 * QUIET_CHROMA of grey. Blocks that reach this luma are loud (not quiet). */
static int find_min_loud_luma(const struct glint_bright *b)
{
    const int most[2] = {128 + QUIET_CHROMA, 128 + QUIET_CHROMA};
    const int least[2] = {127 - QUIET_CHROMA, 127 - QUIET_CHROMA};
    const int32_t left_q16 =
        b->low_sum_q16 - compute_max_chroma_term_q16(b, most, least);
    const int luma = b->ycc.black + left_q16 / b->ycc.to_rgb_q16[0][0];

    return q_clamp_sat(left_q16 > 0 ? luma : 0, 0, 256);
}

/* Returns a number that tests four bytes at once, each in a lane of 16 bits:
 * when it is added to them, bit 8 of a lane becomes 1 if the lane's byte is
 * CODE or more. */
static uint64_t compute_threshold_carry(int code)
{
    return (uint64_t)(256 - code) * UINT64_C(0x0001000100010001);
}

/* Returns whether a block is loud. MOST has the max of its bytes, INVERSE the
 * max of 255 minus its bytes. Luma is in the low bytes of pairs if Y is 0,
 * otherwise in the high bytes. */
static WHOLLY_INLINE int is_block_loud(uint64_t most, uint64_t inverse, int y,
                                       uint64_t luma_carry,
                                       uint64_t chroma_carry)
{
    const uint64_t low = UINT64_C(0x00ff00ff00ff00ff);
    const uint64_t luma = (y ? most >> 8 : most) & low;
    const uint64_t chroma = (y ? most : most >> 8) & low;
    const uint64_t less = (y ? inverse : inverse >> 8) & low;
    const uint64_t sum =
        (luma + luma_carry) | (chroma + chroma_carry) | (less + chroma_carry);

    return (sum & ~low) != 0;
}

/* number of blocks of YUYV or UYVY that are tested together */
enum { TOGETHER = 4 };

/* The limits of quiet blocks (QUIET_CHROMA and find_min_loud_luma()): for each
 * byte index modulo 16, the max byte and the max of 255 minus the byte. */
struct quiet {
    uint8_t most[16], inverse[16];
};

static void set_quiet_limits(struct quiet *quiet, int y, int loud)
{
    for (int i = 0; i < 16; i++) {
        const int is_luma = (i & 1) == y;

        quiet->most[i] = (uint8_t)(is_luma ? loud - 1 : 128 + QUIET_CHROMA);
        quiet->inverse[i] = (uint8_t)(is_luma ? 255 : 128 + QUIET_CHROMA);
    }
}

static WHOLLY_INLINE uint8_t find_max_of_8_strided_bytes(const uint8_t *p)
{
    return max_u8(max_u8(max_u8(p[0], p[16]), max_u8(p[32], p[48])),
                  max_u8(max_u8(p[64], p[80]), max_u8(p[96], p[112])));
}

static WHOLLY_INLINE uint8_t find_min_of_8_strided_bytes(const uint8_t *p)
{
    return min_u8(min_u8(min_u8(p[0], p[16]), min_u8(p[32], p[48])),
                  min_u8(min_u8(p[64], p[80]), min_u8(p[96], p[112])));
}

/* Tests TOGETHER blocks at P. Sets ABOVE[i] to nonzero if a byte whose index
 * modulo 16 is i exceeds QUIET. Compilers vectorise this function like
 * find_byte_max_and_inverted_min(). */
static NEVER_INLINE void
find_bytes_above_limits(uint8_t above[restrict 16], const uint8_t *restrict p,
                        const struct quiet *restrict quiet)
{
    uint8_t most[16], inverse[16];

    for (int i = 0; i < 16; i++)
        most[i] = max_u8(find_max_of_8_strided_bytes(p + i),
                         find_max_of_8_strided_bytes(p + 128 + i));
    for (int i = 0; i < 16; i++)
        inverse[i] =
            (uint8_t)(255 - min_u8(find_min_of_8_strided_bytes(p + i),
                                   find_min_of_8_strided_bytes(p + 128 + i)));
    for (int i = 0; i < 16; i++)
        above[i] =
            (uint8_t)((max_u8(most[i], quiet->most[i]) ^ quiet->most[i]) |
                      (max_u8(inverse[i], quiet->inverse[i]) ^
                       quiet->inverse[i]));
}

static WHOLLY_INLINE int are_blocks_quiet(const uint8_t *p,
                                          const struct quiet *quiet)
{
    uint8_t above[16];

    find_bytes_above_limits(above, p, quiet);
    return or_together_words(above, 2) == 0;
}

/* Marks the complete blocks of a row of YUYV or UYVY at PX that can have bright
 * pixels. Y is the offset of the first luma byte. Most blocks are quiet, so
 * TOGETHER blocks are first tested for this at once, by the max of their luma
 * and the extremes of their chroma. If one is loud, each block is tested
 * separately, and loud blocks again by the extremes of Cb and of Cr. Loud
 * blocks are usually neighbours, so the TOGETHER blocks after a loud block are
 * tested one by one. If find_min_loud_luma() is 0, no block is quiet. */
static WHOLLY_INLINE int mark_bright_yuyv_blocks(struct glint_bright *b,
                                                 const uint8_t *px, int y)
{
    const int n = b->width / BRIGHT_BLOCK, loud_from = find_min_loud_luma(b);
    const uint64_t luma_carry = compute_threshold_carry(loud_from);
    const uint64_t chroma_carry = compute_threshold_carry(129 + QUIET_CHROMA);
    struct quiet quiet;
    int any = 0, loud = loud_from == 0;

    set_quiet_limits(&quiet, y, loud_from > 0 ? loud_from : 1);
    for (int i = 0; i < n;) {
        const int end = i + TOGETHER < n ? i + TOGETHER : n;

        if (!loud && end - i == TOGETHER &&
            are_blocks_quiet(px + i * 2 * BRIGHT_BLOCK, &quiet)) {
            for (; i < end; i++)
                b->block[i] = 0;
            continue;
        }
        loud = 0;
        for (; i < end; i++) {
            uint8_t half[16];
            int is_one;

            find_byte_max_and_inverted_min(half, px + i * 2 * BRIGHT_BLOCK,
                                           BRIGHT_BLOCK / 8);
            is_one = is_block_loud(bytes_load(half), bytes_load(half + 8), y,
                                   luma_carry, chroma_carry);
            b->block[i] = is_one && can_packed_block_be_bright(b, half);
            loud |= is_one;
            any |= b->block[i];
        }
    }
    return any;
}

static int mark_bright_packed_blocks(struct glint_bright *b, const uint8_t *px)
{
    return b->layout->sample[0].offset ? mark_bright_yuyv_blocks(b, px, 1)
                                       : mark_bright_yuyv_blocks(b, px, 0);
}

/* Returns whether a block of a planar picture can have bright pixels. Its Y
 * samples begin at PX; its Cb and Cr samples, 16 N bytes each, begin at C[0]
 * and C[1]. */
static WHOLLY_INLINE int
can_planar_block_be_bright(const struct glint_bright *b, const uint8_t *px,
                           const uint8_t *const c[2], int n)
{
    struct extremes luma, cb, cr;

    find_byte_extremes(&luma, px, BRIGHT_BLOCK / 16);
    find_byte_extremes(&cb, c[0], n);
    find_byte_extremes(&cr, c[1], n);
    return can_pixel_be_bright(
        b, get_largest_byte(&luma),
        (const int[]){get_largest_byte(&cb), get_largest_byte(&cr)},
        (const int[]){get_smallest_byte(&cb), get_smallest_byte(&cr)});
}

/* Returns whether a block can have bright pixels if its chroma is interleaved,
 * beginning at C. CB is the offset of the first Cb sample, 0 or 1. */
static WHOLLY_INLINE int
can_semiplanar_block_be_bright(const struct glint_bright *b, const uint8_t *px,
                               const uint8_t *c, int cb)
{
    struct extremes luma, e;
    const int cr = 1 - cb;

    find_byte_extremes(&luma, px, BRIGHT_BLOCK / 16);
    find_byte_extremes(&e, c, BRIGHT_BLOCK / 16);
    return can_pixel_be_bright(
        b, get_largest_byte(&luma),
        (const int[]){bright_larger(e.most[cb], e.most[cb + 2]),
                      bright_larger(e.most[cr], e.most[cr + 2])},
        (const int[]){min_u8(e.least[cb], e.least[cb + 2]),
                      min_u8(e.least[cr], e.least[cr + 2])});
}

static int mark_bright_semiplanar_blocks(struct glint_bright *b)
{
    const struct glint_bright_code *code = b->code;
    const int cb = code[2].first < code[1].first;
    const uint8_t *first = cb ? code[2].first : code[1].first;
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        b->block[i] = (uint8_t)can_semiplanar_block_be_bright(
            b, code[0].first + i * BRIGHT_BLOCK, first + i * BRIGHT_BLOCK, cb);
        any |= b->block[i];
    }
    return any;
}

static int mark_bright_planar_blocks(struct glint_bright *b)
{
    const struct glint_bright_code *code = b->code;
    const int bytes = BRIGHT_BLOCK >> code[1].shift;
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        const uint8_t *const c[2] = {code[1].first + i * bytes,
                                     code[2].first + i * bytes};
        const uint8_t *px = code[0].first + i * BRIGHT_BLOCK;

        b->block[i] =
            (uint8_t)(bytes == 16 ? can_planar_block_be_bright(b, px, c, 1)
                                  : can_planar_block_be_bright(b, px, c, 2));
        any |= b->block[i];
    }
    return any;
}

/* Sets block[i] to 1 if block i may have a pixel of brightness low or more,
 * else to 0. An incomplete last block is not tested. Returns 0 if no tested
 * block may have such a pixel. */
static int mark_bright_blocks_of_row(struct glint_bright *b)
{
    const uint8_t *first = b->code[0].first;

    if (b->layout->kind == GLINT_LAYOUT_565)
        return mark_bright_rgb565_blocks(b, first);
    if (b->layout->kind != GLINT_LAYOUT_YCC)
        return mark_bright_blocks_by_pixel_bytes(
            b, first - b->layout->sample[0].offset);
    if (glint_layout_is_packed(b->layout))
        return mark_bright_packed_blocks(b,
                                         first - b->layout->sample[0].offset);
    return b->layout->planes == 2 ? mark_bright_semiplanar_blocks(b)
                                  : mark_bright_planar_blocks(b);
}

/* --------------------------------------------------------------- R, G and B */

/* Returns the brightness of pixel X. At least one of its channels must be
 * clipped. */
static WHOLLY_INLINE uint8_t
look_up_clipped_brightness(const struct glint_bright *b, int x)
{
    int rgb[3];

    bright_read_rgb_codes(b, x, rgb);
    return b->beyond[bright_compute_luma(rgb)];
}

/* Sets the brightness of pixels X .. END - 1; returns the max. */
static int compute_rgb_brightness_range(struct glint_bright *b, int x, int end)
{
    int greatest = 0;

    for (; x < end; x++) {
        int rgb[3], value;

        bright_read_rgb_codes(b, x, rgb);
        value = bright_larger(rgb[0], bright_larger(rgb[1], rgb[2]));
        if (value >= BRIGHT_CLIPPED)
            value = b->beyond[bright_compute_luma(rgb)];
        b->value[x] = (uint8_t)value;
        greatest = bright_larger(greatest, value);
    }
    return greatest;
}

enum { RGB_BYTES = 3 * BRIGHT_BLOCK };

/* Sets LARGEST[I] to the max of the three bytes P[I .. I + 2], for I up to
 * RGB_BYTES - 3. Returns the max of all bytes. The last vector overlaps the
 * vector before it. */
static NEVER_INLINE int find_max_of_next_3_bytes(const uint8_t *p,
                                                 uint8_t largest[RGB_BYTES])
{
    uint8_t greatest = 0;

    for (int i = 0; i < RGB_BYTES - 16; i++) {
        const uint8_t two = p[i] > p[i + 1] ? p[i] : p[i + 1];
        const uint8_t most = two > p[i + 2] ? two : p[i + 2];

        largest[i] = most;
        greatest = greatest > most ? greatest : most;
    }
    for (int i = RGB_BYTES - 18; i < RGB_BYTES - 2; i++) {
        const uint8_t two = p[i] > p[i + 1] ? p[i] : p[i + 1];
        const uint8_t most = two > p[i + 2] ? two : p[i + 2];

        largest[i] = most;
        greatest = greatest > most ? greatest : most;
    }
    return greatest;
}

/* Sets the brightness of the complete block that begins at pixel X, in a format
 * with three bytes per pixel; returns the max. */
static int compute_rgb24_block_brightness(struct glint_bright *b, int x)
{
    const ptrdiff_t at = (ptrdiff_t)3 * x - b->layout->sample[0].offset;
    uint8_t largest[RGB_BYTES], *value = b->value + x;
    int greatest = find_max_of_next_3_bytes(b->code[0].first + at, largest);

    for (int i = 0; i < BRIGHT_BLOCK; i++)
        value[i] = largest[3 * i];
    if (greatest < BRIGHT_CLIPPED)
        return greatest;
    greatest = 0;
    for (int i = 0; i < BRIGHT_BLOCK; i++) {
        if (value[i] >= BRIGHT_CLIPPED)
            value[i] = look_up_clipped_brightness(b, x + i);
        greatest = bright_larger(greatest, value[i]);
    }
    return greatest;
}

/* ------------------------------------------------------------- Y, Cb and Cr */

/* Returns A * B / 2^16, rounded down. */
static WHOLLY_INLINE int16_t multiply_high(int16_t a, int16_t b)
{
    return (int16_t)((int32_t)a * b >> 16);
}

/* Sets VALUE to max(R, G, B) of each pixel, clamped to 0 .. 255. It is computed
 * from LUMA, CB and CR; the error before rounding is at most 1/5 code.
 * Compilers vectorise this in 16 bits: codes have 7 fraction bits, coefficients
 * 13 and products 4, at most 2.12 * 255 * 16 < 2^14. */
static WHOLLY_INLINE void compute_block_max_channels(
    const struct glint_bright *b, uint8_t value[BRIGHT_BLOCK],
    const uint8_t luma[BRIGHT_BLOCK], const uint8_t cb[BRIGHT_BLOCK],
    const uint8_t cr[BRIGHT_BLOCK])
{
    const int32_t(*m_q16)[3] = b->ycc.to_rgb_q16;
    const int16_t white = (int16_t)q_shift(m_q16[0][0], 3);
    const int16_t red = (int16_t)q_shift(m_q16[0][2], 3);
    const int16_t blue = (int16_t)q_shift(m_q16[2][1], 3);
    const int16_t green_u = (int16_t)q_shift(m_q16[1][1], 3);
    const int16_t green_v = (int16_t)q_shift(m_q16[1][2], 3);
    const int16_t black = (int16_t)b->ycc.black;

    for (int i = 0; i < BRIGHT_BLOCK; i++) {
        const int16_t y = (int16_t)((luma[i] - black) * 128);
        const int16_t u = (int16_t)((cb[i] - 128) * 128);
        const int16_t v = (int16_t)((cr[i] - 128) * 128);
        const int16_t r = multiply_high(v, red), l = multiply_high(u, blue);
        const int16_t g =
            (int16_t)(multiply_high(u, green_u) + multiply_high(v, green_v));
        const int16_t rl = r > l ? r : l, most = rl > g ? rl : g;
        const int16_t code =
            (int16_t)((multiply_high(y, white) + most + 9) >> 4);
        const int16_t held = code < 255 ? code : 255;

        value[i] = (uint8_t)(held > 0 ? held : 0);
    }
}

/* Copies one channel of a block. Neighbouring codes of the channel are STEP
 * bytes apart. */
static WHOLLY_INLINE void copy_block_codes(uint8_t code[BRIGHT_BLOCK],
                                           const uint8_t *px, int step)
{
    for (int k = 0; k < BRIGHT_BLOCK; k++)
        code[k] = px[k * step];
}

/* Copies one channel of a block in which two pixels share each code. The codes
 * are STEP bytes apart, and each is written twice. */
static WHOLLY_INLINE void copy_block_codes_twice(uint8_t code[BRIGHT_BLOCK],
                                                 const uint8_t *px, int step)
{
    for (int k = 0; k < BRIGHT_BLOCK / 2; k++)
        code[2 * k] = code[2 * k + 1] = px[k * step];
}

/* Copies channel I of the block that begins at pixel X. After the end of the
 * row it repeats the code of the last pixel. Steps and bounds are constant in
 * the common cases, so that compilers vectorise the loops. */
static void copy_block_channel(const struct glint_bright *b, int i, int x,
                               uint8_t code[BRIGHT_BLOCK])
{
    const struct glint_bright_code *c = &b->code[i];
    const int n = b->width - x < BRIGHT_BLOCK ? b->width - x : BRIGHT_BLOCK;
    const uint8_t *px = c->first + (x >> c->shift) * c->step;

    if (n < BRIGHT_BLOCK || (c->shift == 0 && c->step > 2)) {
        for (int k = 0; k < BRIGHT_BLOCK; k++)
            code[k] = px[((k < n ? k : n - 1) >> c->shift) * c->step];
    } else if (c->shift == 0) {
        if (c->step == 1)
            copy_block_codes(code, px, 1);
        else
            copy_block_codes(code, px, 2);
    } else {
        if (c->step == 1)
            copy_block_codes_twice(code, px, 1);
        else if (c->step == 2)
            copy_block_codes_twice(code, px, 2);
        else
            copy_block_codes_twice(code, px, 4);
    }
}

/* Sets the brightness of the block that begins at pixel X, from luma and chroma
 * or from luma alone. Returns the max brightness. If all pixels are below low
 * and unclipped, sets nothing and returns 0. */
static NEVER_INLINE int compute_ycc_block_brightness(struct glint_bright *b,
                                                     int x)
{
    uint8_t luma[BRIGHT_BLOCK], cb[BRIGHT_BLOCK], cr[BRIGHT_BLOCK];
    uint8_t value[BRIGHT_BLOCK];
    uint8_t greatest_code = 0, greatest = 0, *row = b->value + x;

    copy_block_channel(b, 0, x, luma);
    if (b->layout->kind == GLINT_LAYOUT_GREY) {
        for (int i = 0; i < BRIGHT_BLOCK; i++)
            value[i] = b->full_luma[luma[i]];
    } else {
        copy_block_channel(b, 1, x, cb);
        copy_block_channel(b, 2, x, cr);
        compute_block_max_channels(b, value, luma, cb, cr);
    }
    for (int i = 0; i < BRIGHT_BLOCK; i++)
        greatest_code = value[i] > greatest_code ? value[i] : greatest_code;
    for (int i = 0; i < BRIGHT_BLOCK && greatest_code >= BRIGHT_CLIPPED; i++)
        if (value[i] >= BRIGHT_CLIPPED)
            value[i] = b->beyond[b->full_luma[luma[i]]];
    if (greatest_code < b->low && greatest_code < BRIGHT_CLIPPED)
        return 0;
    for (int i = 0; i < BRIGHT_BLOCK; i++)
        greatest = greatest > value[i] ? greatest : value[i];
    for (int i = 0; i < BRIGHT_BLOCK; i++)
        row[i] = value[i];
    return greatest;
}

/* Sets the brightness of the marked block I. Returns the max, or 0 if it is
 * below low. */
static int compute_block_brightness(struct glint_bright *b, int i)
{
    const int x = i * BRIGHT_BLOCK;
    const int end = x + BRIGHT_BLOCK < b->width ? x + BRIGHT_BLOCK : b->width;
    const int is_whole = end - x == BRIGHT_BLOCK;
    int greatest;

    if (!bright_is_rgb(b))
        greatest = compute_ycc_block_brightness(b, x);
    else if (is_whole && b->layout->kind == GLINT_LAYOUT_RGB &&
             b->code[0].step == 3)
        greatest = compute_rgb24_block_brightness(b, x);
    else
        greatest = compute_rgb_brightness_range(b, x, end);
    return greatest < b->low ? 0 : greatest;
}

int glint_bright_scan_row(struct glint_bright *b, int y)
{
    const int n_blocks = (b->width + BRIGHT_BLOCK - 1) / BRIGHT_BLOCK;
    int any, greatest = 0;

    b->n_marked = 0;
    glint_bright_select_row(b, y);
    any = mark_bright_blocks_of_row(b);
    /* An incomplete last block cannot be tested and is always marked. */
    if (n_blocks * BRIGHT_BLOCK > b->width)
        any = b->block[n_blocks - 1] = 1;
    for (int i = 0; any && i < n_blocks; i++)
        if (b->block[i]) {
            b->block[i] = (uint8_t)compute_block_brightness(b, i);
            b->marked[b->n_marked] = i;
            b->n_marked += b->block[i] > 0;
            greatest = bright_larger(greatest, b->block[i]);
        }
    return greatest;
}
