/* SPDX-License-Identifier: MIT
 *
 * glint/scene/motion_bake.h - reconstructs the motion of a body from a
 * recording, in double precision.
 *
 *     baker = glint_motion_baker_open();
 *     glint_recording_read(baker, "run.json", read, ctx, &error);
 *     glint_motion_baker_finish(baker, "run", &data, &bytes, &report, &error);
 *     glint_motion_baker_close(baker);
 *
 *   in   for each frame, the positions of food items (objects that sensors of
 *        the body detect) in the axes of the body, and which food items are new
 *   out  a file of glint/scene/motion.h: for each frame, position and rotation
 *        of the body in the axes of the first frame, and positions of the food
 *        items
 *
 * The same recording gives the same bytes. Frames are read one by one: memory
 * grows by about 60 bytes per frame. */
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

/* Constants of the body. */
struct glint_motion_body {
    double size;      /* radius of the body, 0 .. 1e6 */
    double angle_deg; /* angle of view of each sensor, 0.01 .. 360 */
    int n_sensors;
    /* Axis of each sensor, given by the angles theta and phi in radians: (sin
     * theta cos phi, sin theta sin phi, cos theta). */
    double theta[GLINT_MOTION_MAX_SENSORS], phi[GLINT_MOTION_MAX_SENSORS];
};

/* Observations of one frame. */
struct glint_motion_sight {
    long long number; /* number of the frame in the recording; -1: not stated */
    /* Odometry of the body: its translation tv and rotation rv since the
     * previous frame, in the axes of the body in the previous frame. rv is an
     * axis times an angle in radians. */
    double tv[3], rv[3];
    int n_foods;
    double food[GLINT_MOTION_MAX_FOODS][3];
    bool is_new[GLINT_MOTION_MAX_FOODS]; /* ignored in the first frame */
    /* Number of intensities per food item. 0: all intensities are 1; 1: one
     * intensity for all sensors; otherwise one intensity for each sensor. */
    int n_intensities;
    double intensity[GLINT_MOTION_MAX_FOODS][GLINT_MOTION_MAX_SENSORS];
};

struct glint_motion_report {
    long n_frames, n_resets;
    double span; /* diagonal of the bounding box of all frames */
    double path; /* length of the body's path */
    /* The residual of a frame is the max distance between the observed position
     * of a food item and that known from earlier frames. residual: max over all
     * frames, in residual_frame; residual_rms: RMS; bad_frames: number of
     * frames that exceed span / 1000. */
    double residual, residual_rms;
    long residual_frame, bad_frames;
    long held_intensities; /* number clamped to 0 .. 1 */
    /* has_senses: the recording has tv or rv. senses_off, senses_most: distance
     * between the reconstructed position and the position that tv and rv give
     * when they are added up. senses_off is the distance in the last frame,
     * senses_most the max over all frames. */
    bool has_senses;
    double senses_off, senses_most;
};

struct glint_motion_baker;

/* Creates a baker; returns NULL if there is no memory. */
struct glint_motion_baker *glint_motion_baker_open(void);
void glint_motion_baker_close(struct glint_motion_baker *baker);

/* Set the body, and add the next frame. The body must be set before
 * glint_motion_baker_finish(). On GLINT_E_LENS, ERROR states what is wrong,
 * without a position in the file. May return GLINT_E_MEMORY. */
enum glint_status glint_motion_baker_body(struct glint_motion_baker *baker,
                                          const struct glint_motion_body *body,
                                          struct glint_error *error);
enum glint_status
glint_motion_baker_frame(struct glint_motion_baker *baker,
                         const struct glint_motion_sight *sight,
                         struct glint_error *error);

/* Creates the file *DATA[*BYTES], which is malloc'ed. The file stores the first
 * 63 characters of NAME that are a-z, A-Z, 0-9, '-' or '_'. Returns
 * GLINT_E_LENS if there is no frame, or body and frames are inconsistent. May
 * return GLINT_E_MEMORY. */
enum glint_status glint_motion_baker_finish(struct glint_motion_baker *baker,
                                            const char *name, uint64_t key,
                                            unsigned char **data, size_t *bytes,
                                            struct glint_motion_report *report,
                                            struct glint_error *error);

/* Reads at most N bytes into TO. Returns the number of bytes, 0 at the end, -1
 * on failure. */
typedef long glint_recording_read_fn(void *ctx, char *to, size_t n);

/* Reads a recording in JSON and passes it to BAKER frame by frame. Both
 * spellings of keys are accepted. Unknown keys are skipped; trailing commas are
 * allowed. On GLINT_E_LENS, ERROR states file, line, column and cause. Returns
 * GLINT_E_UNSUPPORTED if glint was built without jansson. May return GLINT_E_IO
 * or GLINT_E_MEMORY. */
enum glint_status glint_recording_read(struct glint_motion_baker *baker,
                                       const char *file_name,
                                       glint_recording_read_fn *read, void *ctx,
                                       struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
