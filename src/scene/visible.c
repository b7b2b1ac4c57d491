/* SPDX-License-Identifier: MIT
 *
 * Finds the visible object at each sample of a tile: spheres by a ray through
 * each sample, planes by 1 / z, triangles by the module for meshes.
 *
 * Two shortcuts save rays at spheres. In a pixel completely inside the outline
 * of a sphere, all samples get the sphere's depth at the pixel's middle. A
 * sphere that overlaps no other sphere gets a single depth where all objects
 * drawn before are behind its far side. This suffices, as spheres are drawn
 * last. */
#include "scene/visible.h"
#include "scene/parts.h"

/* Sample positions, x and y, 1/256 pixel: four at the corners of a rotated
 * square; eight and sixteen, each in its own row and column, spread as evenly
 * as possible. */
/* clang-format off */
static const int8_t one_q8[1][2] = {{0, 0}};
static const int8_t four_q8[4][2] = {
    {-96, -32}, {32, -96}, {96, 32}, {-32, 96}};
static const int8_t eight_q8[8][2] = {
    {16, -48}, {-16, 48}, {80, 16}, {-48, -80},
    {-80, 80}, {-112, -16}, {48, 112}, {112, -112}};
static const int8_t sixteen_q8[16][2] = {
    {24, 24}, {-8, -40}, {-40, 40}, {72, -8}, {-72, -24}, {40, 88},
    {88, 56}, {56, -72}, {-24, 104}, {8, -104}, {-56, -88}, {-88, 72},
    {-120, 8}, {120, -56}, {104, 120}, {-104, -120}};
/* clang-format on */

const int8_t (*glint_scene_samples(int n))[2]
{
    return n == 1 ? one_q8 : n == 4 ? four_q8 : n == 8 ? eight_q8 : sixteen_q8;
}

/* ----------------------------------------------------------------- spheres */

/* A primary ray, and its chord in a ball. */
struct look {
    struct glint_scene_ray ray;
    struct glint_chord chord;
    int32_t seen_q30[3]; /* the ray's direction in camera coordinates */
};

/* Sets LOOK to the ray through (X, Y) and its chord in the ball PLACED; returns
 * whether the ray hits the ball. */
static int find_chord_of_pixel_ray(const struct glint_scene *s,
                                   const struct glint_placed *placed,
                                   int32_t x_q8, int32_t y_q8,
                                   struct look *look)
{
    glint_view_set_ray(&s->view, x_q8, y_q8, &look->ray, look->seen_q30);
    return glint_ray_intersect_sphere(&look->ray, placed->at, placed->radius,
                                      &look->chord);
}

static void write_sample_if_nearer(struct glint_scene_worker *w,
                                   const struct look *look, uint32_t id, int x,
                                   int y, int k)
{
    const int32_t t = look->chord.t[look->chord.t[0] <= 0];
    const int32_t z = q_larger(1, q_mul(t, look->seen_q30[2], 30));

    if (t <= 0)
        return;
    glint_write_sample_if_nearer(
        w, x, y, k,
        q_larger(1, glint_divide_rounded((uint64_t)w->scene->nearest << 30,
                                         (uint64_t)z)),
        id);
}

/* Returns whether all objects drawn so far at samples FIRST .. END - 1 are
 * behind the far side of the ball. */
static int are_samples_behind_ball(const struct glint_scene_worker *w,
                                   const struct glint_placed *placed, int first,
                                   int end)
{
    int32_t most = 0;

    for (int i = first; i < end; i++)
        most = q_larger(most, w->depth[i]);
    return placed->flat_depth && most < placed->far_depth;
}

/* Sets samples FIRST .. END - 1 to the ball's id and its flat depth. */
static void set_ball_samples(struct glint_scene_worker *w,
                             const struct glint_placed *placed, uint32_t id,
                             int first, int end)
{
    for (int i = first; i < end; i++) {
        w->depth[i] = placed->flat_depth;
        w->id[i] = id;
    }
}

/* Returns whether the rays through all samples of a pixel hit the ball PLACED.
 * LOOK is the ray through the pixel's middle, which must hit the ball. */
static int is_pixel_inside_ball(const struct glint_placed *placed,
                                const struct look *look)
{
    const int64_t within = ((int64_t)placed->radius - placed->margin) *
                           (INT64_C(1) << look->chord.up);

    return within > 0 &&
           v3_dot(look->chord.middle, look->chord.middle) <= within * within;
}

/* Draws the ball in a pixel. Returns whether the rays through all samples hit
 * the ball, with a margin. */
static int draw_ball_pixel(struct glint_scene_worker *w,
                           const struct glint_placed *placed, uint32_t id,
                           int x, int y)
{
    const struct glint_scene *s = w->scene;
    const int32_t x_q8 = glint_pixel_position_q8(s, x, 0),
                  y_q8 = glint_pixel_position_q8(s, y, 1);
    const int n = s->cfg.edge_samples;
    struct look look;
    const int meets = find_chord_of_pixel_ray(s, placed, x_q8, y_q8, &look);
    const int is_inside = meets && is_pixel_inside_ball(placed, &look);
    const int first = glint_get_sample_index(w, x, y, 0);

    if (is_inside && are_samples_behind_ball(w, placed, first, first + n)) {
        set_ball_samples(w, placed, id, first, first + n);
        return 1;
    }
    if (is_inside || (meets && n == 1)) {
        for (int k = 0; k < n; k++)
            write_sample_if_nearer(w, &look, id, x, y, k);
        return is_inside;
    }
    if (n == 1 || (!meets && !glint_ray_intersect_sphere(
                                 &look.ray, placed->at,
                                 placed->radius + placed->margin, &look.chord)))
        return 0;
    for (int k = 0; k < n; k++)
        if (find_chord_of_pixel_ray(
                s, placed, x_q8 + glint_sample_offset_q8(s, k, 0),
                y_q8 + glint_sample_offset_q8(s, k, 1), &look))
            write_sample_if_nearer(w, &look, id, x, y, k);
    return 0;
}

/* Draws a ball in row Y. All pixels between two pixels inside the ball are
 * inside, too. If one depth suffices for the ball, rays are traced in these
 * pixels only where other objects may hide it. */
static void draw_ball_row(struct glint_scene_worker *w,
                          const struct glint_placed *placed, uint32_t id,
                          struct glint_box b, int y)
{
    const int n = w->scene->cfg.edge_samples;
    int x = b.x0, end = b.x1, is_in = 0;

    while (x < end && !is_in)
        is_in = draw_ball_pixel(w, placed, id, x++, y) && placed->flat_depth;
    while (is_in && x < end && !draw_ball_pixel(w, placed, id, end - 1, y))
        end--;
    for (; x < end - is_in; x++) {
        const int first = glint_get_sample_index(w, x, y, 0);

        if (are_samples_behind_ball(w, placed, first, first + n))
            set_ball_samples(w, placed, id, first, first + n);
        else
            draw_ball_pixel(w, placed, id, x, y);
    }
}

/* ------------------------------------------------------------------ planes */

/* Differences of a plane's depth between a pixel's middle and its samples. */
struct deeper {
    int64_t by[GLINT_SCENE_SAMPLES];
};

static inline void draw_plane_row(struct glint_scene_worker *w,
                                  const struct glint_depth *depth,
                                  const struct deeper *deeper, uint32_t id,
                                  int n, int x0, int x1, int y)
{
    const struct glint_scene *s = w->scene;
    const int first = glint_get_sample_index(w, x0, y, 0);
    int32_t *at = w->depth + first;
    uint32_t *ids = w->id + first;
    int64_t middle = depth->across * glint_pixel_position_q8(s, x0, 0) +
                     depth->down * glint_pixel_position_q8(s, y, 1) + depth->at;

    for (int x = x0; x < x1; x++, at += n, ids += n) {
        for (int k = 0; k < n; k++) {
            const int64_t far = (middle + deeper->by[k]) >> depth->shift;
            const int32_t here = far < INT32_MAX ? (int32_t)far : INT32_MAX;

            if (far > 0 && (here > at[k] || (here == at[k] && id < ids[k]))) {
                at[k] = here;
                ids[k] = id;
            }
        }
        middle += 256 * depth->across;
    }
}

/* Draws the part of a plane in B. */
static void draw_plane(struct glint_scene_worker *w,
                       const struct glint_placed *placed, uint32_t id,
                       struct glint_box b)
{
    const struct glint_scene *s = w->scene;
    const struct glint_depth *d = &placed->depth;
    const int n = s->cfg.edge_samples;
    struct deeper deeper;

    for (int k = 0; k < n; k++)
        deeper.by[k] = d->across * glint_sample_offset_q8(s, k, 0) +
                       d->down * glint_sample_offset_q8(s, k, 1);
    for (int y = b.y0; y < b.y1; y++)
        if (n == 4)
            draw_plane_row(w, d, &deeper, id, 4, b.x0, b.x1, y);
        else
            draw_plane_row(w, d, &deeper, id, n, b.x0, b.x1, y);
}

/* ------------------------------------------------------------------- frame */

enum {
    MOST_COMPARED = 64 /* max number of objects for which all pairs are
                          compared */
};

/* Returns whether ball B overlaps ball A in the picture and in depth. A single
 * depth per ball may then order them wrongly. */
static int can_partly_occlude(const struct glint_placed *a,
                              const struct glint_placed *b)
{
    return b->is_seen && b->object->kind == GLINT_OBJECT_SPHERE &&
           a->z[0] <= b->z[1] + 2 && b->z[0] <= a->z[1] + 2 &&
           !glint_box_is_empty(glint_box_intersect(a->box, b->box));
}

void glint_scene_set_single_depths_of_balls(struct glint_scene *s)
{
    const uint32_t n = s->model.header->n_objects;

    for (uint32_t i = 0; i < n && n <= MOST_COMPARED; i++) {
        struct glint_placed *p = &s->placed[i];
        int is =
            p->is_seen && p->object->kind == GLINT_OBJECT_SPHERE && p->z[0] > 0;

        for (uint32_t k = 0; k < n && is; k++)
            is = k == i || !can_partly_occlude(p, &s->placed[k]);
        if (!is)
            continue;
        p->far_depth = glint_divide_rounded((uint64_t)s->nearest << 30,
                                            (uint64_t)p->z[1] + 2);
        p->flat_depth = q_larger(
            1, glint_divide_rounded((uint64_t)s->nearest << 30,
                                    (uint64_t)p->z[0] + (uint64_t)p->reach));
    }
}

/* Returns whether all of object P lies on the side of PLANE where the camera
 * is. */
static int is_object_in_front_of_plane(const struct glint_scene *s,
                                       const struct glint_placed *p,
                                       const struct glint_placed *plane)
{
    int32_t off[3], camera[3];
    int64_t away, side;

    v3_subtract(p->centre, plane->at, off);
    v3_subtract(s->view.at, plane->at, camera);
    away = q_shift(v3_dot(off, plane->centre), 30);
    side = v3_dot(camera, plane->centre);
    return (away < 0) == (side < 0) &&
           q_magnitude(away) > (uint64_t)p->reach + 2;
}

/* Reduces the box of a shadow catcher to the pixels that may have shadows, or
 * objects that the catcher may hide. Keeps the box if another plane is visible
 * or a light has no shadow grid. */
static void shrink_box_of_catcher(struct glint_scene *s,
                                  struct glint_placed *plane)
{
    struct glint_box box = {0, 0, 0, 0};

    for (uint32_t i = 0; i < s->n_lit; i++) {
        if (!s->model.header->shadow)
            break;
        if (!s->lit[i].shadow || s->n_planes)
            return;
        box = glint_box_unite(
            box, glint_shadow_find_plane_box(s, s->lit[i].shadow, plane));
    }
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        struct glint_placed *p = &s->placed[i];

        if (p == plane || !p->is_seen)
            continue;
        if (p->object->kind == GLINT_OBJECT_PLANE)
            return;
        if (is_object_in_front_of_plane(s, p, plane))
            continue;
        box = glint_box_unite(box, p->box);
        p->is_behind_catcher = 1;
    }
    plane->box = box;
    plane->is_only_shadow =
        s->model.header->background == GLINT_BACKGROUND_CAMERA;
    plane->is_seen = !glint_box_is_empty(box);
}

void glint_scene_shrink_catcher_boxes(struct glint_scene *s)
{
    for (uint32_t i = 0; i < s->model.header->n_objects; i++)
        if (s->placed[i].is_seen && s->placed[i].object->catcher_q15)
            shrink_box_of_catcher(s, &s->placed[i]);
}

enum { BLOCK = 8 }; /* side of the blocks of a shadow catcher, pixels */

/* Returns whether PLANE may change pixels of B. */
static int can_catcher_change_pixels(const struct glint_scene *s,
                                     const struct glint_placed *plane,
                                     struct glint_box b)
{
    int32_t corner[4][3];

    if (!plane->is_only_shadow || !s->model.header->shadow)
        return 1;
    for (uint32_t i = 0; i < s->model.header->n_objects; i++)
        if (s->placed[i].is_behind_catcher &&
            !glint_box_is_empty(glint_box_intersect(s->placed[i].box, b)))
            return 1;
    for (int k = 0; k < 4; k++) {
        struct glint_scene_ray ray;
        int32_t seen_q30[3], t;

        /* the middles of pixels next to the corners, outside B */
        glint_view_set_ray(
            &s->view, glint_pixel_position_q8(s, k & 1 ? b.x1 : b.x0 - 1, 0),
            glint_pixel_position_q8(s, k & 2 ? b.y1 : b.y0 - 1, 1), &ray,
            seen_q30);
        t = glint_ray_intersect_plane(&ray, plane->at, plane->centre);
        if (t == 0 || t == GLINT_PLANE_END ||
            q_magnitude(v3_cosine_q30(ray.toward_q30, plane->centre)) <
                1 << 20 ||
            !glint_ray_point_at_distance(&ray, t, corner[k]))
            return 1;
    }
    for (uint32_t i = 0; i < s->n_lit; i++)
        if (glint_shadow_can_fall_on(s->lit[i].shadow,
                                     (const int32_t(*)[3])corner))
            return 1;
    return 0;
}

/* Draws a plane in the tile of W; of a shadow catcher only the blocks of pixels
 * that it may change. */
static void draw_visible_blocks_of_plane(struct glint_scene_worker *w,
                                         const struct glint_placed *plane,
                                         uint32_t id)
{
    const struct glint_box b = glint_box_intersect(w->tile, plane->box);
    const int side = plane->is_only_shadow ? BLOCK : GLINT_MAX_SIDE;

    for (int y = b.y0; y < b.y1; y += side)
        for (int x = b.x0; x < b.x1; x += side) {
            const struct glint_box block = glint_box_intersect(
                b, (struct glint_box){x, y, x + side, y + side});

            if (can_catcher_change_pixels(w->scene, plane, block))
                draw_plane(w, plane, id, block);
        }
}

/* -------------------------------------------------------------------- tile */

/* Returns the box of pixels of TILE that may see an object. Meshes are included
 * if the tile's list has triangles. */
static struct glint_box
find_pixels_that_may_see_objects(const struct glint_scene *s,
                                 struct glint_box tile, int has_triangles)
{
    struct glint_box all = {0, 0, 0, 0};

    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];

        if (p->is_seen &&
            (has_triangles || p->object->kind != GLINT_OBJECT_MESH))
            all = glint_box_unite(all, glint_box_intersect(tile, p->box));
    }
    return all;
}

static void clear_tile_samples(struct glint_scene_worker *w)
{
    const struct glint_box b = w->touched;
    const int n = w->scene->cfg.edge_samples * (b.x1 - b.x0);

    for (int y = b.y0; y < b.y1; y++) {
        const int first = glint_get_sample_index(w, b.x0, y, 0);

        for (int i = first; i < first + n; i++) {
            w->depth[i] = 0;
            w->id[i] = GLINT_NOTHING;
        }
    }
}

int glint_scene_look(struct glint_scene_worker *w, struct glint_box tile)
{
    const struct glint_scene *s = w->scene;
    const int at = (tile.y0 >> s->cfg.tile_log2) * s->bins.tiles_x +
                   (tile.x0 >> s->cfg.tile_log2);
    const int has_triangles =
        s->has_triangles && s->bins.start[at] < s->bins.start[at + 1];

    w->tile = tile;
    w->touched = find_pixels_that_may_see_objects(s, tile, has_triangles);
    if (s->motion)
        w->touched =
            glint_box_unite(w->touched, s->cfg.parts.motions->touch(s, tile));
    clear_tile_samples(w);
    if (glint_box_is_empty(w->touched))
        return s->model.header->background != GLINT_BACKGROUND_CAMERA;
    for (int32_t i = has_triangles ? s->bins.start[at] : 0;
         has_triangles && i < s->bins.start[at + 1]; i++)
        s->cfg.parts.meshes->look(w, (uint32_t)s->bins.ref[i]);
    for (uint32_t i = 0; i < s->model.header->n_objects; i++)
        if (s->placed[i].is_seen &&
            s->placed[i].object->kind == GLINT_OBJECT_PLANE)
            draw_visible_blocks_of_plane(w, &s->placed[i],
                                         glint_make_triangle_id(i, 0));
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *placed = &s->placed[i];
        const struct glint_box b = glint_box_intersect(tile, placed->box);

        if (!placed->is_seen || glint_box_is_empty(b))
            continue;
        for (int y = b.y0; placed->radius > 0 && y < b.y1; y++) {
            struct glint_box row = b;

            if (glint_scene_find_ball_span(s, placed, y, &row.x0, &row.x1))
                draw_ball_row(w, placed, glint_make_triangle_id(i, 0), row, y);
        }
    }
    return 1;
}
