/* SPDX-License-Identifier: MIT */
#include "lamps/unclip.h"

#include "base/divide.h"
#include "base/log2.h"

#define ONE_Q16       (1 << 16)
#define MAX_POWER_Q16 (INT64_C(1) << 42)

enum {
    LEVELS = GLINT_PROFILE_LEVELS,
    SHOWN = 5 /* the last level whose light counts to what is seen */
};

/* ------------------------------------------------------------------- colour */

static int64_t luminance(const int64_t v[3])
{
    return (v[0] * Q_CONST(0.2126, 15) + v[1] * Q_CONST(0.7152, 15) +
            v[2] * Q_CONST(0.0722, 15)) >>
           15;
}

/* What is clipped counts 1/64: the fringe decides where there is one worth the
 * name, and white comes out where everything is clipped to white, without a
 * step in between. */
static void set_colour(struct glint_spot *spot,
                       const struct glint_profile_sums *sums)
{
    int64_t v[3], y;
    int down = 0;

    for (int c = 0; c < 3; c++) {
        v[c] = 63 * sums->of[c].fringe_q16 + sums->of[c].white_q16;
        v[c] = v[c] > 0 ? v[c] : 0;
        down = bit_length((uint64_t)v[c]) - 44 > down
                   ? bit_length((uint64_t)v[c]) - 44
                   : down;
    }
    for (int c = 0; c < 3; c++)
        v[c] >>= down & 31; /* 20 at most */
    y = luminance(v);
    for (int c = 0; c < 3 && y > 0; c++)
        spot->rgb_q15[c] = q_clamp_sat(q_divide(v[c] << 15, y), 0, 1 << 20);
}

/* -------------------------------------------------------------------- power */

/* What a channel shows, and what it is without clipping, as log2 of pixels. */
struct guess {
    int32_t seen_q16, whole_q16;
    int32_t trust_q16;
};

static int32_t log_of_q8(int64_t area_q8)
{
    return q_log2_q16((uint64_t)(area_q8 > 0 ? area_q8 : 0) + 128) -
           8 * ONE_Q16;
}

/* How much of level K counts: all of it where the background is more even than
 * that, none where it has as much itself. */
static int32_t weight_q16(const struct glint_profile_channel *of, int k)
{
    const int32_t spread_q16 =
        q_log2_q16((uint64_t)of->spread_q16 + 66) - 16 * ONE_Q16;

    return k <= 2 ? ONE_Q16
                  : q_clamp_sat(-k * ONE_Q16 - spread_q16, 0, ONE_Q16);
}

/* A step of level k goes from 2^-k to twice that, so that what is above 2^-5 is
 * the sum of the areas times the steps. */
static int64_t flux_q16(const struct glint_profile_channel *of)
{
    int64_t sum_q16 = 0;

    for (int k = 1; k <= SHOWN; k++)
        sum_q16 +=
            q_shift((of->area_q8[k] << (8 - k)) * (weight_q16(of, k) >> 8), 8);
    return sum_q16 + q_shift((of->area_q8[SHOWN] << (8 - SHOWN)) *
                                 (weight_q16(of, SHOWN) >> 8),
                             8);
}

static int32_t radius_q8(int64_t area_q8)
{
    return (int32_t)q_root((uint64_t)(area_q8 + 128) << 8);
}

/* log2 of how many pixels further out than the clipped core the light reaches
 * to LEVEL, -2 .. 6. */
static int32_t width_q16(const struct glint_profile_channel *of, int level)
{
    const int32_t width_q8 =
        radius_q8(of->area_q8[level]) - radius_q8(of->area_q8[0]);
    const int32_t w_q16 =
        q_log2_q16((uint64_t)(width_q8 > 0 ? width_q8 : 0) + 64) - 8 * ONE_Q16;

    return q_clamp_sat(w_q16, -2 * ONE_Q16, 6 * ONE_Q16);
}

/* How many octaves more area than the core there is at LEVEL. */
static int32_t growth_q16(const struct glint_profile_channel *of, int level)
{
    return q_clamp_sat(log_of_q8(of->area_q8[level]) -
                           log_of_q8(of->area_q8[0]),
                       0, 6 * ONE_Q16);
}

/* How many stops over white the clipped core is: the more the steeper the light
 * falls right beside it; the further the halo goes, above a background as even
 * as it is; and the wider the rim, for so large a core. Fitted to what
 * power_table makes (tests/programs), by least absolute error. */
static int32_t stops_q16(const struct glint_profile_channel *of)
{
    const int32_t core_q16 = log_of_q8(of->area_q8[0]);
    const int32_t steep_q16 = growth_q16(of, 2), wide_q16 = width_q16(of, 3);
    const int32_t even_q16 =
        q_log2_q16((uint64_t)of->spread_q16 + 983) - 16 * ONE_Q16;
    const int64_t s_q16 =
        (int64_t)Q_CONST(2.846, 16) - q_mul(steep_q16, Q_CONST(3.511, 16), 16) +
        q_mul(q_mul(steep_q16, growth_q16(of, 3), 16), Q_CONST(0.307, 16), 16) -
        q_mul(q_mul(width_q16(of, LEVELS), even_q16, 16), Q_CONST(0.075, 16),
              16) -
        q_mul(core_q16, Q_CONST(0.075, 16), 16) -
        q_mul(q_mul(core_q16, width_q16(of, 2), 16), Q_CONST(0.223, 16), 16) +
        q_mul(q_mul(wide_q16, wide_q16, 16), Q_CONST(0.500, 16), 16);

    return q_clamp_sat(s_q16, 0, 14 * ONE_Q16);
}

/* What AREA hides if it is STOPS over white: held to MAX_POWER. */
static int64_t hidden_of_q16(int64_t area_q8, int32_t stops_q16)
{
    int32_t area_q16;

    if (area_q8 < 1)
        return 0;
    area_q16 = q_log2_q16((uint64_t)area_q8) - 8 * ONE_Q16;
    return q_exp2_q16(
               q_clamp_sat(area_q16 + stops_q16, -16 * ONE_Q16, 27 * ONE_Q16)) -
           q_exp2_q16(q_clamp_sat(area_q16, -16 * ONE_Q16, 27 * ONE_Q16));
}

static struct guess guess_of(const struct glint_profile_channel *of,
                             int32_t rgb_q15)
{
    const int32_t stops = stops_q16(of);
    const int64_t seen_q16 = flux_q16(of);
    const int64_t hidden_q16 = hidden_of_q16(of->area_q8[0], stops);
    const int32_t base_q16 = q_log2_q16((uint64_t)rgb_q15 + 64) +
                             q_log2_q16((uint64_t)of->scale_q16);
    struct guess g;
    int64_t far_q16;

    g.seen_q16 = q_log2_q16((uint64_t)seen_q16 + 1) - base_q16;
    g.whole_q16 = q_log2_q16((uint64_t)(seen_q16 + hidden_q16) + 1) - base_q16;
    far_q16 = g.whole_q16 - g.seen_q16 + ONE_Q16 / 8;
    g.trust_q16 =
        q_clamp_sat(q_divide((int64_t)rgb_q15 << 18, far_q16), 1, 1 << 26);
    return g;
}

/* The channels each tell how much more there is than is seen; the less of it is
 * hidden the more its word counts. */
static void set_power(struct glint_spot *spot,
                      const struct glint_profile_sums *sums)
{
    int64_t seen = 0, whole = 0, trust = 0, power_q16, flux[3];

    for (int c = 0; c < 3; c++) {
        const struct guess g = guess_of(&sums->of[c], spot->rgb_q15[c]);

        seen += (int64_t)g.seen_q16 * g.trust_q16;
        whole += (int64_t)g.whole_q16 * g.trust_q16;
        trust += g.trust_q16;
        flux[c] = q_divide(flux_q16(&sums->of[c]) << 16, sums->of[c].scale_q16);
    }
    power_q16 = luminance(flux);
    power_q16 += q_exp2_q16((int32_t)q_divide(whole, trust) + 31 * ONE_Q16 -
                            16 * ONE_Q16) -
                 q_exp2_q16((int32_t)q_divide(seen, trust) + 31 * ONE_Q16 -
                            16 * ONE_Q16);
    spot->power_q16 = power_q16 < MAX_POWER_Q16 ? power_q16 : MAX_POWER_Q16;
}

/* ------------------------------------------------------------------- extent */

static int32_t root_q8(int64_t square_q16, int step)
{
    return square_q16 > 0 ? (int32_t)q_root((uint64_t)square_q16) * step : 0;
}

/* The second moments about the centroid, in steps: xx, yy, xy. */
static void list_moments(const struct glint_profile_sums *sums,
                         int64_t m_q16[3])
{
    const int64_t w = sums->w_q16 > 0 ? sums->w_q16 : 1;
    int64_t mean_q16[2];

    for (int i = 0; i < 2; i++)
        mean_q16[i] = q_divide(sums->moment_q16[i] * ONE_Q16, w);
    for (int i = 0; i < 3; i++) {
        const int64_t mean2 = mean_q16[i == 1] * mean_q16[i > 0];

        m_q16[i] = q_divide(sums->square_q16[i] * ONE_Q16, w) - (mean2 >> 16);
    }
}

/* What of the clipped core is the lamp, 0 .. 1: the glare of a small lamp that
 * is far over white is clipped, too, and falls off over as much as its radius;
 * a large lamp has a sharp rim, of a pixel. */
static int32_t lamp_share_q15(const struct glint_profile_sums *sums)
{
    const struct glint_profile_channel *of = &sums->of[0];
    int64_t inner_q8, outer_q8, rim_q8;

    for (int c = 1; c < 3; c++)
        if (sums->of[c].area_q8[0] > of->area_q8[0])
            of = &sums->of[c];
    /* radii of circles, but for the root of pi */
    inner_q8 = q_root((uint64_t)of->area_q8[0] << 8);
    outer_q8 = q_root((uint64_t)of->area_q8[2] << 8);
    rim_q8 = outer_q8 - inner_q8 - Q_CONST(1.7725, 8);
    if (inner_q8 <= 0 || rim_q8 <= 0)
        return 1 << 15;
    return (1 << 15) -
           q_clamp_sat(q_divide(rim_q8 << 16, inner_q8), 0, 1 << 15);
}

/* The semi-axes are the roots of the eigenvalues of the second moments. */
static void set_extent(struct glint_spot *spot,
                       const struct glint_profile_sums *sums)
{
    const int32_t share_q15 = lamp_share_q15(sums);
    int64_t m_q16[3], half, mid, apart, cos2_q15;

    list_moments(sums, m_q16);
    half = (m_q16[0] - m_q16[1]) / 2;
    mid = (m_q16[0] + m_q16[1]) / 2;
    apart = (int64_t)q_root((uint64_t)(half * half + m_q16[2] * m_q16[2]));
    spot->axis_q8[0] = q_mul(root_q8(mid + apart, sums->step), share_q15, 15);
    spot->axis_q8[1] = q_mul(root_q8(mid - apart, sums->step), share_q15, 15);
    cos2_q15 = apart > 0
                   ? q_clamp_sat(q_divide(half * 32768, apart), -32768, 32768)
                   : 32768;
    spot->cos_q15 = (int32_t)q_root((uint64_t)(32768 + cos2_q15) << 14);
    spot->sin_q15 = (int32_t)q_root((uint64_t)(32768 - cos2_q15) << 14);
    if (m_q16[2] < 0)
        spot->sin_q15 = -spot->sin_q15;
}

void glint_unclip(struct glint_spot *spot,
                  const struct glint_profile_sums *sums)
{
    set_colour(spot, sums);
    set_power(spot, sums);
    set_extent(spot, sums);
}
