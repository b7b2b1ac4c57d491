/* SPDX-License-Identifier: MIT
 *
 * Finds lamps in pictures of one size, and follows them if these are a video.
 * All memory is allocated by open. */
#ifndef GLINT_ENGINE_DETECTOR_H
#define GLINT_ENGINE_DETECTOR_H

#include "glint/bake.h"
#include "glint/lamps.h"
#include "glint/profile.h"
#include "glint/lamp_tracker.h"

enum { GLINT_LAMP_DETECTOR_MAX = 1024 }; /* as many as GLINT_ENGINE_MAX_LAMPS */

struct glint_lamp_detector {
    double headroom_ev; /* stops by which clipped pixels exceed white; below 0:
                           estimated from the profile of each lamp */
    int max; /* most lamps per picture, 1 .. GLINT_LAMP_DETECTOR_MAX */

    /* The lamps of the last frame, as found, the strongest first; those of a
     * still picture are numbered from 1. */
    struct glint_lamp_track *track;
    int n_tracks;

    /* Private. */
    struct glint_lamp_finder *lights;
    struct glint_lamp_tracker *tracks;
    struct glint_profile *profile;
    double scale;            /* factor on the powers of tracks */
    struct glint_spot *spot; /* [GLINT_LAMP_DETECTOR_MAX] */
    int n_spots;             /* spots of the last frame, lamps and candidates */
    int max_tracks;
    void *mem;
};

/* Opens DETECTOR, whose headroom_ev and max are set. CFG states what a lamp is;
 * its keep_faint is not used. */
enum glint_status
glint_lamp_detector_open(struct glint_lamp_detector *detector,
                         const struct glint_lamp_finder_config *cfg);

/* The same for pictures of WIDTH x HEIGHT, with lamps that reach
 * threshold_ev[0] stops from white and extend down to threshold_ev[1]. */
enum glint_status
glint_lamp_detector_open_at(struct glint_lamp_detector *detector, int width,
                            int height, const double threshold_ev[2]);
void glint_lamp_detector_close(struct glint_lamp_detector *detector);

/* Writes the lamps of IMAGE, which comes ELAPSED_US after the last frame, to
 * LAMPS, which has room for GLINT_LAMP_DETECTOR_MAX; returns how many. They
 * rise and fade as in glint/lamp_tracker.h, so for a while there may be a few
 * more than max. ELAPSED_US 0: IMAGE is a still picture. */
int glint_lamp_detector_frame(struct glint_lamp_detector *detector,
                              const struct glint_image *image,
                              int32_t elapsed_us, const struct glint_view *view,
                              double focal_mm, struct glint_lamp *lamps);

/* Returns the light of LAMP in excess of what the picture shows, in white x
 * pixels: TRACK is the lamp's, LEVEL how far it has risen, SHARE its visible
 * fraction, and WHITE the light of the picture's white. */
double glint_lamp_excess(const struct glint_lamp *lamp,
                         const struct glint_lamp_track *track, double level,
                         double share, double white);

/* Returns spot I, the strongest first, of those of the last frame that were not
 * taken for lamps, yet are within a stop of white on average and about as
 * compact as a disc; NULL if there are no so many. */
const struct glint_spot *
glint_lamp_detector_doubtful(const struct glint_lamp_detector *detector, int i);

/* Declares that the next frame is unrelated to the last one: another camera, a
 * jump. */
void glint_lamp_detector_restart(struct glint_lamp_detector *detector);

#endif
