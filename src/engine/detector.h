/* SPDX-License-Identifier: MIT
 *
 * Finds lamps in pictures of one size, and follows them where these are a
 * video. What it needs is taken by open.
 */
#ifndef GLINT_ENGINE_DETECTOR_H
#define GLINT_ENGINE_DETECTOR_H

#include "glint/bake.h"
#include "glint/lamps.h"
#include "glint/profile.h"
#include "glint/lamp_tracker.h"

enum { GLINT_LAMP_DETECTOR_MAX = 1024 }; /* GLINT_ENGINE_MAX_LAMPS */

struct glint_lamp_detector {
    double headroom_ev; /* stops by which clipped pixels really exceed white;
                           below 0: the profile of each lamp tells */
    int max; /* most lamps per picture, 1 .. GLINT_LAMP_DETECTOR_MAX */

    /* The lamps of the last frame, as found, the strongest first; untracked
     * ones are numbered from 1. */
    struct glint_lamp_track *track;
    int n_tracks;

    /* Private. */
    struct glint_lamp_finder *lights;
    struct glint_lamp_tracker *tracks;
    struct glint_profile *profile;
    double scale;            /* factor of the powers of tracks */
    struct glint_spot *spot; /* [GLINT_LAMP_DETECTOR_MAX] */
    int n_spots; /* spots of the last frame, lamps and doubtful ones */
    int max_tracks;
    void *mem;
};

/* Sets headroom_ev and max before. CFG says what a light is; keep_faint is the
 * detector's own. */
enum glint_status
glint_lamp_detector_open(struct glint_lamp_detector *detector,
                         const struct glint_lamp_finder_config *cfg);
void glint_lamp_detector_close(struct glint_lamp_detector *detector);

/* Writes the lamps of IMAGE, which comes ELAPSED_US after the one before:
 * rising and fading as glint/lamp_tracker.h has it, so a few more than max may
 * be there for a while. 0: a picture by itself. LAMPS has room for
 * GLINT_LAMP_DETECTOR_MAX. */
int glint_lamp_detector_frame(struct glint_lamp_detector *detector,
                              const struct glint_image *image,
                              int32_t elapsed_us, const struct glint_view *view,
                              double focal_mm, struct glint_lamp *lamps);

/* The strongest place of the last frame that was taken for no lamp, yet is
 * within a stop of white on average and about as compact as a disc; NULL: there
 * is none. */
const struct glint_spot *
glint_lamp_detector_doubtful(const struct glint_lamp_detector *detector);

/* The next frame has nothing to do with the last: another camera, a jump. */
void glint_lamp_detector_restart(struct glint_lamp_detector *detector);

#endif
