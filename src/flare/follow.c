/* SPDX-License-Identifier: MIT */
#include "flare/follow.h"

#include "base/q.h"

#define ONE_Q15   (1 << 15)
#define SETTLE_US 60000

/* Where drift over spread lies between noise and change. Noise of a bell curve
 * is above the first in one picture of 40. */
#define NOISE_Q15  Q_CONST(0.7, 15)
#define CHANGE_Q15 Q_CONST(0.95, 15)

/* X times GAIN, away from 0, so that what is left ends in 0. */
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

void glint_follow_blend(struct glint_follow *f, int32_t elapsed_us)
{
    if (elapsed_us >= f->left_us) {
        f->offset = 0;
        f->left_us = 0;
        return;
    }
    f->offset -=
        part_of(f->offset, (int32_t)(((int64_t)elapsed_us << 15) / f->left_us));
    f->left_us -= elapsed_us;
}

/* From the smooth part of noise to all the way of change. */
static int32_t gain_q15(const struct glint_follow *f, int64_t floor,
                        int32_t smooth_q15)
{
    const int64_t one_way_q15 = (size_of(f->drift) << 15) / (f->spread + floor);
    const int32_t change_q15 = q_clamp_sat((one_way_q15 - NOISE_Q15) * ONE_Q15 /
                                               (CHANGE_Q15 - NOISE_Q15),
                                           0, ONE_Q15);

    return smooth_q15 + q_mul(ONE_Q15 - smooth_q15, change_q15, 15);
}

void glint_follow_step(struct glint_follow *f, int64_t target, int64_t floor,
                       const struct glint_pace *pace, int repeats)
{
    const int64_t error = target - f->value;
    int32_t gain;

    f->drift += part_of(error - f->drift, pace->smooth_q15);
    f->spread += part_of(size_of(error) - f->spread, pace->smooth_q15);
    gain = gain_q15(f, floor, pace->smooth_q15);
    if (repeats && gain < pace->settle_q15)
        gain = pace->settle_q15;
    f->value =
        size_of(error) <= floor / 4 ? target : f->value + part_of(error, gain);
}

void glint_follow_jump(struct glint_follow *f, int64_t value, int64_t shown,
                       int32_t time_us)
{
    f->value = value;
    f->drift = 0;
    f->offset = shown - value;
    f->left_us = time_us;
}
