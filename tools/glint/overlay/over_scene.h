/* SPDX-License-Identifier: MIT
 *
 * over_scene.h - a scene over the pictures of a camera, and what it does to the
 * lamps of the flare.
 *
 *     over_scene_open(&over, tool);                   scene and poses
 *     over_scene_size(&over, &dials);                 when the size changes
 *     over_scene_draw(&over, &image, frame);          each picture
 *     over_scene_close(&over);
 *
 * Frames of a video rise. Moving objects bakes nothing.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVER_SCENE_H
#define GLINT_TOOLS_OVERLAY_OVER_SCENE_H

#include "glint/scene/motion.h"
#include "glint/view.h"
#include "control/controls.h"
#include "control/playback.h"
#include "scenes/baked_scene.h"
#include "scenes/poses.h"
#include "scenes/budget.h"
#include "scenes/glints.h"
#include "scenes/scene_frame.h"
#include "control/steer.h"

/* Where an object was moved to. */
struct scene_moved {
    bool is_moved;
    int32_t at[3], turn_q30[4];
};

/* The poses of a file, and where they have moved objects. */
struct scene_poses {
    struct poses file;
    struct scene_moved *moved; /* objects, lights, and the camera */
    int frame;                 /* of the poses that are shown */
    bool has_warned;           /* of lines that were skipped */
};

struct over_scene {
    /* Options. */
    const char *file;         /* NULL: there is no scene */
    const char *pose_file;    /* or NULL */
    const char *control_file; /* or NULL; "-": standard input */
    bool is_live;             /* a FIFO of poses or control is not waited for */
    /* Sets the option NAME of the flare, for lines of control;
     * GLINT_E_ARGUMENT: ERROR states why it stays as it was. NULL: there is no
     * flare. */
    enum glint_status (*set_option)(void *ctx, const char *name, double value,
                                    struct glint_error *error);
    void *set_ctx;

    double budget_ms;   /* what drawing may take; 0: as long as it does */
    int32_t elapsed_us; /* from the last picture to the next; 0: it is one by
                           itself */

    /* Private. */
    const struct tool *tool;
    struct scene_budget budget;
    struct baked_scene baked;
    struct scene_poses poses;
    struct controls control;
    struct playback playback;   /* of poses and recorded motion */
    int shown;                  /* the frame of them that is drawn */
    struct glint_motion motion; /* of the scene, if it has one */
    struct steer steer;
    struct glints glints;
    struct scene_frame frame;
    bool is_open, is_sized;

    /* Of the last frame. */
    double ms;
    int lights;       /* of the scene, that flare in the lens */
    int lamps_hidden; /* lamps and lights of which nothing is seen */
};

/* Opens scene, poses and lines of control, if there are any. Returns an exit
 * code, after printing the reason on failure. */
int over_scene_open(struct over_scene *over, const struct tool *tool);

/* Returns whether the camera of the scene has the field of the lens. */
bool over_scene_needs_lens(const struct over_scene *over);

/* Returns whether the scene has lights, but shows none to lenses. */
bool over_scene_keeps_lights(const struct over_scene *over);

/* Prepares OVER for pictures of the size of DIALS, unless there is no scene.
 * Returns an exit code. */
int over_scene_size(struct over_scene *over, const struct scene_dials *dials);

/* Draws the following pictures with the requested dials, but no finer than
 * QUALITY, as of --quality; 1: as requested. A budget changes them
 * automatically. GLINT_E_MEMORY. */
enum glint_status over_scene_coarsen(struct over_scene *over, double quality);

/* Obeys the lines of control up to FRAME. Drawing it does so, but the lens has
 * to be zoomed before lamps are placed. */
void over_scene_obey(struct over_scene *over, int frame);

/* Draws the scene of frame FRAME onto IMAGE. */
enum glint_status over_scene_draw(struct over_scene *over,
                                  const struct glint_image *image, int frame);

/* Draws the time line of the recorded motion on IMAGE, of 8 bits, if the scene
 * has one. */
void over_scene_mark(const struct over_scene *over,
                     const struct glint_image *image);

/* The scene alone, for pictures that are not a struct glint_image. */
struct over_scene_layer {
    float *rgb;         /* [height][width][3], linear light, 1 = white */
    uint16_t *cover_q8; /* [height][width], what is hidden, 0 .. 256 */
};

/* Makes LAYER of the scene drawn last; over_scene_layer_free() frees it.
 * GLINT_E_MEMORY. */
enum glint_status over_scene_layer(struct over_scene *over,
                                   struct over_scene_layer *layer);
void over_scene_layer_free(struct over_scene_layer *layer);

/* Most lamps that a scene gives. */
enum { OVER_SCENE_LAMPS = GLINT_SCENE_MAX_LIGHTS + GLINTS_MAX };

/* Sets LAMPS, [GLINTS_MAX], to the highlights of the scene drawn last, as a
 * lens of FOCAL_MM sees them; the picture shows them, as it does lamps.
 * FOLLOWS: they are tracked from picture to picture. Returns how many there
 * are. */
int over_scene_glints(struct over_scene *over, bool follows,
                      const struct glint_view *view, double focal_mm,
                      struct glint_engine_lamp *lamps);

/* Returns the memory that drawing takes. */
size_t over_scene_bytes(const struct over_scene *over);

/* Writes a few words on the frame drawn last. */
void over_scene_say(const struct over_scene *over, FILE *to);

/* Writes "scene": an object on the frame drawn last. */
void over_scene_json(struct json_writer *json, const struct over_scene *over);

void over_scene_close(struct over_scene *over);

#endif
