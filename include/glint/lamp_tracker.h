/* SPDX-License-Identifier: MIT
 *
 * glint/lamp_tracker.h - follows lamps over time: which spot of a picture is
 * which lamp.
 *
 *     bytes = glint_lamp_tracker_bytes(&cfg);                      once
 *     glint_lamp_tracker_init(&tracks, &cfg, mem, bytes);
 *     n = glint_lamp_finder_find(finder, &image, spots, 1024);     each picture
 *     n = glint_lamp_tracker_step(tracks, spots, n, us, track, max);
 *
 * A track is one lamp with a constant number. It is assigned the spot nearest
 * to its predicted place. Place, flux and colour are averaged where they
 * scatter and followed where they change, without jumps: a track rises and
 * fades in time, and changes of flux and place are blended when lamps merge,
 * separate or are hidden. A track without a spot fades, is remembered for a
 * while, and gets its number back when the lamp returns. After a cut all tracks
 * restart, in one picture.
 *
 * Integers only. The order of the spots changes nothing. If a spot repeats,
 * bit for bit, its track equals it after attack + 1 s or five pictures,
 * whichever is later: bit for bit, at full level. */
#ifndef GLINT_LAMP_TRACKER_H
#define GLINT_LAMP_TRACKER_H

#include <stddef.h>
#include <stdint.h>

#include "glint/lamps.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_lamp_state {
    GLINT_LAMP_RISING,
    GLINT_LAMP_STEADY, /* visible, at full level */
    GLINT_LAMP_FADING, /* the lamp is hidden or off, or too many are brighter:
                          the track continues, slower and slower */
    GLINT_LAMP_LEAVING /* the lamp left the picture, and the track continues */
};

/* A lamp over time. Draw it with LEVEL times power; the power does not
 * include the level. */
struct glint_lamp_track {
    uint32_t id; /* counts from 1; unique */
    enum glint_lamp_state state;
    int32_t x_q8, y_q8; /* place, as in struct glint_spot; may be off-screen */
    int32_t size_q8;    /* RMS radius, pixels */
    int32_t level_q15; /* 1 .. 32768: how far the lamp has risen or faded; 32768
                          is full */
    int64_t flux_q16;  /* linear luminance, 1 = white pixel */
    int64_t power_q16; /* linear luminance without clipping, as in struct
                          glint_spot */
    int32_t axis_q8[2]; /* RMS semi-axes of the core, pixels */
    /* Direction of the major axis, to 1/4 degree; cos >= 0. */
    int32_t cos_q15, sin_q15;
    int32_t rgb_q15[3]; /* mean linear colour, luminance 1 */
};

struct glint_lamp_tracker_config {
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int max_tracks;    /* max lamps that are followed at a time, 1 .. 1024 */
    int max_shown;     /* max lamps that are reported, the strongest, 1 ..
                          max_tracks; the level of others fades */
    int32_t match_q15; /* max distance of a spot from the predicted place of its
                          track, as a fraction of the picture's width */
    int32_t cut_q15;   /* fraction of the flux; above 32768: no cuts. A cut is
                          where at least this fraction of the flux vanishes and at
                          least this fraction of the flux seen now is new, or
                          where three lamps or more appear or vanish at once */
    /* Milliseconds from level 0 to full, or to a greater flux. */
    int32_t attack_ms;
    int32_t release_ms; /* milliseconds from full level to 0, or to less flux */
    int32_t leave_ms;   /* milliseconds from full level to 0 for lamps that left
                           the picture */
    int32_t memory_ms; /* milliseconds for which a lamp without a spot keeps its
                          number */
    int32_t smooth_ms; /* time constant of averaging, milliseconds */
};                     /* Every time is 1 .. 60000 ms. */

struct glint_lamp_tracker; /* opaque, in the caller's memory */

/* Sets CFG to defaults for pictures of WIDTH x HEIGHT. */
void glint_lamp_tracker_defaults(struct glint_lamp_tracker_config *cfg,
                                 int width, int height);

/* Returns the exact number of bytes that init needs for CFG; 0 if CFG is out
 * of range. */
size_t glint_lamp_tracker_bytes(const struct glint_lamp_tracker_config *cfg);

/* Places tracks in MEM[BYTES], aligned to 64. GLINT_E_MEMORY: BYTES is too
 * small. GLINT_E_ARGUMENT: CFG or the alignment is wrong. */
enum glint_status
glint_lamp_tracker_init(struct glint_lamp_tracker **tracks,
                        const struct glint_lamp_tracker_config *cfg, void *mem,
                        size_t bytes);

/* Processes the N (0 .. 1024) spots of the next picture, ELAPSED_US after
 * the last one, and writes the tracks to be drawn, the strongest first, at
 * most MAX of them; max_tracks is enough. Returns their number. Faint spots
 * (glint/lamps.h) only continue tracks. */
int glint_lamp_tracker_step(struct glint_lamp_tracker *tracks,
                            const struct glint_spot *spots, int n,
                            int32_t elapsed_us, struct glint_lamp_track *out,
                            int max);

/* Forgets all tracks: the spots of the next step are new and at full level
 * at once, as after init. For callers that know of a cut. */
void glint_lamp_tracker_restart(struct glint_lamp_tracker *tracks);

/* Returns whether the last step was the first one, or detected a cut. */
int glint_lamp_tracker_was_cut(const struct glint_lamp_tracker *tracks);

/* Returns the fraction of its white, _q15, that the next picture of a video,
 * ELAPSED_US after the last one, should keep: white may darken by a stop per
 * second, or by any amount if no lamp is seen or remembered. For
 * glint_lamp_finder_keep_white(). */
int32_t glint_lamp_tracker_white_q15(const struct glint_lamp_tracker *tracks,
                                     int32_t elapsed_us);

#ifdef __cplusplus
}
#endif

#endif
