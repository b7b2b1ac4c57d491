/* SPDX-License-Identifier: MIT
 *
 * Follows one number of a lamp over time: noise is averaged, change is
 * followed.
 *
 *   in   the number as each picture shows it, at any rate
 *   out  a number that does not scatter, lag or jump
 *
 * Method: errors of the number are averaged with their signs (drift) and
 * without (spread). Noise drifts nowhere, so its drift is a small part of the
 * spread, and the number moves a small part of the way, as an average over the
 * pace's time does. A change drifts all one way, or is far larger than the
 * spread, and the number follows it at once. So the filter adapts to the noise
 * of each lamp, and lags behind steady change by no more than five times an
 * error that does no harm (floor).
 *
 * A change that must not be seen at once is blended: the number has it, and the
 * shown number goes there at a bounded speed.
 *
 * A number that repeats bit for bit has no noise; it is reached soon and
 * exactly.
 *
 * Limits: numbers are below 2^43 in magnitude, times below 2^26 us. */
#ifndef GLINT_FOLLOW_FOLLOW_H
#define GLINT_FOLLOW_FOLLOW_H

#include <stdint.h>

struct glint_follow {
    int64_t value;
    /* Means of errors with their signs, and of their magnitudes. */
    int64_t drift, spread;
    int64_t offset; /* value + offset is shown */
    int64_t stride; /* distance that the offset moves in the time of a blend */
};

/* The filter's parameters for the time between two pictures. */
struct glint_pace {
    int32_t elapsed_us;
    int32_t smooth_q15; /* part of the way for noise */
    int32_t settle_q15; /* part of the way for change that repeats */
};

struct glint_pace glint_pace_of(int32_t elapsed_us, int32_t smooth_us);

/* Returns ELAPSED_US / (ELAPSED_US + TIME_US): the part of the way that an
 * average over that time goes; TIME_US >= 1. */
int32_t glint_pace_part_q15(int32_t elapsed_us, int32_t time_us);

/* Returns ELAPSED_US / TIME_US, 1 at most: the part of the way at a steady
 * speed. */
int32_t glint_pace_share_q15(int32_t elapsed_us, int32_t time_us);

/* Begins at VALUE; its errors are assumed to be SPREAD until they are known. */
void glint_follow_start(struct glint_follow *f, int64_t value, int64_t spread);

/* Moves the shown number towards the value for ELAPSED_US; a whole stride takes
 * TIME_US. */
void glint_follow_blend(struct glint_follow *f, int32_t elapsed_us,
                        int32_t time_us);

enum glint_follow_as {
    GLINT_FOLLOW_JUDGED,   /* noise or change is told by the errors so far */
    GLINT_FOLLOW_REPEATED, /* all members of the lamp are as they were */
    GLINT_FOLLOW_CHANGED
};

/* Follows TARGET; FLOOR is an error that does no harm, >= 1. Returns how much
 * of a change it was, 0 .. 1. */
int32_t glint_follow_step_q15(struct glint_follow *f, int64_t target,
                              int64_t floor, const struct glint_pace *pace,
                              enum glint_follow_as as);

/* Goes from AHEAD towards TARGET as for noise, and assumes noise of at least
 * SPREAD until more is known. */
void glint_follow_doubt(struct glint_follow *f, int64_t ahead, int64_t target,
                        int64_t spread, const struct glint_pace *pace);

/* Sets the value, but goes on showing SHOWN; blends then move from there to the
 * value, within their time unless more changes follow. */
void glint_follow_jump(struct glint_follow *f, int64_t value, int64_t shown);

static inline int64_t glint_follow_shown(const struct glint_follow *f)
{
    return f->value + f->offset;
}

#endif
