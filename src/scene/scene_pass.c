/* SPDX-License-Identifier: MIT
 *
 * The drawing pass (tile/pass.h) of a scene. Each object that the samples of a
 * pixel see is shaded only once, in the pixel's middle; reflecting and
 * transparent objects are shaded at each sample. Where objects cover a fraction
 * of a pixel, the picture's light shows through the rest. */
#include "scene/quick.h"
#include "scene/visible.h"
#include "scene/parts.h"

enum {
    /* sums of light and coverage are scaled to this number of samples per
     * pixel */
    SUMMED = 4
};

static void *clear_triangle_cache_for_row(const void *self,
                                          struct glint_box row, int worker)
{
    const struct glint_scene *scene = self;

    (void)row;
    for (int i = 0; scene->worker[worker].quick && i < GLINT_QUICK_TRIANGLES;
         i++)
        scene->worker[worker].quick[i].id = GLINT_NOTHING;
    return &scene->worker[worker];
}

static int find_objects_in_tile(void *state, struct glint_box tile)
{
    return glint_scene_look(state, tile);
}

/* Returns whether object ID is shaded at each sample. This is true for mirrors
 * and transparent objects, inside which edges of other objects are visible. */
static inline int is_shaded_per_sample(const struct glint_scene *s, uint32_t id)
{
    return s->has_split && id != GLINT_NOTHING && s->placed[id >> 20].is_split;
}

enum {
    /* special sample indices: the pixel's middle, and the middle of a block of
     * 2 x 2 pixels */
    MIDDLE = -1,
    QUAD = -2
};

/* Returns the offset of sample K from its pixel's middle along AXIS, 1/256
 * pixel. For QUAD: the corner shared with the pixels to the right and below. */
static int32_t get_sample_offset(const struct glint_scene *s, int k, int axis)
{
    return k >= 0 ? glint_sample_offset_q8(s, k, axis) : k == QUAD ? 128 : 0;
}

/* Finds the surface of object ID at pixel (X, Y) where the fast path (quick.h)
 * fails at the pixel's middle. Tries the exact ray through the middle first,
 * unless K is QUAD or the object is shaded at each sample; then the fast path
 * and the exact ray at sample K. */
static NEVER_INLINE int find_exact_surface(struct glint_scene_worker *w,
                                           uint32_t id, int x, int y, int k,
                                           struct glint_scene_ray *ray,
                                           struct glint_met_surface *surface)
{
    const struct glint_scene *s = w->scene;

    for (int i = k == QUAD || is_shaded_per_sample(s, id); i < 2; i++) {
        const int at = i ? k : MIDDLE;
        struct glint_met met;
        int32_t seen_q30[3];

        const int32_t x_q8 =
            glint_pixel_position_q8(s, x, 0) + get_sample_offset(s, at, 0);
        const int32_t y_q8 =
            glint_pixel_position_q8(s, y, 1) + get_sample_offset(s, at, 1);

        /* find_sample_surface() has already tried the fast path at the pixel's
         * middle */
        if (i > 0 && glint_quick_find_surface(w, id, x_q8, y_q8, ray, surface))
            return 1;
        glint_view_set_ray(&s->view, x_q8, y_q8, ray, seen_q30);
        if (glint_scene_ray_hits_id(s, ray, seen_q30, id, &met))
            return glint_scene_find_surface_at_hit(s, ray, &met, surface);
    }
    return 0;
}

/* Finds the surface that sample K of pixel (X, Y) sees; uses the fast path in
 * most pixels. */
static inline int find_sample_surface(struct glint_scene_worker *w, uint32_t id,
                                      int x, int y, int k,
                                      struct glint_scene_ray *ray,
                                      struct glint_met_surface *surface)
{
    const struct glint_scene *s = w->scene;

    return (k != QUAD && !is_shaded_per_sample(s, id) &&
            glint_quick_find_surface(w, id, glint_pixel_position_q8(s, x, 0),
                                     glint_pixel_position_q8(s, y, 1), ray,
                                     surface)) ||
           find_exact_surface(w, id, x, y, k, ray, surface);
}

/* Sets RGB_Q15 to the light of the background at pixel (X, Y). */
static void compute_background_light(const struct glint_scene *s, int x, int y,
                                     int32_t rgb_q15[3])
{
    struct glint_scene_ray ray = {.at = {0}};
    int32_t seen_q30[3];

    if (s->model.header->background == GLINT_BACKGROUND_ENVIRONMENT)
        glint_view_set_ray(&s->view, glint_pixel_position_q8(s, x, 0),
                           glint_pixel_position_q8(s, y, 1), &ray, seen_q30);
    glint_scene_look_up_background(s, ray.toward_q30,
                                   glint_scene_pixel_variance_q40(s), rgb_q15);
}

/* Shades the object or triangle ID, or the background, that sample K of pixel
 * (X, Y) sees. Returns whether the sample sees an object. */
static inline int shade_sample(struct glint_scene_worker *w, uint32_t id, int x,
                               int y, int k, struct glint_met_shade *shade)
{
    const struct glint_scene *s = w->scene;
    const struct glint_scene_header *h = s->model.header;
    struct glint_scene_ray ray;
    struct glint_met_surface surface;

    *shade = (struct glint_met_shade){{0, 0, 0}, 0};
    if (id != GLINT_NOTHING &&
        find_sample_surface(w, id, x, y, k, &ray, &surface)) {
        glint_scene_shade_surface(s, &ray, &surface, shade);
        return 1;
    }
    if (h->background != GLINT_BACKGROUND_CAMERA) {
        shade->cover_q8 = GLINT_COVER_ALL;
        compute_background_light(s, x, y, shade->rgb_q15);
    }
    return 0;
}

static inline int does_pixel_see_only_background(const uint32_t *id, int n)
{
    uint32_t all = id[0];

    for (int k = 1; k < n; k++)
        all &= id[k]; /* all bits of GLINT_NOTHING are set */
    return all == GLINT_NOTHING;
}

/* Returns whether object ID is a shadow catcher: it only receives shadows, and
 * does not hide lamps. */
static inline int is_shadow_catcher(const struct glint_scene *s, uint32_t id)
{
    return s->has_catchers && id != GLINT_NOTHING &&
           s->placed[id >> 20].is_catcher;
}

/* Returns whether two samples that see A and B can share one shaded point: they
 * see the same object, or two triangles of a smooth surface that share a
 * vertex. */
static int can_objects_share_shading(const struct glint_scene *s, uint32_t a,
                                     uint32_t b)
{
    return a == b ||
           ((a ^ b) >> 20 == 0 && a != GLINT_NOTHING && b != GLINT_NOTHING &&
            s->placed[a >> 20].object->kind == GLINT_OBJECT_MESH &&
            s->cfg.parts.meshes->joins(s, a, b));
}

/* Groups N samples that can share one shaded point. Sets TIMES of one sample of
 * each group to the size of the group, and TIMES of the others to 0. */
static inline void group_samples_by_shading(const struct glint_scene *s,
                                            const uint32_t *id, int n,
                                            int times[GLINT_SCENE_SAMPLES])
{
    int first = 0;

    for (int k = 0; k < n; k++) {
        times[k] = 0;
        if (is_shaded_per_sample(s, id[k])) {
            first = k;
        } else if (k > 0 && id[k] != id[k - 1]) {
            first = 0;
            while (first < k &&
                   (times[first] == 0 ||
                    !can_objects_share_shading(s, id[first], id[k])))
                first++;
        }
        times[first]++;
    }
}

/* Records the light of SHADE above white as a highlight of object ID. SHARE_Q4:
 * its area, pixels. OFF_Q8: offset of the area's middle from the top left
 * corner of pixel (X, Y). */
static inline void record_highlight(const struct glint_scene *s, uint32_t id,
                                    const struct glint_met_shade *shade, int x,
                                    int y, int32_t off_q8, int share_q4)
{
    const int32_t *rgb_q15 = shade->rgb_q15;

    if (s->bright &&
        (rgb_q15[0] > GLINT_SCENE_ONE_Q15 || rgb_q15[1] > GLINT_SCENE_ONE_Q15 ||
         rgb_q15[2] > GLINT_SCENE_ONE_Q15))
        s->cfg.parts.highlights->note(s->bright, id >> 20, 256 * x + off_q8,
                                      256 * y + off_q8, rgb_q15, share_q4);
}

/* Adds SHADE, of object ID, to SUM for TIMES of N samples. */
static inline void add_shaded_samples(const struct glint_scene *s, uint32_t id,
                                      const struct glint_met_shade *shade,
                                      int times, struct glint_scene_sum *sum)
{
    sum->cover_q10 += times * shade->cover_q8;
    if (is_shadow_catcher(s, id))
        sum->shadow_q10 += times * shade->cover_q8;
    for (int c = 0; c < 3; c++)
        sum->rgb_q17[c] += (int64_t)times * shade->rgb_q15[c];
}

/* Shades the samples of pixel (X, Y) one by one, except samples that can share
 * the shading of another one. */
static NEVER_INLINE void shade_pixel_samples(struct glint_scene_worker *w,
                                             const uint32_t *id, int n, int x,
                                             int y, struct glint_scene_sum *sum)
{
    const struct glint_scene *s = w->scene;
    const int down = n == 16 ? 2 : n == 8;
    int times[GLINT_SCENE_SAMPLES];

    group_samples_by_shading(s, id, n, times);
    for (int k = 0; k < n; k++) {
        struct glint_met_shade shade;

        if (times[k] == 0)
            continue;
        if (shade_sample(w, id[k], x, y, k, &shade))
            record_highlight(s, id[k], &shade, x, y, 128,
                             times[k] << (4 - glint_get_samples_log2(n)));
        add_shaded_samples(s, id[k], &shade, times[k], sum);
    }
    for (int c = 0; c < 3; c++)
        sum->rgb_q17[c] =
            down ? q_shift(sum->rgb_q17[c], down) : sum->rgb_q17[c];
    sum->cover_q10 = (sum->cover_q10 + down) >> down;
    sum->shadow_q10 = (sum->shadow_q10 + down) >> down;
}

static inline int do_all_samples_see_object(const uint32_t *id, int n,
                                            uint32_t thing)
{
    uint32_t other = 0;

    for (int k = 0; k < n; k++)
        other |= id[k] ^ thing;
    return other == 0;
}

static int can_all_samples_share_shading(const struct glint_scene *s,
                                         const uint32_t *id, int n,
                                         uint32_t thing)
{
    uint32_t last = thing;

    for (int k = 0; k < n; k++) {
        if (id[k] != last && !can_objects_share_shading(s, id[k], thing))
            return 0;
        last = id[k];
    }
    return 1;
}

/* Returns whether all samples of the aligned block of 2 x 2 pixels that
 * contains (X, Y) see one object, or adjacent triangles of one smooth surface,
 * so that one shaded point serves all four pixels. */
static int can_pixel_quad_share_shading(const struct glint_scene_worker *w,
                                        int n, int x, int y)
{
    const struct glint_box b = w->touched;
    const int x0 = x & ~1, y0 = y & ~1;
    const uint32_t *id;

    if (x0 < b.x0 || y0 < b.y0 || x0 + 1 >= b.x1 || y0 + 1 >= b.y1)
        return 0;
    id = &w->id[glint_get_sample_index(w, x0, y0, 0)];
    if (id[0] == GLINT_NOTHING)
        return 0;
    return can_all_samples_share_shading(w->scene, id, 2 * n, id[0]) &&
           can_all_samples_share_shading(
               w->scene, &w->id[glint_get_sample_index(w, x0, y0 + 1, 0)],
               2 * n, id[0]);
}

/* Shades pixel (X, Y), whose N samples see the objects ID[N], and sets SUM. */
static inline void shade_pixel(struct glint_scene_worker *w, const uint32_t *id,
                               int n, int x, int y, struct glint_scene_sum *sum)
{
    const struct glint_scene *s = w->scene;
    const int quad = w->quad && can_pixel_quad_share_shading(w, n, x, y);
    struct glint_scene_sum *kept =
        quad ? &w->quad[(x - w->tile.x0) >> 1] : NULL;
    struct glint_met_shade shade;

    if (quad && ((x | y) & 1)) {
        *sum = *kept;
        return;
    }
    *sum = (struct glint_scene_sum){{0, 0, 0}, 0, 0};
    if (quad || n == 1 ||
        (do_all_samples_see_object(id, n, id[0]) &&
         !is_shaded_per_sample(s, id[0]))) {
        if (shade_sample(w, id[0], x, y, quad ? QUAD : 0, &shade))
            record_highlight(s, id[0], &shade, x, y, quad ? 256 : 128,
                             quad ? 64 : 16);
        add_shaded_samples(s, id[0], &shade, SUMMED, sum);
    } else {
        shade_pixel_samples(w, id, n, x, y, sum);
    }
    if (quad)
        *kept = *sum;
}

static inline void write_pixel_light(const struct glint_scene_worker *w,
                                     const struct glint_pass_rows *rows, int i,
                                     int row, const int64_t sum_q17[3],
                                     int cover_q10)
{
    rows->cover->cover_q8[row][i] = (uint16_t)((cover_q10 + 2) >> 2);
    for (int c = 0; c < 3; c++)
        if (w->is_linear)
            rows->light_q20[c][i] = q_clamp_sat(sum_q17[c] * 8, 0, INT32_MAX);
        else
            rows->light->rgb_q16[c][row][i] =
                (uint16_t)q_clamp_sat((sum_q17[c] + 1) >> 1, 0, 65535);
}

/* Sets N pixels of row ROW, from column X to the right, to the same light and
 * coverage. */
static void write_pixel_run(const struct glint_scene_worker *w,
                            const struct glint_pass_rows *rows, int row, int x,
                            int n, const int32_t rgb_q15[3], int cover_q8)
{
    const int first = x - w->tile.x0;
    uint16_t *to_q8 = &rows->cover->cover_q8[row][first];

    for (int i = 0; i < n; i++)
        to_q8[i] = (uint16_t)cover_q8;
    for (int c = 0; c < 3; c++) {
        const int64_t light_q17 = (int64_t)rgb_q15[c] * SUMMED;
        const int32_t light_q20 = q_clamp_sat(light_q17 * 8, 0, INT32_MAX);
        const uint16_t light_q16 =
            (uint16_t)q_clamp_sat((light_q17 + 1) >> 1, 0, 65535);

        if (w->is_linear) {
            for (int i = 0; i < n; i++)
                rows->light_q20[c][first + i] = light_q20;
        } else {
            uint16_t *to_q16 = &rows->light->rgb_q16[c][row][first];

            for (int i = 0; i < n; i++)
                to_q16[i] = light_q16;
        }
    }
}

static void add_full_cover_of_pixels(const struct glint_scene *s, int y, int x0,
                                     int x1)
{
    enum { SIDE = 1 << GLINT_COVER_LOG2 };
    uint16_t *cover = &s->cover[(y >> GLINT_COVER_LOG2) * s->cover_across];

    for (int x = x0, end; x < x1; x = end) {
        end = q_smaller((x + SIDE) & -SIDE, x1);
        cover[x >> GLINT_COVER_LOG2] = (uint16_t)(cover[x >> GLINT_COVER_LOG2] +
                                                  (end - x) * GLINT_COVER_ALL);
    }
}

/* Sets pixels X0 .. X1 - 1 of row ROW to the background's light. */
static void write_background_pixels(const struct glint_scene_worker *w,
                                    const struct glint_pass_rows *rows, int row,
                                    int x0, int x1)
{
    static const int32_t none_q15[3];
    const struct glint_scene_header *h = w->scene->model.header;

    if (h->background == GLINT_BACKGROUND_CAMERA) {
        write_pixel_run(w, rows, row, x0, x1 - x0, none_q15, 0);
        return;
    }
    add_full_cover_of_pixels(w->scene, rows->y + row, x0, x1);
    if (h->background != GLINT_BACKGROUND_ENVIRONMENT) {
        write_pixel_run(w, rows, row, x0, x1 - x0, h->background_q15,
                        GLINT_COVER_ALL);
        return;
    }
    for (int x = x0; x < x1; x++) {
        int32_t rgb_q15[3];

        compute_background_light(w->scene, x, rows->y + row, rgb_q15);
        write_pixel_run(w, rows, row, x, 1, rgb_q15, GLINT_COVER_ALL);
    }
}

/* Draws pixel X of row ROW, whose N samples see the objects ID[N]; returns
 * whether the pixel changes. */
static inline int draw_row_pixel(struct glint_scene_worker *w,
                                 const struct glint_pass_rows *rows, int row,
                                 int x, const uint32_t *id, int n)
{
    const struct glint_scene *s = w->scene;
    const int y = rows->y + row;
    uint16_t *cover = &s->cover[(y >> GLINT_COVER_LOG2) * s->cover_across +
                                (x >> GLINT_COVER_LOG2)];
    struct glint_scene_sum sum;

    shade_pixel(w, id, n, x, y, &sum);
    if (w->n_over)
        s->cfg.parts.motions->over(w, x, y, &sum);
    write_pixel_light(w, rows, x - w->tile.x0, row, sum.rgb_q17, sum.cover_q10);
    *cover = (uint16_t)(*cover + ((sum.cover_q10 - sum.shadow_q10 + 2) >> 2));
    return sum.cover_q10 || sum.rgb_q17[0] || sum.rgb_q17[1] || sum.rgb_q17[2];
}

/* Draws row ROW with N samples per pixel; returns whether any pixel changes. */
static inline int draw_pixel_row(struct glint_scene_worker *w,
                                 const struct glint_pass_rows *rows, int row,
                                 int n)
{
    const struct glint_scene *s = w->scene;
    const struct glint_box b = w->touched;
    const int y = rows->y + row;
    const int is_in = !glint_box_is_empty(b) && y >= b.y0 && y < b.y1;
    const int x0 = is_in ? b.x0 : w->tile.x1, x1 = is_in ? b.x1 : w->tile.x1;
    const uint32_t *id = &w->id[glint_get_sample_index(w, x0, y, 0)];
    int any = s->model.header->background != GLINT_BACKGROUND_CAMERA;
    int same = x0; /* end of the run of pixels that the same overlays cover */

    w->n_spans = w->n_over = 0;
    if (s->motion && is_in)
        s->cfg.parts.motions->list(w, y);
    write_background_pixels(w, rows, row, w->tile.x0, x0);
    for (int x = x0, end; x < x1; x = end) {
        if (x == same)
            same = w->n_spans ? q_smaller(s->cfg.parts.motions->next(w, x), x1)
                              : x1;
        for (end = x;
             end < same && !w->n_over && does_pixel_see_only_background(id, n);
             id += n)
            end++;
        if (end > x) {
            write_background_pixels(w, rows, row, x, end);
            continue;
        }
        any |= draw_row_pixel(w, rows, row, x, id, n);
        id += n;
        end = x + 1;
    }
    write_background_pixels(w, rows, row, x1, w->tile.x1);
    return any;
}

static enum glint_given draw_pixel_rows(void *state,
                                        const struct glint_pass_rows *rows)
{
    struct glint_scene_worker *w = state;
    const int n = w->scene->cfg.edge_samples;
    int any = 0;

    if (w->scene->model.header->background == GLINT_BACKGROUND_CAMERA &&
        (rows->y >= w->touched.y1 || rows->y + rows->n <= w->touched.y0))
        return GLINT_GIVES_NOTHING;
    for (int row = 0; row < rows->n; row++)
        any |= n == 1   ? draw_pixel_row(w, rows, row, 1)
               : n == 4 ? draw_pixel_row(w, rows, row, 4)
                        : draw_pixel_row(w, rows, row, n);
    return any ? GLINT_GIVES_COVER : GLINT_GIVES_NOTHING;
}

static struct glint_pass get_scene_pass(const struct glint_scene *scene)
{
    return (struct glint_pass){scene, clear_triangle_cache_for_row,
                               find_objects_in_tile, draw_pixel_rows};
}

/* ----------------------------------------------------------------- drawing */

struct draw {
    struct glint_scene *scene;
    struct glint_tiles tiles;
    struct glint_pass pass;
};

static void draw_row_of_tiles(void *ctx, int job, int worker)
{
    struct draw *d = ctx;

    glint_tiles_draw_row(&d->tiles, &d->pass, 1, job, worker,
                         &d->scene->worker[worker].scratch);
}

void glint_scene_draw(struct glint_scene *scene,
                      const struct glint_image *image)
{
    struct draw d = {.scene = scene, .pass = get_scene_pass(scene)};

    glint_scene_spread(scene);
    glint_resolve_init(scene->resolve, image, 0, scene->cfg.sets);
    d.tiles = (struct glint_tiles){.region = scene->bins.region,
                                   .tile_log2 = scene->cfg.tile_log2,
                                   .width = scene->cfg.width,
                                   .height = scene->cfg.height,
                                   .image = image,
                                   .resolve = scene->resolve,
                                   .blend = &glint_blend};
    for (int i = 0; i < scene->cover_across * scene->cover_down; i++)
        scene->cover[i] = 0;
    if (scene->bright)
        scene->cfg.parts.highlights->begin(scene->bright);
    for (int i = 0; i < glint_workers_count(scene->cfg.workers); i++)
        scene->worker[i].is_linear = image->format == GLINT_LINEAR_Q20;
    glint_workers_run(scene->cfg.workers, glint_tiles_count_rows(&d.tiles),
                      draw_row_of_tiles, &d);
}
