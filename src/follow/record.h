/* SPDX-License-Identifier: MIT
 *
 * The state of one tracked lamp (a record), and its update for each picture.
 *
 *     glint_record_begin_track(r, id, spot);               once
 *     glint_record_predict_position(r, &step);             each picture
 *     glint_record_update_with_spot(r, &step, spot);              or
 *     glint_record_update_without_spot(r, &step);
 *     glint_record_update_fade_level(r, &step); */
#ifndef GLINT_FOLLOW_RECORD_H
#define GLINT_FOLLOW_RECORD_H

#include "glint/lamp_tracker.h"

/* The state of the filter of one number of a lamp (record.c). */
struct glint_follow {
    int64_t value;
    /* Averages of the errors: with their signs (drift), and of their magnitudes
     * (spread). */
    int64_t drift, spread;
    int64_t offset; /* shown number minus value */
    int64_t stride; /* max change of offset in one attack or release time */
};

/* The filter's parameters for the time between two pictures. */
struct glint_pace {
    int32_t elapsed_us;
    int32_t smooth_q15; /* fraction of an error that one picture corrects if the
                           error is noise */
    int32_t settle_q15; /* fraction of an error that one picture corrects if
                           spots repeat exactly */
};

struct glint_pace glint_pace_compute_for_interval(int32_t elapsed_us,
                                                  int32_t smooth_us);

/* Returns ELAPSED_US / (ELAPSED_US + TIME_US): the fraction of an error that an
 * average over TIME_US corrects. TIME_US must be at least 1. */
int32_t glint_pace_compute_fraction_q15(int32_t elapsed_us, int32_t time_us);

/* The numbers of a lamp that are filtered. Positions are in _q16, all others in
 * the units of struct glint_spot. */
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
    int n_same; /* number of consecutive pictures whose spot equals the one
                   before */
    int is_new; /* number of further pictures in which the first motion sets the
                   velocity; 0: motion is averaged into the velocity */
    int64_t velocity_q16[2]; /* velocity of the lamp, pixels per second */
    int64_t ahead_q16[2];    /* predicted position of the lamp, pixels, _q16 */
    int32_t level_q30;
    int32_t lost_us; /* time since the lamp last had a spot, us; 0: it has one
                        in this picture */
    int is_shown; /* set by the caller; 1: the fade level rises while the lamp
                     has a spot */
};

/* Parameters of one picture, common to all records. */
struct glint_record_step {
    const struct glint_lamp_tracker_config *cfg;
    struct glint_pace pace;
    int is_fresh; /* 1: new lamps are shown at full level at once, without a
                     fade */
};

/* Returns the flux of SPOT, clamped to 0 .. 2^42, the flux of 2^26 white
 * pixels. */
int64_t glint_record_clamp_flux_q16(const struct glint_spot *spot);

/* Returns the power of SPOT, clamped to the same range. */
int64_t glint_record_clamp_power_q16(const struct glint_spot *spot);

void glint_record_begin_track(struct glint_record *r, uint32_t id,
                              const struct glint_spot *spot);

/* Sets ahead_q16 to the position that the velocity predicts for this picture.
 */
void glint_record_predict_position(struct glint_record *r,
                                   const struct glint_record_step *step);

void glint_record_update_with_spot(struct glint_record *r,
                                   const struct glint_record_step *step,
                                   const struct glint_spot *spot);

/* Updates a record for a picture in which the lamp has no spot: moves the lamp
 * by its velocity. Frees the record if the lamp is far off-screen, or is faded
 * out and leaving the picture or lost for memory_ms. */
void glint_record_update_without_spot(struct glint_record *r,
                                      const struct glint_record_step *step);

/* Raises or lowers the fade level, limited by the elapsed time, and sets the
 * lamp's state. */
void glint_record_update_fade_level(struct glint_record *r,
                                    const struct glint_record_step *step);

struct glint_lamp_track glint_record_make_track(const struct glint_record *r);

#endif
