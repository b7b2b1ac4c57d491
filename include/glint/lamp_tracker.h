/* SPDX-License-Identifier: MIT
 *
 * glint/lamp_tracker.h - tracks lamps over time: assigns the spots found in
 * each picture to lamps.
 *
 *     bytes = glint_lamp_tracker_bytes(&cfg);                      once
 *     glint_lamp_tracker_init(&tracks, &cfg, mem, bytes);
 *     n = glint_lamp_finder_find(finder, &image, spots, 1024);     each picture
 *     n = glint_lamp_tracker_step(tracks, spots, n, us, track, max);
 *
 * A track is one lamp with a constant number. It is assigned the spot nearest
 * to its predicted position. Noise in position, flux and colour is averaged
 * out; real changes are followed without jumps: a track rises and fades over
 * time, and changes of flux and position are blended when lamps merge, separate
 * or are hidden. A track without a spot fades. It is remembered for a while: if
 * the lamp returns, it gets the same number. After a cut all tracks restart at
 * once.
 *
 * All arithmetic is in integers. The result does not depend on the order of the
 * spots. If a spot stays the same bit for bit, its track equals it bit for bit,
 * at full level, after attack_ms + 1 s or five pictures, whichever is later. */
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
    GLINT_LAMP_STEADY, /* the lamp is visible, at full level */
    /* The lamp is hidden or off, or too many lamps are brighter. The track
     * continues to move, slower and slower. */
    GLINT_LAMP_FADING,
    /* The lamp has left the picture; its track continues to move off-screen. */
    GLINT_LAMP_LEAVING
};

/* A lamp over time. Draw it with the power times the level; the power does not
 * include the level. */
struct glint_lamp_track {
    uint32_t id; /* unique number, from 1 */
    enum glint_lamp_state state;
    int32_t x_q8, y_q8; /* position, as in struct glint_spot; may be
                           off-screen */
    int32_t size_q8;    /* RMS radius, pixels */
    /* Factor that fades the lamp in and out, 1 .. 32768; 32768 is full. */
    int32_t level_q15;
    /* Linear luminance in the picture, 1 = white pixel. */
    int64_t flux_q16;
    /* Linear luminance that the lamp would have if the picture clipped nothing,
     * as in struct glint_spot. */
    int64_t power_q16;
    int32_t axis_q8[2]; /* RMS semi-axes of the core, pixels */
    /* Direction of the major axis, to 1/4 degree; cos >= 0. */
    int32_t cos_q15, sin_q15;
    int32_t rgb_q15[3]; /* mean linear colour, luminance 1 */
};

struct glint_lamp_tracker_config {
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int max_tracks;    /* max number of lamps that are tracked at a time, 1 ..
                          1024 */
    /* Max number of lamps that are reported, 1 .. max_tracks. The strongest
     * lamps are reported; the level of all others falls. */
    int max_shown;
    /* Max distance of a spot from the predicted position of its track, as a
     * fraction of the picture's width. */
    int32_t match_q15;
    /* Min fraction of the flux that changes at a cut; above 32768: cuts are not
     * detected. There are two criteria for a cut. Either this fraction of the
     * previous picture's flux vanishes and this fraction of the new picture's
     * flux is new; or all of three or more lamps vanish at once, or three or
     * more appear in a picture without lamps. */
    int32_t cut_q15;
    /* Time in which the level rises from 0 to full, or the flux rises to a
     * greater flux, milliseconds. All times of this struct are 1 .. 60000. */
    int32_t attack_ms;
    /* Time in which the level falls from full to 0, or the flux falls to a
     * lesser flux, milliseconds. */
    int32_t release_ms;
    /* Time in which the level falls from full to 0 after the lamp left the
     * picture, milliseconds. */
    int32_t leave_ms;
    /* Time for which the number of a lamp without a spot stays reserved for it,
     * milliseconds. */
    int32_t memory_ms;
    int32_t smooth_ms; /* time constant of averaging, milliseconds */
};

struct glint_lamp_tracker; /* opaque, in the caller's memory */

/* Sets CFG to defaults for pictures of WIDTH x HEIGHT. */
void glint_lamp_tracker_defaults(struct glint_lamp_tracker_config *cfg,
                                 int width, int height);

/* Returns the exact number of bytes that glint_lamp_tracker_init() needs for
 * CFG; 0 if CFG is out of range. */
size_t glint_lamp_tracker_bytes(const struct glint_lamp_tracker_config *cfg);

/* Places a tracker in MEM[BYTES], aligned to 64; *TRACKS points into it.
 * Returns GLINT_E_MEMORY if BYTES is too small. Returns GLINT_E_ARGUMENT if CFG
 * or the alignment is wrong. */
enum glint_status
glint_lamp_tracker_init(struct glint_lamp_tracker **tracks,
                        const struct glint_lamp_tracker_config *cfg, void *mem,
                        size_t bytes);

/* Processes the N (0 .. 1024) spots of the next picture, ELAPSED_US after the
 * last picture, and writes the tracks to be drawn to OUT, the strongest first.
 * Writes at most MAX, which need not exceed max_tracks; returns their number.
 * Faint spots (glint/lamps.h) continue tracks but do not start any. */
int glint_lamp_tracker_step(struct glint_lamp_tracker *tracks,
                            const struct glint_spot *spots, int n,
                            int32_t elapsed_us, struct glint_lamp_track *out,
                            int max);

/* Removes all tracks: the spots of the next step start new tracks at full
 * level, as after glint_lamp_tracker_init(). Call it at a known cut. */
void glint_lamp_tracker_restart(struct glint_lamp_tracker *tracks);

/* Returns whether the last step was the first one, or detected a cut. */
int glint_lamp_tracker_was_cut(const struct glint_lamp_tracker *tracks);

/* Returns the fraction PART_Q15 for glint_lamp_finder_keep_white(), for the
 * next picture of a video, ELAPSED_US after the last picture. With this
 * fraction the white level may fall by a stop per second, or by any amount if
 * no lamp is visible or remembered. */
int32_t glint_lamp_tracker_white_q15(const struct glint_lamp_tracker *tracks,
                                     int32_t elapsed_us);

#ifdef __cplusplus
}
#endif

#endif
