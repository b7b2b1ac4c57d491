/* SPDX-License-Identifier: MIT
 *
 * Tests drawing scenes in every format. Images must not depend on tiles,
 * workers or the order of jobs, closed meshes must have no gaps, and the lights
 * passed to the flare must be right.
 */
#include "glint/flare.h"
#include "glint/scene/account.h"
#include "scene/state.h"
#include "scene/visible.h"
#include "support/model_builder.h"
#include "support/models/scene_builder.h"
#include "support/shuffle.h"
#include "support/test.h"

static struct glint_scene_stats stats;
static struct glint_scene_config cfg;

enum {
    UNIT = 1 << 16,
    ONE_Q30 = 1 << 30,
    WIDTH = 131,
    HEIGHT = 77,
    BYTES = WIDTH * HEIGHT * 12
};

static struct scene_file file;

static void set_default_config(void)
{
    glint_scene_defaults(&cfg, WIDTH, HEIGHT);
    cfg.parts = scene_parts;
}

static struct glint_scene *begin_scene(void)
{
    return scene_init_renderer(&file, &cfg, &stats);
}

/* Adds a closed mesh, a bumpy ball, around the origin. */
static uint32_t add_ball_mesh(double size)
{
    enum { SIDES = 16, RINGS = 9, N = SIDES * RINGS + 2 };
    static int32_t at[N][3];
    static uint32_t t[2 * SIDES * RINGS][3];
    uint32_t seed = 5;
    int n;

    for (int i = 0; i < N; i++) {
        const double b = i < N - 2 ? 3.14159265 * (i / SIDES + 1) / (RINGS + 1)
                                   : 3.14159265 * (i - N + 2);
        const double a = 6.2831853 * (i % SIDES) / SIDES;
        const double r = size * UNIT * (.8 + .2 * rng_unit(&seed));

        at[i][0] = (int32_t)lround(r * sin(b) * cos(a));
        at[i][1] = (int32_t)lround(r * sin(b) * sin(a));
        at[i][2] = (int32_t)lround(r * cos(b));
    }
    n = scene_make_ball(RINGS, SIDES, t);
    return scene_add_mesh(&file, (const int32_t(*)[3])at, NULL, NULL, N,
                          (const uint32_t(*)[3])t, n);
}

/* Makes a scene of balls, a mesh and a floor, with reflection, transmission and
 * a texture. */
static void make_scene_of_all_objects(void)
{
    static const int32_t sun[3] = {ONE_Q30 / 5 * 3, ONE_Q30 / 5 * 4, 0};
    static const int32_t lamp[3] = {-3 * UNIT, 5 * UNIT, 2 * UNIT};
    uint8_t rgb[3 * 64];

    for (int i = 0; i < 3 * 64; i++)
        rgb[i] = (uint8_t)(i * 37);
    scene_begin_header(&file);
    file.header.shadow = file.header.flare = 1;
    scene_add_material(&file, "plain");
    scene_add_material(&file, "mirror");
    scene_add_material(&file, "glass");
    scene_add_material(&file, "wood");
    file.material[0].diffuse_q15 = 26000;
    file.material[0].specular_q15 = 6000;
    file.material[1].diffuse_q15 = 9000;
    file.material[1].reflect_q15 = 20000;
    file.material[2].diffuse_q15 = 2000;
    file.material[2].pass_q15 = 28000;
    file.material[2].index_q16 = 98304;
    file.material[3].texture = scene_add_texture(&file, rgb, 3, 3);
    scene_add_sphere(&file, "mirror", 1, -2 * UNIT, 0, 7 * UNIT, UNIT);
    scene_add_sphere(&file, "glass", 2, UNIT / 2, -UNIT / 3, 5 * UNIT,
                     UNIT / 2);
    scene_add_plane(&file, "floor", 3, -UNIT);
    file.object[scene_add_object(&file, "rock", 0, add_ball_mesh(1))].at[2] =
        6 * UNIT;
    scene_add_sun(&file, sun);
    file.light[0].radius = ONE_Q30 / 20;
    scene_add_lamp(&file, lamp, 4 * UNIT);
}

TEST_BEFORE
{
    set_default_config();
    make_scene_of_all_objects();
}

static void fill_image_with_pattern(uint8_t *px, size_t n)
{
    for (size_t i = 0; i < n; i++)
        px[i] = (uint8_t)(40 + i * 7 / 2 % 90);
}

/* --------------------------------------------------- scheduling and format */

static void draw_scene(struct glint_scene_config config,
                       enum glint_pixel_format format, int workers,
                       uint32_t order, uint8_t *px)
{
    struct glint_image image = glint_image_over(px, format, WIDTH, HEIGHT);
    struct shuffle shuffle;

    fill_image_with_pattern(px, BYTES);
    init_shuffled_workers(&shuffle, workers, order);
    config.workers = &shuffle.workers;
    glint_scene_draw(scene_init_renderer(&file, &config, &stats), &image);
    assert_int_equal(stats.objects, 4);
    assert_int_equal(stats.dropped_objects, 0);
}

TEST(image_does_not_depend_on_job_order)
{
    static uint8_t px[2][BYTES];

    for (int format = GLINT_RGB24; format <= GLINT_RGB565; format++) {
        static const int samples[4] = {4, 16, 8, 1};
        const size_t bytes =
            glint_image_bytes((enum glint_pixel_format)format, WIDTH, HEIGHT);
        uint8_t before[64];
        int changed = 0;

        set_default_config();
        cfg.edge_samples = samples[format % 4];
        cfg.half_shading = format & 1;

        draw_scene(cfg, (enum glint_pixel_format)format, 1, 1, px[0]);
        fill_image_with_pattern(px[1], BYTES);
        for (size_t i = 0; i < bytes; i++)
            changed += px[0][i] != px[1][i];
        assert_true(changed > (int)bytes / 6);
        memcpy(before, px[1] + bytes, bytes < BYTES ? 64 : 0);
        assert_memory_equal(px[0] + bytes, px[1] + bytes, BYTES - bytes);
        for (int log2 = 3; log2 <= 6; log2++) {
            cfg.tile_log2 = log2;
            draw_scene(cfg, (enum glint_pixel_format)format, 1 + log2,
                       77U * (uint32_t)log2, px[1]);
            assert_memory_equal(px[0], px[1], BYTES);
        }
    }
}

/* ---------------------------------------------------------- covered pixels */

TEST(invisible_objects_change_nothing)
{
    static uint8_t px[BYTES], before[BYTES];
    struct glint_image image = glint_image_over(px, GLINT_I420, WIDTH, HEIGHT);

    fill_image_with_pattern(px, BYTES);
    fill_image_with_pattern(before, BYTES);
    for (int i = 0; i < 4; i++)
        file.object[i].hidden = 1;
    glint_scene_draw(begin_scene(), &image);
    assert_memory_equal(px, before, BYTES);
    assert_int_equal(stats.objects, 0);
    make_scene_of_all_objects();
    /* all objects except the floor are behind the camera */
    file.header.camera.axis_q30[0][0] = -ONE_Q30;
    file.header.camera.axis_q30[2][2] = -ONE_Q30;
    file.object[2].hidden = 1;
    glint_scene_draw(begin_scene(), &image);
    assert_memory_equal(px, before, BYTES);
    /* a shadow catcher in a scene without shadows changes nothing */
    make_scene_of_all_objects();
    for (int i = 0; i < 4; i++)
        file.object[i].hidden = i != 2;
    file.object[2].catcher_q15 = 20000;
    glint_scene_draw(begin_scene(), &image);
    assert_memory_equal(px, before, BYTES);
    /* an object that casts a shadow on the catcher darkens the image */
    make_scene_of_all_objects();
    file.object[2].catcher_q15 = 32768;
    file.object[0].hidden = file.object[1].hidden = 1;
    glint_scene_draw(begin_scene(), &image);
    assert_memory_not_equal(px, before, BYTES);
}

/* Checks that the number of pixels that a ball covers is the area of its disc,
 * and that the memory hardly depends on the image size. */
TEST(ball_covers_its_disc)
{
    static uint8_t px[BYTES];
    struct glint_image image = glint_image_over(px, GLINT_RGB24, WIDTH, HEIGHT);
    struct glint_scene *s;
    int64_t sum = 0;

    scene_begin_header(&file);
    scene_add_material(&file, "m");
    scene_add_sphere(&file, "ball", 0, 0, 0, 100 * UNIT, 40 * UNIT);
    glint_scene_defaults(&cfg, WIDTH, HEIGHT);
    s = begin_scene();
    memset(px, 0, sizeof px);
    glint_scene_draw(s, &image);
    for (int i = 0; i < s->cover_across * s->cover_down; i++)
        sum += s->cover[i];
    /* the disc has a radius of f tan(asin(.4)) pixels */
    assert_true(
        fabs((double)sum / 256 / (3.14159265 * pow(WIDTH / 2. * .436436, 2)) -
             1) < 2e-3);
}

/* Checks the memory limits at 320x240 with two workers: at most 120 KiB for
 * balls and planes with Phong shading alone, and 60 KiB more for a sun with
 * shadows. */
TEST(memory_stays_within_its_limits)
{
    static const int32_t toward_q30[3] = {0, 0, -(1 << 30)};
    struct glint_workers two = {.n = 2};
    struct glint_scene_model model;
    size_t bytes;

    scene_begin_header(&file);
    scene_add_material(&file, "m");
    for (int i = 0; i < 8; i++)
        scene_add_sphere(&file, "ball", 0, 0, 0, 100 * UNIT, 4 * UNIT);
    glint_scene_defaults(&cfg, 320, 240);
    cfg.workers = &two;
    model = scene_open_model(&file);
    bytes = glint_scene_bytes(&cfg, &model);
    print_message("8 balls: %zu bytes", bytes);
    assert_in_range(bytes, 1, 120 << 10);
    scene_add_sun(&file, toward_q30);
    file.header.shadow = 1;
    model = scene_open_model(&file);
    print_message(", with a sun's shadows: %zu\n",
                  glint_scene_bytes(&cfg, &model));
    assert_in_range(glint_scene_bytes(&cfg, &model), bytes + 1,
                    bytes + (60 << 10));
}

/* Checks that from any position inside a closed mesh all rays hit it, even if
 * some vertices are behind the camera. */
TEST(closed_mesh_has_no_leaks)
{
    static uint8_t px[BYTES];
    struct glint_image image = glint_image_over(px, GLINT_RGB24, WIDTH, HEIGHT);
    uint32_t seed = 1;

    cfg.max_refs = 1 << 18;
    for (int i = 0; i < 60; i++) {
        struct glint_scene *s;
        double size = exp2(rng_int_below(&seed, 16) - 5);

        scene_begin_header(&file);
        scene_add_material(&file, "m");
        file.material[0].diffuse_q15 = 0;
        scene_add_object(&file, "rock", 0, add_ball_mesh(size));
        for (int k = 0; k < 3; k++)
            file.header.camera.at[k] =
                (int32_t)((rng_unit(&seed) - .5) * .8 * size * UNIT);
        file.header.camera.tan_x_q24 = 1 << (20 + rng_int_below(&seed, 8));
        s = begin_scene();
        assert_int_equal(stats.dropped_objects, 0);
        memset(px, 255, sizeof px);
        glint_scene_draw(s, &image);
        for (int k = 0; k < 3 * WIDTH * HEIGHT; k++)
            assert_int_equal(px[k], 0);
    }
}

TEST(sample_shows_the_first_object)
{
    const struct glint_scene *s;
    int n = 0, other = 0;

    s = begin_scene();
    for (int y = 0; y < HEIGHT; y += 32)
        for (int x = 0; x < WIDTH; x += 32) {
            const struct glint_box tile = {x, y,
                                           x + 32 < WIDTH ? x + 32 : WIDTH,
                                           y + 32 < HEIGHT ? y + 32 : HEIGHT};
            const struct glint_scene_worker *w = &s->worker[0];

            glint_scene_look(&s->worker[0], tile);
            for (int i = 0; i < 32 * 32 * 4; i += 4) {
                const int px = x + i / 4 % 32, py = y + i / 4 / 32;
                struct glint_scene_ray ray;
                struct glint_met met;
                int32_t seen_q30[3];
                int is;

                if (px >= WIDTH || py >= HEIGHT)
                    continue;
                glint_view_set_ray(&s->view, 256 * px - 128 * (WIDTH - 1) - 96,
                                   256 * py - 128 * (HEIGHT - 1) - 32, &ray,
                                   seen_q30);
                is = glint_scene_find_nearest_hit(s, &ray, GLINT_NOTHING, 0,
                                                  &met);
                n++;
                other += w->id[i] !=
                         (is ? glint_make_triangle_id(met.object, met.triangle)
                             : GLINT_NOTHING);
            }
        }
    print_message("%d of %d samples see another thing than their rays\n", other,
                  n);
    assert_true(n == WIDTH * HEIGHT && other <= 5);
}

/* Draws the scene of make_scene_of_all_objects() in linear light. */
static void draw_scene_linear(int edge_samples, int half, int32_t *px_q20)
{
    struct glint_image image =
        glint_image_over(px_q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);

    cfg.edge_samples = edge_samples;
    cfg.half_shading = half;
    memset(px_q20, 0, sizeof *px_q20 * 3 * WIDTH * HEIGHT);
    glint_scene_draw(begin_scene(), &image);
}

/* Returns the root mean square difference between A and B, 1 = display
 * white. */
static double compute_rms_difference(const int32_t *a_q20, const int32_t *b_q20)
{
    double sum = 0;

    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        sum += pow((a_q20[i] - b_q20[i]) / 0x1p20, 2);
    return sqrt(sum / (3 * WIDTH * HEIGHT));
}

/* Checks that more samples per pixel give images closer to one with 16 samples.
 * Shading 2 x 2 pixels at once must change only pixels whose neighbours show
 * the same object. */
TEST(more_samples_come_closer)
{
    static int32_t all[3 * WIDTH * HEIGHT], some[3 * WIDTH * HEIGHT];
    double last = 1;
    int changed = 0;

    draw_scene_linear(16, 0, all);
    for (int n = 1; n <= 8; n *= n == 1 ? 4 : 2) {
        double off;

        draw_scene_linear(n, 0, some);
        off = compute_rms_difference(some, all);
        print_message("%d samples: %.1f dB\n", n, -20 * log10(off));
        assert_true(off > 0 && off < .8 * last);
        last = off;
    }
    draw_scene_linear(16, 1, some);
    print_message("two by two: %.1f dB\n",
                  -20 * log10(compute_rms_difference(some, all)));
    assert_true(compute_rms_difference(some, all) < .1);
    for (int y = 0; y < HEIGHT - 1; y += 2)
        for (int x = 0; x < WIDTH - 1; x += 2) {
            const int i = 3 * (y * WIDTH + x);
            int is = 0, alike = 1;

            for (int k = 0; k < 12; k++) {
                const int at = i + k % 6 + k / 6 * 3 * WIDTH;

                is |= some[at] != all[at];
                alike &= some[at] == some[i + k % 3];
            }
            assert_true(!is || alike);
            changed += is;
        }
    assert_in_range(changed, 500, WIDTH * HEIGHT / 4);
}

TEST(exact_capacity_is_sufficient)
{
    const struct glint_scene_model model = scene_open_model(&file);

    begin_scene();
    assert_true(stats.need_refs == stats.refs && stats.refs > 0);
    cfg.max_refs = stats.need_refs;
    begin_scene();
    assert_int_equal(stats.dropped_objects, 0);
    cfg.max_refs--;
    begin_scene();
    assert_int_equal(stats.dropped_objects, 1);
    assert_true(stats.refs == 0 && stats.need_refs == cfg.max_refs + 1);
    cfg.parts.bounces = NULL;
    assert_string_equal(glint_scene_lacks(&cfg.parts, &model), "bounces");
    assert_int_equal(glint_scene_bytes(&cfg, &model), 0);
    cfg.parts.meshes = NULL;
    assert_string_equal(glint_scene_lacks(&cfg.parts, &model), "meshes");
    cfg.parts = scene_parts;
    cfg.parts.textures = NULL;
    assert_string_equal(glint_scene_lacks(&cfg.parts, &model), "textures");
    cfg.parts = scene_parts;
    cfg.edge_samples = 2;
    assert_int_equal(glint_scene_bytes(&cfg, &model), 0);
}

TEST(changed_poses_equal_a_new_scene)
{
    const int32_t at[4] = {UNIT, 0, 9 * UNIT}, far[3] = {GLINT_SCENE_SPAN - 9};
    const int32_t turn[4] = {ONE_Q30 / 5 * 3, 0, ONE_Q30 / 5 * 4, 0};
    const int32_t axes[3][3] = {{ONE_Q30}, {0, ONE_Q30}, {0, 0, -ONE_Q30}};
    const int32_t crooked[3][3] = {{ONE_Q30}, {ONE_Q30}, {0, 0, ONE_Q30}};
    struct glint_scene *s;
    int32_t x[3] = {1 << 20, 0, 0}, to[3];

    s = begin_scene();
    assert_ok(glint_scene_set_pose(s, 0, at, turn));
    assert_int_equal(glint_scene_set_pose(s, 0, far, turn), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_pose(s, 4, at, turn), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_pose(s, 0, at, at), GLINT_E_ARGUMENT);
    /* a rotation about y by 2 atan(4/3): the x axis becomes (-.28, 0, -.96) */
    v3_rotate(&s->placed[0].turn, x, to);
    assert_true(abs(to[0] + 293601) <= 1 && to[1] == 0 &&
                abs(to[2] + 1006633) <= 1);
    assert_int_equal(s->placed[0].at[2], 9 * UNIT);
    assert_ok(glint_scene_set_camera(s, at, axes));
    assert_int_equal(glint_scene_set_camera(s, at, crooked), GLINT_E_ARGUMENT);
    assert_ok(glint_scene_set_light(s, 1, at));
    assert_int_equal(glint_scene_set_light(s, 0, at), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_light(s, 2, at), GLINT_E_ARGUMENT);
}

/* ----------------------------------------------------------------- shadows */

/* Sets SURFACE to a random point near the objects of
 * make_scene_of_all_objects(), above the floor. */
static void set_random_surface_point(uint32_t *seed,
                                     struct glint_met_surface *surface)
{
    static const int32_t at[3] = {0, 0, 6 * UNIT};

    *surface = (struct glint_met_surface){.object = 2};
    for (int k = 0; k < 3; k++) {
        surface->place[k] = at[k] + (int32_t)((rng_unit(seed) - .5) * 9 * UNIT);
        surface->face_q30[k] = k == 1 ? ONE_Q30 : 0;
    }
}

/* The shadows of a sun are found by a grid. Checks that they equal shadows by
 * rays that are tested against all objects, also far below objects, outside the
 * grid, and from oblique surfaces. */
TEST(shadow_grid_equals_brute_force)
{
    uint32_t seed = 1;
    int n = 0, other = 0, partly = 0, dark = 0;

    for (int points = 1; points <= 16; points *= 4) {
        struct glint_scene *s;

        cfg.shadow_points = points;
        make_scene_of_all_objects();
        file.object[2].catcher_q15 = points == 4 ? 20000 : 0;
        s = begin_scene();
        assert_true(s->lit[0].shadow && s->lit[0].shadow->is_ready);
        assert_null(s->lit[1].shadow);
        for (int i = 0; i < 20000; i++) {
            struct glint_met_surface surface;
            int32_t by_grid, by_rays;

            set_random_surface_point(&seed, &surface);
            s->lit[0].shadow->is_ready = 1;
            by_grid = glint_scene_lit_fraction(s, &surface, &s->lit[0]);
            s->lit[0].shadow->is_ready = 0;
            by_rays = glint_scene_lit_fraction(s, &surface, &s->lit[0]);
            n++;
            other += by_grid != by_rays;
            dark += by_rays == 0;
            partly += by_rays > 0 && by_rays < 32768;
        }
        glint_scene_show(s, 0, 0);
        assert_false(s->lit[0].shadow->is_ready);
    }
    print_message(
        "%d of %d places, %d dark, %d partly: %d other than by rays\n", n, n,
        dark, partly, other);
    assert_true(dark > 500 && partly > 200 && other <= 3);
}

/* Checks that the visible fraction of a lamp equals that of rays to all its
 * points, also where a single test finds that no object can hide the lamp. */
TEST(lamp_is_as_visible_as_its_points)
{
    uint32_t seed = 1;
    int lit = 0, partly = 0;

    file.object[2].catcher_q15 = 20000;
    file.light[1].radius = UNIT;
    for (cfg.shadow_points = 4; cfg.shadow_points <= 16;
         cfg.shadow_points *= 4) {
        const struct glint_scene *s = begin_scene();
        const int n = cfg.shadow_points;

        for (int i = 0; i < 20000; i++) {
            struct glint_met_surface surface;
            struct glint_scene_ray ray = {.at = {0}};
            int32_t level_q15[3], share_q15, t;
            int reached = 0;

            set_random_surface_point(&seed, &surface);
            memcpy(ray.at, surface.place, sizeof ray.at);
            t = glint_scene_compute_light_at(s, &s->lit[1], ray.at,
                                             ray.toward_q30, level_q15);
            for (int k = 0; k < n; k++) {
                struct glint_scene_ray to = ray;

                glint_scene_aim_at_light_point(&to, t, UNIT, k, n);
                reached += v3_dot(to.toward_q30, surface.face_q30) > 0 &&
                           !glint_scene_is_ray_blocked(s, &to, 2, 0, t);
            }
            share_q15 = glint_scene_lit_fraction(s, &surface, &s->lit[1]);
            assert_int_equal(share_q15, 32768 / n * reached);
            lit += reached == n;
            partly += reached > 0 && reached < n;
        }
    }
    print_message("%d lit, %d partly\n", lit, partly);
    assert_true(lit > 10000 && partly > 1000);
}

/* Checks a square mesh perpendicular to each axis in turn, which coincides with
 * a side of its triangle grid. For points behind it, on either side, it must
 * occlude a lamp. */
TEST(flat_mesh_shadows_a_lamp)
{
    static const uint32_t t[2][3] = {{0, 1, 2}, {0, 2, 3}};

    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            struct glint_met_surface surface = {.object = 0};
            int32_t at[4][3], lamp[3] = {0, 0, 0};
            struct glint_scene *s;

            memset(at, 0, sizeof at);
            for (int i = 0; i < 4; i++) {
                at[i][u] = i == 1 || i == 2 ? UNIT : -UNIT;
                at[i][v] = i >= 2 ? UNIT : -UNIT;
            }
            scene_begin_header(&file);
            file.header.shadow = 1;
            scene_add_material(&file, "m");
            scene_add_sphere(&file, "far", 0, 90 * UNIT, 0, 0, UNIT);
            scene_add_object(&file, "flat", 0,
                             scene_add_mesh(&file, (const int32_t(*)[3])at,
                                            NULL, NULL, 4, t, 2));
            lamp[axis] = 3 * side * UNIT;
            scene_add_lamp(&file, lamp, UNIT);
            s = begin_scene();
            surface.place[axis] = -side * UNIT;
            surface.place[u] = UNIT / 3;
            surface.face_q30[axis] = side < 0 ? -ONE_Q30 : ONE_Q30;
            assert_int_equal(glint_scene_lit_fraction(s, &surface, &s->lit[0]),
                             0);
            surface.place[u] = 4 * UNIT;
            assert_int_equal(glint_scene_lit_fraction(s, &surface, &s->lit[0]),
                             32768);
        }
}

/* Sets the direction of the sun to X, 1, Z, scaled to length 1. */
static void set_sun_direction_upwards(double x, double z)
{
    const double to[3] = {x, 1, z}, length = sqrt(x * x + z * z + 1);

    for (int k = 0; k < 3; k++)
        file.light[0].toward_q30[k] =
            (int32_t)lround(ldexp(to[k] / length, 30));
}

/* Returns the number of samples that see object I. */
static int count_samples_of_object(struct glint_scene *s, uint32_t i)
{
    struct glint_scene_worker *const w = &s->worker[0];
    const int side = 1 << s->cfg.tile_log2;
    int n = 0;

    for (int y = 0; y < HEIGHT; y += side)
        for (int x = 0; x < WIDTH; x += side) {
            const struct glint_box tile = glint_box_intersect(
                (struct glint_box){0, 0, WIDTH, HEIGHT},
                (struct glint_box){x, y, x + side, y + side});

            glint_scene_look(w, tile);
            for (int row = w->touched.y0; row < w->touched.y1; row++)
                for (int k = glint_get_sample_index(w, w->touched.x0, row, 0);
                     k < glint_get_sample_index(w, w->touched.x1, row, 0); k++)
                    n += w->id[k] >> 20 == i;
        }
    return n;
}

/* Checks that three shortcuts do not change images: shadow catchers are shaded
 * only in the box and in the blocks of pixels where shadows may fall, and small
 * balls have a single depth. */
TEST(confined_shading_equals_full_shading)
{
    static uint8_t px[2][BYTES];
    struct glint_image image = {
        .format = GLINT_RGB24, .width = WIDTH, .height = HEIGHT};
    const struct glint_box all = {0, 0, WIDTH, HEIGHT};
    uint32_t seed = 1;
    int less = 0, flat = 0, samples[3] = {0, 0, 0};

    for (int i = 0; i < 40; i++) {
        struct glint_scene *s;

        make_scene_of_all_objects();
        file.object[2].catcher_q15 = 30000;
        file.object[2].hidden = file.object[3].hidden = i % 3 == 0;
        file.header.n_lights = 1;
        for (int k = 0; k < 4; k += k == 1 ? 2 : 1)
            for (int j = 0; j < 3; j++)
                file.object[k].at[j] += rng_int_below(&seed, UNIT) - UNIT / 3;
        /* objects in front of the catcher, under other suns */
        for (int k = 0; i % 2 && k < 4; k += k == 1 ? 2 : 1)
            file.object[k].at[1] += 2 * UNIT;
        /* a ball behind it */
        if (i % 4 == 2) {
            file.object[0].at[1] -= 3 * UNIT;
            file.object[0].at[2] += 3 * UNIT;
        }
        if (i % 2)
            set_sun_direction_upwards(rng_signed(&seed), rng_signed(&seed));
        s = begin_scene();
        for (int k = 0; k < 2; k++) {
            fill_image_with_pattern(px[k], BYTES);
            glint_image_place(&image, px[k]);
            glint_scene_draw(s, &image);
            samples[k] += count_samples_of_object(s, 2);
            less += k == 0 && s->placed[2].box.x1 - s->placed[2].box.x0 < WIDTH;
            flat += k == 0 && s->placed[0].flat_depth > 0;
            s->placed[2].is_only_shadow = 0;
            samples[2] += k == 0 ? count_samples_of_object(s, 2) : 0;
            s->placed[2].box = all;
            s->placed[2].is_seen = !file.object[2].hidden;
            for (int j = 0; j < 4; j++)
                s->placed[j].flat_depth = 0;
        }
        assert_memory_equal(px[0], px[1], BYTES);
    }
    print_message("%d confined, %d flat; samples of catchers: %d in blocks, %d "
                  "in boxes, %d in all\n",
                  less, flat, samples[0], samples[2], samples[1]);
    assert_true(less > 10 && flat > 5);
    assert_true(samples[0] < samples[2] * 9 / 10 && samples[2] < samples[1]);
}

/* ------------------------------------------------------------------ lights */

/* Sets the direction of a sun above the camera's axis to the tangents X and
 * Y. */
static void set_sun_direction(double x, double y)
{
    const double length = sqrt(x * x + y * y + 1);
    const double to[3] = {x / length, y / length, 1 / length};

    for (int k = 0; k < 3; k++)
        file.light[0].toward_q30[k] = (int32_t)lround(ldexp(to[k], 30));
}

/* Checks position and power of the lights that the scene passes to the flare
 * against those seen through a pinhole, in double precision. */
TEST(lights_for_the_lens_match_double_precision)
{
    struct glint_scene_lamp lamp[GLINT_SCENE_MAX_LIGHTS];
    uint32_t seed = 1;

    for (int i = 0; i < 200; i++) {
        const double x = 3 * rng_unit(&seed) - 1.5, y = rng_unit(&seed) - .5;
        const double f = WIDTH / 2., cosine = 1 / sqrt(1 + x * x + y * y);
        double power;

        make_scene_of_all_objects();
        for (int k = 0; k < 4; k++)
            file.object[k].hidden = 1;
        set_sun_direction(x, y);
        file.light[1].at[0] = (int32_t)(x * 8 * UNIT);
        file.light[1].at[1] = (int32_t)(y * 8 * UNIT);
        file.light[1].at[2] = 8 * UNIT;
        assert_int_equal(glint_scene_lights(begin_scene(), lamp), 2);
        power = 3.14159265358979 * f * f / pow(cosine, 3);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(lamp[k].share, 16);
            assert_true(fabs(lamp[k].x_q8 / 256. - WIDTH / 2. - f * x) < .02);
            assert_true(fabs(lamp[k].y_q8 / 256. - HEIGHT / 2. + f * y) < .02);
        }
        assert_true(fabs(glint_real_value(lamp[0].rgb[1]) / power - 1) < 1e-6);
        /* a lamp of power 1 at a distance of 4 units */
        power *= 16 * cosine * cosine / 64;
        assert_true(fabs(glint_real_value(lamp[1].rgb[1]) / power - 1) < 1e-4);
        assert_true(abs(lamp[0].radius_q8 - (int)(256 * f * .05 / cosine)) <=
                    1);
    }
    make_scene_of_all_objects();
    file.header.flare = 0;
    assert_int_equal(glint_scene_lights(begin_scene(), lamp), 0);
}

/* Checks that scene and flare agree on the direction of a light: the flare's
 * pinhole camera must convert the pixel of the light, as the scene reports it,
 * to the direction that the light has in the scene. */
TEST(lens_and_scene_agree_on_directions)
{
    struct model_image image = model_make_three_ghosts();
    const struct glint_lens lens = model_open_image(&image);
    const double f =
        glint_real_value(lens.header->focal_mm) *
        glint_real_value(glint_flare_pixels_per_mm(&lens, WIDTH, HEIGHT));
    struct glint_scene_lamp lamp[GLINT_SCENE_MAX_LIGHTS];
    uint32_t seed = 1;

    cfg.focal_q16 = llround(ldexp(f, 16));
    for (int i = 0; i < 300; i++) {
        const double x = .7 * rng_unit(&seed) - .35, y = rng_unit(&seed) - .5;
        struct glint_light light;
        double tangent;

        make_scene_of_all_objects();
        file.header.camera.kind = GLINT_CAMERA_LENS;
        file.header.camera.tan_x_q24 = 0;
        file.header.n_lights = 1;
        for (int k = 0; k < 4; k++)
            file.object[k].hidden = 1;
        set_sun_direction(x, y);
        assert_int_equal(glint_scene_lights(begin_scene(), lamp), 1);
        light = glint_light_from_pixel(&lens, WIDTH, HEIGHT, lamp[0].x_q8,
                                       lamp[0].y_q8);
        tangent = (double)light.sine_q30 / light.cosine_q30;
        assert_true(fabs(f * (tangent * light.cos_q30 / ONE_Q30 - x)) < .01);
        assert_true(fabs(f * (tangent * light.sin_q30 / ONE_Q30 - y)) < .01);
    }
}

/* Checks that the visible fraction of a sun falls to 0 in several steps while
 * the sun sets behind a ball. */
TEST(setting_sun_is_occluded_gradually)
{
    struct glint_scene_lamp lamp[GLINT_SCENE_MAX_LIGHTS];
    int last = 16, levels = 0;

    file.header.n_lights = 1;
    for (int k = 1; k < 4; k++)
        file.object[k].hidden = 1;
    for (int i = 0; i <= 60; i++) {
        int share;

        set_sun_direction(-2 / 7. + .3 - i * .005, 0);
        assert_int_equal(glint_scene_lights(begin_scene(), lamp), 1);
        share = lamp[0].share;
        assert_true(share <= last);
        levels += share < last;
        last = share;
    }
    assert_true(last == 0 && levels >= 6);
}

TEST(lamps_are_dimmed_by_coverage)
{
    static uint8_t px[BYTES];
    struct glint_image image = glint_image_over(px, GLINT_RGB24, WIDTH, HEIGHT);
    struct glint_scene *s;

    file.object[2].hidden = 1;
    s = begin_scene();
    glint_scene_draw(s, &image);
    /* The first position is in the middle of the mesh, the second one in a
     * corner of the image. */
    assert_int_equal(glint_scene_cover(s, 128 * WIDTH, 128 * HEIGHT, 256), 256);
    assert_int_equal(glint_scene_cover(s, 256, 256, 2000), 0);
    assert_int_equal(glint_scene_cover(s, -99999, 256, 2000), 0);
    assert_in_range(glint_scene_cover(s, 128 * WIDTH, 128 * HEIGHT, 256 * 60),
                    20, 90);
}

static int64_t sum_scene_coverage(const struct glint_image *image)
{
    struct glint_scene *s = begin_scene();
    int64_t sum = 0;

    memset(image->plane[0], 128, WIDTH * HEIGHT * 3);
    glint_scene_draw(s, image);
    for (int i = 0; i < s->cover_across * s->cover_down; i++)
        sum += s->cover[i];
    return sum;
}

/* Checks that a shadow on a shadow catcher darkens the image but does not hide
 * lamps. */
TEST(shadows_hide_no_lamps)
{
    static uint8_t px[BYTES], alone[BYTES];
    struct glint_image image = glint_image_over(px, GLINT_RGB24, WIDTH, HEIGHT);
    int64_t cover;
    int n_dark = 0;

    file.header.n_lights = 1;
    set_sun_direction(0, 20);
    file.object[1].hidden = file.object[2].hidden = file.object[3].hidden = 1;
    file.object[2].catcher_q15 = 32768;
    cover = sum_scene_coverage(&image);
    memcpy(alone, px, sizeof alone);
    file.object[2].hidden = 0;
    assert_true(cover > 0);
    assert_int_equal(sum_scene_coverage(&image), cover);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        n_dark += px[i] < alone[i];
    assert_true(n_dark > 100);
}

/* Checks that a shadow catcher, which has no material, does not depend on the
 * material at index 0: neither in the image nor in the number of shaded
 * points. */
TEST(catcher_has_no_material)
{
    static uint8_t px[2][BYTES];
    int64_t shaded[2];

    file.object[2].catcher_q15 = 32768;
    for (int k = 0; k < 2; k++) {
        static struct glint_scene_part objects[SCENE_PARTS], all;

        file.object[2].material = k ? 1 : 0;
        draw_scene(cfg, GLINT_RGB24, 1, 1, px[k]);
        glint_scene_account(scene_init_renderer(&file, &cfg, NULL), objects,
                            &all, NULL);
        shaded[k] = objects[2].count[GLINT_SCENE_SHADED];
    }
    assert_true(shaded[0] > 100);
    assert_int_equal(shaded[0], shaded[1]);
    assert_memory_equal(px[0], px[1], BYTES);
}
