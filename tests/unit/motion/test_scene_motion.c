/* SPDX-License-Identifier: MIT
 *
 * Tests recorded motion in scenes.
 */
#include "control/steer.h"
#include "glint/scene/bake.h"
#include "scene/motion/play.h"
#include "support/rng.h"
#include "support/test.h"
#include "support/tracks/moving.h"
#include "support/tracks/tracks.h"

enum {
    WIDTH = MOVING_WIDTH,
    HEIGHT = MOVING_HEIGHT,
    FOODS = MOVING_FOODS,
    SENSORS = MOVING_SENSORS
};

#define LOOK                                   \
    "camera fov 53 at -4 12 26 toward 0 0 0\n" \
    "light sun direction .35 .8 .6 colour 5e4 4.8e4 4.5e4\nshadow on\n"
#define RUN \
    "motion run x size .6 sensors .2 foods .5 shells 1.8 lines .06 box 1 "

static uint64_t hash_image(const struct moving *d)
{
    uint64_t hash = UINT64_C(14695981039346656037);

    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        hash = (hash ^ (uint32_t)d->light_q20[i]) * UINT64_C(1099511628211);
    return hash;
}

/* --------------------------------------------------------------- any frame */

/* Checks that a frame is the same whether it is reached by playing, by single
 * steps or by jumps, for all tile sizes. */
TEST(row_d8_seeking_equals_playing)
{
    enum { N = 40 };
    uint64_t played[N];
    struct moving *d;
    uint32_t seed = 3;

    moving_bake_track(3, N, 60);
    d = moving_open_scene(LOOK RUN, 5, 4);
    assert_int_equal(glint_scene_frames(d->frame.scene), N);
    for (int k = 0; k < N; k++) {
        glint_scene_seek(d->frame.scene, (uint32_t)k);
        moving_draw_frame(d);
        played[k] = hash_image(d);
        assert_true(k == 0 || played[k] != played[k - 1]);
    }
    for (int i = 0; i < 200; i++) {
        const uint32_t k = (uint32_t)rng_int_below(&seed, N);

        glint_scene_seek(d->frame.scene, k);
        moving_draw_frame(d);
        assert_true(hash_image(d) == played[k]);
    }
    glint_scene_seek(d->frame.scene, 1u << 31);
    moving_draw_frame(d);
    assert_true(hash_image(d) == played[N - 1]);
    moving_close_scene(d);
    for (int log2 = 3; log2 <= 6; log2++) {
        d = moving_open_scene(LOOK RUN, log2, 4);
        for (uint32_t k = 0; k < N; k += 13) {
            glint_scene_seek(d->frame.scene, k);
            moving_draw_frame(d);
            assert_true(hash_image(d) == played[k]);
        }
        moving_close_scene(d);
    }
}

/* ------------------------------------------------ detection by brute force */

/* Returns by which angle, radians, food F (a landmark) of FRAME is inside the
 * detection angle of sensor S. Negative: F is outside. */
static double compute_detection_margin(const struct glint_motion_frame *frame,
                                       double size, int s, int f)
{
    const double axis[3] = {sin(moving_body.theta[s]) * cos(moving_body.phi[s]),
                            sin(moving_body.theta[s]) * sin(moving_body.phi[s]),
                            cos(moving_body.theta[s])};
    double q[4], length = 0, to[3], dot = 0, square = 0;

    for (int k = 0; k < 4; k++)
        length += pow(frame->pose.turn_q14[k], 2);
    for (int k = 0; k < 4; k++)
        q[k] = frame->pose.turn_q14[k] / sqrt(length);
    track_rotate_vector(q, axis, true, to);
    for (int k = 0; k < 3; k++) {
        const double d = ldexp(frame->food[f][k], -24) -
                         ldexp(frame->pose.at[k], -24) - size * to[k];

        dot += d * to[k];
        square += d * d;
    }
    return moving_angle_to_food_deg() * GLINT_PI / 360 -
           acos(dot / sqrt(square));
}

/* Compares detection by angle, and by angle and intensity, with brute force,
 * for 10 000 frames of random steps, rotations and foods (landmarks), with six
 * sensors and five foods. */
TEST(row_d7_detection_matches_brute_force)
{
    enum { N = 10000 };
    struct moving *d[2];
    int seen[2] = {0, 0}, close = 0;

    moving_bake_track(3, N, 75);
    d[0] = moving_open_scene(LOOK RUN "detect angle", 5, 1);
    d[1] = moving_open_scene(LOOK RUN "detect both .3", 5, 1);
    for (uint32_t k = 0; k < N; k++) {
        const struct glint_motion_frame *frame =
            &d[0]->frame.scene->motion->frame;

        for (int i = 0; i < 2; i++)
            glint_scene_seek(d[i]->frame.scene, k);
        for (int f = 0; f < FOODS; f++)
            for (int s = 0; s < SENSORS; s++) {
                const double margin = compute_detection_margin(frame, .6, s, f);
                const int bright = frame->intensity[f][s] > 76; /* .3 * 255 */
                const int got[2] = {
                    (int)(glint_scene_seen_by(d[0]->frame.scene, (uint32_t)f) >>
                              s &
                          1),
                    (int)(glint_scene_seen_by(d[1]->frame.scene, (uint32_t)f) >>
                              s &
                          1)};

                /* positions are rounded to steps, so nearly equal angles are
                 * not compared */
                if (fabs(margin) < 1e-6) {
                    close++;
                    continue;
                }
                assert_int_equal(got[0], margin > 0);
                assert_int_equal(got[1], margin > 0 && bright);
                seen[0] += got[0];
                seen[1] += got[1];
            }
    }
    print_message("  %d of %d seen, %d of them bright; %d too close to tell\n",
                  seen[0], N * FOODS * SENSORS, seen[1], close);
    assert_true(close < 10 && seen[0] > 10000 && seen[1] > 5000);
    moving_close_scene(d[0]);
    moving_close_scene(d[1]);
}

/* Checks that angles compared by their squared cosines give the same result as
 * exact integers, also for wide angles. */
TEST(angles_are_compared_exactly)
{
    uint32_t seed = 5;
    int seen = 0;

    for (int i = 0; i < 200000; i++) {
        const int bits = 1 + rng_int_below(&seed, 29);
        int32_t axis[3], d[3], c = (int32_t)rng_bits32(&seed) >> 1;
        int64_t v[3];
        long double dot = 0, square = 0;

        for (int k = 0; k < 3; k++) {
            v[k] = (int32_t)rng_bits32(&seed);
            d[k] = (int32_t)rng_bits32(&seed) >> (32 - bits);
        }
        assert_true(glint_normalise_vector(v, axis));
        if (i % 3 == 0) /* on the axis */
            for (int k = 0; k < 3; k++)
                d[k] = axis[k] >> (31 - bits);
        for (int k = 0; k < 3; k++) {
            dot += (long double)axis[k] * d[k];
            square += (long double)d[k] * d[k];
        }
        if (fabsl(dot - c * sqrtl(square)) < 1e-9L * fabsl(dot))
            continue;
        seen += glint_motion_is_in_view_cone(axis, c, d);
        assert_int_equal(glint_motion_is_in_view_cone(axis, c, d),
                         dot > c * sqrtl(square));
    }
    assert_true(seen > 50000 && seen < 150000);
}

/* ----------------------------------------------------------- control lines */

#define METALS                                                             \
    "material dark ward diffuse 0 0 0 specular .2 .2 .2 alpha .1 .1\n"     \
    "material light ward diffuse .5 .5 .5 specular .2 .2 .2 alpha .1 .1\n" \
    "sphere a at 0 8 0 radius 1 material dark\n"

/* Checks that a control line that fails changes neither the camera, whether in
 * a sensor or free, nor the materials of objects, and that the next line is
 * executed. */
TEST(failed_control_lines_change_nothing)
{
    static const struct control_line bright = {
        .verb = CONTROL_COLOUR, .v = {.6, .6, .6}, .n = 3}; /* of all metals */
    static const char *const before[2] = {"camera sensor 1", "walk 1 2 3"};
    struct glint_error error;
    struct control_line line;
    struct steer steer;
    struct moving *d;

    moving_bake_track(3, 20, 60);
    d = moving_open_scene(LOOK METALS RUN, 5, 4);
    assert_ok(steer_open(&steer, &d->model));
    for (int i = 0; i < 2; i++) {
        struct steer was;
        uint64_t hash;

        control_parse_line(before[i], "f:1", &line, &error);
        assert_ok(
            steer_execute_command(&steer, d->frame.scene, &line, "", &error));
        moving_draw_frame(d);
        hash = hash_image(d);
        was = steer;
        control_parse_line("distance 9e5", "f:2", &line, &error);
        assert_int_equal(
            steer_execute_command(&steer, d->frame.scene, &line, "", &error),
            GLINT_E_FORMAT);
        assert_memory_equal(&steer, &was, sizeof was);
        assert_int_equal(
            steer_execute_command(&steer, d->frame.scene, &bright, "", &error),
            GLINT_E_FORMAT);
        moving_draw_frame(d);
        assert_true(hash_image(d) == hash);
        steer_apply_state(&steer, d->frame.scene);
        moving_draw_frame(d);
        assert_true(hash_image(d) == hash);
    }
    control_parse_line("orbit 30 20", "f:3", &line, &error);
    assert_ok(steer_execute_command(&steer, d->frame.scene, &line, "", &error));
    steer_close(&steer);
    moving_close_scene(d);
}

/* ------------------------------------------------------ camera in a sensor */

/* Returns the mean column of the pixels with more red than blue; -1: there are
 * none. Sets *N to their number. */
static double compute_mean_column_of_red(const struct moving *d, int *n)
{
    double sum = 0;

    *n = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int32_t *p = &d->light_q20[3 * i];

        if (p[0] > 4 * p[2] && p[0] > 1 << 16) {
            sum += i % WIDTH;
            ++*n;
        }
    }
    return *n ? sum / *n : -1;
}

/* Checks a camera placed in a sensor. The object ahead must be in the image
 * centre, and the field of view must be that of the sensor. Leaving the sensor
 * must restore the previous image. */
TEST(row_d9_camera_is_placed_in_a_sensor)
{
    /* foods (landmarks): one ahead of sensor 0, one ahead of sensor 1, and two
     * others */
    double food[4][3] = {{6, 0, 0}, {0, 6, 0}, {0, -3, 7}, {-9, 1, 2}};
    uint64_t outside;
    struct moving *d;
    int n;

    moving_bake_foods(food, 4, 60);
    d = moving_open_scene(LOOK RUN, 5, 4);
    moving_draw_frame(d);
    outside = hash_image(d);
    for (int k = 0; k < 2; k++) { /* Sensor k points at food (landmark) k. */
        assert_ok(glint_scene_enter(d->frame.scene, k));
        glint_scene_show_kind(d->frame.scene, GLINT_KIND_SHELLS, 0);
        moving_draw_frame(d);
        assert_true(fabs(compute_mean_column_of_red(d, &n) - (WIDTH - 1) / 2.) <
                    .5);
        /* radius .5 at a distance of 6 - .6, in an image whose width is 2 tan
         * 30 degrees */
        assert_true(fabs(sqrt(n / GLINT_PI) -
                         .5 / 5.4 * WIDTH / (2 * tan(GLINT_PI / 6))) < 1);
    }
    assert_int_equal(glint_scene_enter(d->frame.scene, SENSORS),
                     GLINT_E_ARGUMENT);
    assert_ok(glint_scene_enter(d->frame.scene, -1));
    glint_scene_show_kind(d->frame.scene, GLINT_KIND_SHELLS, 1);
    moving_draw_frame(d);
    assert_true(hash_image(d) == outside);
    moving_close_scene(d);
    d = moving_open_scene("camera sensor 2\nlight sun direction .3 .8 .6 "
                          "colour 5e4 5e4 5e4\n" RUN,
                          5, 4);
    glint_scene_show_kind(d->frame.scene, GLINT_KIND_SHELLS, 0);
    moving_draw_frame(d);
    assert_true(fabs(compute_mean_column_of_red(d, &n) - (WIDTH - 1) / 2.) <
                .5);
    moving_close_scene(d);
}

/* ---------------------------------------------------------- detected foods */

/* Checks detections of foods (landmarks): three foods by one sensor each, two
 * by all sensors, and two by two sensors. */
TEST(row_d10_sensors_detect_their_foods)
{
    double three[3][3] = {{5, 0, 0}, {0, 5, 0}, {0, 0, 5}};
    double corner[4][3] = {{5, 5, 0}, {-5, 5, 0}, {5, -5, 7}, {3, 3, -8}};
    double any[3][3] = {{4, 5, 3}, {-5, 4, 6}, {5, 3, -4}};
    struct moving *d;

    moving_bake_foods(three, 3, 50);
    d = moving_open_scene(LOOK RUN, 5, 4);
    assert_int_equal(glint_scene_seen_by(d->frame.scene, 0), 1);
    assert_int_equal(glint_scene_seen_by(d->frame.scene, 1), 2);
    assert_int_equal(glint_scene_seen_by(d->frame.scene, 2), 16);
    assert_int_equal(glint_scene_seen_by(d->frame.scene, 3), 0);
    moving_close_scene(d);
    moving_bake_foods(any, 3, 360);
    d = moving_open_scene(LOOK RUN, 5, 4);
    for (uint32_t f = 0; f < 3; f++)
        assert_int_equal(glint_scene_seen_by(d->frame.scene, f), 63);
    moving_close_scene(d);
    moving_bake_foods(corner, 4, 100);
    d = moving_open_scene(LOOK RUN, 5, 4);
    assert_int_equal(glint_scene_seen_by(d->frame.scene, 0), 1 | 2);
    assert_int_equal(glint_scene_seen_by(d->frame.scene, 1), 2 | 4);
    moving_close_scene(d);
}

/* Checks that each type of object is visible at first, can be hidden and shown
 * again, and can be resized. */
TEST(object_types_can_be_hidden_and_resized)
{
    double food[4][3] = {{5, 0, 0}, {0, 5, 0}, {0, 0, 5}, {-5, -4, 6}};
    uint64_t whole;
    struct moving *d;

    moving_bake_foods(food, 4, 50);
    d = moving_open_scene(LOOK RUN, 5, 4);
    moving_draw_frame(d);
    whole = hash_image(d);
    for (int kind = 0; kind < GLINT_KINDS; kind++) {
        const int32_t steps = 1 << d->model.header->unit_log2;

        glint_scene_show_kind(d->frame.scene, (enum glint_scene_kind)kind, 0);
        moving_draw_frame(d);
        assert_true(hash_image(d) != whole);
        glint_scene_show_kind(d->frame.scene, (enum glint_scene_kind)kind, 1);
        moving_draw_frame(d);
        assert_true(hash_image(d) == whole);
        assert_ok(glint_scene_size_kind(d->frame.scene,
                                        (enum glint_scene_kind)kind, steps));
        moving_draw_frame(d);
        assert_true(hash_image(d) != whole);
        whole = hash_image(d);
        assert_int_equal(glint_scene_size_kind(d->frame.scene,
                                               (enum glint_scene_kind)kind, 0),
                         GLINT_E_ARGUMENT);
    }
    moving_close_scene(d);
}

/* Checks a shell (transparent sphere): in its middle it covers half of the
 * light that its material does not transmit. A food (landmark) inside it must
 * be visible through it. */
TEST(shells_let_light_pass)
{
    double food[3][3] = {{5, 0, 0}, {0, 5, 0}, {0, 0, 5}};
    const int middle = 3 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    struct moving *d;

    moving_bake_foods(food, 3, 50);
    d = moving_open_scene("camera fov 30 at 5 0 10 toward 5 0 0\n"
                          "material shells phong 1 0 0 colour 0 .5 1 pass .5\n"
                          "material foods phong 1 0 0 colour 1 0 0\n"
                          "motion run x size .6 foods .5 shells 4\n",
                          5, 4);
    moving_draw_frame(d);
    /* a food (landmark) of red 1 behind a shell of coverage 1/4 */
    assert_true(abs(d->light_q20[middle] - (3 << 18)) < 1 << 14);
    assert_true(abs(d->light_q20[middle + 2] - (1 << 18)) < 1 << 14);
    glint_scene_show_kind(d->frame.scene, GLINT_KIND_FOODS, 0);
    moving_draw_frame(d);
    assert_true(d->light_q20[middle] == 0);
    assert_true(abs(d->light_q20[middle + 2] - (1 << 18)) < 1 << 14);
    assert_true(abs(glint_scene_cover(d->frame.scene, 256 * WIDTH / 2,
                                      256 * HEIGHT / 2, 1024) -
                    64) < 8);
    moving_close_scene(d);
}

/* Checks that lines that leave the widest image are drawn until their whole
 * width is off-screen: an edge of the box, 200 pixels wide, leaves at an
 * angle. */
TEST(wide_lines_are_drawn_until_off_screen)
{
    enum { WIDE = 8192, LOW = 16 };
    static int32_t light_q20[3 * WIDE * LOW];
    static const struct tool tool = {.name = "test"};
    const struct scene_dials dials = {
        .width = WIDE, .height = LOW, .edge_samples = 1, .shadow_points = 1};
    const int32_t half = 759250125; /* sqrt(1/2), Q30 */
    const int32_t axis_q30[3][3] = {
        {half, half, 0}, {-half, half, 0}, {0, 0, -(1 << 30)}};
    double food[3][3] = {{40, 0, 0}, {-40, 5, 0}, {0, -5, -5}};
    struct glint_image image =
        glint_image_over(light_q20, GLINT_LINEAR_Q20, WIDE, LOW);
    const struct glint_motion_state *m;
    struct scene_frame frame;
    int32_t at[3], away, aside;
    struct moving *d;

    moving_bake_foods(food, 3, 50);
    d = moving_open_scene(LOOK "motion run x lines .1 box 1\n", 5, 1);
    assert_ok(scene_frame_open(&frame, &tool, &d->model, &dials));
    m = frame.scene->motion;
    away = m->high[0] / 4;
    aside = (int32_t)(WIDE / 2 * 256. * away /
                      ((double)frame.scene->view.per_tan_q8 * sqrt(2)));
    at[0] = (m->low[0] + m->high[0]) / 2 - aside;
    at[1] = m->low[1] - aside;
    at[2] = m->high[2] + away;
    assert_ok(glint_scene_set_camera(frame.scene, at, axis_q30));
    assert_ok(glint_scene_size_kind(
        frame.scene, GLINT_KIND_BOX,
        (int32_t)(200 * 256. * away / (double)frame.scene->view.per_tan_q8)));
    assert_ok(scene_frame_draw(&frame, &image));
    for (int y = 0; y < LOW; y++)
        for (int x = WIDE - 20; x < WIDE; x++)
            assert_memory_equal(light_q20 + 3 * (y * WIDE + x),
                                light_q20 + 3 * (LOW / 2 * WIDE + WIDE - 20),
                                3 * sizeof *light_q20);
    assert_true(light_q20[3 * WIDE - 1] > 0);
    scene_frame_close(&frame);
    moving_close_scene(d);
}

/* Checks that lamps attached to the body move with it, by the positions that
 * the flare receives. */
TEST(lamps_move_with_the_body)
{
    struct glint_scene_lamp lamp[GLINT_SCENE_MAX_LIGHTS];
    struct moving *d;

    moving_bake_track(0, 100, 60);
    d = moving_open_scene(
        "camera fov 60 at 0 0 30 toward 0 0 0\n"
        "light lamp at 0 1 0 colour 5 5 5 on run\nflare lights\n"
        "motion run x size .5\n",
        5, 1);
    for (uint32_t k = 0; k < 100; k += 9) {
        const struct glint_motion_state *m = d->frame.scene->motion;
        double q[4], up[3], at[3];
        const double y[3] = {0, 1, 0};

        glint_scene_seek(d->frame.scene, k);
        moving_draw_frame(d);
        for (int i = 0; i < 4; i++)
            q[i] = ldexp(m->frame.pose.turn_q14[i], -14);
        track_rotate_vector(q, y, true, up);
        for (int i = 0; i < 3; i++)
            at[i] = ldexp(m->frame.pose.at[i], -24) + up[i];
        assert_int_equal(glint_scene_lights(d->frame.scene, lamp), 1);
        assert_true(
            fabs(lamp[0].x_q8 / 256. - WIDTH / 2. -
                 at[0] / (30 - at[2]) * WIDTH / (2 * tan(GLINT_PI / 6))) < .1);
    }
    moving_close_scene(d);
}

/* ---------------------------------------------------------- extreme scenes */

TEST(missing_module_is_named)
{
    struct glint_scene_parts parts;
    struct moving *d;

    moving_bake_track(0, 10, 60);
    d = moving_open_scene(LOOK RUN, 5, 1);
    parts = d->frame.cfg.parts;
    assert_null(glint_scene_lacks(&parts, &d->model));
    parts.motions = NULL;
    assert_string_equal(glint_scene_lacks(&parts, &d->model), "motions");
    moving_close_scene(d);
}

/* Checks cameras at any position, also inside shells and lines, and objects of
 * any size, from one step to a quarter of the space. No sum may overflow
 * (CONFIG=qcheck), and no loop may be endless. */
TEST(extreme_positions_and_sizes_do_not_overflow)
{
    struct moving *d;
    uint32_t seed = 8;

    moving_bake_track(3, 60, 170);
    d = moving_open_scene(LOOK RUN, 5, 4);
    for (int i = 0; i < 400; i++) {
        struct glint_scene *s = d->frame.scene;
        int32_t at[3], axis_q30[3][3] = {{0}};
        const int shift = rng_int_below(&seed, 28),
                  turn = rng_int_below(&seed, 3);

        glint_scene_seek(s, (uint32_t)rng_int_below(&seed, 60));
        for (int k = 0; k < 3; k++) {
            at[k] = ((int32_t)rng_bits32(&seed) >> 4) >> shift;
            axis_q30[k][(k + turn) % 3] = 1 << 30;
        }
        if (i % 4 == 1) /* camera inside a food (landmark) or in the body */
            memcpy(at, s->motion->food_at[i % FOODS], sizeof at);
        assert_ok(glint_scene_set_camera(s, at, (const int32_t(*)[3])axis_q30));
        glint_scene_size_kind(s, (enum glint_scene_kind)rng_int_below(&seed, 6),
                              1 << rng_int_below(&seed, 27));
        moving_draw_frame(d);
    }
    for (int k = 0; k < SENSORS; k++)
        if (glint_scene_enter(d->frame.scene, k) == GLINT_OK)
            moving_draw_frame(d);
    moving_close_scene(d);
}
