/* SPDX-License-Identifier: MIT */
#include "follow/follow.h"

#include "base/q.h"

#define ONE_Q15   (1 << 15)
#define SETTLE_US 60000

/* Ratios of drift to spread up to which an error is noise, and from which it is
 * change. Noise of a bell curve passes the first in one picture of 100, and
 * exceeds SUDDEN times the spread in one of 1000. */
#define NOISE_Q15  Q_CONST(0.8, 15)
#define CHANGE_Q15 Q_CONST(0.95, 15)
#define SUDDEN     6

/* Returns X times GAIN, rounded away from 0, so that a remainder ends in 0. */
static int64_t part_of(int64_t x, int32_t gain_q15)
{
    return x < 0 ? -((-x * gain_q15 + ONE_Q15 - 1) >> 15)
                 : (x * gain_q15 + ONE_Q15 - 1) >> 15;
}

static int64_t size_of(int64_t x)
{
    return x < 0 ? -x : x;
}

int32_t glint_pace_part_q15(int32_t elapsed_us, int32_t time_us)
{
    const int64_t sum = (int64_t)elapsed_us + time_us;

    return (int32_t)((((int64_t)elapsed_us << 15) + sum / 2) / sum);
}

int32_t glint_pace_share_q15(int32_t elapsed_us, int32_t time_us)
{
    return q_clamp_sat(((int64_t)elapsed_us << 15) / time_us, 0, ONE_Q15);
}

struct glint_pace glint_pace_of(int32_t elapsed_us, int32_t smooth_us)
{
    return (struct glint_pace){
        .elapsed_us = elapsed_us,
        .smooth_q15 = glint_pace_part_q15(elapsed_us, smooth_us),
        .settle_q15 = glint_pace_part_q15(elapsed_us, SETTLE_US)};
}

void glint_follow_start(struct glint_follow *f, int64_t value, int64_t spread)
{
    *f = (struct glint_follow){.value = value, .spread = spread};
}

void glint_follow_blend(struct glint_follow *f, int32_t elapsed_us,
                        int32_t time_us)
{
    const int64_t step =
        part_of(f->stride, glint_pace_share_q15(elapsed_us, time_us));

    if (size_of(f->offset) <= step)
        f->offset = f->stride = 0;
    else
        f->offset -= f->offset < 0 ? -step : step;
}

/* Returns whether the errors so far are noise, 0, or a change, 1, or between.
 */
static int32_t judge_q15(const struct glint_follow *f, int64_t floor)
{
    const int64_t one_way_q15 = (size_of(f->drift) << 15) / (f->spread + floor);

    return q_clamp_sat((one_way_q15 - NOISE_Q15) * ONE_Q15 /
                           (CHANGE_Q15 - NOISE_Q15),
                       0, ONE_Q15);
}

/* Takes ERROR into drift and spread; returns how much of a change it is, 0 ..
 * 1. */
static int32_t learn_q15(struct glint_follow *f, int64_t error, int64_t floor,
                         int32_t smooth_q15, enum glint_follow_as as)
{
    if (as == GLINT_FOLLOW_CHANGED ||
        size_of(error) > SUDDEN * (f->spread + floor)) {
        f->drift = error / 2; /* Earlier errors are of no use after a change. */
        f->spread = size_of(error / 2);
        return ONE_Q15;
    }
    f->drift += part_of(error - f->drift, smooth_q15);
    f->spread += part_of(size_of(error) - f->spread, smooth_q15);
    return judge_q15(f, floor);
}

int32_t glint_follow_step_q15(struct glint_follow *f, int64_t target,
                              int64_t floor, const struct glint_pace *pace,
                              enum glint_follow_as as)
{
    const int64_t error = target - f->value;
    const int32_t change_q15 = learn_q15(f, error, floor, pace->smooth_q15, as);
    int32_t gain_q15 =
        pace->smooth_q15 + q_mul(ONE_Q15 - pace->smooth_q15, change_q15, 15);

    if (as == GLINT_FOLLOW_REPEATED && gain_q15 < pace->settle_q15)
        gain_q15 = pace->settle_q15;
    f->value = size_of(error) <= floor / 4
                   ? target
                   : f->value + part_of(error, gain_q15);
    return change_q15;
}

void glint_follow_doubt(struct glint_follow *f, int64_t ahead, int64_t target,
                        int64_t spread, const struct glint_pace *pace)
{
    f->drift = 0;
    if (f->spread < spread)
        f->spread = spread;
    f->value = ahead + part_of(target - ahead, pace->smooth_q15);
}

void glint_follow_jump(struct glint_follow *f, int64_t value, int64_t shown)
{
    f->value = value;
    f->offset = shown - value;
    if (f->stride < size_of(f->offset))
        f->stride = size_of(f->offset);
}
