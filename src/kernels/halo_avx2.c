/* SPDX-License-Identifier: MIT
 *
 * halo_c.c for rows of eight pixels. */
#include "kernels/halo.h"

#include <immintrin.h>

#include "base/q.h"

typedef __m256i V;

#define v_set   _mm256_set1_epi32
#define v_add   _mm256_add_epi32
#define v_sub   _mm256_sub_epi32
#define v_times _mm256_mullo_epi32
#define v_min   _mm256_min_epi32
#define v_max   _mm256_max_epi32
#define v_left  _mm256_slli_epi32
#define v_right _mm256_srli_epi32
#define v_and   _mm256_and_si256
#define w_add   _mm256_add_epi64
#define w_sub   _mm256_sub_epi64
#define w_set   _mm256_set1_epi64x

/* Two vectors of 64 bits: pixels 0, 1, 4, 5 and pixels 2, 3, 6, 7. */
struct pair {
    V a, b;
};

/* Returns X times the number of each pixel. */
static inline struct pair multiply_by_pixel(int64_t x)
{
    return (struct pair){_mm256_set_epi64x(5 * x, 4 * x, x, 0),
                         _mm256_set_epi64x(7 * x, 6 * x, 3 * x, 2 * x)};
}

/* Returns the lower 32 bits of each pixel, in the order of pixels. */
static inline V join_lower_halves(struct pair p)
{
    return _mm256_castps_si256(_mm256_shuffle_ps(
        _mm256_castsi256_ps(p.a), _mm256_castsi256_ps(p.b), 0x88));
}

/* Returns A B / 2^16, rounded; 0 <= A B < 2^31 - 2^15. */
static inline V v_times_q16(V a, V b)
{
    return v_right(v_add(v_times(a, b), v_set(32768)), 16);
}

/* Returns q_log2_q16(X). Bit lengths of X are LEAST .. MOST, 1 .. 31. */
static inline V compute_log2_q16(V x, int least, int most)
{
    const V one = v_set(65536);
    V n = v_set(least - 1), f, bend;

    for (int bits = least; bits < most; bits++)
        n = v_sub(n, _mm256_cmpgt_epi32(x, v_set((int32_t)((1U << bits) - 1))));
    f = v_and(v_right(_mm256_sllv_epi32(x, v_sub(v_set(31), n)), 15),
              v_set(65535));
    bend = v_sub(v_set(Q_CONST(0.1463143, 16)),
                 v_times_q16(f, v_set(Q_CONST(0.0440047, 16))));
    bend = v_sub(v_set(Q_CONST(0.2660299, 16)), v_times_q16(f, bend));
    bend = v_sub(v_set(Q_CONST(0.4417403, 16)), v_times_q16(f, bend));
    bend = v_times_q16(v_times_q16(f, v_sub(one, f)), bend);
    return v_add(v_add(v_left(n, 16), f), bend);
}

/* Members of struct glint_halo that all rows share, in all lanes. They are
 * copies, which the light that is written cannot change. */
struct constants {
    V width_q8, reach_q8, reach_log2_q16, next_q15, log2_q16[3];
};

static inline struct constants set_constants(const struct glint_halo *h)
{
    return (struct constants){
        v_set(h->width_q8),
        v_set(h->reach_q8),
        v_set(h->reach_log2_q16),
        v_set(h->next_q15),
        {v_set(h->log2_q16[0]), v_set(h->log2_q16[1]), v_set(h->log2_q16[2])}};
}

/* Returns the distances of the pixels of row Y from the nearest line. */
static inline V compute_line_distances(const struct glint_halo *h, int y)
{
    V least = v_set(INT32_MAX);

    for (int k = 0; k < h->n_lines; k++) {
        const V first = w_set(h->v_q38[k] + y * 256 * (int64_t)h->cos_q30[k]);
        struct pair v = multiply_by_pixel(256 * (int64_t)h->sin_q30[k]);

        v.a = _mm256_srli_epi64(w_sub(first, v.a), 30);
        v.b = _mm256_srli_epi64(w_sub(first, v.b), 30);
        least = v_min(least, _mm256_abs_epi32(join_lower_halves(v)));
    }
    return least;
}

/* Returns log2 (_q16) of the squared distances of the pixels from the lamp,
 * pixels. */
static inline V compute_r2_log2_q16(const struct glint_halo *h, int y)
{
    const int64_t dy_q8 = h->dy_q8 + 256 * y, x0 = h->dx_q8, x1 = x0 + 7 * 256;
    const int64_t y2 = dy_q8 * dy_q8, left = x0 * x0, right = x1 * x1;
    const int64_t inner = (int64_t)h->inner_q16;
    const int64_t near = y2 + (x0 < 0 && x1 > 0 ? 0
                               : left < right   ? left
                                                : right);
    const int64_t far = y2 + (left > right ? left : right);
    const int least = bit_length((uint64_t)(near > inner ? near : inner));
    const int most = bit_length((uint64_t)(far > inner ? far : inner));
    const int shift = most > 31 ? most - 31 : 0;
    const __m128i by = _mm_cvtsi32_si128(shift);
    struct pair r2 = multiply_by_pixel(256);

    r2.a = w_add(r2.a, w_set(x0));
    r2.b = w_add(r2.b, w_set(x0));
    r2.a = w_add(_mm256_mul_epi32(r2.a, r2.a), w_set(y2));
    r2.b = w_add(_mm256_mul_epi32(r2.b, r2.b), w_set(y2));
    r2.a = _mm256_srl_epi64(r2.a, by);
    r2.b = _mm256_srl_epi64(r2.b, by);
    return v_add(compute_log2_q16(v_max(join_lower_halves(r2),
                                        v_set((int32_t)(inner >> shift))),
                                  least - shift, most - shift),
                 v_set((shift - 16) * 65536));
}

/* Returns log2 (_q16) of V times 4 plus REACH. */
static inline V compute_column_q16(const struct constants *h, V v_q8)
{
    const V x = v_add(v_left(v_q8, 2), h->reach_q8);
    /* The distance changes by at most a pixel per pixel. */
    const int32_t first = _mm256_cvtsi256_si32(x), range = 4 * (7 * 256 + 1);
    const int32_t least =
        q_larger(first - range, _mm256_cvtsi256_si32(h->reach_q8));

    return v_sub(
        compute_log2_q16(x, bit_length((uint64_t)least),
                         bit_length((uint64_t)first + (uint64_t)range)),
        h->reach_log2_q16);
}

/* Sets SUM to the interpolated entries at the byte offset AT of TABLE and of
 * its next row. WEIGHT: of the entry, the next one, and those of the next row.
 */
static inline void add_table_entries(const glint_star_halo_row *table, V at,
                                     const V weight[4], V sum[3])
{
    const V low = v_set(65535);

    for (int row = 0; row < 2; row++) {
        const int *const from = (const int *)(const void *)table[row];
        const V a = _mm256_i32gather_epi32(from, at, 1);
        const V b = _mm256_i32gather_epi32(from + 1, at, 1);
        const V c = _mm256_i32gather_epi32(from + 2, at, 1);
        const V near = weight[2 * row], far = weight[2 * row + 1];

        sum[0] = v_add(sum[0], v_add(v_times(near, v_and(a, low)),
                                     v_times(far, v_right(b, 16))));
        sum[1] = v_add(sum[1], v_add(v_times(near, v_right(a, 16)),
                                     v_times(far, v_and(c, low))));
        sum[2] = v_add(sum[2], v_add(v_times(near, v_and(b, low)),
                                     v_times(far, v_right(c, 16))));
    }
}

/* Adds 2^X to LIGHT. */
static inline void add_exp2(V x_q16, int64_t *light_q20)
{
    const V f = v_and(x_q16, v_set(65535)), zero = _mm256_setzero_si256();
    const V whole = _mm256_srai_epi32(x_q16, 16);
    V bend = v_add(v_set(Q_CONST(0.0654388, 16)),
                   v_times_q16(f, v_set(Q_CONST(0.0136865, 16))));
    V y;

    bend = v_add(v_set(Q_CONST(0.3070043, 16)), v_times_q16(f, bend));
    y = v_sub(v_add(v_set(65536), f),
              v_times_q16(v_times_q16(f, v_sub(v_set(65536), f)), bend));
    for (int i = 0; i < 2; i++) {
        V *const to = (V *)(void *)(light_q20 + 4 * i);
        const V wide = _mm256_cvtepu32_epi64(i ? _mm256_extracti128_si256(y, 1)
                                               : _mm256_castsi256_si128(y));
        const V by =
            _mm256_cvtepi32_epi64(i ? _mm256_extracti128_si256(whole, 1)
                                    : _mm256_castsi256_si128(whole));
        /* Shifts by 64 or more, among them negative ones, give 0. */
        const V shifted =
            _mm256_or_si256(_mm256_sllv_epi64(wide, by),
                            _mm256_srlv_epi64(wide, w_sub(zero, by)));

        _mm256_storeu_si256(to, w_add(_mm256_loadu_si256(to), shifted));
    }
}

static inline void add_row(const struct glint_halo *h,
                           const struct constants *all, int y, V v_q8,
                           int64_t *light_q20)
{
    const V zero = _mm256_setzero_si256(), part = v_set(32767);
    const V r2_log2_q16 = compute_r2_log2_q16(h, y);
    const V row =
        v_min(v_max(v_left(v_sub(r2_log2_q16, v_set(4 * 65536)), 1), zero),
              v_set(((GLINT_STAR_HALO_ROWS - 1) << 16) - 1));
    const V column =
        v_min(v_max(v_left(compute_column_q16(all, v_q8), 2), zero),
              v_set(((GLINT_STAR_HALO_COLUMNS - 1) << 16) - 1));
    const V down = v_and(v_right(row, 1), part);
    const V right = v_and(v_right(column, 1), part);
    const V both = v_right(v_times(down, right), 15);
    const V at = v_add(
        v_times(v_right(row, 16), v_set((int)sizeof(glint_star_halo_row))),
        v_times(v_right(column, 16), v_set(6)));
    V weight[4] = {v_sub(v_add(v_set(32768), both), v_add(down, right)),
                   v_sub(right, both), v_sub(down, both), both};
    V sum[3] = {zero, zero, zero};

    if (h->next_q15 > 0) {
        V next[4];

        for (int k = 0; k < 4; k++) {
            next[k] = v_right(v_times(weight[k], all->next_q15), 15);
            weight[k] = v_sub(weight[k], next[k]);
        }
        add_table_entries(h->next, at, next, sum);
    }
    add_table_entries(h->table, at, weight, sum);
    for (int c = 0; c < 3; c++) {
        const V log2_of =
            v_sub(v_add(v_left(v_right(sum[c], 15), 5), all->log2_q16[c]),
                  r2_log2_q16);

        add_exp2(v_min(log2_of, v_set(34 * 65536)),
                 light_q20 + c * GLINT_HALO_CHANNEL);
    }
}

void glint_halo_avx2(const struct glint_halo *h, int n_x, int n_y,
                     int64_t *light_q20)
{
    const struct constants all = set_constants(h);

    (void)n_x;
    for (int y = 0; y < n_y; y++) {
        const V v_q8 = compute_line_distances(h, y);
        const V is_far = _mm256_cmpgt_epi32(v_q8, all.width_q8);

        if (_mm256_movemask_epi8(is_far) != -1)
            add_row(h, &all, y, v_q8, light_q20 + y * GLINT_HALO_STRIDE);
    }
}

/* Returns four values of light clamped to 0 .. 2^20 - 1, and sets them to 0. */
static inline V take_clamped_light(int64_t *light_q20)
{
    V *const at = (V *)(void *)light_q20;
    const V zero = _mm256_setzero_si256(), most = w_set((1 << 20) - 1);
    const V x = _mm256_loadu_si256(at);
    const V positive = _mm256_andnot_si256(_mm256_cmpgt_epi64(zero, x), x);

    _mm256_storeu_si256(at, zero);
    return _mm256_blendv_epi8(positive, most,
                              _mm256_cmpgt_epi64(positive, most));
}

int glint_move_light_avx2(int64_t *light_q20, int n, uint16_t *light_q16)
{
    const V order = _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7);
    __m128i any = _mm_setzero_si128();

    for (int i = 0; i < n; i += 8) {
        const V a = take_clamped_light(light_q20 + i);
        const V b = take_clamped_light(light_q20 + i + 4);
        /* pixels 0, 4, 1, 5, 2, 6, 3, 7 */
        const V both = _mm256_or_si256(a, _mm256_slli_epi64(b, 32));
        const V x = v_right(_mm256_permutevar8x32_epi32(both, order), 4);
        const __m128i packed = _mm_packus_epi32(_mm256_castsi256_si128(x),
                                                _mm256_extracti128_si256(x, 1));

        _mm_storeu_si128((__m128i *)(void *)(light_q16 + i), packed);
        any = _mm_or_si128(any, packed);
    }
    return !_mm_testz_si128(any, any);
}
