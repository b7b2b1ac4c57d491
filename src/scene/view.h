/* SPDX-License-Identifier: MIT
 *
 * The camera of a frame: pixels to rays, places to pixels.
 *
 * Places in the picture are q8 pixels from its middle, x to the right, y down,
 * within +-2^22 of it: samples at the middle of pixel (i, j) of a picture W x H
 * are at (256 i - 128 (W - 1), 256 j - 128 (H - 1)). Camera coordinates are
 * steps: to the right, up, ahead. */
#ifndef GLINT_SCENE_VIEW_H
#define GLINT_SCENE_VIEW_H

#include "glint/scene/model.h"
#include "scene/ray.h"
#include "tile/box.h"

struct glint_scene_view {
    int32_t at[3];
    struct glint_scene_turn turn; /* space to camera coordinates */
    int width, height;
    /* Tangent of 1/256 pixel across and down, and 256 times the pixels per unit
     * of tangent. */
    int64_t step_q56[2];
    int64_t per_tan_q8; /* 256 pixels across per unit of tangent */
    int wide;           /* 0; or by how many bits tangents pass 2 */
    struct glint_real focal_q8[2];
};

/* A vertex in the picture, in homogeneous numbers: at (x / w, y / w) if w > 0.
 * In front, and within 2^22 of the middle, w is 1; of others x, y and w are the
 * direction to it, within 2^16. */
struct glint_corner {
    int32_t x, y, w;
};

/* 1 / z of a plane: of place (x, y) it is (across x + down y + at) >> shift,
 * times 2^30 the nearest z of the frame. */
struct glint_depth {
    int64_t across, down, at;
    int shift;
};

/* Sets VIEW for a picture of WIDTH x HEIGHT. FOCAL_Q16: focal length in pixels,
 * of cameras of kind GLINT_CAMERA_LENS. Returns 0 if its tangents from the
 * middle pass 64. */
int glint_view_init(struct glint_scene_view *view,
                    const struct glint_scene_camera *camera, int width,
                    int height, int64_t focal_q16);

/* Sets RAY to the ray through (X, Y), and SEEN_Q30 to its direction in camera
 * coordinates. */
void glint_view_ray(const struct glint_scene_view *view, int32_t x_q8,
                    int32_t y_q8, struct glint_scene_ray *ray,
                    int32_t seen_q30[3]);

/* Sets TO to the camera coordinates of PLACE, within +-2^30. */
void glint_view_seen(const struct glint_scene_view *view,
                     const int32_t place[3], int32_t to[3]);

/* Returns where camera coordinates V are in the picture. */
struct glint_corner glint_view_corner(const struct glint_scene_view *view,
                                      const int32_t v[3]);

/* Returns the pixels that the N places V may touch together, each in camera
 * coordinates; all if one is too near or behind. */
struct glint_box glint_view_box(const struct glint_scene_view *view,
                                const int32_t (*v)[3], int n);

/* Sets DEPTH to the depth of the plane of NORMAL_Q30 through V, both in camera
 * coordinates. Returns 0 if the camera is in the plane. NEAREST is the least
 * z. */
int glint_view_depth(const struct glint_scene_view *view, const int32_t v[3],
                     const int32_t normal_q30[3], int32_t nearest,
                     struct glint_depth *depth);

#endif
