/* SPDX-License-Identifier: MIT
 *
 * halo_c.c for rows of eight pixels, four at a time. */
#include "kernels/halo.h"

#include <arm_neon.h>

#include "base/q.h"

typedef int32x4_t V;
typedef uint32x4_t U;

#define v_set vdupq_n_s32
#define u_set vdupq_n_u32

/* Members of struct glint_halo in all lanes, and the right shift that makes the
 * squared distances of all pixels fit 31 bits. They are copies, which the light
 * that is written cannot change. */
struct constants {
    int64x2_t by;
    U inner;
    V shift_log2_q16, reach_q8, reach_log2_q16, log2_q16[3];
};

/* Returns A B / 2^16, rounded; 0 <= A B < 2^32. */
static inline U u_times_q16(U a, U b)
{
    return vrshrq_n_u32(vmulq_u32(a, b), 16);
}

/* Returns q_log2_q16(X); X > 0. */
static inline V compute_log2_q16(U x)
{
    const V zeros = vreinterpretq_s32_u32(vclzq_u32(x));
    const U f = vandq_u32(vshrq_n_u32(vshlq_u32(x, zeros), 15), u_set(65535));
    U bend = vsubq_u32(u_set(Q_CONST(0.1463143, 16)),
                       u_times_q16(f, u_set(Q_CONST(0.0440047, 16))));

    bend = vsubq_u32(u_set(Q_CONST(0.2660299, 16)), u_times_q16(f, bend));
    bend = vsubq_u32(u_set(Q_CONST(0.4417403, 16)), u_times_q16(f, bend));
    bend = u_times_q16(u_times_q16(f, vsubq_u32(u_set(65536), f)), bend);
    return vaddq_s32(vshlq_n_s32(vsubq_s32(v_set(31), zeros), 16),
                     vreinterpretq_s32_u32(vaddq_u32(f, bend)));
}

static inline struct constants set_constants(const struct glint_halo *h)
{
    const int32_t side_q8 = (GLINT_HALO_SIDE - 1) * 256;
    const int64_t x = q_larger(-h->dx_q8, h->dx_q8 + side_q8);
    const int64_t y = q_larger(-h->dy_q8, h->dy_q8 + side_q8);
    const uint64_t far = (uint64_t)(x * x + y * y);
    const int bits = bit_length(far > h->inner_q16 ? far : h->inner_q16);
    const int shift = bits > 31 ? bits - 31 : 0;

    return (struct constants){
        vdupq_n_s64(-shift),
        u_set((uint32_t)(h->inner_q16 >> shift)),
        v_set((shift - 16) * 65536),
        v_set(h->reach_q8),
        v_set(h->reach_log2_q16),
        {v_set(h->log2_q16[0]), v_set(h->log2_q16[1]), v_set(h->log2_q16[2])}};
}

/* Sets V to the distances of the pixels of row Y from the nearest line. Returns
 * the smallest. */
static inline int32_t compute_line_distances(const struct glint_halo *h, int y,
                                             V v_q8[2])
{
    int32x2_t least;

    v_q8[0] = v_q8[1] = v_set(INT32_MAX);
    for (int k = 0; k < h->n_lines; k++) {
        const int64_t first = h->v_q38[k] + y * 256 * (int64_t)h->cos_q30[k];
        const int64_t fall = 256 * (int64_t)h->sin_q30[k];
        const int64x2_t two = vdupq_n_s64(2 * fall);
        int64x2_t here = vcombine_s64(vcreate_s64((uint64_t)first),
                                      vcreate_s64((uint64_t)(first - fall)));

        for (int i = 0; i < 2; i++) {
            const int64x2_t next = vsubq_s64(here, two);
            const V v =
                vcombine_s32(vshrn_n_s64(here, 30), vshrn_n_s64(next, 30));

            v_q8[i] = vminq_s32(v_q8[i], vabsq_s32(v));
            here = vsubq_s64(next, two);
        }
    }
    least = vmin_s32(vmin_s32(vget_low_s32(v_q8[0]), vget_high_s32(v_q8[0])),
                     vmin_s32(vget_low_s32(v_q8[1]), vget_high_s32(v_q8[1])));
    return vget_lane_s32(vpmin_s32(least, least), 0);
}

/* Returns log2 (_q16) of the squared distances from the lamp, pixels, of four
 * pixels, the first at DX. Y2: square of their DY. */
static inline V compute_r2_log2_q16(const struct constants *h, int32_t dx_q8,
                                    int64_t y2_q16)
{
    static const int32_t pixel_q8[4] = {0, 256, 512, 768};
    const V dx = vaddq_s32(v_set(dx_q8), vld1q_s32(pixel_q8));
    const int64x2_t y2 = vdupq_n_s64(y2_q16);
    const int32x2_t a = vget_low_s32(dx), b = vget_high_s32(dx);
    const int64x2_t left = vshlq_s64(vmlal_s32(y2, a, a), h->by);
    const int64x2_t right = vshlq_s64(vmlal_s32(y2, b, b), h->by);
    const U r2 =
        vreinterpretq_u32_s32(vcombine_s32(vmovn_s64(left), vmovn_s64(right)));

    return vaddq_s32(compute_log2_q16(vmaxq_u32(r2, h->inner)),
                     h->shift_log2_q16);
}

/* Adds the entries at FROM and in the next row, and their neighbours, times
 * WEIGHT. SUM[0]: of three channels and of no meaning; SUM[1]: of no meaning
 * and of three channels. Six values of each row are read. */
static inline void add_table_entries(const uint16_t *from, uint16x4_t weight,
                                     U sum[2])
{
    const uint16_t *const below = from + 3 * GLINT_STAR_HALO_COLUMNS;

    sum[0] = vmlal_lane_u16(sum[0], vld1_u16(from), weight, 0);
    sum[1] = vmlal_lane_u16(sum[1], vld1_u16(from + 2), weight, 1);
    sum[0] = vmlal_lane_u16(sum[0], vld1_u16(below), weight, 2);
    sum[1] = vmlal_lane_u16(sum[1], vld1_u16(below + 2), weight, 3);
}

/* Returns the fractional index X clamped to 0 .. LAST, LAST excluded. */
static inline U clamp_index(V x_q16, int last)
{
    return vreinterpretq_u32_s32(
        vminq_s32(vmaxq_s32(x_q16, v_set(0)), v_set((last << 16) - 1)));
}

/* Sets SUM to the interpolated entries of the tables, of three channels and one
 * value of no meaning per pixel. */
static inline void interpolate_tables(const struct glint_halo *h, U row,
                                      U column, uint32_t sum_q26[4][4])
{
    const U down = vandq_u32(vshrq_n_u32(row, 1), u_set(32767));
    const U right = vandq_u32(vshrq_n_u32(column, 1), u_set(32767));
    const U both = vshrq_n_u32(vmulq_u32(down, right), 15);
    U weight[4] = {
        vsubq_u32(vaddq_u32(u_set(32768), both), vaddq_u32(down, right)),
        vsubq_u32(right, both), vsubq_u32(down, both), both};
    uint16x4x4_t near, far;
    uint16_t near_q15[4][4], far_q15[4][4];
    uint32_t at[4];

    vst1q_u32(at,
              vmlaq_n_u32(vmulq_n_u32(vshrq_n_u32(column, 16), 3),
                          vshrq_n_u32(row, 16), 3 * GLINT_STAR_HALO_COLUMNS));
    for (int k = 0; k < 4; k++) {
        const U next =
            vshrq_n_u32(vmulq_n_u32(weight[k], (uint32_t)h->next_q15), 15);

        near.val[k] = vmovn_u32(vsubq_u32(weight[k], next));
        far.val[k] = vmovn_u32(next);
    }
    vst4_u16(near_q15[0], near);
    vst4_u16(far_q15[0], far);
    for (int x = 0; x < 4; x++) {
        U sum[2] = {u_set(0), u_set(0)};

        add_table_entries(&h->table[0][0][0] + at[x], vld1_u16(near_q15[x]),
                          sum);
        if (h->next_q15 > 0)
            add_table_entries(&h->next[0][0][0] + at[x], vld1_u16(far_q15[x]),
                              sum);
        vst1q_u32(sum_q26[x], vaddq_u32(sum[0], vextq_u32(sum[1], sum[1], 1)));
    }
}

/* Adds 2^X to LIGHT. */
static inline void add_exp2(V x_q16, int64_t *light_q20)
{
    const U f = vandq_u32(vreinterpretq_u32_s32(x_q16), u_set(65535));
    /* Shifts by negative numbers are to the right. */
    const V whole = vmaxq_s32(vshrq_n_s32(x_q16, 16), v_set(-32));
    U bend = vaddq_u32(u_set(Q_CONST(0.0654388, 16)),
                       u_times_q16(f, u_set(Q_CONST(0.0136865, 16))));
    V y;

    bend = vaddq_u32(u_set(Q_CONST(0.3070043, 16)), u_times_q16(f, bend));
    bend = u_times_q16(u_times_q16(f, vsubq_u32(u_set(65536), f)), bend);
    y = vreinterpretq_s32_u32(vsubq_u32(vaddq_u32(u_set(65536), f), bend));
    vst1q_s64(light_q20, vaddq_s64(vld1q_s64(light_q20),
                                   vshlq_s64(vmovl_s32(vget_low_s32(y)),
                                             vmovl_s32(vget_low_s32(whole)))));
    vst1q_s64(light_q20 + 2,
              vaddq_s64(vld1q_s64(light_q20 + 2),
                        vshlq_s64(vmovl_s32(vget_high_s32(y)),
                                  vmovl_s32(vget_high_s32(whole)))));
}

/* Adds the light of four pixels. */
static inline void add_light(const struct glint_halo *h,
                             const struct constants *all, V r2_log2_q16, V v_q8,
                             int64_t *light_q20)
{
    const V column_q16 =
        vsubq_s32(compute_log2_q16(vreinterpretq_u32_s32(
                      vaddq_s32(vshlq_n_s32(v_q8, 2), all->reach_q8))),
                  all->reach_log2_q16);
    const V row_q16 = vsubq_s32(r2_log2_q16, v_set(4 * 65536));
    uint32_t sum_q26[4][4];
    uint32x4x4_t sum;

    interpolate_tables(
        h, clamp_index(vshlq_n_s32(row_q16, 1), GLINT_STAR_HALO_ROWS - 1),
        clamp_index(vshlq_n_s32(column_q16, 2), GLINT_STAR_HALO_COLUMNS - 1),
        sum_q26);
    sum = vld4q_u32(sum_q26[0]);
    for (int c = 0; c < 3; c++) {
        const V table_q16 =
            vreinterpretq_s32_u32(vshlq_n_u32(vshrq_n_u32(sum.val[c], 15), 5));

        add_exp2(vminq_s32(vsubq_s32(vaddq_s32(table_q16, all->log2_q16[c]),
                                     r2_log2_q16),
                           v_set(34 * 65536)),
                 light_q20 + c * GLINT_HALO_CHANNEL);
    }
}

void glint_halo_neon(const struct glint_halo *h, int n_x, int n_y,
                     int64_t *light_q20)
{
    const struct constants all = set_constants(h);

    (void)n_x;
    for (int y = 0; y < n_y; y++) {
        const int64_t dy_q8 = h->dy_q8 + 256 * y;
        V v_q8[2];

        if (compute_line_distances(h, y, v_q8) > h->width_q8)
            continue;
        for (int i = 0; i < 2; i++)
            add_light(
                h, &all,
                compute_r2_log2_q16(&all, h->dx_q8 + 1024 * i, dy_q8 * dy_q8),
                v_q8[i], light_q20 + y * GLINT_HALO_STRIDE + 4 * i);
    }
}

/* Returns four values of light divided by 16 and clamped to 0 .. 65535, and
 * sets them to 0. */
static inline uint16x4_t take_clamped_light(int64_t *light_q20)
{
    const uint32x2_t left = vqshrun_n_s64(vld1q_s64(light_q20), 4);
    const uint32x2_t right = vqshrun_n_s64(vld1q_s64(light_q20 + 2), 4);

    vst1q_s64(light_q20, vdupq_n_s64(0));
    vst1q_s64(light_q20 + 2, vdupq_n_s64(0));
    return vqmovn_u32(vcombine_u32(left, right));
}

int glint_move_light_neon(int64_t *light_q20, int n, uint16_t *light_q16)
{
    uint16x4_t any = vdup_n_u16(0);

    for (int i = 0; i < n; i += 4) {
        const uint16x4_t x = take_clamped_light(light_q20 + i);

        vst1_u16(light_q16 + i, x);
        any = vorr_u16(any, x);
    }
    return vget_lane_u64(vreinterpret_u64_u16(any), 0) != 0;
}
