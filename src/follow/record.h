/* SPDX-License-Identifier: MIT
 *
 * One lamp over time: its record, and how a picture changes it.
 *
 *     glint_record_begin(r, id, spot);               once
 *     glint_record_look_ahead(r, &step);             each picture
 *     glint_record_see(r, &step, spot);              or
 *     glint_record_miss(r, &step);
 *     glint_record_set_level(r, &step); */
#ifndef GLINT_FOLLOW_RECORD_H
#define GLINT_FOLLOW_RECORD_H

#include "glint/lamp_tracker.h"

/* One number of a lamp that is followed (record.c). */
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

/* The channels that are followed: places in _q16, all others as in struct
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
    uint32_t id; /* 0: the record is free */
    enum glint_lamp_state state;
    struct glint_follow of[GLINT_CHANNELS];
    struct glint_spot last; /* the spot that it was last seen as */
    int n_same; /* number of pictures in a row, after the first, that showed the
                   same spot */
    int64_t velocity_q16[2]; /* pixels a second */
    int64_t ahead_q16[2];    /* pixels: predicted place of the lamp */
    int32_t level_q30;
    int32_t lost_us; /* time since it was last seen; 0: it is seen now */
    int is_shown; /* set by the caller: the level rises while the lamp is seen
                   */
};

/* The values that all records of a picture share. */
struct glint_record_step {
    const struct glint_lamp_tracker_config *cfg;
    struct glint_pace pace;
    int is_fresh; /* 1: a lamp that begins is at full level at once */
};

/* Returns the flux of a spot, clamped to 0 .. 2^42: the largest picture, all
 * white. */
int64_t glint_record_flux_q16(const struct glint_spot *spot);

/* Returns the power of a spot, clamped to 0 .. 2^42. */
int64_t glint_record_power_q16(const struct glint_spot *spot);

void glint_record_begin(struct glint_record *r, uint32_t id,
                        const struct glint_spot *spot);

/* Predicts the place of the lamp. */
void glint_record_look_ahead(struct glint_record *r,
                             const struct glint_record_step *step);

void glint_record_see(struct glint_record *r,
                      const struct glint_record_step *step,
                      const struct glint_spot *spot);

/* Continues a record without a spot: the lamp moves on, and is forgotten after
 * a while. */
void glint_record_miss(struct glint_record *r,
                       const struct glint_record_step *step);

/* Raises or lowers the level by the time of the step, and sets the state. */
void glint_record_set_level(struct glint_record *r,
                            const struct glint_record_step *step);

struct glint_lamp_track glint_record_track(const struct glint_record *r);

#endif
