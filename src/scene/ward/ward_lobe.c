/* SPDX-License-Identifier: MIT
 *
 * Half vectors of a material, and the levels that they read.
 *
 * Sample k of n has u = (k + 1/2) / n and v the bits of k in reverse: slopes
 * sqrt(-ln u) (ax cos 2 pi v, ay sin 2 pi v) [Ward92]. With constant footprints
 * they lose their mean and have variance (1 - f) alpha^2 / 2 along each axis,
 * f = kappa / n; the level read has the other part, sigma^2 = 2 f ax ay (h.o),
 * of the reflected direction. As published a sample has the solid angle
 * 4 ax ay (h.o) (h.n)^3 pi / (n u). */
#include "base/log2.h"
#include "glint/scene/ward.h"
#include "scene/vector.h"

enum { ONE_Q16 = 1 << 16, LN2_Q16 = 45426, LOG2_PI_Q16 = 108232 };

/* sin 2 pi k / 32 */
static const int32_t sine_q30[9] = {0,         209476638,  410903207,
                                    596538995, 759250125,  892783698,
                                    992008094, 1053110176, 1073741824};

static int32_t sine_of(unsigned k)
{
    const unsigned of_half = k & 15;
    const int32_t s = sine_q30[of_half > 8 ? 16 - of_half : of_half];

    return k & 16 ? -s : s;
}

static unsigned reversed(unsigned k)
{
    return (k & 1) << 4 | (k & 2) << 2 | (k & 4) | (k & 8) >> 2 | k >> 4;
}

/* Sets SLOPE_Q16 to the slopes for alphas of 1. */
static void draw(int n, int32_t slope_q16[GLINT_WARD_SAMPLES][2])
{
    for (int k = 0; k < n; k++) {
        const int32_t log2_q16 =
            q_log2_q16(2 * (uint64_t)n) - q_log2_q16(2 * (uint64_t)k + 1);
        const int32_t length_q16 = (int32_t)glint_root(
            (uint64_t)(uint32_t)log2_q16 * LN2_Q16); /* of a q32 */
        const unsigned turn = reversed((unsigned)k);

        slope_q16[k][0] = q_mul(length_q16, sine_of((turn + 8) & 31), 30);
        slope_q16[k][1] = q_mul(length_q16, sine_of(turn), 30);
    }
}

/* Returns f of N samples, q16: kappa is 1, 1.4, 2, 2 and 3 of 1, 4, 8, 16 and
 * 32 samples, and straight between. */
static int32_t footprint_q16(int n)
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

/* Gives the slopes along AXIS mean 0 and the mean square WANT, q32. */
static void settle(int n, int axis, uint32_t want_q32,
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
    /* Too few samples may all lie on the other axis. */
    by_q16 =
        square_q32 >> 24
            ? glint_root((uint64_t)want_q32 * (UINT64_C(1) << 32) / square_q32)
            : 0;
    for (int k = 0; k < n; k++)
        slope_q16[k][axis] = q_mul(slope_q16[k][axis], (int32_t)by_q16, 16);
}

/* Returns log2 of the area of the blur of the constant footprint F_Q16, times 4
 * over that of a texel of side 1: of 4 sigma^2 / (4 pi), but for h.o. */
static int32_t constant_q16(const int32_t alpha_q24[2], int32_t f_q16)
{
    const int64_t smaller = q_smaller(alpha_q24[0], alpha_q24[1]);
    const uint64_t even_q48 = (uint64_t)alpha_q24[0] * (uint64_t)alpha_q24[1];
    const uint64_t most_q48 = (uint64_t)(smaller * smaller) / 4 * 3;
    const uint64_t area_q48 = (even_q48 >> 16) * (uint64_t)f_q16;

    /* 4 * 2 / (4 pi) = 2 / pi */
    return q_log2_q16(area_q48 < most_q48 ? area_q48 : most_q48) - (48 << 16) +
           ONE_Q16 - LOG2_PI_Q16;
}

static void set_half(const int32_t slope_q16[2], const int32_t alpha_q24[2],
                     struct glint_ward_sample *s, int32_t half_q30[3])
{
    const int64_t v[3] = {(int64_t)alpha_q24[0] * slope_q16[0],
                          (int64_t)alpha_q24[1] * slope_q16[1],
                          INT64_C(1) << 40};

    glint_unit(v, half_q30);
    for (int k = 0; k < 3; k++)
        s->half_q14[k] = (int32_t)q_shift(half_q30[k], 16);
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
    const int n = options->samples,
              is_even = options->rule == GLINT_WARD_CONSTANT;
    const int32_t f_q16 = footprint_q16(n);
    const int32_t side_q16 = (int32_t)(environment->header->side_log2 << 17);
    int32_t alpha_q24[2] = {material->alpha_q24[0], material->alpha_q24[1]};
    int32_t slope_q16[GLINT_WARD_SAMPLES][2];
    const int held = glint_ward_hold(alpha_q24);

    *lobe =
        (struct glint_ward_lobe){.n = n,
                                 .nearest = options->nearest,
                                 .norm = material->norm,
                                 .unit_log2 = environment->header->unit_log2,
                                 .share_q16 = (ONE_Q16 + n / 2) / n};
    draw(n, slope_q16);
    for (int axis = 0; axis < 2 && is_even; axis++)
        settle(n, axis, (uint32_t)(ONE_Q16 - f_q16) << 15, slope_q16);
    for (int k = 0; k < 3; k++)
        lobe->specular_q15[k] = material->specular_q15[k];
    for (int k = 0; k < n; k++) {
        struct glint_ward_sample *s = &lobe->sample[k];
        int32_t half_q30[3], area_q16;

        set_half(slope_q16[k], alpha_q24, s, half_q30);
        s->factor_q14 = s->half_q14[2];
        if (material->norm == GLINT_WARD_1992)
            s->factor_q14 = q_mul(q_mul(s->factor_q14, s->factor_q14, 14),
                                  s->half_q14[2], 14);
        if (is_even)
            area_q16 = constant_q16(alpha_q24, f_q16);
        else
            area_q16 =
                q_log2_q16((uint64_t)alpha_q24[0] * (uint64_t)alpha_q24[1]) +
                3 * q_log2_q16((uint64_t)half_q30[2]) -
                q_log2_q16(2 * (uint64_t)k + 1) + (1 << 16) -
                ((48 + 3 * 30) << 16);
        s->level_q8 =
            (int32_t)q_shift(area_q16 + side_q16, 9) + options->bias_q8;
    }
    return held;
}
