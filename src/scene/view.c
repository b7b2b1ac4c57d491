/* SPDX-License-Identifier: MIT */
#include "scene/view.h"

#include "base/real.h"

enum { NEAR_BITS = 22, FAR_BITS = 16 };

/* Returns the tangent of 1/256 pixel, _q56. TAN is the tangent of half the
 * picture, SIDE / 2 pixels. It is at most 2^6, so the result times 128 SIDE is
 * at most 2^62. */
static int64_t compute_pixel_tangent(int32_t tan_q24, int side)
{
    return q_divide((int64_t)tan_q24 << 25, side > 1 ? side : 1);
}

int glint_view_init(struct glint_scene_view *view,
                    const struct glint_scene_camera *camera, int width,
                    int height, int64_t focal_q16)
{
    const int64_t max_q56 = INT64_C(1) << 62;

    for (int k = 0; k < 3; k++) {
        view->at[k] = camera->at[k];
        for (int i = 0; i < 3; i++)
            view->turn.row_q30[k][i] = camera->axis_q30[k][i];
    }
    view->width = width;
    view->height = height;
    if (camera->kind == GLINT_CAMERA_CORNERS) {
        view->step_q56[0] = compute_pixel_tangent(camera->tan_x_q24, width - 1);
        view->step_q56[1] =
            compute_pixel_tangent(camera->tan_y_q24, height - 1);
    } else if (camera->kind == GLINT_CAMERA_FIELD) {
        view->step_q56[0] = compute_pixel_tangent(camera->tan_x_q24, width);
        view->step_q56[1] = view->step_q56[0];
    } else {
        if (focal_q16 < 1 << 10 || focal_q16 > INT64_C(1) << 40)
            return 0;
        view->step_q56[0] = /* 2^64 / focal length */
            (int64_t)((uint64_t)q_divide(INT64_MAX, focal_q16) * 2);
        view->step_q56[1] = view->step_q56[0];
    }
    if (view->step_q56[0] >> 1 > q_divide(max_q56, 256 * width) ||
        view->step_q56[1] >> 1 > q_divide(max_q56, 256 * height))
        return 0;
    /* 128 * side * step, the tangent at the picture's edge, is below 2^(57 +
     * wide) */
    view->per_tan_q8 = (int64_t)q_divide(INT64_C(1) << 56, view->step_q56[0]);
    view->wide = 0;
    while ((view->step_q56[0] * width | view->step_q56[1] * height) >>
           (50 + view->wide))
        view->wide++;
    for (int k = 0; k < 2; k++)
        view->focal_q8[k] =
            real_over(real_of(1, 56), real_of(view->step_q56[k], 0));
    return 1;
}

void glint_view_set_ray(const struct glint_scene_view *view, int32_t x_q8,
                        int32_t y_q8, struct glint_scene_ray *ray,
                        int32_t seen_q30[3])
{
    const int64_t toward_q28[3] = {q_shift(x_q8 * view->step_q56[0], 28),
                                   -q_shift(y_q8 * view->step_q56[1], 28),
                                   1 << 28};

    glint_normalise_vector(toward_q28, seen_q30);
    v3_rotate_back(&view->turn, seen_q30, ray->toward_q30);
    for (int k = 0; k < 3; k++)
        ray->at[k] = view->at[k];
}

void glint_view_convert_to_camera(const struct glint_scene_view *view,
                                  const int32_t place[3], int32_t to[3])
{
    int32_t off[3];

    v3_subtract(place, view->at, off);
    v3_rotate(&view->turn, off, to);
}

/* ---------------------------------------------------------------- corners */

/* Returns X / 2^DOWN, rounded; a negative DOWN multiplies. The result must fit
 * into 32 bits. */
static int32_t shift_right_rounded(int64_t x, int down)
{
    if (down > 62)
        return 0;
    return (int32_t)(down >= 0 ? q_shift(x, down)
                               : x * (INT64_C(1) << (down < -62 ? 0 : -down)));
}

/* Returns X * focal length / Z, where ONE_OVER is 2^63 / (Z 2^UP). Sets *FITS
 * to 0 if the result is too large. X is first scaled up to 2^30, so that small
 * quotients are as precise as large ones. */
static int32_t project_to_picture_q8(int32_t x, struct glint_real focal_q8,
                                     uint32_t one_over, int up, int *fits)
{
    const int more = 30 - bit_length(q_magnitude(x));
    const int64_t over_z =
        (int64_t)shift_right_rounded(x, -more) * one_over >> 31;
    const int64_t product = over_z * focal_q8.mantissa; /* below 2^62 */
    const int down = 32 - up + more - focal_q8.exponent;

    if (x == 0 || down > 62)
        return 0;
    if (down < 0 || bit_length(q_magnitude(product)) - down > NEAR_BITS) {
        *fits = 0;
        return 0;
    }
    return (int32_t)q_shift(product, down);
}

/* Returns the direction to V in homogeneous picture coordinates of 16 bits. */
static struct glint_corner
compute_direction(const struct glint_scene_view *view, const int32_t v[3])
{
    const struct glint_real *f = view->focal_q8;
    const int64_t x = (int64_t)v[0] * f[0].mantissa;
    const int64_t y = -(int64_t)v[1] * f[1].mantissa;
    const int n_x = x ? bit_length(q_magnitude(x)) + f[0].exponent : -999;
    const int n_y = y ? bit_length(q_magnitude(y)) + f[1].exponent : -999;
    const int n_z = v[2] ? bit_length(q_magnitude(v[2])) : -999;
    const int most = q_larger(n_z, q_larger(n_x, n_y)) - FAR_BITS;

    return (struct glint_corner){shift_right_rounded(x, most - f[0].exponent),
                                 shift_right_rounded(y, most - f[1].exponent),
                                 shift_right_rounded(v[2], most)};
}

struct glint_corner
glint_view_project_vertex(const struct glint_scene_view *view,
                          const int32_t v[3])
{
    struct glint_corner c = {0, 0, 1};
    int fits = v[2] > 0;

    if (fits) {
        const int up = q_count_normalising_shift((uint64_t)v[2]);
        const uint32_t one_over = q_reciprocal((uint32_t)v[2] << up);

        c.x =
            project_to_picture_q8(v[0], view->focal_q8[0], one_over, up, &fits);
        c.y = -project_to_picture_q8(v[1], view->focal_q8[1], one_over, up,
                                     &fits);
    }
    return fits ? c : compute_direction(view, v);
}

struct glint_box
glint_view_find_box_of_points(const struct glint_scene_view *view,
                              const int32_t (*v)[3], int n)
{
    const struct glint_box all = {0, 0, view->width, view->height};
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};

    for (int k = 0; k < n; k++) {
        const struct glint_corner c = glint_view_project_vertex(view, v[k]);

        if (v[k][2] <= 0 || c.w != 1)
            return all;
        lo[0] = q_smaller(lo[0], c.x);
        lo[1] = q_smaller(lo[1], c.y);
        hi[0] = q_larger(hi[0], c.x);
        hi[1] = q_larger(hi[1], c.y);
    }
    return glint_box_intersect(
        all, (struct glint_box){((lo[0] + 128 * (all.x1 - 1)) >> 8) - 1,
                                ((lo[1] + 128 * (all.y1 - 1)) >> 8) - 1,
                                ((hi[0] + 128 * (all.x1 - 1)) >> 8) + 2,
                                ((hi[1] + 128 * (all.y1 - 1)) >> 8) + 2});
}

/* ------------------------------------------------------------------ depths */

/* 1 / z = (n . r) / (n . v). r = (x step, -y step, 1) is the ray, n the normal
 * and v a point of the plane. The coefficients have the max number of fraction
 * bits with which each term stays below 2^60. */
int glint_view_set_plane_depth(const struct glint_scene_view *view,
                               const int32_t v[3], const int32_t normal_q30[3],
                               int32_t nearest, struct glint_depth *depth)
{
    const int64_t away_q30 = v3_dot(normal_q30, v);
    struct glint_real over, term[3];
    int shift = 62;

    if (away_q30 == 0)
        return 0;
    over = real_over(real_of(nearest, 60), real_of(away_q30, 0));
    for (int k = 0; k < 3; k++) {
        term[k] = real_times(real_of(normal_q30[k], -30), over);
        if (k < 2)
            term[k] = real_times(term[k], real_of(view->step_q56[k], -56));
        if (term[k].mantissa)
            shift = q_smaller(shift, (k < 2 ? 7 : 29) - term[k].exponent);
    }
    if (shift < 0)
        return 0;
    depth->shift = shift;
    depth->across = real_integer(term[0], shift, INT64_C(1) << 60);
    depth->down = -real_integer(term[1], shift, INT64_C(1) << 60);
    depth->at = real_integer(term[2], shift, INT64_C(1) << 60);
    return 1;
}
