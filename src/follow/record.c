/* SPDX-License-Identifier: MIT */
#include "follow/record.h"

#include "base/q.h"

#define VELOCITY_US 100000 /* microseconds over which velocity is averaged */
/* microseconds in which a lamp whose motion is not seen loses 1 - 1/e of its
 * velocity */
#define COAST_US     1000000
#define MAX_FLUX_Q16 (INT64_C(1) << 42)
#define FULL_Q30     (INT32_C(1) << 30)
#define ONE_Q15      (1 << 15)

/* Repetitions in a row that count; a single one may be chance. */
enum { REPEATS = 2 };

enum {
    X = GLINT_CHANNEL_X,
    FLUX = GLINT_CHANNEL_FLUX,
    SIZE = GLINT_CHANNEL_SIZE
};

static int64_t clamp(int64_t x, int64_t low, int64_t high)
{
    return x < low ? low : x > high ? high : x;
}

static int64_t size_of(int64_t x)
{
    return x < 0 ? -x : x;
}

/* ------------------------------------------------------------- what is seen */

int64_t glint_record_flux_q16(const struct glint_spot *spot)
{
    return clamp(spot->flux_q16, 0, MAX_FLUX_Q16);
}

int64_t glint_record_power_q16(const struct glint_spot *spot)
{
    return clamp(spot->power_q16, 0, MAX_FLUX_Q16);
}

/* Sets cosine and sine of twice the orientation of S: both directions of an
 * axis give the same. */
static void double_angle(const struct glint_spot *s, int64_t *cos2_q15,
                         int64_t *sin2_q15)
{
    const int64_t c = clamp(s->cos_q15, -ONE_Q15, ONE_Q15);
    const int64_t d = clamp(s->sin_q15, -ONE_Q15, ONE_Q15);

    *cos2_q15 = (c * c - d * d) >> 15;
    *sin2_q15 = (2 * c * d) >> 15;
}

/* Lists a spot's values by channel, clamped to what a picture can show. */
static void list_targets(const struct glint_spot *s,
                         int64_t target[GLINT_CHANNELS])
{
    target[X] = clamp(s->x_q8, 0, GLINT_MAX_SIDE << 8) * 256;
    target[X + 1] = clamp(s->y_q8, 0, GLINT_MAX_SIDE << 8) * 256;
    target[FLUX] = glint_record_flux_q16(s);
    target[GLINT_CHANNEL_POWER] = glint_record_power_q16(s);
    target[SIZE] = clamp(s->size_q8, 0, GLINT_MAX_SIDE << 8);
    for (int i = 0; i < 2; i++)
        target[GLINT_CHANNEL_MAJOR + i] =
            clamp(s->axis_q8[i], 0, GLINT_MAX_SIDE << 8);
    double_angle(s, &target[GLINT_CHANNEL_COS2], &target[GLINT_CHANNEL_SIN2]);
    for (int i = 0; i < 3; i++)
        target[GLINT_CHANNEL_RED + i] = clamp(s->rgb_q15[i], 0, 1 << 20);
}

/* Returns an error of VALUE that does no harm: 1/32 pixel for places, 1/64 for
 * all other channels, and 1/16 pixel more for sizes. */
static int64_t floor_of(int channel, int64_t value)
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

static int is_same(const struct glint_spot *a, const struct glint_spot *b)
{
    return a->x_q8 == b->x_q8 && a->y_q8 == b->y_q8 &&
           a->size_q8 == b->size_q8 && a->area == b->area &&
           a->n_clipped == b->n_clipped && a->flux_q16 == b->flux_q16 &&
           a->power_q16 == b->power_q16 && a->axis_q8[0] == b->axis_q8[0] &&
           a->axis_q8[1] == b->axis_q8[1] && a->sin_q15 == b->sin_q15 &&
           a->rgb_q15[0] == b->rgb_q15[0] && a->rgb_q15[1] == b->rgb_q15[1] &&
           a->rgb_q15[2] == b->rgb_q15[2];
}

/* Returns whether the shape of a lamp changed: its flux differs by a quarter
 * from picture to picture, as lamps merged, separated or were covered. */
static int is_other_shape(const struct glint_spot *a,
                          const struct glint_spot *b)
{
    const int64_t p_q16 = glint_record_flux_q16(a);
    const int64_t q_q16 = glint_record_flux_q16(b);

    return size_of(p_q16 - q_q16) > (p_q16 > q_q16 ? p_q16 : q_q16) / 4;
}

/* ------------------------------------------------------------------- motion */

void glint_record_look_ahead(struct glint_record *r,
                             const struct glint_record_step *step)
{
    for (int axis = 0; axis < 2; axis++)
        r->ahead_q16[axis] = r->of[X + axis].value + r->velocity_q16[axis] *
                                                         step->pace.elapsed_us /
                                                         1000000;
}

static void slow_down(struct glint_record *r,
                      const struct glint_record_step *step, int axis)
{
    const int32_t part_q15 =
        glint_pace_part_q15(step->pace.elapsed_us, COAST_US);

    r->velocity_q16[axis] -= r->velocity_q16[axis] * part_q15 / (1 << 15);
}

/* Averages the velocity with that of the last step from BEFORE; noise counts
 * half as much as change. Velocities are clamped to 16 times the picture's
 * width a second. */
static void learn_velocity(struct glint_record *r,
                           const struct glint_record_step *step, int axis,
                           int64_t before_q16, int32_t change_q15)
{
    const int64_t limit_q16 = (int64_t)step->cfg->width << (16 + 4);
    const int32_t us = step->pace.elapsed_us;
    const int32_t part_q15 =
        q_mul(glint_pace_part_q15(us, VELOCITY_US), ONE_Q15 + change_q15, 16);
    int64_t now_q16;

    if (us == 0)
        return;
    now_q16 = (r->of[X + axis].value - before_q16) * 1000000 / us;
    now_q16 = clamp(now_q16, -limit_q16, limit_q16);
    r->velocity_q16[axis] +=
        (now_q16 - r->velocity_q16[axis]) * part_q15 / (1 << 15);
}

/* Takes a place that belongs to a changed shape, which is no motion. Close to
 * the expected place, within half the lamp's radius, it counts as noise;
 * farther away the shown place moves on as before, and is blended to the new
 * one. */
static void doubt_place(struct glint_record *r,
                        const struct glint_record_step *step, int axis,
                        int64_t target_q16)
{
    struct glint_follow *f = &r->of[X + axis];
    const int64_t ahead_q16 = r->ahead_q16[axis];
    const int64_t extent_q16 = r->of[SIZE].value * 256;

    if (size_of(target_q16 - ahead_q16) <= extent_q16 / 2)
        glint_follow_doubt(f, ahead_q16, target_q16, extent_q16 / 4,
                           &step->pace);
    else
        glint_follow_jump(f, target_q16, ahead_q16 + f->offset);
}

/* Returns how to follow a place: an error of more than three quarters of the
 * lamp's radius is change, not noise. */
static enum glint_follow_as judge_place(const struct glint_record *r,
                                        int64_t error_q16, int is_repeat)
{
    if (size_of(error_q16) > r->of[SIZE].value * 192 + 65536 / 8)
        return GLINT_FOLLOW_CHANGED;
    return is_repeat ? GLINT_FOLLOW_REPEATED : GLINT_FOLLOW_JUDGED;
}

/* Returns whether TARGET is too far for the lamp's motion: twice its radius and
 * an eighth of the match distance from the expected place. It may be motion
 * that begins, or another lamp. */
static int is_leap(const struct glint_record *r,
                   const struct glint_record_step *step, int axis,
                   int64_t target_q16)
{
    return size_of(target_q16 - r->ahead_q16[axis]) >
           r->of[SIZE].value * 512 +
               (int64_t)step->cfg->width * step->cfg->match_q15 / 4;
}

static void leap(struct glint_record *r, const struct glint_record_step *step,
                 int axis, int64_t target_q16)
{
    struct glint_follow *f = &r->of[X + axis];
    const int64_t before_q16 = f->value;

    glint_follow_jump(f, target_q16, r->ahead_q16[axis] + f->offset);
    learn_velocity(r, step, axis, before_q16, ONE_Q15);
}

static void follow_place(struct glint_record *r,
                         const struct glint_record_step *step, int axis,
                         int64_t target_q16, int is_repeat)
{
    struct glint_follow *f = &r->of[X + axis];
    const int64_t before_q16 = f->value;
    const int32_t change_q15 = glint_follow_step_q15(
        f, target_q16, floor_of(X, 0), &step->pace,
        judge_place(r, target_q16 - before_q16, is_repeat));

    learn_velocity(r, step, axis, before_q16, change_q15);
}

/* Moves a lamp without a spot on; a hidden one slows down. */
static void coast(struct glint_record *r, const struct glint_record_step *step)
{
    for (int axis = 0; axis < 2; axis++) {
        r->of[X + axis].value = r->ahead_q16[axis];
        if (r->state != GLINT_LAMP_LEAVING)
            slow_down(r, step, axis);
    }
}

/* Returns whether the lamp moves out of the picture, through a side close to
 * it. */
static int is_leaving(const struct glint_record *r,
                      const struct glint_record_step *step)
{
    const int side[2] = {step->cfg->width, step->cfg->height};

    for (int axis = 0; axis < 2; axis++) {
        const int64_t at_q16 = r->of[X + axis].value;
        const int64_t speed_q16 = size_of(r->velocity_q16[axis]);
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

/* Returns how to follow light of CHANNEL. What a clipped core hides is guessed
 * from its rim, and may be half or twice as much in noise, so that powers are
 * judged by the errors so far, but where pictures repeat. */
static enum glint_follow_as judge_light(int channel, int64_t change,
                                        int64_t larger, int64_t floor,
                                        int is_repeat)
{
    if ((channel != GLINT_CHANNEL_POWER || is_repeat) &&
        size_of(change) > larger / 4 + 4 * floor)
        return GLINT_FOLLOW_CHANGED;
    return is_repeat ? GLINT_FOLLOW_REPEATED : GLINT_FOLLOW_JUDGED;
}

/* Returns the time in us in which all of a lamp may appear or vanish. */
static int32_t blend_us(const struct glint_lamp_tracker_config *cfg,
                        int64_t change)
{
    return 1000 * (change > 0 ? cfg->attack_ms : cfg->release_ms);
}

/* Follows TARGET. A change that is faster than all of the light in the attack
 * or release time is blended over that time. */
static void follow_light(struct glint_record *r,
                         const struct glint_record_step *step, int channel,
                         int64_t target, int is_repeat)
{
    struct glint_follow *f = &r->of[channel];
    const int64_t before = f->value, shown = glint_follow_shown(f);
    const int64_t larger =
        channel == GLINT_CHANNEL_COS2 || channel == GLINT_CHANNEL_SIN2
            ? ONE_Q15 /* in units of a full axis, whichever way it lies */
        : target > before ? target
                          : before;
    const int64_t floor = floor_of(channel, larger);
    int32_t share_q15;
    int64_t change;

    glint_follow_step_q15(
        f, target, floor, &step->pace,
        judge_light(channel, target - before, larger, floor, is_repeat));
    change = f->value - before;
    share_q15 = glint_pace_share_q15(step->pace.elapsed_us,
                                     blend_us(step->cfg, change));
    if (f->offset != 0 || size_of(change) > (larger * share_q15) >> 15)
        glint_follow_jump(f, f->value, shown);
}

static void start(struct glint_record *r, const struct glint_spot *s)
{
    int64_t target[GLINT_CHANNELS];

    list_targets(s, target);
    for (int c = 0; c < GLINT_CHANNELS; c++)
        glint_follow_start(&r->of[c], target[c], 2 * floor_of(c, target[c]));
}

void glint_record_begin(struct glint_record *r, uint32_t id,
                        const struct glint_spot *spot)
{
    *r = (struct glint_record){.id = id, .last = *spot};
    start(r, spot);
}

static int count_same(struct glint_record *r, const struct glint_spot *spot)
{
    if (r->lost_us > 0 || !is_same(spot, &r->last))
        r->n_same = 0;
    else if (r->n_same < REPEATS)
        r->n_same++;
    return r->n_same;
}

static void blend(struct glint_record *r, const struct glint_record_step *step)
{
    for (int c = 0; c < GLINT_CHANNELS; c++)
        glint_follow_blend(&r->of[c], step->pace.elapsed_us,
                           blend_us(step->cfg, -r->of[c].offset));
}

void glint_record_see(struct glint_record *r,
                      const struct glint_record_step *step,
                      const struct glint_spot *spot)
{
    const int is_back = r->lost_us > 0;
    const int is_repeat = count_same(r, spot) >= REPEATS;
    const int is_new_shape = is_back || is_other_shape(spot, &r->last);
    int64_t target[GLINT_CHANNELS];

    if (is_back && r->level_q30 == 0) {
        start(r, spot);
    } else {
        list_targets(spot, target);
        for (int axis = 0; axis < 2; axis++)
            if (is_new_shape)
                doubt_place(r, step, axis, target[X + axis]);
            else if (is_leap(r, step, axis, target[X + axis]))
                leap(r, step, axis, target[X + axis]);
            else
                follow_place(r, step, axis, target[X + axis], is_repeat);
        for (int c = FLUX; c < GLINT_CHANNELS; c++)
            follow_light(r, step, c, target[c], is_repeat);
    }
    blend(r, step);
    r->last = *spot;
    r->lost_us = 0;
}

/* Returns whether the lamp is so far outside of the picture that it neither
 * comes back nor throws a flare into it. */
static int is_far(const struct glint_record *r)
{
    const int64_t limit_q16 = (int64_t)4 * GLINT_MAX_SIDE << 16;

    return size_of(r->of[X].value) > limit_q16 ||
           size_of(r->of[X + 1].value) > limit_q16;
}

static int is_over(const struct glint_record *r,
                   const struct glint_record_step *step)
{
    return r->level_q30 == 0 && (r->state == GLINT_LAMP_LEAVING ||
                                 r->lost_us / 1000 >= step->cfg->memory_ms);
}

void glint_record_miss(struct glint_record *r,
                       const struct glint_record_step *step)
{
    blend(r, step);
    if (r->lost_us == 0)
        r->state = is_leaving(r, step) ? GLINT_LAMP_LEAVING : GLINT_LAMP_FADING;
    coast(r, step);
    r->lost_us += step->pace.elapsed_us > 0 ? step->pace.elapsed_us : 1;
    if (is_over(r, step) || is_far(r))
        r->id = 0;
}

/* -------------------------------------------------------------------- level */

/* Returns the part of full level by which a level may change in the time of
 * STEP, if all of it takes MS. */
static int32_t level_step_q30(const struct glint_record_step *step, int32_t ms)
{
    const int64_t part_q30 =
        ((int64_t)step->pace.elapsed_us << 30) / (ms * INT64_C(1000));

    return q_clamp_sat(part_q30, 0, FULL_Q30);
}

static void rise(struct glint_record *r, const struct glint_record_step *step)
{
    const int32_t part_q30 = level_step_q30(step, step->cfg->attack_ms);

    r->level_q30 = step->is_fresh || r->level_q30 > FULL_Q30 - part_q30
                       ? FULL_Q30
                       : r->level_q30 + part_q30;
    r->state = r->level_q30 == FULL_Q30 ? GLINT_LAMP_STEADY : GLINT_LAMP_RISING;
}

static void fade(struct glint_record *r, const struct glint_record_step *step)
{
    const int is_out = r->state == GLINT_LAMP_LEAVING && r->lost_us > 0;
    const int32_t part_q30 = level_step_q30(
        step, is_out ? step->cfg->leave_ms : step->cfg->release_ms);

    r->level_q30 = r->level_q30 > part_q30 ? r->level_q30 - part_q30 : 0;
    r->state = is_out ? GLINT_LAMP_LEAVING : GLINT_LAMP_FADING;
}

void glint_record_set_level(struct glint_record *r,
                            const struct glint_record_step *step)
{
    if (r->lost_us == 0 && r->is_shown)
        rise(r, step);
    else
        fade(r, step);
}

/* Sets the axis to half the angle; it is horizontal if both are 0. */
static void set_axis(struct glint_lamp_track *track, int64_t cos2_q15,
                     int64_t sin2_q15)
{
    const int64_t size_q15 =
        q_root((uint64_t)(cos2_q15 * cos2_q15 + sin2_q15 * sin2_q15));
    const int64_t cos_q15 =
        size_q15 > 0 ? cos2_q15 * ONE_Q15 / size_q15 : ONE_Q15;

    track->cos_q15 = (int32_t)q_root(
        (uint64_t)clamp(ONE_Q15 + cos_q15, 0, 2 * ONE_Q15) << 14);
    track->sin_q15 = (int32_t)q_root(
        (uint64_t)clamp(ONE_Q15 - cos_q15, 0, 2 * ONE_Q15) << 14);
    if (sin2_q15 < 0)
        track->sin_q15 = -track->sin_q15;
}

struct glint_lamp_track glint_record_track(const struct glint_record *r)
{
    const struct glint_follow *of = r->of;
    struct glint_lamp_track track = {
        .id = r->id,
        .state = r->state,
        .x_q8 = q_narrow(q_shift(glint_follow_shown(&of[X]), 8)),
        .y_q8 = q_narrow(q_shift(glint_follow_shown(&of[X + 1]), 8)),
        .size_q8 = q_narrow(glint_follow_shown(&of[SIZE])),
        .level_q15 = q_narrow(q_shift(r->level_q30, 30 - 15)),
        .flux_q16 = glint_follow_shown(&of[FLUX]),
        .power_q16 = glint_follow_shown(&of[GLINT_CHANNEL_POWER])};

    for (int i = 0; i < 2; i++)
        track.axis_q8[i] =
            q_narrow(glint_follow_shown(&of[GLINT_CHANNEL_MAJOR + i]));
    set_axis(&track, glint_follow_shown(&of[GLINT_CHANNEL_COS2]),
             glint_follow_shown(&of[GLINT_CHANNEL_SIN2]));
    for (int i = 0; i < 3; i++)
        track.rgb_q15[i] =
            q_narrow(glint_follow_shown(&of[GLINT_CHANNEL_RED + i]));
    return track;
}
