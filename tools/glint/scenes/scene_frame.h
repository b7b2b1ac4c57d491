/* SPDX-License-Identifier: MIT
 *
 * A baked scene ready to be drawn by the integer run time, and its memory.
 *
 *     scene_frame_open(&frame, tool, &baked.model, &dials);
 *     scene_frame_draw(&frame, &image);                     each picture
 *     scene_frame_close(&frame);
 */
#ifndef GLINT_TOOLS_SCENES_SCENE_FRAME_H
#define GLINT_TOOLS_SCENES_SCENE_FRAME_H

#include "options/tool.h"

/* What a picture is drawn with. 0 is as the run time likes it. */
struct scene_dials {
    int width, height; /* pixels */
    double focal_px;   /* focal length of a camera that has the lens's field */
    int edge_samples;  /* 1, 4, 8 or 16 */
    int shadow_points; /* 1, 4 or 16 */
    bool half_shading; /* two by two pixels at once, within one object */
    int ward_samples;  /* 1 .. 32 lookups of a place on brushed metal */
    bool has_highlights;
    int highlights; /* 0 .. 8, whatever the scene says, with has_highlights */
    int tile_log2;
    bool dither;
};

/* Sets the dials that options choose. */
void scene_dials_choose(struct scene_dials *dials,
                        const struct glint_options *options);

/* Puts the objects of a scene where they are. */
typedef void scene_frame_pose_fn(void *ctx, struct glint_scene *scene);

struct scene_frame {
    const struct tool *tool;
    const struct glint_scene_model *model; /* not owned */
    struct glint_scene_config cfg;
    struct glint_scene *scene; /* in MEM */
    void *mem;
    size_t bytes;
    /* NULL, or called with POSE_CTX before the next picture of a scene that was
     * placed again: it begins with the poses and looks of its model. */
    scene_frame_pose_fn *pose;
    void *pose_ctx;
    bool is_fresh; /* it was */

    /* Of the picture drawn last. */
    struct glint_scene_stats stats;
    int map_texels; /* of translucent objects, worked out for it */
    double project_ms, map_ms, draw_ms;
};

/* Allocates memory for pictures of MODEL, which must outlive FRAME. Returns an
 * exit code, after printing the reason on failure. */
int scene_frame_open(struct scene_frame *frame, const struct tool *tool,
                     const struct glint_scene_model *model,
                     const struct scene_dials *dials);
void scene_frame_close(struct scene_frame *frame);

/* Puts objects where they are and prepares a frame. */
void scene_frame_begin(struct scene_frame *frame);

/* Draws the scene onto IMAGE, of the size of the dials. Takes more memory where
 * the lists of its triangles need it. _draw returns an exit code, _try says
 * nothing. */
int scene_frame_draw(struct scene_frame *frame,
                     const struct glint_image *image);
enum glint_status scene_frame_try(struct scene_frame *frame,
                                  const struct glint_image *image);

#endif
