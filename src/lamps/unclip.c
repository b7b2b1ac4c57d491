/* SPDX-License-Identifier: MIT */
#include "lamps/unclip.h"

#include "base/divide.h"
#include "base/log2.h"
#include "lamps/unclip_weights.h"

#define ONE_Q16       (1 << 16)
#define MAX_POWER_Q16 (INT64_C(1) << 42)
#define RIM_GLARE     Q_CONST(0.30, 15)
#define RIM_FACE      Q_CONST(0.45, 15)

enum {
    LEVELS = GLINT_PROFILE_LEVELS,
    FEATURES = GLINT_UNCLIP_FEATURES,
    UNITS = GLINT_UNCLIP_UNITS,
    SHOWN = 5 /* darkest brightness level that counts as light of the lamp */
};

/* ------------------------------------------------------------------- colour */

static int64_t compute_luminance(const int64_t v[3])
{
    return (v[0] * Q_CONST(0.2126, 15) + v[1] * Q_CONST(0.7152, 15) +
            v[2] * Q_CONST(0.0722, 15)) >>
           15;
}

/* Sets the colour of SPOT. Clipped light has 1/63 of the weight of the
 * unclipped light around it (fringe): a large fringe determines the colour, and
 * a spot without a fringe becomes white, with a continuous transition. */
static void set_spot_colour(struct glint_spot *spot,
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
        v[c] >>= down & 31; /* at most 20 */
    y = compute_luminance(v);
    for (int c = 0; c < 3 && y > 0; c++)
        spot->rgb_q15[c] = q_clamp_sat(q_divide(v[c] << 15, y), 0, 1 << 20);
}

/* ------------------------------------------------------------------- extent */

static int32_t compute_axis_from_moment_q8(int64_t square_q16, int step)
{
    return square_q16 > 0 ? (int32_t)q_root((uint64_t)square_q16) * step : 0;
}

/* Sets M to the second moments xx, yy, xy of the core about its centroid, in
 * squared sample distances. */
static void compute_central_moments(const struct glint_profile_sums *sums,
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

/* Returns the radius of the lamp / the radius of its clipped core, 0 .. 1. It
 * is estimated from the width of the fall-off around the core. A small lamp far
 * above white has clipped glare around it, which falls off over half of the
 * core's radius or more. A large lamp has a sharp rim, one pixel wide. */
static int32_t
estimate_lamp_radius_by_glare_q15(const struct glint_profile_sums *sums)
{
    const struct glint_profile_channel *of = &sums->of[0];
    int64_t inner_q8, outer_q8, rim_q8;

    for (int c = 1; c < 3; c++)
        if (sums->of[c].area_q8[0] > of->area_q8[0])
            of = &sums->of[c];
    /* Both values are radii of circles, times sqrt(pi), computed from their
     * areas. */
    inner_q8 = q_root((uint64_t)of->area_q8[0] << 8);
    outer_q8 = q_root((uint64_t)of->area_q8[2] << 8);
    rim_q8 = outer_q8 - inner_q8 - Q_CONST(1.7725, 8);
    if (inner_q8 <= 0 || rim_q8 <= 0)
        return 1 << 15;
    return (1 << 15) -
           q_clamp_sat(q_divide(rim_q8 << 16, inner_q8), 0, 1 << 15);
}

/* Returns the radius of the lamp / the radius of its clipped core, 0 .. 1. It
 * is estimated from the rim of a large core. If light drops more at the rim
 * than glare can drop, the complete core is the lamp. Returns 0 for a small
 * core. */
static int32_t
estimate_lamp_radius_by_rim_q15(const struct glint_profile_sums *sums)
{
    const int32_t over_q15 = sums->rim_q15 - RIM_GLARE;

    return q_clamp_sat(over_q15 * 32768 / (RIM_FACE - RIM_GLARE), 0, 1 << 15);
}

/* Semi-axes of the spot, which includes the lamp's glare, from the second
 * moments of its pixels. */
struct axes {
    int32_t major_q8, minor_q8;
    int64_t half, apart; /* half: half of xx - yy; apart: half of the difference
                            between the eigenvalues of the moments */
    int is_down;
};

/* Returns the semi-axes of the spot: the square roots of the eigenvalues of its
 * second moments. */
static struct axes compute_spot_axes(const struct glint_profile_sums *sums)
{
    int64_t m_q16[3], half, mid, apart;

    compute_central_moments(sums, m_q16);
    half = (m_q16[0] - m_q16[1]) / 2;
    mid = (m_q16[0] + m_q16[1]) / 2;
    apart = (int64_t)q_root((uint64_t)(half * half + m_q16[2] * m_q16[2]));
    return (struct axes){compute_axis_from_moment_q8(mid + apart, sums->step),
                         compute_axis_from_moment_q8(mid - apart, sums->step),
                         half, apart, m_q16[2] < 0};
}

static void set_lamp_extent(struct glint_spot *spot,
                            const struct glint_profile_sums *sums)
{
    const struct axes axes = compute_spot_axes(sums);
    const int32_t share_q15 = q_larger(estimate_lamp_radius_by_glare_q15(sums),
                                       estimate_lamp_radius_by_rim_q15(sums));
    int64_t cos2_q15 = 32768;

    spot->axis_q8[0] = q_mul(axes.major_q8, share_q15, 15);
    spot->axis_q8[1] = q_mul(axes.minor_q8, share_q15, 15);
    if (axes.apart > 0)
        cos2_q15 =
            q_clamp_sat(q_divide(axes.half * 32768, axes.apart), -32768, 32768);
    spot->cos_q15 = (int32_t)q_root((uint64_t)(32768 + cos2_q15) << 14);
    spot->sin_q15 = (int32_t)q_root((uint64_t)(32768 - cos2_q15) << 14);
    if (axes.is_down)
        spot->sin_q15 = -spot->sin_q15;
}

/* -------------------------------------------------------------------- power */

static int32_t compute_area_log2(int64_t area_q8)
{
    return q_log2_q16((uint64_t)(area_q8 > 0 ? area_q8 : 0) + 128) -
           8 * ONE_Q16;
}

/* Returns the weight of the area of brightness level K: 1 for levels 1 and 2,
 * and for darker ones if the background's spread is at most half of the level's
 * min light. It falls to 0 where the spread equals that light. */
static int32_t
weigh_brightness_level_q16(const struct glint_profile_channel *of, int k)
{
    const int32_t spread_q16 =
        q_log2_q16((uint64_t)of->spread_q16 + 66) - 16 * ONE_Q16;

    return k <= 2 ? ONE_Q16
                  : q_clamp_sat(-k * ONE_Q16 - spread_q16, 0, ONE_Q16);
}

/* Returns the visible light of a lamp: the sum of u (light above the
 * background, 1 = white) over the pixels of levels up to SHOWN. Level k covers
 * u from 2^-k to 2^(1 - k). The sum of (area of a level) 2^-k is the sum of u -
 * 2^-SHOWN; the area of level SHOWN adds the missing 2^-SHOWN. */
static int64_t compute_shown_flux_q16(const struct glint_profile_channel *of)
{
    int64_t sum_q16 = 0;

    for (int k = 1; k <= SHOWN; k++)
        sum_q16 += q_shift((of->area_q8[k] << (8 - k)) *
                               (weigh_brightness_level_q16(of, k) >> 8),
                           8);
    return sum_q16 + q_shift((of->area_q8[SHOWN] << (8 - SHOWN)) *
                                 (weigh_brightness_level_q16(of, SHOWN) >> 8),
                             8);
}

static int64_t find_max_channel_area_q8(const struct glint_profile_sums *sums,
                                        int level)
{
    int64_t area_q8 = sums->of[0].area_q8[level];

    for (int c = 1; c < 3; c++)
        if (sums->of[c].area_q8[level] > area_q8)
            area_q8 = sums->of[c].area_q8[level];
    return area_q8;
}

static int64_t find_min_clipped_area_q8(const struct glint_profile_sums *sums)
{
    int64_t area_q8 = sums->of[0].area_q8[0];

    for (int c = 1; c < 3; c++)
        if (sums->of[c].area_q8[0] < area_q8)
            area_q8 = sums->of[c].area_q8[0];
    return area_q8;
}

/* Returns the largest channel of the spot's colour at luminance 1, or 0.5 if
 * the spot has no colour. */
static int32_t find_max_colour_channel_q15(const struct glint_spot *spot)
{
    int32_t most = Q_CONST(0.5, 15);

    for (int c = 0; c < 3; c++)
        most = spot->rgb_q15[c] > most ? spot->rgb_q15[c] : most;
    return most;
}

/* Returns the degree to which the codes of the picture resolve LEVEL: 0 if its
 * min light is one code step above the background, 1 from two steps on. */
static int32_t
compute_level_resolution_q16(const struct glint_profile_sums *sums, int level)
{
    int32_t step_q16 = 1;

    for (int c = 0; c < 3; c++)
        if (sums->of[c].step_q16 > step_q16)
            step_q16 = sums->of[c].step_q16;
    return q_clamp_sat((16 - level) * ONE_Q16 - q_log2_q16((uint64_t)step_q16),
                       0, ONE_Q16);
}

/* Sets GROWTH to log2 of (area / area of the core), per level. If codes are as
 * coarse as in RGB565, the area of a dark level depends only on where the
 * picture changes from one code to the next. So such a level is assumed to grow
 * like the level before it. Levels are an octave apart, so at most one level is
 * partly resolved. Sums are below 2^26. */
static void compute_level_growth(int32_t growth_q16[LEVELS],
                                 const struct glint_profile_sums *sums,
                                 int32_t core_q16)
{
    int32_t at_q16 = 0, by_q16 = 0;

    for (int k = 1; k <= LEVELS; k++) {
        const int32_t seen_q16 =
            compute_area_log2(find_max_channel_area_q8(sums, k)) - core_q16;
        const int32_t on_q16 = at_q16 + by_q16;
        const int32_t next_q16 =
            on_q16 +
            q_mul(seen_q16 - on_q16, compute_level_resolution_q16(sums, k), 16);

        by_q16 = next_q16 - at_q16;
        at_q16 = next_q16;
        growth_q16[k - 1] = next_q16;
    }
}

void glint_unclip_compute_features(int32_t feature_q16[GLINT_UNCLIP_FEATURES],
                                   const struct glint_spot *spot,
                                   const struct glint_profile_sums *sums)
{
    const int32_t core_q16 =
        compute_area_log2(find_max_channel_area_q8(sums, 0));
    int64_t spread_q16 = 0, black_q20 = 0;

    for (int c = 0; c < 3; c++) {
        spread_q16 += sums->of[c].spread_q16;
        black_q20 += sums->of[c].black_q20;
    }
    feature_q16[0] = core_q16;
    feature_q16[1] =
        core_q16 - compute_area_log2(find_min_clipped_area_q8(sums));
    compute_level_growth(feature_q16 + 2, sums, core_q16);
    /* spread and light of the background: means over the channels, plus 0.001
     * (spread) and 0.002 (light) */
    feature_q16[2 + LEVELS] =
        q_log2_q16((uint64_t)spread_q16 + 197) - Q_CONST(17.585, 16);
    feature_q16[3 + LEVELS] =
        q_log2_q16((uint64_t)black_q20 + 6291) - Q_CONST(21.585, 16);
    feature_q16[4 + LEVELS] =
        q_log2_q16((uint64_t)find_max_colour_channel_q15(spot)) - 15 * ONE_Q16;
    feature_q16[5 + LEVELS] =
        compute_area_log2(q_mul(compute_spot_axes(sums).minor_q8,
                                estimate_lamp_radius_by_glare_q15(sums), 15));
}

/* Returns the weighted sum of features, each clamped to its range, plus the
 * bias. A feature is below 2^23 and a weight below 2^15, so that the sum of 14
 * products is below 2^42. */
static int64_t sum_weighted_features_q26(const int16_t weight_q10[FEATURES + 1],
                                         const int32_t feature_q16[FEATURES])
{
    int64_t sum_q26 = (int64_t)weight_q10[FEATURES] * ONE_Q16;

    for (int i = 0; i < FEATURES; i++)
        sum_q26 += (int64_t)weight_q10[i] * q_clamp_sat(feature_q16[i],
                                                        range_q8[i][0] * 256,
                                                        range_q8[i][1] * 256);
    return sum_q26;
}

/* Returns log2 of the core's light / white, -6 .. 14: a linear term plus a
 * perceptron with one layer of rectified units. The units model interactions of
 * features: the cause of a halo depends on the size of the core and on the
 * background. A unit is below 2^32 in _q16, its product with a weight below
 * 2^47; there are six units. */
static int32_t predict_core_log2_q16(const int32_t feature_q16[FEATURES])
{
    int64_t sum_q26 = sum_weighted_features_q26(linear_q10, feature_q16);

    for (int i = 0; i < UNITS; i++) {
        const int64_t unit_q26 =
            sum_weighted_features_q26(unit_q10[i], feature_q16);

        if (unit_q26 > 0)
            sum_q26 += q_shift(unit_q26, 10) * out_q10[i];
    }
    return q_clamp_sat(q_shift(sum_q26, 10), -6 * ONE_Q16, 14 * ONE_Q16);
}

void glint_unclip_compute_shown_light(int64_t *seen_q16, int64_t *core_q16,
                                      const struct glint_spot *spot,
                                      const struct glint_profile_sums *sums)
{
    int64_t flux[3];

    for (int c = 0; c < 3; c++)
        flux[c] = q_divide(compute_shown_flux_q16(&sums->of[c]) << 16,
                           sums->of[c].scale_q16);
    *seen_q16 = compute_luminance(flux);
    *core_q16 = q_divide(find_max_channel_area_q8(sums, 0) << 23,
                         find_max_colour_channel_q15(spot));
}

/* Sets the power of SPOT, which is the visible light plus the light of the core
 * that is lost to clipping. The lost light is estimated from features, and
 * clamped to 2^27 white pixels. The sum is clamped to MAX_POWER. */
static void set_spot_power(struct glint_spot *spot,
                           const struct glint_profile_sums *sums)
{
    int64_t seen_q16, core_q16, hidden_q16 = 0;
    int32_t feature_q16[FEATURES];

    glint_unclip_compute_shown_light(&seen_q16, &core_q16, spot, sums);
    glint_unclip_compute_features(feature_q16, spot, sums);
    if (core_q16 > 0)
        hidden_q16 = q_exp2_q16(
            q_clamp_sat(q_log2_q16((uint64_t)core_q16) +
                            predict_core_log2_q16(feature_q16) - 16 * ONE_Q16,
                        -16 * ONE_Q16, 27 * ONE_Q16));
    spot->power_q16 = seen_q16 + hidden_q16 < MAX_POWER_Q16
                          ? seen_q16 + hidden_q16
                          : MAX_POWER_Q16;
}

void glint_unclip_estimate_lamp(struct glint_spot *spot,
                                const struct glint_profile_sums *sums)
{
    set_spot_colour(spot, sums);
    set_lamp_extent(spot, sums);
    set_spot_power(spot, sums);
}
