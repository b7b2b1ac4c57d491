/* SPDX-License-Identifier: MIT
 *
 * The camera of a frame: maps pixels to rays, and points to pixels.
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
    struct glint_scene_turn turn; /* rotation from world to camera
                                     coordinates */
    int width, height;
    /* tangents of the angles of 1/256 pixel, horizontally and vertically */
    int64_t step_q56[2];
    int64_t per_tan_q8; /* 1/256 pixels per unit of tangent, horizontally */
    /* the tangent at the picture's edge is below 2^(1 + wide) */
    int wide;
    struct glint_real focal_q8[2];
};

/* A vertex in the picture, in homogeneous coordinates: its position is (x / w,
 * y / w) if w > 0. w is 1 if the vertex is in front of the camera and within
 * 2^22 of the picture's middle; otherwise (x, y, w) is the direction to the
 * vertex, within 2^16. */
struct glint_corner {
    int32_t x, y, w;
};

/* The depth of a plane at position (x, y) of the picture: 2^30 * (min z of the
 * frame) / z = (across x + down y + at) >> shift. */
struct glint_depth {
    int64_t across, down, at;
    int shift;
};

/* Sets VIEW for a picture of WIDTH x HEIGHT. FOCAL_Q16 is the focal length in
 * pixels, used only for GLINT_CAMERA_LENS. Returns 1, or 0 if FOCAL_Q16 is out
 * of range or tangents of angles in the picture exceed 64. */
int glint_view_init(struct glint_scene_view *view,
                    const struct glint_scene_camera *camera, int width,
                    int height, int64_t focal_q16);

/* Sets RAY to the camera's ray through position (X, Y), and SEEN_Q30 to its
 * direction in camera coordinates. */
void glint_view_set_ray(const struct glint_scene_view *view, int32_t x_q8,
                        int32_t y_q8, struct glint_scene_ray *ray,
                        int32_t seen_q30[3]);

/* Sets TO to the camera coordinates of point PLACE, steps, within +-2^30. */
void glint_view_convert_to_camera(const struct glint_scene_view *view,
                                  const int32_t place[3], int32_t to[3]);

/* Returns point V, in camera coordinates, projected to the picture. */
struct glint_corner
glint_view_project_vertex(const struct glint_scene_view *view,
                          const int32_t v[3]);

/* Returns the box of pixels around N points V, in camera coordinates. It is the
 * whole picture if a point is behind the camera or farther than 2^14 pixels
 * from the picture's middle. */
struct glint_box
glint_view_find_box_of_points(const struct glint_scene_view *view,
                              const int32_t (*v)[3], int n);

/* Sets DEPTH to the depth function of the plane with normal NORMAL_Q30 through
 * V, both in camera coordinates. Returns 1, or 0 if the camera is in the plane
 * or so near that the coefficients are out of range. NEAREST is the min z of
 * the frame. */
int glint_view_set_plane_depth(const struct glint_scene_view *view,
                               const int32_t v[3], const int32_t normal_q30[3],
                               int32_t nearest, struct glint_depth *depth);

#endif
