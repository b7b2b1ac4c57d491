/* SPDX-License-Identifier: MIT */
#include "scene/translucent/spread.h"

#include "base/compiler.h"
#include "base/q.h"

enum {
    MOST_ROW = GLINT_STRIP + GLINT_TRANSLUCENT_MOST_KERNEL + 1,
    MOST_VALUE = 32767
};

struct glint_spread_scratch
glint_spread_carve(struct glint_arena *arena,
                   const struct glint_translucent *stone, int height)
{
    const size_t kernel = stone->header->kernel;
    const size_t rows = (size_t)height, all = rows + kernel;

    return (struct glint_spread_scratch){
        .taps =
            glint_arena_allocate(arena, 1, sizeof(struct glint_spread_taps)),
        .any = glint_arena_allocate(arena, all, sizeof(int32_t)),
        .pair = glint_arena_allocate(arena, all * (GLINT_STRIP + kernel),
                                     sizeof(int32_t)),
        .value =
            glint_arena_allocate(arena, all / 2 * GLINT_STRIP, sizeof(int32_t)),
        .sum = glint_arena_allocate(arena, rows * GLINT_STRIP, sizeof(int32_t)),
        .total =
            glint_arena_allocate(arena, rows * GLINT_STRIP, sizeof(int32_t))};
}

/* ------------------------------------------------------------------- taps */

/* Returns tap I, counted from the end of TAP[N]; 0 if I is out of range. */
static int32_t read_reversed_tap(const int16_t *tap, int n, int i)
{
    return i < 0 || i >= n ? 0 : tap[n - 1 - i];
}

static void store_taps_as_pairs(const struct glint_translucent *t, uint32_t i,
                                struct glint_spread_taps *taps)
{
    const int n = (int)t->header->kernel;
    const int16_t *row = t->tap + 2 * (size_t)i * t->header->kernel;
    const int16_t *column = row + n;

    taps->n = (n + 1) / 2;
    taps->shift = (int)t->shift[i];
    for (int k = 0; k < taps->n; k++) {
        taps->row[k] =
            glint_pack_int16_pair(read_reversed_tap(row, n, 2 * k),
                                  read_reversed_tap(row, n, 2 * k + 1));
        taps->even[k] =
            glint_pack_int16_pair(read_reversed_tap(column, n, 2 * k),
                                  read_reversed_tap(column, n, 2 * k + 1));
        taps->odd[k] =
            glint_pack_int16_pair(read_reversed_tap(column, n, 2 * k - 1),
                                  read_reversed_tap(column, n, 2 * k));
    }
}

/* ------------------------------------------------------------------- codes */

/* The codes in a row of a table, from a texel to the row's end. */
struct codes {
    const uint8_t *at;
    int is_signed;
    int bits; /* a code stands for the factor code / 2^bits */
};

/* Returns the codes in row Y of table TABLE, from texel X on. */
static struct codes find_codes_in_table_row(const struct glint_translucent *t,
                                            size_t table, int x, int y)
{
    const struct glint_translucent_header *h = t->header;
    const size_t log2 = h->side_log2, mask = ((size_t)1 << log2) - 1;
    const int is_signed = h->variant == GLINT_TRANSLUCENT_FACTORED;

    return (struct codes){t->code + (table << 2 * log2) +
                              (((size_t)y & mask) << log2) + ((size_t)x & mask),
                          is_signed, GLINT_TRANSLUCENT_CODE_BITS - is_signed};
}

static inline int32_t read_code_of_texel(const struct codes *f, int i)
{
    return f->is_signed ? (int8_t)f->at[i] : f->at[i];
}

/* ------------------------------------------------------------------- light */

/* Sets VALUE to the light of channel C that enters at texels X .. X + N - 1 of
 * row Y. These texels must be in the map and within one tile of the translucent
 * medium. Light is below 2^15, and so is light * code / 2^bits. */
static void set_entering_light_of_run(const struct glint_spread *s, int c,
                                      int x, int y, int n, int16_t *value)
{
    const int16_t *light = s->light[c] + (ptrdiff_t)y * s->width + x;
    struct codes in;

    if (!s->stone->cluster) {
        for (int i = 0; i < n; i++)
            value[i] = light[i];
        return;
    }
    in = find_codes_in_table_row(s->stone, 3 + (size_t)c, x, y);
    for (int i = 0; i < n; i++)
        value[i] = (int16_t)((light[i] * read_code_of_texel(&in, i) +
                              (1 << (in.bits - 1))) >>
                             in.bits);
}

/* Sets VALUE[N] to the light that enters at texels X .. X + N - 1 of row Y;
 * these texels may lie outside the map. Returns 0 if no light enters at any of
 * them. */
static int set_entering_light_of_row(const struct glint_spread *s, int c, int x,
                                     int y, int n, int16_t *value)
{
    const int side = 1 << s->stone->header->side_log2;
    int done = 0, any = 0;

    if (y < 0 || y >= s->height) {
        if (!s->is_ball)
            return 0;
        y = y < 0 ? -1 - y : 2 * s->height - 1 - y;
        x += s->width / 2;
    }
    for (int i = 0; i < n; i++)
        value[i] = 0;
    while (done < n) {
        const int at = x + done;
        const int more = q_smaller(n - done, side - (at & (side - 1)));

        if (s->is_ball)
            set_entering_light_of_run(s, c, at & (s->width - 1), y, more,
                                      value + done);
        else if (at >= 0 && at < s->width)
            set_entering_light_of_run(s, c, at, y, more, value + done);
        done += more;
    }
    for (int i = 0; i < n; i++)
        any |= value[i];
    return any;
}

/* Stores the entering light of rows Y .. Y + N_ROWS - 1 as pairs of
 * neighbouring texels, for the strip that begins at column X0. */
static void store_light_rows_as_pairs(const struct glint_spread *s, int c,
                                      int x0, int y, int n_rows,
                                      struct glint_spread_scratch *scratch)
{
    const int kernel = (int)s->stone->header->kernel;
    const int n = GLINT_STRIP + kernel - 1;
    int16_t value[MOST_ROW];

    for (int i = 0; i < n_rows; i++) {
        int32_t *pair = scratch->pair + (ptrdiff_t)i * (n + 1);

        scratch->any[i] =
            set_entering_light_of_row(s, c, x0 - kernel / 2, y + i, n, value);
        if (!scratch->any[i])
            continue;
        value[n] = value[n + 1] = 0;
        for (int k = 0; k <= n; k++)
            pair[k] = glint_pack_int16_pair(value[k], value[k + 1]);
    }
}

/* ------------------------------------------------------------ convolutions */

/* Sets SUM to the horizontal convolution of the entering light of row I. */
static void convolve_light_row(const struct glint_spread *s,
                               const struct glint_spread_scratch *scratch,
                               int i, const struct glint_spread_taps *taps,
                               int32_t sum[GLINT_STRIP])
{
    const int stride = GLINT_STRIP + (int)s->stone->header->kernel;

    for (int k = 0; k < GLINT_STRIP; k++)
        sum[k] = 0;
    if (scratch->any[i])
        s->convolve(sum, scratch->pair + (ptrdiff_t)i * stride, 2, taps->row,
                    taps->n, GLINT_STRIP);
}

/* Convolves N pairs of rows horizontally with TAPS, and stores the results in
 * VALUE. */
static void convolve_pairs_of_light_rows(
    const struct glint_spread *s, const struct glint_spread_scratch *scratch,
    const struct glint_spread_taps *taps, int n, int32_t *value)
{
    const int shift = taps->shift;
    const int32_t half = (1 << shift) >> 1;

    for (int i = 0; i < n; i++, value += GLINT_STRIP) {
        int32_t sum[2][GLINT_STRIP];

        for (int k = 0; k < 2; k++)
            convolve_light_row(s, scratch, 2 * i + k, taps, sum[k]);
        for (int k = 0; k < GLINT_STRIP; k++)
            value[k] = glint_pack_int16_pair((sum[0][k] + half) >> shift,
                                             (sum[1][k] + half) >> shift);
    }
}

/* Adds the vertical convolution of VALUE to SUM, the rows of the strip from Y0
 * down. */
static void add_convolved_columns(const struct glint_spread *s,
                                  const struct glint_spread_taps *taps,
                                  const int32_t *value, int rows, int32_t *sum)
{
    for (int y = 0; y < rows; y++)
        s->convolve(sum + (ptrdiff_t)y * GLINT_STRIP,
                    value + (ptrdiff_t)(y / 2) * GLINT_STRIP, GLINT_STRIP,
                    y & 1 ? taps->odd : taps->even, taps->n, GLINT_STRIP);
}

/* ------------------------------------------------------------------ planes */

/* Returns whether plane P of the kernel applies to any texel of the strip. In a
 * clustered medium, plane P applies only to the texels of cluster P. */
static int does_strip_use_kernel_plane(const struct glint_spread *s, uint32_t p,
                                       int x0, int y0, int y1)
{
    const int log2 = (int)s->stone->header->side_log2, mask = (1 << log2) - 1;

    if (!s->stone->cluster)
        return 1;
    for (int y = y0; y < y1; y++)
        for (int i = 0; i < GLINT_STRIP; i++)
            if (s->stone->cluster[((y & mask) << log2) + (x0 & mask) + i] == p)
                return 1;
    return 0;
}

/* Adds SUM, the convolution by plane P of row Y, times the plane's weight at
 * each texel, to TOTAL. The magnitudes of the sums of all planes add up to less
 * than 2^31, so TOTAL does not overflow. */
static void add_plane_sum_times_weights(const struct glint_spread *s, int c,
                                        uint32_t p, int x0, int y,
                                        const int32_t *sum, int32_t *total)
{
    const struct glint_translucent *t = s->stone;
    const int log2 = (int)t->header->side_log2, mask = (1 << log2) - 1;
    const size_t table = t->header->variant == GLINT_TRANSLUCENT_FACTORED
                             ? (size_t)c * t->header->n_planes + p
                             : (size_t)c;
    const struct codes f = find_codes_in_table_row(t, table, x0, y);
    const int32_t half = 1 << (f.bits - 1);

    if (t->cluster) {
        const uint8_t *of = t->cluster + ((y & mask) << log2) + (x0 & mask);

        for (int i = 0; i < GLINT_STRIP; i++)
            total[i] = of[i] == p ? ((sum[i] + half) >> f.bits) *
                                        read_code_of_texel(&f, i)
                                  : total[i];
    } else if (f.is_signed) {
        const int8_t *code = (const int8_t *)f.at;

        for (int i = 0; i < GLINT_STRIP; i++)
            total[i] += ((sum[i] + half) >> f.bits) * code[i];
    } else {
        for (int i = 0; i < GLINT_STRIP; i++)
            total[i] += ((sum[i] + half) >> f.bits) * read_code_of_texel(&f, i);
    }
}

/* Adds the light that plane P of the kernel spreads to scratch->total. */
static void spread_light_by_kernel_plane(const struct glint_spread *s, int c,
                                         uint32_t p, int x0, int y0, int y1,
                                         struct glint_spread_scratch *scratch)
{
    const struct glint_translucent_header *h = s->stone->header;
    const int rows = y1 - y0, n = (rows + (int)h->kernel) / 2;

    for (int i = 0; i < rows * GLINT_STRIP; i++)
        scratch->sum[i] = 0;
    for (uint32_t r = 0; r < h->rank; r++) {
        struct glint_spread_taps *taps = scratch->taps;

        store_taps_as_pairs(
            s->stone, ((uint32_t)c * h->n_planes + p) * h->rank + r, taps);
        convolve_pairs_of_light_rows(s, scratch, taps, n, scratch->value);
        add_convolved_columns(s, taps, scratch->value, rows, scratch->sum);
    }
    for (int y = 0; y < rows; y++)
        add_plane_sum_times_weights(
            s, c, p, x0, y0 + y, scratch->sum + (ptrdiff_t)y * GLINT_STRIP,
            scratch->total + (ptrdiff_t)y * GLINT_STRIP);
}

/* ------------------------------------------------------------------ strips */

/* Sets a row of the map to TOTAL times the medium's gain; negative values
 * become 0. */
static void write_map_row(const struct glint_spread *s, int c, int x0, int y,
                          const int32_t *total)
{
    const struct glint_real gain = s->stone->header->gain[c];
    const int down = -gain.exponent;
    int16_t *map = s->map[c] + (ptrdiff_t)y * s->width + x0;

    for (int i = 0; i < GLINT_STRIP; i++) {
        const int64_t m = total[i] > 0 && down < 62
                              ? q_shift((int64_t)total[i] * gain.mantissa, down)
                              : 0;

        map[i] = (int16_t)q_clamp_sat(m, 0, MOST_VALUE);
    }
}

void glint_spread_light_in_strip(const struct glint_spread *spread, int c,
                                 int x0, int y0, int y1,
                                 struct glint_spread_scratch *scratch)
{
    const struct glint_translucent_header *h = spread->stone->header;
    const int kernel = (int)h->kernel, rows = y1 - y0;

    for (int i = 0; i < rows * GLINT_STRIP; i++)
        scratch->total[i] = 0;
    store_light_rows_as_pairs(spread, c, x0, y0 - kernel / 2,
                              (rows + kernel) & ~1, scratch);
    for (uint32_t p = 0; p < h->n_planes; p++)
        if (does_strip_use_kernel_plane(spread, p, x0, y0, y1))
            spread_light_by_kernel_plane(spread, c, p, x0, y0, y1, scratch);
    for (int y = 0; y < rows; y++)
        write_map_row(spread, c, x0, y0 + y,
                      scratch->total + (ptrdiff_t)y * GLINT_STRIP);
}
