/* SPDX-License-Identifier: MIT
 *
 * A baked scene prepared for drawing by the integer run time, with its memory.
 *
 *     scene_frame_open(&frame, tool, &baked.model, &dials);
 *     scene_frame_draw(&frame, &image);                     each picture
 *     scene_frame_close(&frame);
 */
#ifndef GLINT_TOOLS_SCENES_SCENE_FRAME_H
#define GLINT_TOOLS_SCENES_SCENE_FRAME_H

#include "options/tool.h"

/* Drawing parameters; 0: the default of the run time. */
struct scene_dials {
    int width, height; /* size of pictures, pixels */
    /* focal length, pixels, by which a pinhole camera has the field of view of
     * the lens */
    double focal_px;
    int edge_samples;  /* samples per pixel at edges: 1, 4, 8 or 16 */
    int shadow_points; /* points per light for soft shadows: 1, 4 or 16 */
    /* whether 2 x 2 pixels of the same object get a common shading value */
    bool half_shading;
    int ward_samples; /* 1 .. 32 lookups per point of brushed metal */
    bool has_highlights;
    /* max number of highlights, 0 .. 8; replaces that of the scene file if
     * has_highlights */
    int highlights;
    int tile_log2;
    /* whether scene_frame_open() rejects a scene whose first picture needs more
     * than SCENE_TESTS intersection tests; false if the user set
     * shadow_points */
    bool is_bounded;
};

/* Max number of intersection tests for a picture, as glint_scene_count_tests()
 * counts them. Each pixel of the tiles that a triangle touches counts as a
 * test. The limit corresponds to about 30 s of processor time; options can lift
 * the limit. For large pictures the limit is SCENE_TESTS_PX per pixel, ten
 * times as many as the scenes that come with glint need. */
#define SCENE_TESTS    INT64_C(1500000000)
#define SCENE_TESTS_PX 1000

/* Sets the members of DIALS from OPTIONS. */
void scene_dials_set_defaults(struct scene_dials *dials,
                              const struct glint_options *options);

/* Sets the objects of SCENE to their present poses. */
typedef void scene_frame_pose_fn(void *ctx, struct glint_scene *scene);

struct scene_frame {
    const struct tool *tool;
    const struct glint_scene_model *model; /* not owned */
    struct glint_scene_config cfg;
    struct glint_scene *scene; /* the initialised scene, in MEM */
    void *mem;
    size_t bytes;
    /* Called with POSE_CTX before the first picture after SCENE was
     * initialised, which resets poses and materials to those of the model; may
     * be NULL */
    scene_frame_pose_fn *pose;
    void *pose_ctx;
    /* whether SCENE was initialised and POSE has not been called since */
    bool is_fresh;

    /* Statistics of the picture drawn last: */
    struct glint_scene_stats stats;
    /* number of light-map texels of translucent objects that were computed */
    int map_texels;
    double project_ms, map_ms, draw_ms;
};

/* Allocates memory for pictures of MODEL, which must outlive FRAME. Returns an
 * exit code, after printing the reason on failure. The exit code is EXIT_LENS
 * if dials->is_bounded and a picture exceeds SCENE_TESTS. */
int scene_frame_open(struct scene_frame *frame, const struct tool *tool,
                     const struct glint_scene_model *model,
                     const struct scene_dials *dials);
void scene_frame_close(struct scene_frame *frame);

/* Draw the scene onto IMAGE, which must have the width and height of the
 * parameters. Allocate more memory if there are more triangles in view than
 * before. scene_frame_draw() prints the reason of a failure and returns an exit
 * code. scene_frame_draw_once() prints nothing. */
int scene_frame_draw(struct scene_frame *frame,
                     const struct glint_image *image);
enum glint_status scene_frame_draw_once(struct scene_frame *frame,
                                        const struct glint_image *image);

#endif
