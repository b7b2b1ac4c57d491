/* SPDX-License-Identifier: MIT
 *
 * Matches the lights of a frame to lights that were planned in an earlier frame
 * (static lights). The rays of the static lights are then drawn again. A change
 * of brightness becomes a factor on the colours of the light's bundles. */
#include "flare/dim.h"
#include "flare/state.h"

enum {
    ONE_Q14 = 1 << 14,
    MOST_GAIN_Q14 = ONE_Q14 + ONE_Q14 / 2,
    LEAST_PART = 64 /* max error of a colour channel is 1 / LEAST_PART of the
                       largest channel */
};

/* Returns the index of the planned light nearest to LIGHT, or -1 if none is
 * within the chord NEAR_Q30 (distance of directions on the unit sphere). Also,
 * apart_q30 of both may differ by NEAR_Q30 at most. */
static int find_nearest_planned_light(const struct glint_still *s,
                                      const struct glint_light *light,
                                      int32_t near_q30)
{
    uint64_t least2_q60 = (uint64_t)near_q30 * (uint64_t)near_q30;
    int at = -1;

    for (int i = 0; i < s->n; i++) {
        const int32_t apart_q30 = light->apart_q30 - s->light[i].apart_q30;
        const uint64_t apart2_q60 =
            glint_light_compute_squared_distance_q60(light, &s->light[i]);

        if (apart2_q60 > least2_q60 || apart_q30 > near_q30 ||
            apart_q30 < -near_q30 || (at >= 0 && apart2_q60 == least2_q60))
            continue;
        least2_q60 = apart2_q60;
        at = i;
    }
    return at;
}

/* Returns (power of light B in channel C) / UNIT, at most 2^4. UNIT is a
 * power. */
static int64_t compute_channel_over_power_q20(const struct glint_light *b,
                                              int c, struct glint_real unit)
{
    const struct glint_real x =
        real_times(b->power, real_of(b->rgb_q14[c], -14));

    return real_integer(real_over(x, unit), 20, INT64_C(1) << 24);
}

/* Sets the gains of planned light I to sum_q20, the power of the lights
 * assigned to it, / its planned power. Gains are clamped to 1.5. Returns 0 if a
 * channel then differs by more than 1/64 of the largest channel. */
static int compute_light_gain(struct glint_still *s, int i)
{
    const int64_t *sum_q20 = s->sum_q20[i];
    int64_t most_q20 = 1;
    int serves = 1;

    for (int c = 0; c < 3; c++)
        most_q20 = sum_q20[c] > most_q20 ? sum_q20[c] : most_q20;
    for (int c = 0; c < 3; c++) {
        const int64_t was_q20 =
            compute_channel_over_power_q20(&s->light[i], c, s->light[i].power);
        const int64_t ratio_q14 =
            was_q20 > 0 ? q_divide(sum_q20[c] * ONE_Q14 + was_q20 / 2, was_q20)
                        : ONE_Q14;
        const int32_t gain_q14 = q_clamp_sat(ratio_q14, 0, MOST_GAIN_Q14);
        const int64_t off_q20 = sum_q20[c] - q_shift(was_q20 * gain_q14, 14);

        s->gain_q14[i][c] = gain_q14;
        serves &= off_q20 * LEAST_PART <= most_q20 &&
                  off_q20 * LEAST_PART >= -most_q20;
    }
    return serves;
}

/* Assigns each of N LIGHTS to the nearest planned light, and sets the planned
 * lights' gains (factors on their colours). Returns 0, so that the lights must
 * be planned again, if a light has no planned light within NEAR_Q30, or a gain
 * is out of range. */
static int match_lights_and_set_gains(struct glint_still *s,
                                      const struct glint_light *lights, int n,
                                      int32_t near_q30)
{
    int all = 1;

    for (int i = 0; i < s->n; i++)
        for (int c = 0; c < 3; c++)
            s->sum_q20[i][c] = 0;
    for (int i = 0; i < n; i++) {
        const int at = find_nearest_planned_light(s, &lights[i], near_q30);

        if (at < 0 || s->light[at].power.mantissa <= 0)
            return 0;
        for (int c = 0; c < 3; c++)
            s->sum_q20[at][c] += compute_channel_over_power_q20(
                &lights[i], c, s->light[at].power);
    }
    for (int i = 0; i < s->n; i++)
        all &= compute_light_gain(s, i);
    return all;
}

int glint_lights_still(struct glint_still *still,
                       const struct glint_light *lights, int n_lights,
                       int32_t near_q30)
{
    if (still->n > 0 &&
        match_lights_and_set_gains(still, lights, n_lights, near_q30))
        return still->n;
    still->n = n_lights <= still->max_lights ? n_lights : 0;
    for (int i = 0; i < still->n; i++) {
        still->light[i] = lights[i];
        for (int c = 0; c < 3; c++)
            still->gain_q14[i][c] = ONE_Q14;
    }
    return still->n;
}
