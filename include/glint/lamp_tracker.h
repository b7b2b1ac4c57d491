/* SPDX-License-Identifier: MIT
 *
 * glint/lamp_tracker.h - lamps over time: which spot of a picture is which
 * lamp.
 *
 *     bytes = glint_lamp_tracker_bytes(&cfg);                        once
 *     glint_lamp_tracker_init(&tracks, &cfg, mem, bytes);
 *     n = glint_lamp_finder_find(finder, &image, spots, 1024);      each
 * picture n = glint_lamp_tracker_step(tracks, spots, n, us, track, max);
 *
 * A track is one lamp with a number of its own. It takes the nearest spot to
 * where it should be by now; its place, flux and colour are averaged where they
 * scatter and followed where they change, and nothing of it jumps: it rises and
 * fades in time, and what becomes of flux and place when lamps merge, part or
 * are hidden is blended in. A track that lost its lamp fades, is remembered for
 * a while and has its number back when the lamp is back. After a cut all begins
 * anew, in one picture.
 *
 * Integers only. The order of the spots changes nothing. A spot that repeats,
 * bit for bit, is what its track says after attack + 1 s or five pictures,
 * whichever is later: bit for bit, at full level.
 */
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
    GLINT_LAMP_STEADY, /* seen, at full level */
    GLINT_LAMP_FADING, /* the lamp is hidden or out, or too many are brighter:
                          the track moves on, slower and slower */
    GLINT_LAMP_LEAVING /* the lamp went out of the picture, and the track moves
                          on */
};

/* A lamp over time. It is to be drawn with LEVEL times power, as the power does
 * not contain the level. */
struct glint_lamp_track {
    uint32_t id; /* counts from 1; no two lamps have the same */
    enum glint_lamp_state state;
    int32_t x_q8, y_q8; /* place, as of a spot; may be outside of the picture */
    int32_t size_q8;    /* RMS radius, pixels */
    int32_t level_q15;  /* 1 .. 32768: how far it has risen or faded */
    int64_t flux_q16;   /* linear luminance, 1 = white pixel */
    int64_t power_q16;  /* the same without clipping: a spot's power */
    int32_t axis_q8[2]; /* RMS semi-axes of the core, pixels */
    /* Direction of the major axis, to 1/4 degree; cos >= 0. */
    int32_t cos_q15, sin_q15;
    int32_t rgb_q15[3]; /* mean linear colour, luminance 1 */
};

struct glint_lamp_tracker_config {
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int max_tracks;    /* lamps that can be followed at a time, 1 .. 1024 */
    int max_shown;     /* the strongest that are seen; the others' level
                          fades. 1 .. max_tracks */
    int32_t match_q15; /* farthest that a spot may be from where its track
                          should be, as a share of the picture's width */
    int32_t cut_q15; /* share of the flux, above 32768: never. A cut is where so
                        much of it goes and as much is new, or three lamps or
                        more go or come all at once */
    /* Milliseconds from 0 to full level, or to a greater flux. */
    int32_t attack_ms;
    int32_t release_ms; /* milliseconds from full level to 0, or to less flux */
    int32_t leave_ms; /* milliseconds of that for lamps that left the picture */
    int32_t memory_ms; /* milliseconds for which a lamp without a spot keeps its
                          number */
    int32_t smooth_ms; /* milliseconds over which scatter is averaged */
};                     /* Every time is 1 .. 60000 ms. */

struct glint_lamp_tracker; /* opaque, in the caller's memory */

/* Sets CFG to what a newcomer should start from, for WIDTH x HEIGHT. */
void glint_lamp_tracker_defaults(struct glint_lamp_tracker_config *cfg,
                                 int width, int height);

/* Bytes that init takes for CFG, exactly; 0 if CFG is out of range. */
size_t glint_lamp_tracker_bytes(const struct glint_lamp_tracker_config *cfg);

/* Places tracks in MEM[BYTES], aligned to 64. GLINT_E_MEMORY: too small.
 * GLINT_E_ARGUMENT: CFG or the alignment is wrong. */
enum glint_status
glint_lamp_tracker_init(struct glint_lamp_tracker **tracks,
                        const struct glint_lamp_tracker_config *cfg, void *mem,
                        size_t bytes);

/* Takes the N (0 .. 1024) spots of the next picture, ELAPSED_US after the one
 * before, and writes the tracks that are to be drawn, the strongest first, at
 * most MAX of them; max_tracks is enough. Returns how many it wrote. Faint
 * spots (glint/lamps.h) only continue tracks. */
int glint_lamp_tracker_step(struct glint_lamp_tracker *tracks,
                            const struct glint_spot *spots, int n,
                            int32_t elapsed_us, struct glint_lamp_track *out,
                            int max);

/* Forgets all tracks: the spots of the next step are new and at full level at
 * once, as after init. For a caller who knows of a cut. */
void glint_lamp_tracker_restart(struct glint_lamp_tracker *tracks);

/* Returns whether the last step was the first, or took its picture for one
 * after a cut. */
int glint_lamp_tracker_was_cut(const struct glint_lamp_tracker *tracks);

/* The part of its white that the next picture of a video keeps, ELAPSED_US
 * after the last: it may darken by a stop a second, and as it likes where no
 * lamp is seen or remembered. For glint_lamp_finder_keep_white(). */
int32_t glint_lamp_tracker_white_q15(const struct glint_lamp_tracker *tracks,
                                     int32_t elapsed_us);

#ifdef __cplusplus
}
#endif

#endif
