/* SPDX-License-Identifier: MIT
 *
 * Computes the half vectors that sample a material's lobe, and the
 * environment's mip levels that each sample reads.
 *
 * The lobe has the widths (alphas) ax and ay along the two tangents. Sample k
 * of n has u = (k + 1/2) / n, and v has the bits of k in reverse. The slopes of
 * its half vector are sqrt(-ln u) (ax cos 2 pi v, ay sin 2 pi v) [Ward92].
 *
 * Rule with constant footprints: the mip level already blurs the reflected
 * direction by a fraction f = kappa / n of the lobe. Its variance is 2 b (h.o),
 * b = f ax ay, with h the half vector and o the direction to the eye. The
 * slopes are centred and have the rest of the variance. There are two
 * candidates for it. (alpha^2 - b) / 2 adds up to the lobe along each axis, but
 * if one alpha is small, all slopes lie on a line. (1 - f) alpha^2 / 2 gives
 * the shape of the lobe, but blurred, as the blur of a level is isotropic. The
 * mean of both is used, which is more accurate than either if alphas differ.
 *
 * Published rule: a sample has the solid angle 4 ax ay (h.o) (h.n)^3 pi / (n
 * u), with n in h.n the normal. */
#include "base/divide.h"
#include "base/log2.h"
#include "glint/scene/ward.h"
#include "kernels/ward/texels.h"
#include "kernels/ward/ward.h"
#include "scene/vector.h"

enum { ONE_Q16 = 1 << 16, LN2_Q16 = 45426, TWO_OVER_PI_Q16 = 41722 };

/* sin 2 pi k / 32 */
static const int32_t sine_q30[9] = {0,         209476638,  410903207,
                                    596538995, 759250125,  892783698,
                                    992008094, 1053110176, 1073741824};

static int32_t compute_sine(unsigned k)
{
    const unsigned of_half = k & 15;
    const int32_t s = sine_q30[of_half > 8 ? 16 - of_half : of_half];

    return k & 16 ? -s : s;
}

static unsigned reverse_bits(unsigned k)
{
    return (k & 1) << 4 | (k & 2) << 2 | (k & 4) | (k & 8) >> 2 | k >> 4;
}

/* Sets SLOPE_Q16 to the slopes of N sampled half vectors for a lobe with alphas
 * of 1. */
static void compute_sample_slopes(int n,
                                  int32_t slope_q16[GLINT_WARD_SAMPLES][2])
{
    for (int k = 0; k < n; k++) {
        const int32_t log2_q16 =
            q_log2_q16(2 * (uint64_t)n) - q_log2_q16(2 * (uint64_t)k + 1);
        const int32_t length_q16 = (int32_t)glint_compute_square_root(
            (uint64_t)(uint32_t)log2_q16 *
            LN2_Q16); /* square root of a _q32 number */
        const unsigned turn = reverse_bits((unsigned)k);

        slope_q16[k][0] = q_mul(length_q16, compute_sine((turn + 8) & 31), 30);
        slope_q16[k][1] = q_mul(length_q16, compute_sine(turn), 30);
    }
}

/* Returns the footprint f of each of N samples, q16: kappa / N. kappa is 1,
 * 1.4, 2, 2 and 3 for 1, 4, 8, 16 and 32 samples, and is interpolated linearly
 * between them. */
static int32_t compute_footprint_of_sample_q16(int n)
{
    static const int32_t at[5] = {1, 4, 8, 16, 32};
    static const int32_t kappa_q16[5] = {65536, 91750, 131072, 131072, 196608};
    int i = 0;

    while (i < 3 && n > at[i + 1])
        i++;
    return (kappa_q16[i] + (kappa_q16[i + 1] - kappa_q16[i]) * (n - at[i]) /
                               (at[i + 1] - at[i])) /
           n;
}

/* Shifts and scales the slopes of N samples along AXIS, so that their mean is 0
 * and their mean square is WANT, q32. */
static void normalise_sample_slopes(int n, int axis, uint32_t want_q32,
                                    int32_t slope_q16[GLINT_WARD_SAMPLES][2])
{
    int64_t sum_q16 = 0;
    uint64_t square_q32 = 0;
    uint32_t by_q16;

    for (int k = 0; k < n; k++)
        sum_q16 += slope_q16[k][axis];
    for (int k = 0; k < n; k++) {
        slope_q16[k][axis] -= (int32_t)sum_q16 / n;
        square_q32 +=
            (uint64_t)((int64_t)slope_q16[k][axis] * slope_q16[k][axis]);
    }
    square_q32 /= (uint64_t)n;
    /* With few samples the slopes along one axis may all be 0. */
    by_q16 = square_q32 >> 24
                 ? glint_compute_square_root((uint64_t)want_q32 *
                                             (UINT64_C(1) << 32) / square_q32)
                 : 0;
    for (int k = 0; k < n; k++)
        slope_q16[k][axis] = q_mul(slope_q16[k][axis], (int32_t)by_q16, 16);
}

/* Returns b, the variance by which a constant footprint F_Q16 blurs slopes,
 * clamped to 3/4 of the square of the smaller alpha. */
static uint64_t compute_variance_of_slope_blur_q48(const int32_t alpha_q24[2],
                                                   int32_t f_q16)
{
    const uint64_t smaller = (uint64_t)q_smaller(alpha_q24[0], alpha_q24[1]);
    const uint64_t max_q48 = smaller * smaller / 4 * 3;
    const uint64_t even_q48 = (uint64_t)alpha_q24[0] * (uint64_t)alpha_q24[1];
    const uint64_t b_q48 = (even_q48 >> 16) * (uint64_t)f_q16;

    return b_q48 < max_q48 ? b_q48 : max_q48;
}

/* Returns twice the variance that sampled slopes must have along an axis with
 * ALPHA, divided by alpha^2. B and F: see the top of this file. */
static int32_t compute_slope_variance_ratio_q16(int32_t alpha_q24,
                                                uint64_t b_q48, int32_t f_q16)
{
    const uint64_t square_q48 = (uint64_t)alpha_q24 * (uint64_t)alpha_q24;
    const int32_t matched_q16 =
        ONE_Q16 - (b_q48 < square_q48
                       ? q_divide_to_fraction_q30(b_q48, square_q48) >> 14
                       : ONE_Q16);

    return (ONE_Q16 - f_q16 + matched_q16) / 2;
}

/* Sets the span of sample K, by which its mip level is chosen, to X * 2^LOG2.
 * Then enlarges it by BIAS_Q8 / 256 levels. X must be at least 1. */
static void set_span_of_sample(struct glint_ward_lobe *lobe, int k, uint64_t x,
                               int log2, int32_t bias_q8)
{
    const int32_t more_q16 = bias_q8 * 512;
    const int cut = bit_length(x) - 31;
    const uint64_t part_q30 = cut > 0 ? x >> cut : x << -cut;
    const uint64_t span =
        part_q30 * (uint64_t)q_exp2_q16(more_q16 & 0xffff) >> 16;
    const int bits = bit_length(span | 1 << 15); /* 31 or 32 */

    lobe->span_q14[k] = (int32_t)(span >> (bits - 15));
    lobe->span_log2[k] = log2 + cut + bits - 1 + (more_q16 >> 16);
}

static void set_half_vector(struct glint_ward_lobe *lobe, int k,
                            const int32_t slope_q16[2],
                            const int32_t alpha_q24[2])
{
    const int64_t v[3] = {(int64_t)alpha_q24[0] * slope_q16[0],
                          (int64_t)alpha_q24[1] * slope_q16[1],
                          INT64_C(1) << 40};
    int32_t half_q30[3];

    glint_normalise_vector(v, half_q30);
    for (int j = 0; j < 3; j++)
        lobe->half_q14[j][k] = (int32_t)q_shift(half_q30[j], 16);
    lobe->factor_q14[k] =
        q_mul(q_mul(lobe->half_q14[2][k], lobe->half_q14[2][k], 14),
              lobe->half_q14[2][k], 14);
}

/* Sets the spans of all samples. A texel of level 0 has a solid angle of 4 pi /
 * side^2. Level 0 blurs light by a quarter of that, as a variance. */
static void set_spans_of_all_samples(struct glint_ward_lobe *lobe, int n,
                                     const int32_t alpha_q24[2], uint64_t b_q48,
                                     const struct glint_ward_options *options,
                                     int side_log2)
{
    const uint64_t even_q32 =
        (uint64_t)alpha_q24[0] * (uint64_t)alpha_q24[1] >> 16;

    for (int k = 0; k < n; k++) {
        if (options->rule == GLINT_WARD_CONSTANT)
            set_span_of_sample(lobe, k, (b_q48 >> 8) * TWO_OVER_PI_Q16,
                               2 * side_log2 - 56, options->bias_q8);
        else
            set_span_of_sample(lobe, k,
                               (uint64_t)q_divide((int64_t)(even_q32 << 8) *
                                                      lobe->factor_q14[k],
                                                  2 * k + 1),
                               2 * side_log2 + 1 - 54, options->bias_q8);
    }
}

void glint_ward_defaults(struct glint_ward_options *options)
{
    *options =
        (struct glint_ward_options){.samples = 8, .rule = GLINT_WARD_CONSTANT};
}

int glint_ward_hold(int32_t alpha_q24[2])
{
    int held = 0;

    for (int k = 0; k < 2; k++) {
        const int32_t least =
            (alpha_q24[1 - k] + GLINT_WARD_RATIO - 1) / GLINT_WARD_RATIO;

        held |= alpha_q24[k] < least;
        alpha_q24[k] = q_larger(alpha_q24[k], least);
    }
    return held;
}

int glint_ward_prepare(struct glint_ward_lobe *lobe,
                       const struct glint_environment *environment,
                       const struct glint_ward_material *material,
                       const struct glint_ward_options *options)
{
    const struct glint_environment_header *h = environment->header;
    const int n = options->samples;
    const int32_t f_q16 = compute_footprint_of_sample_q16(n);
    int32_t alpha_q24[2] = {material->alpha_q24[0], material->alpha_q24[1]};
    int32_t slope_q16[GLINT_WARD_SAMPLES][2];
    const int held = glint_ward_hold(alpha_q24);
    const uint64_t b_q48 = compute_variance_of_slope_blur_q48(alpha_q24, f_q16);

    *lobe =
        (struct glint_ward_lobe){.sum = glint_choose_ward_kernel(options->sets),
                                 .n = n,
                                 .norm = material->norm,
                                 .unit_log2 = h->unit_log2,
                                 .share_q16 = ((1 << 16) + n / 2) / n};
    compute_sample_slopes(n, slope_q16);
    for (int j = 0; j < 2 && options->rule == GLINT_WARD_CONSTANT; j++)
        normalise_sample_slopes(n, j,
                                (uint32_t)compute_slope_variance_ratio_q16(
                                    alpha_q24[j], b_q48, f_q16)
                                    << 15,
                                slope_q16);
    for (int k = 0; k < 3; k++)
        lobe->specular_q15[k] = material->specular_q15[k];
    for (int k = 0; k < n; k++)
        set_half_vector(lobe, k, slope_q16[k], alpha_q24);
    for (int k = n; k < GLINT_WARD_SAMPLES; k++)
        lobe->half_q14[2][k] = -(1 << 14);
    set_spans_of_all_samples(lobe, n, alpha_q24, b_q48, options,
                             (int)h->side_log2);
    return held;
}
