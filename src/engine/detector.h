/* SPDX-License-Identifier: MIT
 *
 * Finds lamps in pictures of one size, and tracks them if the pictures are
 * frames of a video. Memory is allocated only by the functions with open in
 * their names. */
#ifndef GLINT_ENGINE_DETECTOR_H
#define GLINT_ENGINE_DETECTOR_H

#include "glint/bake.h"
#include "glint/lamps.h"
#include "glint/profile.h"
#include "glint/lamp_tracker.h"

enum { GLINT_LAMP_DETECTOR_MAX = 1024 }; /* equal to GLINT_ENGINE_MAX_LAMPS */

struct glint_lamp_detector {
    double headroom_ev; /* assumed light of clipped pixels, stops above white;
                           below 0: the clipped light of each lamp is estimated
                           from its surroundings */
    int max; /* max number of lamps per picture, 1 .. GLINT_LAMP_DETECTOR_MAX */

    /* Lamps of the last frame in picture coordinates, the strongest first. The
     * ids of lamps in a still picture count from 1. */
    struct glint_lamp_track *track;
    int n_tracks;

    /* Private. */
    struct glint_lamp_finder *lights;
    struct glint_lamp_tracker *tracks;
    struct glint_profile *profile;
    double scale;            /* power of a lamp / power of its track */
    struct glint_spot *spot; /* [GLINT_LAMP_DETECTOR_MAX] */
    int n_spots; /* number of bright spots in the last frame, including spots
                    that are not lamps */
    int max_tracks;
    void *mem;
};

/* Opens DETECTOR, whose headroom_ev and max must be set. CFG has the thresholds
 * and rules for lamps; its member keep_faint is ignored. Returns
 * GLINT_E_ARGUMENT if CFG is out of range, or GLINT_E_MEMORY. */
enum glint_status
glint_lamp_detector_open(struct glint_lamp_detector *detector,
                         const struct glint_lamp_finder_config *cfg);

/* Like glint_lamp_detector_open(), for pictures of WIDTH x HEIGHT. The pixels
 * of a lamp have at least threshold_ev[1] stops relative to white, and one of
 * them has at least threshold_ev[0] stops. */
enum glint_status
glint_lamp_detector_open_at(struct glint_lamp_detector *detector, int width,
                            int height, const double threshold_ev[2]);
void glint_lamp_detector_close(struct glint_lamp_detector *detector);

/* Finds the lamps of IMAGE, writes them to LAMPS, an array of
 * GLINT_LAMP_DETECTOR_MAX, and returns their number. ELAPSED_US is the time
 * since the last frame; 0: IMAGE is a still picture. VIEW and FOCAL_MM convert
 * pixels to directions. In a video lamps fade in and out, so that their number
 * may exceed max for a while. */
int glint_lamp_detector_find_lamps(struct glint_lamp_detector *detector,
                                   const struct glint_image *image,
                                   int32_t elapsed_us,
                                   const struct glint_view *view,
                                   double focal_mm, struct glint_lamp *lamps);

/* Returns the light of LAMP that is missing in the picture because it was
 * clipped, in white times pixels. It is the power of LAMP minus its flux in the
 * picture, at least 0. TRACK is the lamp's track, LEVEL its fade level 0 .. 1,
 * SHARE the visible fraction of the lamp, WHITE the linear light of the
 * picture's white. */
double glint_lamp_compute_excess_light(const struct glint_lamp *lamp,
                                       const struct glint_lamp_track *track,
                                       double level, double share,
                                       double white);

/* Returns the I-th doubtful spot of the last frame, counted from 0, the
 * strongest first. Returns NULL if there are no more. A doubtful spot was
 * rejected as a lamp, but its mean light is within a stop of white, and it is
 * about as compact as a disc. */
const struct glint_spot *
glint_lamp_detector_doubtful(const struct glint_lamp_detector *detector, int i);

/* Drops all tracks, for a next frame that is unrelated to the last one, as
 * after a cut to another camera. */
void glint_lamp_detector_restart_tracking(struct glint_lamp_detector *detector);

#endif
