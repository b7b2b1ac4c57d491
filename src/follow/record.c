/* SPDX-License-Identifier: MIT */
#include "follow/record.h"

#include "base/q.h"

#define VELOCITY_US 100000 /* time over which velocity is averaged, us */
/* time constant with which the velocity of an unseen lamp decays, us */
#define COAST_US     1000000
#define MAX_FLUX_Q16 (INT64_C(1) << 42)
#define FULL_Q30     (INT32_C(1) << 30)
#define ONE_Q15      (1 << 15)

/* -------------------------------------------------------------- one number */

/* Filters one number of a lamp (position, power, colour ...) over time:
 * averages noise, but follows changes at once.
 *
 *   in   the number measured in each picture, at any frame rate
 *   out  a number that does not fluctuate, lag or jump
 *
 * Method: the error of a picture is the measured number minus the filter's
 * value. Drift is the average of the errors with their signs, spread the
 * average of their magnitudes. If drift is a small fraction of spread, the
 * errors are noise; the value then moves only by a small fraction of the error,
 * as an average over time does. If the errors have one sign, or are far larger
 * than spread, they are a change; the value then follows at once. So the filter
 * adapts to the noise of each lamp, and lags behind steady change by at most
 * five times the tolerated error (floor).
 *
 * A change that must not show as a jump is blended: the value changes at once,
 * and the shown number approaches it at a bounded speed.
 *
 * A number that is bit-identical in successive pictures has no noise; the
 * filter reaches it soon and exactly.
 *
 * Limits: numbers are below 2^43 in magnitude, times below 2^26 us. */
#define SETTLE_US 60000

/* Limits of drift / spread. Errors are noise up to NOISE, change from CHANGE
 * on, and a mixture in between. A single error of more than SUDDEN times the
 * spread is also a change. Gaussian noise exceeds NOISE in one picture of 100,
 * and SUDDEN in one of 1000. */
#define NOISE_Q15  Q_CONST(0.8, 15)
#define CHANGE_Q15 Q_CONST(0.95, 15)
#define SUDDEN     6

/* Returns X times GAIN, rounded away from 0, so that an error that is corrected
 * repeatedly reaches 0. */
static int64_t multiply_rounding_away(int64_t x, int32_t gain_q15)
{
    return x < 0 ? -((-x * gain_q15 + ONE_Q15 - 1) >> 15)
                 : (x * gain_q15 + ONE_Q15 - 1) >> 15;
}

static int64_t compute_abs(int64_t x)
{
    return x < 0 ? -x : x;
}

enum follow_as {
    FOLLOW_JUDGED,   /* drift and spread decide whether an error is noise or
                        change */
    FOLLOW_REPEATED, /* the spot is the same as in the previous pictures, so it
                        has no noise */
    FOLLOW_CHANGED
};

int32_t glint_pace_compute_fraction_q15(int32_t elapsed_us, int32_t time_us)
{
    const int64_t sum = (int64_t)elapsed_us + time_us;

    return (int32_t)((((int64_t)elapsed_us << 15) + sum / 2) / sum);
}

/* Returns ELAPSED_US / TIME_US, at most 1: the part of a linear transition of
 * TIME_US that passes in ELAPSED_US. */
static int32_t compute_transition_fraction_q15(int32_t elapsed_us,
                                               int32_t time_us)
{
    return q_clamp_sat(((int64_t)elapsed_us << 15) / time_us, 0, ONE_Q15);
}

struct glint_pace glint_pace_compute_for_interval(int32_t elapsed_us,
                                                  int32_t smooth_us)
{
    return (struct glint_pace){
        .elapsed_us = elapsed_us,
        .smooth_q15 = glint_pace_compute_fraction_q15(elapsed_us, smooth_us),
        .settle_q15 = glint_pace_compute_fraction_q15(elapsed_us, SETTLE_US)};
}

/* Initialises a filter with VALUE. SPREAD is the magnitude that errors are
 * assumed to have until some are measured. */
static void start_filter(struct glint_follow *f, int64_t value, int64_t spread)
{
    *f = (struct glint_follow){.value = value, .spread = spread};
}

/* Moves the shown number towards the filter's value by stride * ELAPSED_US /
 * TIME_US. */
static void blend_filter_offset(struct glint_follow *f, int32_t elapsed_us,
                                int32_t time_us)
{
    const int64_t step = multiply_rounding_away(
        f->stride, compute_transition_fraction_q15(elapsed_us, time_us));

    if (compute_abs(f->offset) <= step)
        f->offset = f->stride = 0;
    else
        f->offset -= f->offset < 0 ? -step : step;
}

/* Returns how much of the averaged errors is a change: 0 (only noise) .. 1. */
static int32_t compute_change_degree_q15(const struct glint_follow *f,
                                         int64_t floor)
{
    const int64_t one_way_q15 =
        (compute_abs(f->drift) << 15) / (f->spread + floor);

    return q_clamp_sat((one_way_q15 - NOISE_Q15) * ONE_Q15 /
                           (CHANGE_Q15 - NOISE_Q15),
                       0, ONE_Q15);
}

/* Adds ERROR to the averages drift and spread. Returns how much of ERROR is a
 * change: 0 (only noise) .. 1. */
static int32_t add_filter_error_q15(struct glint_follow *f, int64_t error,
                                    int64_t floor, int32_t smooth_q15,
                                    enum follow_as as)
{
    if (as == FOLLOW_CHANGED ||
        compute_abs(error) > SUDDEN * (f->spread + floor)) {
        f->drift = error / 2; /* Earlier errors are irrelevant after a
                                 change. */
        f->spread = compute_abs(error / 2);
        return ONE_Q15;
    }
    f->drift += multiply_rounding_away(error - f->drift, smooth_q15);
    f->spread +=
        multiply_rounding_away(compute_abs(error) - f->spread, smooth_q15);
    return compute_change_degree_q15(f, floor);
}

/* Moves the filter's value towards TARGET, the measured number: slowly if the
 * error is noise, at once if it is a change. FLOOR is the tolerated error, at
 * least 1. Returns how much of the error is a change, 0 .. 1. */
static int32_t step_filter_q15(struct glint_follow *f, int64_t target,
                               int64_t floor, const struct glint_pace *pace,
                               enum follow_as as)
{
    const int64_t error = target - f->value;
    const int32_t change_q15 =
        add_filter_error_q15(f, error, floor, pace->smooth_q15, as);
    int32_t gain_q15 =
        pace->smooth_q15 + q_mul(ONE_Q15 - pace->smooth_q15, change_q15, 15);

    if (as == FOLLOW_REPEATED && gain_q15 < pace->settle_q15)
        gain_q15 = pace->settle_q15;
    f->value = compute_abs(error) <= floor / 4
                   ? target
                   : f->value + multiply_rounding_away(error, gain_q15);
    return change_q15;
}

/* Moves the filter's value from AHEAD, the prediction, by the fraction
 * smooth_q15 towards TARGET, the measured number, as the error is noise. Sets
 * drift to 0, and raises spread to at least SPREAD. */
static void step_filter_as_noise(struct glint_follow *f, int64_t ahead,
                                 int64_t target, int64_t spread,
                                 const struct glint_pace *pace)
{
    f->drift = 0;
    if (f->spread < spread)
        f->spread = spread;
    f->value = ahead + multiply_rounding_away(target - ahead, pace->smooth_q15);
}

static int64_t get_shown_value(const struct glint_follow *f)
{
    return f->value + f->offset;
}

/* Sets the filter's value at once, but continues to show SHOWN.
 * blend_filter_offset() then moves the shown number to the value within the
 * blend time, unless more changes follow. */
static void set_value_and_blend(struct glint_follow *f, int64_t value,
                                int64_t shown)
{
    f->value = value;
    f->offset = shown - value;
    if (f->stride < compute_abs(f->offset))
        f->stride = compute_abs(f->offset);
}

/* ----------------------------------------------------------------- one lamp */

/* Number of consecutive pictures after which an unchanged spot counts as
 * noise-free; a single repetition may be chance. */
enum { REPEATS = 2 };

enum {
    X = GLINT_CHANNEL_X,
    FLUX = GLINT_CHANNEL_FLUX,
    SIZE = GLINT_CHANNEL_SIZE
};

static int64_t clamp_i64(int64_t x, int64_t low, int64_t high)
{
    return x < low ? low : x > high ? high : x;
}

/* -------------------------------------------------------------------- spots */

int64_t glint_record_clamp_flux_q16(const struct glint_spot *spot)
{
    return clamp_i64(spot->flux_q16, 0, MAX_FLUX_Q16);
}

int64_t glint_record_clamp_power_q16(const struct glint_spot *spot)
{
    return clamp_i64(spot->power_q16, 0, MAX_FLUX_Q16);
}

/* Computes cosine and sine of twice the orientation of spot S, which are the
 * same for both directions of the major axis. */
static void compute_double_angle(const struct glint_spot *s, int64_t *cos2_q15,
                                 int64_t *sin2_q15)
{
    const int64_t c = clamp_i64(s->cos_q15, -ONE_Q15, ONE_Q15);
    const int64_t d = clamp_i64(s->sin_q15, -ONE_Q15, ONE_Q15);

    *cos2_q15 = (c * c - d * d) >> 15;
    *sin2_q15 = (2 * c * d) >> 15;
}

/* Writes the numbers of spot S to TARGET, indexed by channel and clamped to the
 * range that a picture allows. */
static void list_spot_channels(const struct glint_spot *s,
                               int64_t target[GLINT_CHANNELS])
{
    target[X] = clamp_i64(s->x_q8, 0, GLINT_MAX_SIDE << 8) * 256;
    target[X + 1] = clamp_i64(s->y_q8, 0, GLINT_MAX_SIDE << 8) * 256;
    target[FLUX] = glint_record_clamp_flux_q16(s);
    target[GLINT_CHANNEL_POWER] = glint_record_clamp_power_q16(s);
    target[SIZE] = clamp_i64(s->size_q8, 0, GLINT_MAX_SIDE << 8);
    for (int i = 0; i < 2; i++)
        target[GLINT_CHANNEL_MAJOR + i] =
            clamp_i64(s->axis_q8[i], 0, GLINT_MAX_SIDE << 8);
    compute_double_angle(s, &target[GLINT_CHANNEL_COS2],
                         &target[GLINT_CHANNEL_SIN2]);
    for (int i = 0; i < 3; i++)
        target[GLINT_CHANNEL_RED + i] = clamp_i64(s->rgb_q15[i], 0, 1 << 20);
}

/* Returns the tolerated error of VALUE in CHANNEL: 1/32 pixel for positions;
 * 1/64 of the value for light and sizes, plus 1/16 pixel for sizes; 1/64 of
 * full scale for orientation and colour. */
static int64_t compute_tolerated_error(int channel, int64_t value)
{
    switch (channel) {
    case GLINT_CHANNEL_X:
    case GLINT_CHANNEL_Y:
        return 65536 / 32;
    case GLINT_CHANNEL_FLUX:
    case GLINT_CHANNEL_POWER:
        return value / 64 + 1;
    case GLINT_CHANNEL_SIZE:
    case GLINT_CHANNEL_MAJOR:
    case GLINT_CHANNEL_MINOR:
        return value / 64 + 256 / 16;
    default:
        return 32768 / 64;
    }
}

static int are_spots_equal(const struct glint_spot *a,
                           const struct glint_spot *b)
{
    return a->x_q8 == b->x_q8 && a->y_q8 == b->y_q8 &&
           a->size_q8 == b->size_q8 && a->area == b->area &&
           a->n_clipped == b->n_clipped && a->flux_q16 == b->flux_q16 &&
           a->power_q16 == b->power_q16 && a->axis_q8[0] == b->axis_q8[0] &&
           a->axis_q8[1] == b->axis_q8[1] && a->sin_q15 == b->sin_q15 &&
           a->rgb_q15[0] == b->rgb_q15[0] && a->rgb_q15[1] == b->rgb_q15[1] &&
           a->rgb_q15[2] == b->rgb_q15[2];
}

/* Returns whether spots A and B of one lamp differ in flux by more than a
 * quarter of the larger flux. Then lamps have merged or separated, or an object
 * covers part of the lamp. */
static int has_lamp_shape_changed(const struct glint_spot *a,
                                  const struct glint_spot *b)
{
    const int64_t p_q16 = glint_record_clamp_flux_q16(a);
    const int64_t q_q16 = glint_record_clamp_flux_q16(b);

    return compute_abs(p_q16 - q_q16) > (p_q16 > q_q16 ? p_q16 : q_q16) / 4;
}

/* ------------------------------------------------------------------- motion */

void glint_record_predict_position(struct glint_record *r,
                                   const struct glint_record_step *step)
{
    for (int axis = 0; axis < 2; axis++)
        r->ahead_q16[axis] = r->of[X + axis].value + r->velocity_q16[axis] *
                                                         step->pace.elapsed_us /
                                                         1000000;
}

static void slow_unseen_lamp(struct glint_record *r,
                             const struct glint_record_step *step, int axis)
{
    const int32_t part_q15 =
        glint_pace_compute_fraction_q15(step->pace.elapsed_us, COAST_US);

    r->velocity_q16[axis] -= r->velocity_q16[axis] * part_q15 / (1 << 15);
}

/* Updates the average velocity of the lamp along AXIS with the motion from
 * position BEFORE. Motion that is noise has half the weight of motion that is a
 * change. The first change of a new lamp sets the velocity. Velocities are
 * clamped to 16 picture widths per second. Does nothing if no time passed. */
static void update_velocity(struct glint_record *r,
                            const struct glint_record_step *step, int axis,
                            int64_t before_q16, int32_t change_q15)
{
    const int64_t limit_q16 = (int64_t)step->cfg->width << (16 + 4);
    const int32_t us = step->pace.elapsed_us;
    const int32_t part_q15 =
        r->is_new && change_q15 == ONE_Q15
            ? ONE_Q15
            : q_mul(glint_pace_compute_fraction_q15(us, VELOCITY_US),
                    ONE_Q15 + change_q15, 16);
    int64_t now_q16;

    if (us == 0)
        return;
    now_q16 = (r->of[X + axis].value - before_q16) * 1000000 / us;
    now_q16 = clamp_i64(now_q16, -limit_q16, limit_q16);
    r->velocity_q16[axis] +=
        (now_q16 - r->velocity_q16[axis]) * part_q15 / (1 << 15);
}

/* Updates the position along AXIS after a change of shape, which moves the
 * measured centre although the lamp does not move. If the new centre lies
 * within half the lamp's radius of the prediction, the difference counts as
 * noise. Otherwise the shown position continues from the prediction and is
 * blended to the new centre; a lamp whose velocity is unknown jumps there. */
static void
follow_position_after_shape_change(struct glint_record *r,
                                   const struct glint_record_step *step,
                                   int axis, int64_t target_q16)
{
    struct glint_follow *f = &r->of[X + axis];
    const int64_t ahead_q16 = r->ahead_q16[axis];
    const int64_t extent_q16 = r->of[SIZE].value * 256;

    if (compute_abs(target_q16 - ahead_q16) <= extent_q16 / 2)
        step_filter_as_noise(f, ahead_q16, target_q16, extent_q16 / 4,
                             &step->pace);
    else
        set_value_and_blend(f, target_q16,
                            r->is_new ? target_q16 : ahead_q16 + f->offset);
}

/* Returns whether the lamp moves along AXIS by more than half a pixel plus 1/16
 * of its radius per picture. All its position errors then count as change,
 * because the drift has the wrong sign for some pictures after the motion turns
 * or ends. */
static int is_lamp_moving(const struct glint_record *r, int axis)
{
    return compute_abs(r->ahead_q16[axis] - r->of[X + axis].value) >
           r->of[SIZE].value * 16 + 65536 / 2;
}

/* Returns how the filter treats the position error ERROR along AXIS: as change
 * if it exceeds three quarters of the lamp's radius or the lamp moves. */
static enum follow_as judge_position_error(const struct glint_record *r,
                                           int axis, int64_t error_q16,
                                           int is_repeat)
{
    if (compute_abs(error_q16) > r->of[SIZE].value * 192 + 65536 / 8 ||
        is_lamp_moving(r, axis))
        return FOLLOW_CHANGED;
    return is_repeat ? FOLLOW_REPEATED : FOLLOW_JUDGED;
}

static void follow_position(struct glint_record *r,
                            const struct glint_record_step *step, int axis,
                            int64_t target_q16, int is_repeat)
{
    struct glint_follow *f = &r->of[X + axis];
    const int64_t before_q16 = f->value;
    const int32_t change_q15 = step_filter_q15(
        f, target_q16, compute_tolerated_error(X, 0), &step->pace,
        judge_position_error(r, axis, target_q16 - before_q16, is_repeat));

    update_velocity(r, step, axis, before_q16, change_q15);
}

/* Moves a lamp without a spot to its predicted position, and slows it down
 * unless it is leaving the picture. */
static void move_unseen_lamp(struct glint_record *r,
                             const struct glint_record_step *step)
{
    for (int axis = 0; axis < 2; axis++) {
        r->of[X + axis].value = r->ahead_q16[axis];
        if (r->state != GLINT_LAMP_LEAVING)
            slow_unseen_lamp(r, step, axis);
    }
}

/* Returns whether the lamp is close to a side of the picture and its velocity
 * takes it out through that side within leave_ms. */
static int is_lamp_leaving_picture(const struct glint_record *r,
                                   const struct glint_record_step *step)
{
    const int side[2] = {step->cfg->width, step->cfg->height};

    for (int axis = 0; axis < 2; axis++) {
        const int64_t at_q16 = r->of[X + axis].value;
        const int64_t speed_q16 = compute_abs(r->velocity_q16[axis]);
        const int64_t room_q16 = r->velocity_q16[axis] < 0
                                     ? at_q16
                                     : side[axis] * INT64_C(65536) - at_q16;
        const int64_t near_q16 =
            2 * (r->of[SIZE].value * 256 + 65536 +
                 speed_q16 * step->pace.elapsed_us / 1000000);

        if (room_q16 < near_q16 &&
            room_q16 < speed_q16 * step->cfg->leave_ms / 1000)
            return 1;
    }
    return 0;
}

/* -------------------------------------------------------------------- light */

/* Returns how the filter treats CHANGE, an error in a channel other than
 * position: as a change if it exceeds a quarter of LARGER plus four times
 * FLOOR. This does not apply to powers unless pictures repeat: the power of a
 * clipped core is estimated from its rim, and noise may halve or double it. */
static enum follow_as judge_light_error(int channel, int64_t change,
                                        int64_t larger, int64_t floor,
                                        int is_repeat)
{
    if ((channel != GLINT_CHANNEL_POWER || is_repeat) &&
        compute_abs(change) > larger / 4 + 4 * floor)
        return FOLLOW_CHANGED;
    return is_repeat ? FOLLOW_REPEATED : FOLLOW_JUDGED;
}

/* Returns the time over which CHANGE is blended, us: the attack time for a
 * rise, the release time for a fall. */
static int32_t get_blend_time_us(const struct glint_lamp_tracker_config *cfg,
                                 int64_t change)
{
    return 1000 * (change > 0 ? cfg->attack_ms : cfg->release_ms);
}

/* Moves a channel, any but the position, towards TARGET. A change that is
 * faster than full scale in one attack time (rising) or release time (falling)
 * is spread over that time. */
static void follow_light_channel(struct glint_record *r,
                                 const struct glint_record_step *step,
                                 int channel, int64_t target, int is_repeat)
{
    struct glint_follow *f = &r->of[channel];
    const int64_t before = f->value, shown = get_shown_value(f);
    const int64_t larger =
        channel == GLINT_CHANNEL_COS2 || channel == GLINT_CHANNEL_SIN2
            ? ONE_Q15 /* the full scale of an orientation does not depend on its
                         current value */
        : target > before ? target
                          : before;
    const int64_t floor = compute_tolerated_error(channel, larger);
    int32_t share_q15;
    int64_t change;

    step_filter_q15(
        f, target, floor, &step->pace,
        judge_light_error(channel, target - before, larger, floor, is_repeat));
    change = f->value - before;
    share_q15 = compute_transition_fraction_q15(
        step->pace.elapsed_us, get_blend_time_us(step->cfg, change));
    if (f->offset != 0 || compute_abs(change) > (larger * share_q15) >> 15)
        set_value_and_blend(f, f->value, shown);
}

static void start_channel_filters(struct glint_record *r,
                                  const struct glint_spot *s)
{
    int64_t target[GLINT_CHANNELS];

    list_spot_channels(s, target);
    for (int c = 0; c < GLINT_CHANNELS; c++)
        start_filter(&r->of[c], target[c],
                     2 * compute_tolerated_error(c, target[c]));
}

void glint_record_begin_track(struct glint_record *r, uint32_t id,
                              const struct glint_spot *spot)
{
    *r = (struct glint_record){.id = id, .last = *spot, .is_new = 3};
    start_channel_filters(r, spot);
}

static int count_repeated_spots(struct glint_record *r,
                                const struct glint_spot *spot)
{
    if (r->lost_us > 0 || !are_spots_equal(spot, &r->last))
        r->n_same = 0;
    else if (r->n_same < REPEATS)
        r->n_same++;
    return r->n_same;
}

static void blend_all_channels(struct glint_record *r,
                               const struct glint_record_step *step)
{
    for (int c = 0; c < GLINT_CHANNELS; c++)
        blend_filter_offset(&r->of[c], step->pace.elapsed_us,
                            get_blend_time_us(step->cfg, -r->of[c].offset));
}

void glint_record_update_with_spot(struct glint_record *r,
                                   const struct glint_record_step *step,
                                   const struct glint_spot *spot)
{
    const int is_back = r->lost_us > 0;
    const int is_repeat = count_repeated_spots(r, spot) >= REPEATS;
    const int is_new_shape = is_back || has_lamp_shape_changed(spot, &r->last);
    int64_t target[GLINT_CHANNELS];

    if (is_back && r->level_q30 == 0) {
        start_channel_filters(r, spot);
    } else {
        list_spot_channels(spot, target);
        for (int axis = 0; axis < 2; axis++)
            if (is_new_shape)
                follow_position_after_shape_change(r, step, axis,
                                                   target[X + axis]);
            else
                follow_position(r, step, axis, target[X + axis], is_repeat);
        for (int c = FLUX; c < GLINT_CHANNELS; c++)
            follow_light_channel(r, step, c, target[c], is_repeat);
    }
    blend_all_channels(r, step);
    r->last = *spot;
    if (r->velocity_q16[0] || r->velocity_q16[1])
        r->is_new = 0;
    else if (r->is_new > 0)
        r->is_new--;
    r->lost_us = 0;
}

/* Returns whether the lamp is farther outside the picture than four times the
 * max picture size: its track is then dropped. */
static int is_lamp_far_outside(const struct glint_record *r)
{
    const int64_t limit_q16 = (int64_t)4 * GLINT_MAX_SIDE << 16;

    return compute_abs(r->of[X].value) > limit_q16 ||
           compute_abs(r->of[X + 1].value) > limit_q16;
}

static int is_lamp_expired(const struct glint_record *r,
                           const struct glint_record_step *step)
{
    return r->level_q30 == 0 && (r->state == GLINT_LAMP_LEAVING ||
                                 r->lost_us / 1000 >= step->cfg->memory_ms);
}

void glint_record_update_without_spot(struct glint_record *r,
                                      const struct glint_record_step *step)
{
    blend_all_channels(r, step);
    if (r->lost_us == 0)
        r->state = is_lamp_leaving_picture(r, step) ? GLINT_LAMP_LEAVING
                                                    : GLINT_LAMP_FADING;
    move_unseen_lamp(r, step);
    r->lost_us += step->pace.elapsed_us > 0 ? step->pace.elapsed_us : 1;
    if (is_lamp_expired(r, step) || is_lamp_far_outside(r))
        r->id = 0;
}

/* -------------------------------------------------------------------- level */

/* Returns the max change of the fade level in this picture if a fade from 0 to
 * full level lasts MS. */
static int32_t compute_level_step_q30(const struct glint_record_step *step,
                                      int32_t ms)
{
    const int64_t part_q30 =
        ((int64_t)step->pace.elapsed_us << 30) / (ms * INT64_C(1000));

    return q_clamp_sat(part_q30, 0, FULL_Q30);
}

static void raise_fade_level(struct glint_record *r,
                             const struct glint_record_step *step)
{
    const int32_t part_q30 = compute_level_step_q30(step, step->cfg->attack_ms);

    r->level_q30 = step->is_fresh || r->level_q30 > FULL_Q30 - part_q30
                       ? FULL_Q30
                       : r->level_q30 + part_q30;
    r->state = r->level_q30 == FULL_Q30 ? GLINT_LAMP_STEADY : GLINT_LAMP_RISING;
}

static void lower_fade_level(struct glint_record *r,
                             const struct glint_record_step *step)
{
    const int is_out = r->state == GLINT_LAMP_LEAVING && r->lost_us > 0;
    const int32_t part_q30 = compute_level_step_q30(
        step, is_out ? step->cfg->leave_ms : step->cfg->release_ms);

    r->level_q30 = r->level_q30 > part_q30 ? r->level_q30 - part_q30 : 0;
    r->state = is_out ? GLINT_LAMP_LEAVING : GLINT_LAMP_FADING;
}

void glint_record_update_fade_level(struct glint_record *r,
                                    const struct glint_record_step *step)
{
    if (r->lost_us == 0 && r->is_shown)
        raise_fade_level(r, step);
    else
        lower_fade_level(r, step);
}

/* Sets the track's major axis to half the angle whose cosine and sine are
 * proportional to COS2 and SIN2; horizontal if both are 0. */
static void set_track_axis(struct glint_lamp_track *track, int64_t cos2_q15,
                           int64_t sin2_q15)
{
    const int64_t size_q15 =
        q_root((uint64_t)(cos2_q15 * cos2_q15 + sin2_q15 * sin2_q15));
    const int64_t cos_q15 =
        size_q15 > 0 ? cos2_q15 * ONE_Q15 / size_q15 : ONE_Q15;

    track->cos_q15 = (int32_t)q_root(
        (uint64_t)clamp_i64(ONE_Q15 + cos_q15, 0, 2 * ONE_Q15) << 14);
    track->sin_q15 = (int32_t)q_root(
        (uint64_t)clamp_i64(ONE_Q15 - cos_q15, 0, 2 * ONE_Q15) << 14);
    if (sin2_q15 < 0)
        track->sin_q15 = -track->sin_q15;
}

struct glint_lamp_track glint_record_make_track(const struct glint_record *r)
{
    const struct glint_follow *of = r->of;
    struct glint_lamp_track track = {
        .id = r->id,
        .state = r->state,
        .x_q8 = q_narrow(q_shift(get_shown_value(&of[X]), 8)),
        .y_q8 = q_narrow(q_shift(get_shown_value(&of[X + 1]), 8)),
        .size_q8 = q_narrow(get_shown_value(&of[SIZE])),
        .level_q15 = q_narrow(q_shift(r->level_q30, 30 - 15)),
        .flux_q16 = get_shown_value(&of[FLUX]),
        .power_q16 = get_shown_value(&of[GLINT_CHANNEL_POWER])};

    for (int i = 0; i < 2; i++)
        track.axis_q8[i] =
            q_narrow(get_shown_value(&of[GLINT_CHANNEL_MAJOR + i]));
    set_track_axis(&track, get_shown_value(&of[GLINT_CHANNEL_COS2]),
                   get_shown_value(&of[GLINT_CHANNEL_SIN2]));
    for (int i = 0; i < 3; i++)
        track.rgb_q15[i] =
            q_narrow(get_shown_value(&of[GLINT_CHANNEL_RED + i]));
    return track;
}
