/* SPDX-License-Identifier: MIT
 *
 * Tests the reference renderer of scenes against values computed by hand. A1 to
 * A15 number the requirements, which the tests state.
 */
#include "reference/scenes/twin.h"
#include "reference/scenes/vec.h"
#include "support/rng.h"
#include "support/test.h"

static struct twin_hit hit;

struct stage {
    struct glint_description scene;
    struct twin twin;
};

/* Returns a picture of two texels: black on the left, white on the right. */
static enum glint_status make_two_texel_picture(void *ctx, const char *name,
                                                struct glint_image *image,
                                                struct glint_error *error)
{
    uint8_t *mem = calloc(1, 6);

    (void)ctx;
    (void)name;
    (void)error;
    assert_non_null(mem);
    memset(mem + 3, 255, 3);
    *image = glint_image_over(mem, GLINT_RGB24, 2, 1);
    return GLINT_OK;
}

/* Parses TEXT and opens the reference renderer for its scene. */
static struct stage *open_reference_for_text(const char *text)
{
    const struct glint_description_files files = {
        NULL, NULL, make_two_texel_picture, NULL, NULL, NULL};
    struct stage *stage = malloc(sizeof *stage);
    struct glint_error error = {""};

    assert_non_null(stage);
    if (glint_description_parse(&stage->scene, text, strlen(text), "t.scene",
                                &files, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    assert_ok(reference_open(&stage->twin, &stage->scene));
    return stage;
}

static void close_reference(struct stage *stage)
{
    reference_close(&stage->twin);
    glint_description_free(&stage->scene);
    free(stage);
}

static struct twin_ray make_ray(double x, double y, double z, double dx,
                                double dy, double dz)
{
    struct twin_ray ray = {
        {x, y, z}, {dx, dy, dz}, .skip_object = -1, .skip_triangle = -1};

    vec_normalise(ray.toward);
    return ray;
}

static void assert_vec_near(const double *a, double x, double y, double z,
                            double most)
{
    if (fabs(a[0] - x) > most || fabs(a[1] - y) > most || fabs(a[2] - z) > most)
        fail_msg("%.12g %.12g %.12g, not %g %g %g", a[0], a[1], a[2], x, y, z);
}

#define TUTORIAL                            \
    "hand left\ncamera corners\n"           \
    "material m phong 0 1 0\n"              \
    "material u phong 1 0 0 colour 1 0 0\n" \
    "material y phong 1 0 0 colour 1 1 0\n" \
    "material z phong 1 0 0 colour 0 0 1\n"

TEST(a1_unit_vectors_have_length_1)
{
    double a[3] = {0, 6, 8};

    assert_true(vec_normalise(a) == 10);
    assert_vec_near(a, 0, .6, .8, 1e-15);
}

/* A2, A3: checks the normal of the tutorial's triangle, and the point where a
 * ray hits the triangle. */
TEST(a2_a3_triangle_has_its_normal_and_hit)
{
    struct stage *s = open_reference_for_text(
        TUTORIAL "triangle t 0 40 120 30 -40 60 -30 -40 60 material m\n");
    const struct twin_ray ray = make_ray(0, 0, 0, 0, 0, 1);

    assert_true(reference_intersect_scene(&s->twin, &ray, 1e9, &hit));
    assert_vec_near(hit.normal, 0, .6, -.8, 1e-15);
    assert_true(fabs(hit.t - 90) < 1e-12);
    assert_vec_near(hit.place, 0, 0, 90, 1e-12);
    close_reference(s);
}

/* A4: a ray through a point in the plane of the tutorial's triangle hits the
 * triangle if and only if the point is inside it, at any size. A test by
 * comparing areas fails for most small triangles (see test_scene_rays). */
TEST(a4_points_inside_a_triangle_are_hit)
{
    static const double corner[3][3] = {
        {0, 40, 120}, {30, -40, 60}, {-30, -40, 60}};
    uint32_t seed = 1;

    for (double size = 1; size > 1e-4; size /= 10) {
        struct stage *s = open_reference_for_text(
            TUTORIAL "triangle t 0 40 120 30 -40 60 -30 -40 60 material m\n");
        int met = 0;

        for (int i = 0; i < 9; i++)
            s->scene.triangle[0].place[i / 3][i % 3] *= size;
        reference_close(&s->twin);
        assert_ok(reference_open(&s->twin, &s->scene));
        for (int i = 0; i < 20000; i++) {
            const double u = rng_unit(&seed) * 2 - .5;
            const double w = rng_unit(&seed) * 2 - .5;
            const bool is_in = u >= 0 && w >= 0 && u + w <= 1;
            double p[3];
            struct twin_ray ray;

            for (int k = 0; k < 3; k++)
                p[k] = corner[0][k] + u * (corner[1][k] - corner[0][k]) +
                       w * (corner[2][k] - corner[0][k]);
            ray = make_ray(0, 0, 0, p[0], p[1], p[2]);
            if (fabs(u) < 1e-9 || fabs(w) < 1e-9 || fabs(u + w - 1) < 1e-9)
                continue;
            assert_int_equal(
                reference_intersect_object(&s->twin, 0, &ray, 1e9, &hit),
                is_in);
            if (is_in)
                assert_vec_near(hit.place, size * p[0], size * p[1],
                                size * p[2], 1e-12 * size * 150);
            met += is_in;
        }
        /* an eighth of the 20 000 points is inside */
        assert_in_range(met, 2000, 3000);
        close_reference(s);
    }
}

/* A5: of three triangles behind each other, the nearest is visible. */
TEST(a5_nearest_triangle_is_visible)
{
    struct stage *s = open_reference_for_text(
        TUTORIAL "triangle u 0 30 40 40 -30 120 -40 -30 120 material u\n"
                 "triangle y -50 30 124 50 30 124 0 -30 44 material y\n"
                 "triangle z -30 0 37 30 40 117 30 -40 117 material z\n");
    static const double t[3] = {80, 84, 77};
    const struct twin_ray ray = make_ray(0, 0, 0, 0, 0, 1);
    struct twin_pixel pixel;

    for (int i = 0; i < 3; i++) {
        assert_true(reference_intersect_object(&s->twin, i, &ray, 1e9, &hit));
        assert_true(fabs(hit.t - t[i]) < 1e-12);
    }
    pixel = reference_trace_ray(&s->twin, &ray);
    assert_true(pixel.rgb[0] == 0 && pixel.rgb[1] == 0 && pixel.rgb[2] == 1);
    close_reference(s);
}

/* A6: checks that rays of corner pixels have the directions (-8, 4.5, 10) and
 * (8, -4.5, 10). */
TEST(a6_corner_rays_have_their_directions)
{
    const struct twin_view view = {160, 90, 0, 1};
    struct stage *s = open_reference_for_text(
        TUTORIAL "sphere t at 0 0 9 radius 1 material m\n");
    struct twin_ray ray;

    reference_make_camera_ray(&s->twin, &view, 0, 0, &ray);
    vec_add_scaled(ray.from, 10 / ray.toward[2], ray.toward, ray.toward);
    assert_vec_near(ray.toward, -8, 4.5, 10, 1e-12);
    reference_make_camera_ray(&s->twin, &view, 159, 89, &ray);
    vec_add_scaled(ray.from, 10 / ray.toward[2], ray.toward, ray.toward);
    assert_vec_near(ray.toward, 8, -4.5, 10, 1e-12);
    close_reference(s);
}

/* Returns what a ray from (X, Y, Z) along (DX, DY, DZ) sees in the scene of
 * TEXT. */
static struct twin_pixel trace_ray_in_text(const char *text, double x, double y,
                                           double z, double dx, double dy,
                                           double dz)
{
    struct stage *s = open_reference_for_text(text);
    const struct twin_ray ray = make_ray(x, y, z, dx, dy, dz);
    const struct twin_pixel pixel = reference_trace_ray(&s->twin, &ray);

    close_reference(s);
    return pixel;
}

static void assert_rgb_light(struct twin_pixel p, double r, double g, double b)
{
    const double rgb[3] = {(double)p.rgb[0], (double)p.rgb[1],
                           (double)p.rgb[2]};

    assert_vec_near(rgb, r, g, b, 1e-6);
}

/* A7: the diffuse light of a floor at (0, 0, 30) under a lamp at (0, 40, 0). At
 * the lamp's distance, 50, its irradiance is 1. The cosine is .8, so the code
 * is 204 of 255. */
TEST(a7_floor_is_lit_by_the_cosine)
{
    const struct twin_pixel p =
        trace_ray_in_text("hand left\nmaterial m phong 0 1 0 colour 1 0 0\n"
                          "light lamp at 0 40 0 colour 2500 2500 2500\n"
                          "plane floor at 0 0 0 normal 0 1 0 material m\n",
                          0, 30, 0, 0, -1, 1);

    assert_rgb_light(p, .8, 0, 0);
    assert_int_equal((int)(255 * (double)p.rgb[0] + .5), 204);
}

/* A8: for a light and a viewer in the direction of the normal, all of Phong's
 * terms have their max: .1 + .6 times the material's colour, and .3 times the
 * light's colour. For other view directions the specular term decreases with
 * its exponent. */
TEST(a8_phong_terms_match_hand_computation)
{
    static const char text[] =
        "hand left\nmaterial m phong .1 .6 .3 colour 1 .5 0 power 2\n"
        /* angular radius 30 degrees: irradiance is colour x sin^2(30) = .25
         * colour */
        "light sun direction 0 1 0 colour 1 1 2 radius 30\n"
        "plane floor at 0 0 0 normal 0 1 0 material m\n";

    assert_rgb_light(trace_ray_in_text(text, 0, 1, 0, 0, -1, 0),
                     .1 + .15 + .075, .05 + .075 + .075, .15);
    /* at 45 degrees, the squared cosine between mirrored light and view
     * direction is 1/2 */
    assert_rgb_light(trace_ray_in_text(text, 0, 1, 0, 0, -1, 1),
                     .1 + .15 + .0375, .05 + .075 + .0375, .075);
    /* from below only ambient light is visible */
    assert_rgb_light(trace_ray_in_text(text, 0, -1, 0, 0, 1, 0), .1, .05, 0);
}

/* A9: checks that mirroring a direction twice gives the same direction, and
 * that a mirror shows objects in the mirrored direction. */
TEST(a9_mirror_shows_the_mirrored_direction)
{
    static const char text[] = "hand left\nmaterial m phong 0 0 0 reflect .5\n"
                               "material w phong 1 0 0 colour .2 .4 .8\n"
                               "plane floor at 0 0 0 normal 0 1 0 material m\n"
                               "sphere ball at 0 8 9 radius .01 material w\n";

    assert_rgb_light(trace_ray_in_text(text, 0, 1, 0, 0, -1, 1), .1, .2, .4);
    /* no object lies in the mirrored direction, and mirrors do not show the
     * background picture */
    assert_true(trace_ray_in_text(text, 0, 1, 0, 0, -1, -1).cover == 1);
    assert_rgb_light(trace_ray_in_text(text, 0, 1, 0, 0, -1, -1), 0, 0, 0);
}

/* A10: a ball between a point and a lamp at height 5 shadows the point. Balls
 * below the point, above the lamp or beside the ray do not. Some balls nearly
 * reach the lamp, and one contains it. */
TEST(a10_ball_before_a_lamp_casts_a_shadow)
{
    static const struct {
        const char *ball;
        bool dark;
    } row[] = {{"at 0 3 0 radius .5", true},   {"at 0 -2 0 radius .5", false},
               {"at 0 4.4 0 radius .5", true}, {"at 0 5.6 0 radius .5", false},
               {"at 0 5.4 0 radius .5", true}, /* the ball contains the lamp */
               {"at 3 3 0 radius .5", false}};

    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char text[400];
        struct twin_pixel p;

        snprintf(text, sizeof text,
                 "hand left\nmaterial m phong 0 1 0\n"
                 "light lamp at 0 5 0 colour 25 25 25\n"
                 "plane floor at 0 0 0 normal 0 1 0 material m\n"
                 "sphere b %s material m\nshadow on\n",
                 row[i].ball);
        p = trace_ray_in_text(text, 1, 1, 0, -1, -1, 0);
        assert_rgb_light(p, !row[i].dark, !row[i].dark, !row[i].dark);
    }
}

/* A10: no shadow acne. Checks that a ball lit from the camera's position has no
 * dark pixel. */
TEST(a10_lit_ball_has_no_shadow_acne)
{
    struct stage *s = open_reference_for_text(
        "hand left\ncamera fov 40 at 0 0 -4 toward 0 0 0\n"
        "material m phong 0 1 0\nlight lamp at 0 0 -4 colour 9 9 9\n"
        "sphere b at 0 0 0 radius 1 material m\nshadow on\n");
    uint32_t seed = 1;

    for (int i = 0; i < 20000; i++) {
        const double a = .24 * rng_signed(&seed), b = .24 * rng_signed(&seed);
        const struct twin_ray ray = make_ray(0, 0, -4, a, b, 1);

        if (reference_intersect_scene(&s->twin, &ray, 1e9, &hit) &&
            vec_dot(hit.normal, ray.toward) < -.01)
            assert_true(reference_trace_ray(&s->twin, &ray).rgb[0] > 0);
    }
    close_reference(s);
}

#define GLASS(refract)                                        \
    "hand left\nmaterial g phong 0 0 0 pass .5 " refract "\n" \
    "material w phong 1 0 0 colour .2 .4 .8\n"                \
    "sphere b at 0 0 0 radius 1 material g\n"

/* A11: an object behind a transparent ball of refractive index 1 is visible
 * straight through the ball, scaled by the transmitted fraction. Where there is
 * no object, the background picture is visible. The image is bit-identical with
 * and without "refract 1". */
TEST(a11_transparent_ball_shows_what_is_behind)
{
    static const char plain[] =
        GLASS("") "sphere w at 1 0 6 radius .5 material w\n";
    static const char one[] =
        GLASS("refract 1") "sphere w at 1 0 6 radius .5 material w\n";
    int seen = 0;

    for (int k = 0; k < 40; k++) {
        const struct twin_pixel a =
            trace_ray_in_text(plain, 0, 0, -5, k * .005, 0, 1);
        const struct twin_pixel b =
            trace_ray_in_text(one, 0, 0, -5, k * .005, 0, 1);
        /* the ray's distance from (1, 6), the middle of the ball behind, of
         * radius .5 */
        const double off = fabs(11 * (k * .005) - 1) / hypot(k * .005, 1);

        assert_memory_equal(&a, &b, sizeof a);
        assert_rgb_light(a, off < .5 ? .1 : 0, off < .5 ? .2 : 0,
                         off < .5 ? .4 : 0);
        assert_true(a.cover == (off < .5 ? 1 : .5F));
        seen += off < .5;
    }
    assert_true(seen > 10 && seen < 35);
}

/* A12: refraction of a ray half a radius off the centre of a ball of refractive
 * index 1.5. The ray enters at 30 degrees to the normal and continues at
 * asin(1/3) = 19.4712 degrees. It is deflected by twice the difference, and
 * crosses the axis .8949 behind the ball. */
TEST(a12_glass_ball_refracts_by_snells_law)
{
    struct stage *s = open_reference_for_text(
        GLASS("refract 1.5") "plane w at 0 0 9 normal 0 0 -1 material w\n");
    const struct twin_ray ray = make_ray(.5, 0, -5, 0, 0, 1);
    const double a = asin(.5), b = asin(.5 / 1.5);
    /* The ray leaves the ball at a point at the angle ROUND from the axis. From
     * there it runs at TURN radians to the axis. */
    const double round = 2 * b - a, turn = 2 * (a - b);
    const double cross = cos(round) + sin(round) / tan(turn);
    struct glint_described_object *w = &s->scene.object[1];

    /* A small ball where ray and axis cross is visible; a ball next to this
     * point is not. */
    w->kind = GLINT_DESCRIBED_SPHERE;
    w->radius = 1e-6;
    w->at[0] = 0;
    w->at[2] = cross;
    assert_rgb_light(reference_trace_ray(&s->twin, &ray), .1, .2, .4);
    w->at[0] = 2e-6;
    assert_rgb_light(reference_trace_ray(&s->twin, &ray), 0, 0, 0);
    close_reference(s);
    /* Light that meets the ball's surface from inside, at more than the
     * critical angle of 41.8 degrees to the normal, does not leave the ball. */
    assert_rgb_light(
        trace_ray_in_text(
            GLASS("refract 1.5") "plane w at 0 0 9 normal 0 0 -1 material w\n",
            .9, 0, 0, 0, 0, 1),
        0, 0, 0);
    assert_rgb_light(
        trace_ray_in_text(
            GLASS("refract 1.5") "plane w at 0 0 9 normal 0 0 -1 material w\n",
            .5, 0, 0, 0, 0, 1),
        .1, .2, .4);
}

/* A12: a ball of lower refractive index than its surroundings reflects all
 * light, whatever its transmittance, whose angle of incidence exceeds 14.48
 * degrees. */
TEST(a12_ball_of_lower_index_reflects_totally)
{
    static const char text[] =
        GLASS("refract .25") "sphere w at 4 0 -5 radius .5 material w\n";
    int seen = 0;

    /* Total reflection outside the ball: its normal at X bisects the directions
     * to the camera and to the other ball. */
    for (int i = 0; i < 200; i++) {
        const double x = .3 + i * .003, z = -sqrt(1 - x * x);
        const double d[3] = {2 * x * -z, 0, -(1 - 2 * x * x)};
        /* distance of the mirrored ray from the centre of the ball W */
        const double a[3] = {4 - x, 0, -5 - z};
        const double along = a[0] * d[0] + a[2] * d[2];
        const double off = fabs(a[0] * d[2] - a[2] * d[0]);
        const struct twin_pixel p = trace_ray_in_text(text, x, 0, -9, 0, 0, 1);

        const double share = off < .5 && along > 0 ? 1 : 0;

        if (fabs(off - .5) > .01)
            assert_rgb_light(p, .2 * share, .4 * share, .8 * share);
        seen += share > 0;
    }
    assert_in_range(seen, 20, 180);
}

/* A13: each corner of a triangle shows its texel. Light is interpolated
 * linearly between texel centres. The texture repeats outside 0 .. 1. */
TEST(a13_corners_of_a_triangle_show_their_texels)
{
    static const char text[] =
        "hand left\ntexture t x\nmaterial w phong 1 0 0 texture t\n"
        "triangle w 0 0 4 1 0 4 0 1 4 uv 0 0 2 0 0 1 material w\n";

    assert_rgb_light(trace_ray_in_text(text, .125, .5, 0, 0, 0, 1), 0, 0, 0);
    assert_rgb_light(trace_ray_in_text(text, .375, .5, 0, 0, 0, 1), 1, 1, 1);
    assert_rgb_light(trace_ray_in_text(text, .25, .5, 0, 0, 0, 1), .5, .5, .5);
    assert_rgb_light(trace_ray_in_text(text, .3125, .5, 0, 0, 0, 1), .75, .75,
                     .75);
    assert_rgb_light(trace_ray_in_text(text, .75, .1, 0, 0, 0, 1), .5, .5, .5);
    assert_rgb_light(trace_ray_in_text(text, 0, 0, 0, 0, 0, 1), .5, .5, .5);
}

/* A14: a ray misses a triangle without area. It also misses an object if the
 * ray lies in the object's plane. */
TEST(a14_degenerate_objects_are_missed)
{
    static const struct {
        const char *text;
        double toward[3];
    } row[] = {
        {"triangle t -9 1 5 9 1 5 0 1 9 material m\n", {0, 0, 1}},
        {"triangle t -9 0 5 9 0 5 0 0 9 material m\n", {0, 0, 1}},
        {"triangle t 0 -1 5 0 1 5 0 3 5 material m\n", {0, 0, 1}},
        {"triangle t 0 0 5 0 0 5 0 0 5 material m\n", {0, 0, 1}},
        {"plane p at 0 0 0 normal 0 1 0 material m\n", {0, 0, 1}},
        {"plane p at 0 1 0 normal 0 1 0 material m\n", {0, 0, 1}},
        {"plane p at 0 -1 0 normal 0 1 0 material m\n", {0, 1, 1}},
        {"sphere s at 0 0 -5 radius 1 material m\n", {0, 0, 1}},
    };

    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char text[300];
        struct twin_pixel p;

        snprintf(text, sizeof text, "hand left\nmaterial m phong 1 0 0\n%s",
                 row[i].text);
        p = trace_ray_in_text(text, 0, 0, 0, row[i].toward[0], row[i].toward[1],
                              row[i].toward[2]);
        if (p.cover != 0)
            fail_msg("%s", row[i].text);
    }
}

/* A15: a ray finds both intersections with a ball, from outside and from
 * inside. A grazing ray finds its single intersection. */
TEST(a15_ray_finds_both_hits_of_a_ball)
{
    struct stage *s =
        open_reference_for_text("hand left\nmaterial m phong 1 0 0\n"
                                "sphere s at 0 0 5 radius 3 material m\n");
    struct twin_ray ray = make_ray(0, 0, 0, 0, 0, 1);

    assert_true(reference_intersect_scene(&s->twin, &ray, 1e9, &hit));
    assert_true(hit.t == 2 && !hit.inside);
    assert_vec_near(hit.normal, 0, 0, -1, 0);
    ray.from[2] = 4;
    assert_true(reference_intersect_scene(&s->twin, &ray, 1e9, &hit));
    assert_true(hit.t == 4 && hit.inside);
    assert_vec_near(hit.normal, 0, 0, -1, 0);
    ray = make_ray(3, 0, 0, 0, 0, 1);
    assert_true(reference_intersect_scene(&s->twin, &ray, 1e9, &hit) &&
                hit.t == 5);
    ray.from[0] = 3.0000001;
    assert_false(reference_intersect_scene(&s->twin, &ray, 1e9, &hit));
    close_reference(s);
}

/* A shadow catcher of strength .6 removes .6 of the occluded light from the
 * picture. Where no light arrives, it leaves the picture unchanged. */
TEST(shadow_catcher_removes_occluded_light)
{
    static const char text[] =
        "hand left\nmaterial m phong 1 0 0\n"
        "light lamp at 0 5 0 colour 25 25 25\n"
        "plane floor at 0 0 0 normal 0 1 0 catcher .6\n"
        "sphere b at 0 3 0 radius .5 material m\nshadow on\n";

    assert_true(fabs((double)trace_ray_in_text(text, 1, 1, 0, -1, -1, 0).cover -
                     .6) < 1e-6);
    assert_true(trace_ray_in_text(text, 3, 1, 0, 0, -1, 0).cover == 0);
}

/* Returns whether RAY hits triangle T nearer than *T_MAX, which it sets: by the
 * plane of T and the sides of its edges. */
static bool hits_triangle_by_sides(const struct glint_described_triangle *tri,
                                   const struct twin_ray *ray, double *t_max)
{
    double a[3], b[3], n[3], at[3], side[3], t;

    vec_add_scaled(tri->place[1], -1, tri->place[0], a);
    vec_add_scaled(tri->place[2], -1, tri->place[0], b);
    vec_cross(a, b, n);
    vec_add_scaled(tri->place[0], -1, ray->from, at);
    t = vec_dot(at, n) / vec_dot(ray->toward, n);
    if (!(t > 0 && t < *t_max))
        return false;
    vec_add_scaled(ray->from, t, ray->toward, at);
    for (int k = 0; k < 3; k++) {
        vec_add_scaled(tri->place[(k + 1) % 3], -1, tri->place[k], a);
        vec_add_scaled(at, -1, tri->place[k], b);
        vec_cross(a, b, side);
        if (vec_dot(side, n) < 0)
            return false;
    }
    *t_max = t;
    return true;
}

/* Checks that bounding spheres hide no triangle: rays of a mesh whose first
 * triangle is not the first of a sphere, from outside and from inside, hit what
 * they hit if all triangles are tested. */
TEST(bounding_spheres_hide_no_triangle)
{
    char text[16000] = "hand left\nmaterial m phong 1 0 0\n";
    struct stage *s;
    uint32_t seed = 7;
    int met = 0;

    for (int i = 0; i < 100; i++) {
        const double x = 2 * rng_signed(&seed), y = 2 * rng_signed(&seed);

        snprintf(
            text + strlen(text), sizeof text - strlen(text),
            "triangle t%d %.3f %.3f %.3f %.3f %.3f 5 %.3f %.3f 5 material m\n",
            i, x, y, 4 + rng_signed(&seed), x + 1, y, x, y + rng_signed(&seed));
    }
    s = open_reference_for_text(text);
    s->scene.object[5].kind = GLINT_DESCRIBED_MESH; /* of triangles 5 to 94 */
    s->scene.object[5].n_triangles = 90;
    for (int i = 0; i < 4000; i++) {
        const struct twin_ray ray =
            make_ray(0, 0, i % 2 ? 4.5 : 0, .5 * rng_signed(&seed),
                     .5 * rng_signed(&seed), i % 2 ? rng_signed(&seed) : 1);
        double nearest = 1e9;
        bool is = false;

        for (int k = 5; k < 95; k++)
            is |= hits_triangle_by_sides(&s->scene.triangle[k], &ray, &nearest);
        assert_int_equal(
            reference_intersect_object(&s->twin, 5, &ray, 1e9, &hit), is);
        assert_true(!is || fabs(hit.t - nearest) < 1e-9);
        met += is;
    }
    assert_in_range(met, 1000, 3000);
    close_reference(s);
}
