/* SPDX-License-Identifier: MIT
 *
 * Tests the shading of surfaces: examples A6 to A13 of the tutorial are
 * compared with results computed by hand or in double precision.
 */
#include "scene/state.h"
#include "support/canvas.h"
#include "support/models/scene_builder.h"
#include "support/rng.h"
#include "support/test.h"

static struct glint_met met;

enum { UNIT = 1 << 16, ONE_Q30 = 1 << 30, SIDE = 64 };

static struct scene_file file;

static struct glint_scene *start_renderer(int shadow_points)
{
    struct glint_scene_config cfg;

    glint_scene_defaults(&cfg, SIDE, SIDE);
    cfg.shadow_points = shadow_points;
    cfg.parts = scene_parts;
    return scene_init_renderer(&file, &cfg, NULL);
}

static struct glint_scene_ray make_ray(double x, double y, double z, double dx,
                                       double dy, double dz)
{
    const double at[3] = {x, y, z}, d[3] = {dx, dy, dz};
    const double length = sqrt(dx * dx + dy * dy + dz * dz);
    struct glint_scene_ray ray;

    for (int k = 0; k < 3; k++) {
        ray.at[k] = (int32_t)lround(at[k] * UNIT);
        ray.toward_q30[k] = (int32_t)lround(ldexp(d[k] / length, 30));
    }
    return ray;
}

static int intersect_and_shade_ray(const struct glint_scene *s,
                                   const struct glint_scene_ray *ray,
                                   struct glint_met_shade *to)
{
    struct glint_met_surface surface;

    if (!glint_scene_find_nearest_hit(s, ray, GLINT_NOTHING, 0, &met) ||
        !glint_scene_find_surface_at_hit(s, ray, &met, &surface))
        return 0;
    glint_scene_shade_surface(s, ray, &surface, to);
    return 1;
}

static int32_t shade_ray_red_q15(const struct glint_scene *s,
                                 struct glint_scene_ray ray)
{
    struct glint_met_shade to;

    assert_true(intersect_and_shade_ray(s, &ray, &to));
    return to.rgb_q15[0];
}

/* --------------------------------------------------- nearest object (A5) */

/* Checks three triangles, one behind the other, in any order: the nearest must
 * be visible. A triangle that the ray misses must never be the nearest. */
TEST(a5_nearest_triangle_is_visible)
{
    static const int at[4][9] = {
        {0, 30, 40, 40, -30, 120, -40, -30, 120},
        {-50, 30, 124, 50, 30, 124, 0, -30, 44},
        {-30, 0, 37, 30, 40, 117, 30, -40, 117}, /* blue triangle */
        {10, 10, 20, 20, 10, 20, 10, 20, 20}};   /* off the ray */
    static const uint32_t t[1][3] = {{0, 1, 2}};
    const struct glint_scene_ray ahead = make_ray(0, 0, 0, 0, 0, 1);

    for (int first = 0; first < 4; first++) {
        struct glint_scene *s;

        scene_begin_header(&file);
        scene_add_material(&file, "m");
        for (int i = 0; i < 4; i++) {
            int32_t v[3][3];

            for (int k = 0; k < 9; k++)
                v[k / 3][k % 3] = at[(first + i) % 4][k] * UNIT;
            scene_add_object(&file, (const char[2]){(char)('a' + i), 0}, 0,
                             scene_add_mesh(&file, (const int32_t(*)[3])v, NULL,
                                            NULL, 3, t, 1));
        }
        s = start_renderer(1);
        assert_true(
            glint_scene_find_nearest_hit(s, &ahead, GLINT_NOTHING, 0, &met));
        assert_int_equal(met.object, (6 - first) % 4);
        assert_in_range(met.t, 77 * UNIT - 1, 77 * UNIT + 1);
    }
}

/* ------------------------------------------------------ camera rays (A6) */

TEST(a6_corner_rays)
{
    const struct glint_scene_camera camera = {
        .kind = GLINT_CAMERA_CORNERS,
        .axis_q30 = {{ONE_Q30}, {0, ONE_Q30}, {0, 0, ONE_Q30}},
        .tan_x_q24 = (int32_t)lround(.8 * (1 << 24)),
        .tan_y_q24 = (int32_t)lround(.45 * (1 << 24))};
    struct glint_scene_view view;

    assert_true(glint_view_init(&view, &camera, 640, 360, 0));
    for (int x = 0; x < 640; x += 71)
        for (int y = 0; y < 360; y += 359) {
            const double expected[2] = {16. * x / 639 - 8, 4.5 - 9. * y / 359};
            struct glint_scene_ray ray;
            int32_t seen_q30[3];

            glint_view_set_ray(&view, 256 * x - 128 * 639, 256 * y - 128 * 359,
                               &ray, seen_q30);
            for (int k = 0; k < 2; k++)
                assert_true(fabs(10. * ray.toward_q30[k] / ray.toward_q30[2] -
                                 expected[k]) <= 0x1p-16);
        }
}

/* Checks that a point is projected to the pixel whose ray passes through it. */
TEST(projection_inverts_pixel_rays)
{
    uint32_t seed = 3;

    scene_begin_header(&file);
    for (int i = 0; i < 20000; i++) {
        const int x_q8 = rng_int_below(&seed, 1 << 16) - (1 << 15);
        const int y_q8 = rng_int_below(&seed, 1 << 16) - (1 << 15);
        struct glint_scene_ray ray;
        struct glint_corner c;
        struct glint_scene_view view;
        int32_t place[3], seen[3], seen_q30[3];

        file.header.camera.at[0] = rng_int_below(&seed, 100000);
        file.header.camera.tan_x_q24 =
            (1 << 12) + rng_int_below(&seed, 1 << 24);
        assert_true(glint_view_init(&view, &file.header.camera, 256, 256, 0));
        glint_view_set_ray(&view, x_q8, y_q8, &ray, seen_q30);
        assert_true(glint_ray_point_at_distance(&ray, (1 << 26), place));
        glint_view_convert_to_camera(&view, place, seen);
        c = glint_view_project_vertex(&view, seen);
        assert_int_equal(c.w, 1);
        /* one step is 2^-26 of the distance */
        assert_true(abs(c.x - x_q8) <= 2 + 32768. * 0x1p-26 * 0x1p24 * 2 /
                                               file.header.camera.tan_x_q24);
        assert_true(abs(c.y - y_q8) <= 2 + 32768. * 0x1p-26 * 0x1p24 * 2 /
                                               file.header.camera.tan_x_q24);
    }
}

/* ----------------------------------- diffuse and specular light (A7, A8) */

TEST(a7_diffuse_light_of_a_lamp)
{
    const int32_t lamp[3] = {0, 40 * UNIT, 0};
    struct glint_scene *s;
    struct glint_met_shade to;
    const struct glint_scene_ray down = make_ray(0, 10, 30, 0, -1, 0);

    scene_begin_header(&file);
    scene_add_plane(&file, "floor", scene_add_material(&file, "red"), 0);
    file.material[0].rgb_q15[1] = file.material[0].rgb_q15[2] = 0;
    scene_add_lamp(&file, lamp,
                   /* distance at which the irradiance of the lamp is 1 */
                   50 * UNIT);
    s = start_renderer(1);
    assert_true(intersect_and_shade_ray(s, &down, &to));
    assert_int_equal(to.cover_q8, 256);
    assert_in_range(to.rgb_q15[0], 26212, 26216); /* 204 of 255 */
    assert_true(to.rgb_q15[1] == 0 && to.rgb_q15[2] == 0);
}

TEST(phong_power_matches_double_precision)
{
    double worst = 0;

    for (int32_t k_q8 = 256; k_q8 <= 1 << 20; k_q8 += k_q8 / 7 + 1)
        for (int i = 0; i < 20000; i++) {
            const int32_t x_q30 =
                i < 10000 ? ONE_Q30 - i * (1 << 12) : (i - 9999) * 107000;
            const double exact = pow(ldexp(x_q30, -30), k_q8 / 256.);

            worst =
                fmax(worst, fabs(glint_compute_power_q15(x_q30, k_q8) / 32768. -
                                 exact));
        }
    print_message("powers are off by 1 / %.0f at most\n", 1 / worst);
    assert_true(worst < 1. / 512);
    assert_int_equal(glint_compute_power_q15(ONE_Q30, 1 << 20), 32768);
    assert_int_equal(glint_compute_power_q15(0, 256), 0);
    assert_int_equal(glint_compute_power_q15(-5, 256), 0);
}

/* Compares many points of a ball under a sun with Phong's formula in double
 * precision. */
TEST(a8_phong_matches_double_precision)
{
    const int32_t sun[3] = {ONE_Q30 / 5 * 3, ONE_Q30 / 5 * 4, 0};
    struct glint_scene *s;
    uint32_t seed = 1;

    scene_begin_header(&file);
    scene_add_sphere(&file, "ball", scene_add_material(&file, "m"), 0, 0,
                     10 * UNIT, 2 * UNIT);
    file.material[0].ambient_q15 = 3277;
    file.material[0].diffuse_q15 = 19661;
    file.material[0].specular_q15 = 9830;
    file.material[0].rgb_q15[0] = 16384;
    scene_add_sun(&file, sun);
    s = start_renderer(1);
    for (int i = 0; i < 20000; i++) {
        const double a = 6.2831853 * rng_unit(&seed);
        const double r = 1.99 * sqrt(rng_unit(&seed));
        const double n[3] = {r * cos(a) / 2, r * sin(a) / 2,
                             -sqrt(1 - r * r / 4)};
        const double cosine = .6 * n[0] + .8 * n[1];
        /* the camera looks along z */
        const double gloss = fmax(0, 0 - (2 * cosine * n[2]));
        double expected = .1 * .5;

        if (cosine > 0)
            expected += .6 * .5 * cosine + .3 * pow(gloss, 32);
        assert_true(fabs(shade_ray_red_q15(
                             s, make_ray(2 * n[0], 2 * n[1], 0, 0, 0, 1)) /
                             32768. -
                         expected) < 2e-3);
    }
}

/* ----------------------------------------------------------- shadows (A10) */

/* Returns the light on a floor below a lamp at height 4. Unless HIDDEN is set,
 * a ball of radius 1 has its centre at height H below or above the lamp. */
static int32_t measure_light_under_ball(double h, int hidden)
{
    const int32_t lamp[3] = {0, 4 * UNIT, 10 * UNIT};

    scene_begin_header(&file);
    file.header.shadow = 1;
    scene_add_material(&file, "m");
    scene_add_plane(&file, "floor", 0, 0);
    scene_add_sphere(&file, "ball", 0, 0, (int32_t)(h * UNIT), 10 * UNIT, UNIT);
    file.object[1].hidden = (uint32_t)hidden;
    scene_add_lamp(&file, lamp, 4 * UNIT);
    return shade_ray_red_q15(start_renderer(1),
                             make_ray(2, .5, 10, -2, -.5, 0));
}

TEST(a10_ball_shadows_a_floor)
{
    const int32_t lit = measure_light_under_ball(2, 1);

    assert_in_range(lit, 32760, 32768);
    assert_int_equal(measure_light_under_ball(2, 0),
                     0); /* the ball is between lamp and floor */
    assert_int_equal(measure_light_under_ball(5.01, 0),
                     lit); /* above the lamp */
    assert_int_equal(measure_light_under_ball(4.99, 0),
                     0); /* the ball just touches the lamp */
    assert_int_equal(measure_light_under_ball(6, 0), lit);
    assert_int_equal(measure_light_under_ball(-1.01, 0),
                     lit); /* below the floor */
}

/* Checks that surfaces that no object occludes have the same light with and
 * without shadows, bit by bit. */
TEST(a10_open_surfaces_have_no_shadow_acne)
{
    static const int32_t at[4][3] = {{-90000, -70000, 600000},
                                     {80000, -60000, 610000},
                                     {0, 90000, 640000},
                                     {10000, 20000, 560003}};
    static const uint32_t t[4][3] = {
        {0, 2, 1}, {0, 3, 2}, {3, 1, 2}, {0, 1, 3}};
    const int32_t sun[3] = {ONE_Q30 / 5 * 3, ONE_Q30 / 5 * 4, 0};
    struct glint_scene *s = NULL;
    uint32_t seed = 1;
    int n = 0;

    for (int kind = 0; kind < 3; kind++)
        for (int i = 0; i < 3000; i++) {
            struct glint_scene_ray ray;
            struct glint_met_shade to[2];

            if (i == 0) {
                scene_begin_header(&file);
                scene_add_material(&file, "m");
                scene_add_sun(&file, sun);
                if (kind == 0)
                    scene_add_sphere(&file, "a", 0, 5000, -300, 9 * UNIT,
                                     90000);
                else if (kind == 1)
                    scene_add_plane(&file, "a", 0, -3 * UNIT);
                else
                    scene_add_object(
                        &file, "a", 0,
                        scene_add_mesh(&file, at, NULL, NULL, 4, t, 4));
                file.header.shadow = 1;
                s = start_renderer(1);
            }
            ray = make_ray(0, 0, 0, rng_unit(&seed) * .3 - .15,
                           rng_unit(&seed) * .3 - .15 - .25 * (kind == 1), 1);
            file.header.shadow = 0;
            memcpy(file.data, &file.header, sizeof file.header);
            if (!intersect_and_shade_ray(s, &ray, &to[0]))
                continue;
            file.header.shadow = 1;
            memcpy(file.data, &file.header, sizeof file.header);
            intersect_and_shade_ray(s, &ray, &to[1]);
            assert_memory_equal(&to[0], &to[1], sizeof *to);
            n += to[0].rgb_q15[0] > 0;
        }
    assert_true(n > 3000);
}

/* Checks that across the penumbra of a wide light source the light falls
 * monotonically from full to none. */
TEST(a10_penumbra_is_monotone)
{
    const int32_t up[3] = {0, ONE_Q30, 0};
    int32_t last = 0, levels = 0;
    struct glint_scene *s;

    scene_begin_header(&file);
    file.header.shadow = 1;
    scene_add_material(&file, "m");
    scene_add_plane(&file, "floor", 0, 0);
    scene_add_sphere(&file, "ball", 0, 0, 5 * UNIT, 10 * UNIT, UNIT);
    scene_add_sun(&file, up);
    file.light[0].radius = ONE_Q30 / 10;
    s = start_renderer(16);
    for (int i = 0; i <= 40; i++) {
        const int32_t light =
            shade_ray_red_q15(s, make_ray(i * .05, .2, 10, 0, -1, 0));

        assert_true(light >= last);
        levels += light > last;
        last = light;
    }
    assert_true(levels > 8);
    assert_in_range(last, 32767, 32768);
    assert_int_equal(shade_ray_red_q15(s, make_ray(.1, .2, 10, 0, -1, 0)), 0);
}

/* Checks that the light behind objects is multiplied by the fractions that they
 * let through in shadows: none, a part or all. */
TEST(objects_let_a_fraction_of_light_through)
{
    static const struct {
        int32_t unblocked_q15[2], light_q15;
    } row[] = {{{0, 32768}, 0},
               {{8192, 32768}, 8192},
               {{8192, 16384}, 4096},
               {{32768, 32768}, 32768}};
    const int32_t up[3] = {0, ONE_Q30, 0}, lamp[3] = {0, 20 * UNIT, 10 * UNIT};

    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int points = 1; points <= 16; points *= 4)
            for (int is_sun = 0; is_sun < 2; is_sun++) {
                struct glint_scene *s;

                scene_begin_header(&file);
                file.header.shadow = 1;
                scene_add_material(&file, "m");
                scene_add_plane(&file, "floor", 0, 0);
                for (int k = 0; k < 2; k++) {
                    scene_add_sphere(&file, "ball", 0, 0, (4 + 4 * k) * UNIT,
                                     10 * UNIT, UNIT);
                    file.object[1 + k].unblocked_q15 = row[i].unblocked_q15[k];
                }
                if (is_sun)
                    scene_add_sun(&file, up);
                else
                    scene_add_lamp(&file, lamp, 20 * UNIT);
                file.light[0].radius = is_sun ? ONE_Q30 / 100 : UNIT / 10;
                s = start_renderer(points);
                assert_int_equal(s->lit[0].shadow != NULL, 0);
                assert_in_range(
                    shade_ray_red_q15(s, make_ray(0, .2, 10, 0, -1, 0)) + 4,
                    row[i].light_q15, row[i].light_q15 + 8);
            }
}

/* ---------------------------------- transparency and refraction (A11, A12) */

static void make_transparent(struct glint_scene_material *m)
{
    m->diffuse_q15 = 0;
    m->pass_q15 = 32768;
}

/* Checks that a fully transparent ball hides neither a ball behind it, nor a
 * ball inside it, nor the image. */
TEST(a11_transparent_ball_occludes_nothing)
{
    const int32_t up[3] = {0, ONE_Q30, 0};
    struct glint_scene *s;
    uint32_t seed = 1;
    int behind = 0, within = 0, rim = 0;

    scene_begin_header(&file);
    scene_add_material(&file, "m");
    make_transparent(&file.material[scene_add_material(&file, "clear")]);
    scene_add_sphere(&file, "far", 0, UNIT / 2, UNIT / 3, 20 * UNIT, 3 * UNIT);
    scene_add_sphere(&file, "near", 1, 0, 0, 10 * UNIT, 2 * UNIT);
    scene_add_sphere(&file, "inside", 0, UNIT / 4, -UNIT / 4, 10 * UNIT,
                     UNIT / 2);
    scene_add_sun(&file, up);
    s = start_renderer(1);
    for (int i = 0; i < 20000; i++) {
        struct glint_scene_ray ray =
            make_ray(0, 0, i % 2 ? 9 : 0, rng_unit(&seed) * .4 - .2,
                     rng_unit(&seed) * .4 - .2, 1);
        struct glint_met_shade with, without;
        struct glint_chord chord;
        int is;

        if (!glint_ray_intersect_sphere(&ray, s->placed[1].at, 2 * UNIT,
                                        &chord))
            continue;
        within++;
        assert_true(intersect_and_shade_ray(s, &ray, &with));
        glint_scene_show(s, 1, 0);
        is = intersect_and_shade_ray(s, &ray, &without);
        glint_scene_show(s, 1, 1);
        behind += is;
        if ((with.cover_q8 != 0) != is) {
            rim++;
        } else if (is) {
            assert_int_equal(with.cover_q8, 256);
            assert_true(abs(with.rgb_q15[1] - without.rgb_q15[1]) < 16);
        } else {
            assert_int_equal(with.rgb_q15[1], 0);
        }
    }
    /* the point where the ray leaves the ball is rounded to a step */
    assert_true(rim <= 2);
    assert_true(behind > 3000 && within > behind + 3000);
}

/* A simpler method for the second hit of a ball, which fails: it computes in
 * floats the point where a ray enters the ball of RADIUS. Returns whether this
 * point seems to be outside the ball, with a squared distance from the centre
 * above the squared radius by more than MORE. The right answer is false. */
static int is_second_hit_outside(const double middle[3], double radius,
                                 const double d[3], double more)
{
    const double along = middle[0] * d[0] + middle[1] * d[1] + middle[2] * d[2];
    const double square = middle[0] * middle[0] + middle[1] * middle[1] +
                          middle[2] * middle[2] - along * along;
    const double t = along - sqrt(radius * radius - square);
    float l2 = 0;

    for (int k = 0; k < 3; k++) {
        const float place = (float)t * (float)d[k];
        const float l = (float)middle[k] - place;

        l2 += l * l;
    }
    return l2 > (float)(radius * radius + more);
}

/* Checks that each ray through a ball of half transmittance enters and leaves
 * it exactly once. With is_second_hit_outside() instead, rays would hit the
 * ball again at the entry point. */
TEST(a11_ray_leaves_a_ball_once)
{
    enum { RAYS = 100000 };
    int n = 0, outside = 0, farther = 0;
    uint32_t seed = 1;

    while (n < RAYS) {
        const double middle[3] = {20 * rng_unit(&seed) - 10,
                                  20 * rng_unit(&seed) - 10,
                                  100 + 100 * rng_unit(&seed)};
        const double radius = 30;
        struct glint_scene *s;

        scene_begin_header(&file);
        scene_add_material(&file, "half");
        file.material[0].diffuse_q15 = 0;
        file.material[0].pass_q15 = 16384;
        scene_add_sphere(&file, "ball", 0, (int32_t)(middle[0] * UNIT),
                         (int32_t)(middle[1] * UNIT),
                         (int32_t)(middle[2] * UNIT), (int32_t)(radius * UNIT));
        s = start_renderer(1);
        for (int i = 0; i < 1000; i++) {
            const double x = middle[0] / middle[2] + .4 * rng_unit(&seed) - .2;
            const double y = middle[1] / middle[2] + .4 * rng_unit(&seed) - .2;
            const double length = sqrt(x * x + y * y + 1);
            const double d[3] = {x / length, y / length, 1 / length};
            const struct glint_scene_ray ray = make_ray(0, 0, 0, x, y, 1);
            struct glint_met_shade to;

            if (!intersect_and_shade_ray(s, &ray, &to))
                continue;
            assert_int_equal(to.cover_q8, 128);
            outside += is_second_hit_outside(middle, radius, d, 0);
            farther += is_second_hit_outside(middle, radius, d, .001);
            n++;
        }
    }
    print_message("l2 > r2 is wrong for %.1f %%, + .001 for %.1f %%\n",
                  100. * outside / n, 100. * farther / n);
    assert_true(outside > .3 * n && outside < .7 * n);
    assert_true(farther > 0);
}

enum { GLASS_RADIUS = 2, GLASS_AT = 10, WALL_AT = 30 };

/* A ball of refractive index OUTER with a ball of index INNER and radius RADIUS
 * in its middle; the max error of the texture's code behind them, and the least
 * number of rays of 3000 that show it. Inside each other, .25 and 4 magnify the
 * rounding of the place at which a ray meets the inner ball. */
static const struct balls {
    double outer, inner, radius, tolerance;
    int least;
} glass[] = {{1.5, 1.5, .5, 1.6, 2500},
             {1.5, 1.25, 1, 1.6, 2500},
             {1.5, 1, .6, 1.6, 1500},
             {4, .25, 1, 3, 300}};

/* Computes in double precision the path of a ray in the plane y = 0, from the
 * origin along (DX, 0, 1), through the balls B. Returns the x at which the ray
 * meets the wall, and sets HEADING to its angle from the z axis there; to
 * HUGE_VAL if it grazes the inner ball.
 *
 * With q the ray's distance from the middle, its angle to the normal at radius
 * r in a medium of index n has the sine q / (n r). */
static double trace_exact_path(double dx, const struct balls *b,
                               double *heading)
{
    const double outer = b->outer, radius = b->radius;
    const double angle = atan(dx), q = GLASS_AT * sin(angle);
    const double t =
        GLASS_AT * cos(angle) - sqrt(GLASS_RADIUS * GLASS_RADIUS - q * q);
    const double in = asin(q / GLASS_RADIUS),
                 out = asin(q / outer / GLASS_RADIUS);
    double round = 3.14159265358979 - 2 * out, turn = 2 * (in - out);

    if (fabs(q / outer) < radius) {
        const double before = asin(q / outer / radius);
        const double sine = q / b->inner / radius;

        round = 2 * (before - out);
        if (fabs(sine) < 1) {
            round += 3.14159265358979 - 2 * asin(sine);
            turn += 2 * (before - asin(sine));
        } else { /* total reflection */
            turn -= copysign(3.14159265358979, q) - 2 * before;
        }
    }
    round += atan2(t * sin(angle), GLASS_AT - t * cos(angle));
    *heading =
        fabs(fabs(q / outer) - radius) < .02 * radius ? HUGE_VAL : angle - turn;
    return GLASS_RADIUS * sin(round) +
           (WALL_AT - GLASS_AT + GLASS_RADIUS * cos(round)) * tan(angle - turn);
}

/* Checks that a glass ball, and a ball inside it, refract rays as computed in
 * double precision, by the texture coordinate that is visible behind them. */
TEST(a12_glass_balls_refract)
{
    uint8_t rgb[3 * 256];
    struct glint_scene *s;
    uint32_t seed = 1;

    for (int i = 0; i < 256; i++)
        rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = (uint8_t)i;
    scene_begin_header(&file);
    /* in this field of view pixels are smaller than texels */
    file.header.camera.tan_x_q24 = 1 << 12;
    scene_add_material(&file, "m");
    file.material[0].ambient_q15 = 32768;
    file.material[0].diffuse_q15 = 0;
    file.material[0].texture = scene_add_texture(&file, rgb, 8, 0);
    make_transparent(&file.material[scene_add_material(&file, "glass")]);
    make_transparent(&file.material[scene_add_material(&file, "inner")]);
    /* a wall behind the ball: the floor rotated by 90 degrees about x; its
     * texture repeats once per unit */
    scene_add_plane(&file, "wall", 0, 0);
    file.object[0].at[2] = WALL_AT * UNIT;
    file.object[0].turn_q30[0] = 759250125;
    file.object[0].turn_q30[1] = -759250125;
    scene_add_sphere(&file, "ball", 1, 0, 0, GLASS_AT * UNIT,
                     GLASS_RADIUS * UNIT);
    scene_add_sphere(&file, "inner", 2, 0, 0, GLASS_AT * UNIT, UNIT);
    for (size_t k = 0; k < sizeof glass / sizeof *glass; k++) {
        const struct balls *b = &glass[k];
        int n = 0;

        file.material[1].index_q16 = (int32_t)(65536 * b->outer);
        file.material[2].index_q16 = (int32_t)(65536 * b->inner);
        file.object[2].radius = (int32_t)(UNIT * b->radius);
        s = start_renderer(1);
        for (int i = 0; i < 3000; i++) {
            const double dx = rng_unit(&seed) * .2 - .1;
            double heading, u, code;
            struct glint_scene_ray ray = make_ray(0, 0, 0, dx, 0, 1);
            struct glint_met_shade to;

            u = trace_exact_path(dx, b, &heading);
            u -= floor(u);
            if (u < .02 || u > .98 || fabs(heading) > .8)
                continue;
            assert_true(intersect_and_shade_ray(s, &ray, &to));
            code = canvas_encode_srgb_exactly(to.rgb_q15[0] / 32768.);
            assert_true(fabs(code - (256 * u - .5)) < b->tolerance);
            n++;
        }
        print_message("index %g in %g: %d rays\n", b->inner, b->outer, n);
        assert_true(n > b->least);
    }
}

/* Checks that rays inside a ball of refractive index 1.5 that hit its surface
 * above the critical angle of 41.8 degrees are totally reflected, so that
 * nothing is visible. */
TEST(a12_total_reflection_inside_a_ball)
{
    const int32_t up[3] = {0, ONE_Q30, 0};
    struct glint_scene *s;
    int dark = 0;

    scene_begin_header(&file);
    file.header.background = GLINT_BACKGROUND_COLOUR;
    file.header.background_q15[0] = 8192;
    make_transparent(&file.material[scene_add_material(&file, "glass")]);
    file.material[0].index_q16 = 3 << 15;
    scene_add_sphere(&file, "ball", 0, 0, 0, 0, 2 * UNIT);
    scene_add_sun(&file, up);
    s = start_renderer(1);
    for (int i = 0; i <= 100; i++) {
        /* the angle of incidence of this ray has the sine x / 2 */
        const double x = 2 * i / 101.;
        const int32_t red = shade_ray_red_q15(s, make_ray(x, 0, 0, 0, 0, 1));

        if (fabs(x / 2 - 1 / 1.5) > .001)
            assert_int_equal(red, x / 2 < 1 / 1.5 ? 8192 : 0);
        dark += red == 0;
    }
    assert_in_range(dark, 33, 34);
}

/* ---------------------------------------------------------- textures (A13) */

TEST(a13_texture_coordinates)
{
    static const int32_t at[3][3] = {{-300000, -200000, 900000},
                                     {400000, -100000, 1200000},
                                     {0, 350000, 1000000}};
    static const int32_t uv_q16[3][2] = {
        {0, 0}, {65536, 6554}, {13107, 3 * 65536}};
    static const uint32_t t[1][3] = {{0, 2, 1}};
    const uint8_t rgb[12] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
    struct glint_scene *s;
    uint32_t seed = 1;

    scene_begin_header(&file);
    scene_add_material(&file, "m");
    file.material[0].ambient_q15 = 32768;
    file.material[0].diffuse_q15 = 0;
    file.material[0].texture = scene_add_texture(&file, rgb, 1, 1);
    scene_add_object(&file, "a", 0,
                     scene_add_mesh(&file, at, uv_q16, NULL, 3, t, 1));
    s = start_renderer(1);
    for (int i = 0; i < 20000; i++) {
        double w[3] = {1, 0, 0}, place[3] = {0}, uv[2] = {0};
        struct glint_met_surface surface;
        struct glint_scene_ray ray;
        struct glint_met_shade to;

        if (i >= 3) {
            w[1] = rng_unit(&seed);
            w[2] = rng_unit(&seed) * (1 - w[1]);
        } else
            w[i] = 1;
        w[0] = 1 - w[1] - w[2];
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) {
                place[k] += w[j] * at[j][k] / UNIT;
                if (k < 2)
                    uv[k] += w[j] * uv_q16[j][k];
            }
        ray = make_ray(0, 0, 0, place[0], place[1], place[2]);
        assert_true(glint_scene_ray_hits_id(s, &ray, ray.toward_q30, 0, &met) &&
                    glint_scene_find_surface_at_hit(s, &ray, &met, &surface));
        /* half a texel; 1/256 texel is 128 in Q15 */
        for (int k = 0; k < 2; k++)
            assert_true(fabs(surface.uv_q16[k] - uv[k]) < (i < 3 ? 8 : 16));
        glint_scene_shade_surface(s, &ray, &surface, &to);
        for (int c = 0; c < 3; c++) {
            const double u = 2 * uv[0] / 65536 - .5, v = 2 * uv[1] / 65536 - .5;
            const double fu = u - floor(u), fv = v - floor(v);
            const int iu = (int)floor(u) & 1, iv = (int)floor(v) & 1;
            double sum = 0;

            for (int j = 0; j < 4; j++)
                sum +=
                    (j & 1 ? fu : 1 - fu) * (j & 2 ? fv : 1 - fv) *
                    (rgb[3 * (((j >> 1) ^ iv) * 2 + ((j & 1) ^ iu)) + c] > 0);
            assert_true(fabs(to.rgb_q15[c] / 32768. - sum) < 2e-3);
        }
    }
}

TEST(a13_distant_texture_has_its_mean)
{
    uint8_t rgb[3 * 64 * 64];
    int32_t lowest = 32768, highest = 0;
    struct glint_scene *s;
    uint32_t seed = 1;

    for (int i = 0; i < 64 * 64; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = (uint8_t)(((i ^ i >> 6) & 1) * 255);
    scene_begin_header(&file);
    scene_add_material(&file, "m");
    file.material[0].ambient_q15 = 32768;
    file.material[0].diffuse_q15 = 0;
    file.material[0].texture = scene_add_texture(&file, rgb, 6, 6);
    scene_add_plane(&file, "floor", 0, -UNIT);
    s = start_renderer(1);
    for (int i = 0; i < 2000; i++) {
        const double x = rng_unit(&seed) - .5;
        const int32_t near =
            shade_ray_red_q15(s, make_ray(x / 9, -.99, 0, x, -1, .1));
        const int32_t far = shade_ray_red_q15(s, make_ray(x, 0, 0, x, -.02, 1));

        assert_true(near >= 0 && near <= 32768);
        assert_in_range(far, 6900, 7200); /* the linear light of code 127.5 */
    }
    /* The camera looks down vertically. At height 1, a pixel is as wide as 1/32
     * of the height and covers two texels; at height 1/4, it covers half a
     * texel. */
    for (int i = 0; i < 500; i++) {
        const double x = rng_unit(&seed), z = rng_unit(&seed);
        const int32_t close =
            shade_ray_red_q15(s, make_ray(x, -.75, z, 0, -1, 0));

        assert_in_range(shade_ray_red_q15(s, make_ray(x, .001, z, 0, -1, 0)),
                        6900, 7200);
        lowest = close < lowest ? close : lowest;
        highest = close > highest ? close : highest;
    }
    assert_true(lowest < 2000 && highest > 30000);
}
