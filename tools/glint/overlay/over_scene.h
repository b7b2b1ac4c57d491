/* SPDX-License-Identifier: MIT
 *
 * over_scene.h - draws a scene over the pictures of a video. Objects of the
 * scene occlude lamps of the picture. Lights and highlights of the scene become
 * lamps of the flare.
 *
 *     over_scene_open(&over, tool);           scene and poses
 *     over_scene_allocate(&over, &dials);     when the size changes
 *     over_scene_draw(&over, &image, frame);  each picture
 *     over_scene_close(&over);
 *
 * Frame numbers of a video must rise. Moving objects needs no baking. */
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

/* Pose of an object, a light or the camera */
struct scene_moved {
    bool is_moved;
    int32_t at[3], turn_q30[4];
};

/* A pose file, and the poses that it has set */
struct scene_poses {
    struct poses file;
    /* poses in this order: objects, lights, camera */
    struct scene_moved *moved;
    int frame;       /* number of the frame whose poses are applied */
    bool has_warned; /* whether a warning about skipped lines was printed */
};

struct over_scene {
    /* Options. */
    const char *file;      /* scene file; NULL: no scene */
    const char *pose_file; /* pose file; NULL: none */
    const char
        *control_file; /* control file, "-": standard input; NULL: none */
    /* whether poses and control lines are read from a FIFO, without waiting for
     * data */
    bool is_live;
    /* Sets the flare option NAME to VALUE, for a control line. Returns
     * GLINT_E_ARGUMENT with the reason in ERROR if VALUE is invalid. NULL if
     * there is no flare. */
    enum glint_status (*set_option)(void *ctx, const char *name, double value,
                                    struct glint_error *error);
    void *set_ctx;

    double budget_ms; /* time budget of a frame; 0: none */
    /* microseconds since the previous picture; 0: pictures are independent */
    int32_t elapsed_us;

    /* Private. */
    const struct tool *tool;
    struct scene_budget budget;
    struct baked_scene baked;
    struct scene_poses poses;
    struct controls control;
    /* playback position of the pose file and of the recorded motion */
    struct playback playback;
    int shown; /* number of the playback frame drawn last */
    /* recorded motion of the scene, if it has one */
    struct glint_motion motion;
    struct steer steer;
    struct glints glints;
    struct scene_frame frame;
    bool is_open, is_sized;

    /* Statistics of the last frame */
    double ms;
    int lights; /* number of scene lights that add lamps to the flare */
    /* number of lamps and scene lights that are completely occluded */
    int lamps_hidden;
};

/* Opens the scene, pose and control files that the options name. Prints the
 * reason of a failure and returns an exit code. */
int over_scene_open(struct over_scene *over, const struct tool *tool);

/* Returns whether the scene's camera takes its field of view from the lens. */
bool over_scene_needs_lens(const struct over_scene *over);

/* Returns whether the scene has lights that do not add lamps to the flare
 * because the scene file lacks 'flare lights'. */
bool over_scene_has_lights_without_flare(const struct over_scene *over);

/* Allocates the scene for pictures of the size in DIALS. No-op without a scene.
 * Returns an exit code. */
int over_scene_allocate(struct over_scene *over,
                        const struct scene_dials *dials);

/* Limits the quality of the following pictures to QUALITY, 0 .. 1 like
 * --quality; 1 sets no limit. Does nothing if there is a time budget, which
 * determines the quality. Returns GLINT_E_MEMORY on failure. */
enum glint_status over_scene_set_quality(struct over_scene *over,
                                         double quality);

/* Executes the control lines up to FRAME. over_scene_draw() does this, too.
 * Call this function before lamps are positioned if control lines may zoom the
 * lens. */
void over_scene_apply_control(struct over_scene *over, int frame);

enum glint_status over_scene_draw(struct over_scene *over,
                                  const struct glint_image *image, int frame);

/* Draws the time line of the recorded motion on IMAGE, of 8 bits, if the scene
 * has one. */
void over_scene_draw_time_line(const struct over_scene *over,
                               const struct glint_image *image);

/* The scene as a separate layer, for pictures that are not a struct
 * glint_image */
struct over_scene_layer {
    float *rgb;         /* [height][width][3], linear light, 1 = white */
    uint16_t *cover_q8; /* [height][width], coverage, 0 .. 256 */
};

/* Sets LAYER to the scene drawn last; free it by over_scene_layer_free().
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status over_scene_make_layer(struct over_scene *over,
                                        struct over_scene_layer *layer);
void over_scene_layer_free(struct over_scene_layer *layer);

/* Max lamps from a scene: lights and highlights. */
enum { OVER_SCENE_LAMPS = GLINT_SCENE_MAX_LIGHTS + GLINTS_MAX };

/* Sets LAMPS[GLINTS_MAX] to the highlights of the scene drawn last, as lamps of
 * a lens of FOCAL_MM. If FOLLOWS, highlights are tracked from picture to
 * picture. Returns their number. */
int over_scene_add_highlights(struct over_scene *over, bool follows,
                              const struct glint_view *view, double focal_mm,
                              struct glint_engine_lamp *lamps);

/* Returns the bytes of memory for drawing. */
size_t over_scene_count_memory_bytes(const struct over_scene *over);

/* Prints one line of statistics of the frame drawn last. */
void over_scene_print_line(const struct over_scene *over, FILE *to);

/* Writes the JSON member "scene" with statistics of the frame drawn last. */
void over_scene_write_json(struct json_writer *json,
                           const struct over_scene *over);

void over_scene_close(struct over_scene *over);

#endif
