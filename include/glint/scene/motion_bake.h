/* SPDX-License-Identifier: MIT
 *
 * glint/scene/motion_bake.h - reconstructs the motion of a body from its
 * recording, in double precision.
 *
 *     baker = glint_motion_baker_open();
 *     glint_recording_read(baker, "run.json", read, ctx, &error);
 *     glint_motion_baker_finish(baker, "run", &data, &bytes, &report, &error);
 *     glint_motion_baker_close(baker);
 *
 *   in   frame by frame, where foods are in the axes of the body, and which of
 *        them are new ones
 *   out  where the body is and how it is turned in each, in the axes of the
 *        first; and where the foods are: a file of glint/scene/motion.h
 *
 * The same recording gives the same bytes. Frames are taken one by
 * one: memory grows by some 60 bytes a frame. */
#ifndef GLINT_SCENE_MOTION_BAKE_H
#define GLINT_SCENE_MOTION_BAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/scene/motion.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What does not change. */
struct glint_motion_body {
    double size;      /* radius, 0 .. 1e6 */
    double angle_deg; /* that each sensor sees, 0.01 .. 360 */
    int n_sensors;
    /* Axis of each: (sin theta cos phi, sin theta sin phi, cos theta). */
    double theta[GLINT_MOTION_MAX_SENSORS], phi[GLINT_MOTION_MAX_SENSORS];
};

/* What one frame saw. */
struct glint_motion_sight {
    long long number; /* of the frame, as it is written; -1: it is not */
    /* The body's own odometry: translation and rotation since the previous
     * frame, in its axes at that frame; rv is an axis times an angle in
     * radians. */
    double tv[3], rv[3];
    int n_foods;
    double food[GLINT_MOTION_MAX_FOODS][3];
    bool is_new[GLINT_MOTION_MAX_FOODS]; /* means nothing in the first frame */
    /* Of each food: 0: all are 1; 1: of all sensors; else of each. */
    int n_intensities;
    double intensity[GLINT_MOTION_MAX_FOODS][GLINT_MOTION_MAX_SENSORS];
};

struct glint_motion_report {
    long n_frames, n_resets;
    double span; /* diagonal of the box of all frames */
    double path; /* length of the way */
    double residual, residual_rms;
    long residual_frame, bad_frames; /* whose residual is over a thousandth of
                                        the span */
    long held_intensities;           /* outside 0 .. 1 */
    /* If rv and tv are given: error of the pose integrated from them, at the
     * end and max. */
    bool has_senses;
    double senses_off, senses_most;
};

struct glint_motion_baker;

/* Returns NULL if there is no memory. */
struct glint_motion_baker *glint_motion_baker_open(void);
void glint_motion_baker_close(struct glint_motion_baker *baker);

/* Take the body, before finish, and the next frame. GLINT_E_LENS: ERROR states
 * what is wrong, but not where; GLINT_E_MEMORY. */
enum glint_status glint_motion_baker_body(struct glint_motion_baker *baker,
                                          const struct glint_motion_body *body,
                                          struct glint_error *error);
enum glint_status
glint_motion_baker_frame(struct glint_motion_baker *baker,
                         const struct glint_motion_sight *sight,
                         struct glint_error *error);

/* Makes the file, *DATA, which is malloc'ed. NAME is kept in it, its first 63
 * characters of a-z, A-Z, 0-9, '-' and '_'. GLINT_E_LENS: there is no frame, or
 * what there is does not fit together; GLINT_E_MEMORY. */
enum glint_status glint_motion_baker_finish(struct glint_motion_baker *baker,
                                            const char *name, uint64_t key,
                                            unsigned char **data, size_t *bytes,
                                            struct glint_motion_report *report,
                                            struct glint_error *error);

/* Reads at most N bytes into TO; returns how many, 0 at the end, -1 if it could
 * not. */
typedef long glint_recording_read_fn(void *ctx, char *to, size_t n);

/* Reads a recording in JSON, in the words of either spelling, frame by frame,
 * and hands it to BAKER. Unknown keys are skipped, commas may trail.
 * GLINT_E_LENS: ERROR states file, line, column and cause. GLINT_E_UNSUPPORTED:
 * glint was built without jansson; GLINT_E_IO, GLINT_E_MEMORY. */
enum glint_status glint_recording_read(struct glint_motion_baker *baker,
                                       const char *file_name,
                                       glint_recording_read_fn *read, void *ctx,
                                       struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
