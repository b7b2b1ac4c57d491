/* SPDX-License-Identifier: MIT
 *
 * The state of one tracked lamp (a record), and its update for each picture.
 *
 *     glint_record_begin(r, id, spot);               once
 *     glint_record_look_ahead(r, &step);             each picture
 *     glint_record_see(r, &step, spot);              or
 *     glint_record_miss(r, &step);
 *     glint_record_set_level(r, &step); */
#ifndef GLINT_FOLLOW_RECORD_H
#define GLINT_FOLLOW_RECORD_H

#include "glint/lamp_tracker.h"

/* The state of the filter of one number of a lamp (record.c). */
struct glint_follow {
    int64_t value;
    /* Averages of the errors with their signs, and of their magnitudes. */
    int64_t drift, spread;
    int64_t offset; /* the number shown is value + offset */
    int64_t stride; /* change of the offset over the time of a blend */
};

/* The filter's parameters for the time between two pictures. */
struct glint_pace {
    int32_t elapsed_us;
    int32_t smooth_q15; /* fraction of the error that is corrected per picture
                           if it is noise */
    int32_t settle_q15; /* fraction that is corrected if the error persists */
};

struct glint_pace glint_pace_of(int32_t elapsed_us, int32_t smooth_us);

/* Returns ELAPSED_US / (ELAPSED_US + TIME_US): the fraction of an error that an
 * average over TIME_US corrects. TIME_US must be at least 1. */
int32_t glint_pace_part_q15(int32_t elapsed_us, int32_t time_us);

/* The channels of the filter: positions in _q16, all others as in struct
 * glint_spot. */
enum glint_record_channel {
    GLINT_CHANNEL_X,
    GLINT_CHANNEL_Y,
    GLINT_CHANNEL_FLUX,
    GLINT_CHANNEL_POWER,
    GLINT_CHANNEL_SIZE,
    GLINT_CHANNEL_MAJOR,
    GLINT_CHANNEL_MINOR,
    GLINT_CHANNEL_COS2, /* cosine of twice the orientation */
    GLINT_CHANNEL_SIN2,
    GLINT_CHANNEL_RED,
    GLINT_CHANNEL_GREEN,
    GLINT_CHANNEL_BLUE,
    GLINT_CHANNELS
};

struct glint_record {
    uint32_t id; /* identifies the lamp; 0: the record is free */
    enum glint_lamp_state state;
    struct glint_follow of[GLINT_CHANNELS];
    struct glint_spot last; /* the last spot that was assigned to the lamp */
    int n_same; /* number of consecutive pictures, after the first, with an
                   equal spot */
    int is_new; /* number of steps in which the first motion is taken as the
                   lamp's velocity; 0: it has one, or does not move */
    int64_t velocity_q16[2]; /* pixels per second */
    int64_t ahead_q16[2];    /* predicted position of the lamp, pixels, _q16 */
    int32_t level_q30;
    int32_t lost_us; /* time since the lamp was last seen, us; 0: it is seen in
                        this picture */
    int is_shown; /* set by the caller: true if the level rises while the lamp
                     is seen */
};

/* The values that all records of a picture share. */
struct glint_record_step {
    const struct glint_lamp_tracker_config *cfg;
    struct glint_pace pace;
    int is_fresh; /* 1: new lamps start at full level */
};

/* Returns the flux of a spot, clamped to 0 .. 2^42, the flux of the largest
 * picture if all white. */
int64_t glint_record_flux_q16(const struct glint_spot *spot);

/* Returns the power of a spot, clamped to 0 .. 2^42. */
int64_t glint_record_power_q16(const struct glint_spot *spot);

void glint_record_begin(struct glint_record *r, uint32_t id,
                        const struct glint_spot *spot);

/* Predicts the position of the lamp. */
void glint_record_look_ahead(struct glint_record *r,
                             const struct glint_record_step *step);

void glint_record_see(struct glint_record *r,
                      const struct glint_record_step *step,
                      const struct glint_spot *spot);

/* Updates a record for a picture without a spot of the lamp: the lamp moves
 * on with its velocity, and is dropped after a time. */
void glint_record_miss(struct glint_record *r,
                       const struct glint_record_step *step);

/* Raises or lowers the level according to the time of the step, and sets the
 * state. */
void glint_record_set_level(struct glint_record *r,
                            const struct glint_record_step *step);

struct glint_lamp_track glint_record_track(const struct glint_record *r);

#endif
