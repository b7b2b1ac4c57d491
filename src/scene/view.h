/* SPDX-License-Identifier: MIT
 *
 * The camera of a frame: maps pixels to rays and points to pixels.
 *
 * Positions in the picture are q8 pixels from its middle, x to the right, y
 * down, within +-2^22: the middle of pixel (i, j) of a picture W x H is at (256
 * i - 128 (W - 1), 256 j - 128 (H - 1)). Camera coordinates are in steps:
 * right, up, ahead. */
#ifndef GLINT_SCENE_VIEW_H
#define GLINT_SCENE_VIEW_H

#include "glint/scene/model.h"
#include "scene/ray.h"
#include "tile/box.h"

struct glint_scene_view {
    int32_t at[3];
    struct glint_scene_turn turn; /* world to camera coordinates */
    int width, height;
    /* tangents of 1/256 pixel, across and down */
    int64_t step_q56[2];
    int64_t per_tan_q8; /* 256 * number of pixels across per unit of tangent */
    int wide;           /* number of bits by which tangents exceed 2, or 0 */
    struct glint_real focal_q8[2];
};

/* A vertex in the picture, in homogeneous coordinates: at (x / w, y / w) if w >
 * 0. w is 1 if the vertex is in front of the camera and within 2^22 of the
 * middle; otherwise (x, y, w) is the direction to it, within 2^16. */
struct glint_corner {
    int32_t x, y, w;
};

/* 1 / z of a plane as a function of position: at (x, y) of the picture, 2^30
 * * (min z of the frame) / z is (across x + down y + at) >> shift. */
struct glint_depth {
    int64_t across, down, at;
    int shift;
};

/* Sets VIEW for a picture of WIDTH x HEIGHT. FOCAL_Q16 is the focal length in
 * pixels; used only for cameras of kind GLINT_CAMERA_LENS. Returns 0 if
 * tangents of angles in the picture exceed 64. */
int glint_view_init(struct glint_scene_view *view,
                    const struct glint_scene_camera *camera, int width,
                    int height, int64_t focal_q16);

/* Sets RAY to the ray through (X, Y), and SEEN_Q30 to its direction in camera
 * coordinates. */
void glint_view_ray(const struct glint_scene_view *view, int32_t x_q8,
                    int32_t y_q8, struct glint_scene_ray *ray,
                    int32_t seen_q30[3]);

/* Sets TO to the camera coordinates of point PLACE, within +-2^30. */
void glint_view_seen(const struct glint_scene_view *view,
                     const int32_t place[3], int32_t to[3]);

/* Projects the camera coordinates V to the picture. */
struct glint_corner glint_view_corner(const struct glint_scene_view *view,
                                      const int32_t v[3]);

/* Returns the bounding box, in pixels, of the N points V in camera coordinates;
 * the whole picture if a point is too near or behind the camera. */
struct glint_box glint_view_box(const struct glint_scene_view *view,
                                const int32_t (*v)[3], int n);

/* Sets DEPTH to the depth of the plane of NORMAL_Q30 through V, both in camera
 * coordinates. Returns 0 if the camera is in the plane. NEAREST is the min z of
 * the frame. */
int glint_view_depth(const struct glint_scene_view *view, const int32_t v[3],
                     const int32_t normal_q30[3], int32_t nearest,
                     struct glint_depth *depth);

#endif
