/* SPDX-License-Identifier: MIT
 *
 * Tests tracking of lamps in synthetic night scenes with the real finder:
 * tracks must suppress noise and follow motion without abrupt changes.
 */

#include "support/night.h"
#include "support/rng.h"
#include "support/test.h"

enum { FPS30 = 33333, FPS60 = 16667, FULL = 32768 };

static struct night night;

static void init_night(int width, int height)
{
    night_close_tracker(&night);
    night_init_parameters(&night, width, height);
}

TEST_CLOSE
{
    night_close_tracker(&night);
}

static void open_night_tracker(int width, int height, double sigma)
{
    init_night(width, height);
    night.sigma = sigma;
    assert_true(night_open_tracker(&night));
}

static const struct glint_lamp_track *find_only_track(void)
{
    assert_int_equal(night.n_tracks, 1);
    return &night.track[0];
}

/* ------------------------------------------------------------ configuration */

TEST(needs_exactly_the_stated_memory)
{
    struct glint_lamp_tracker_config cfg;
    struct glint_lamp_tracker *tracks;
    size_t bytes;
    void *mem;

    glint_lamp_tracker_defaults(&cfg, 1920, 1080);
    bytes = glint_lamp_tracker_bytes(&cfg);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_ok(glint_lamp_tracker_init(&tracks, &cfg, mem, bytes));
    assert_int_equal(glint_lamp_tracker_init(&tracks, &cfg, mem, bytes - 1),
                     GLINT_E_MEMORY);
    assert_int_equal(glint_lamp_tracker_init(&tracks, &cfg, mem, 1),
                     GLINT_E_MEMORY);
    assert_int_equal(
        glint_lamp_tracker_init(&tracks, &cfg, (char *)mem + 8, bytes - 8),
        GLINT_E_ARGUMENT);
    free(mem);
}

static void assert_config_is_rejected(struct glint_lamp_tracker_config cfg)
{
    static uint64_t mem[16];
    struct glint_lamp_tracker *tracks;

    assert_true(glint_lamp_tracker_bytes(&cfg) == 0);
    assert_int_equal(glint_lamp_tracker_init(&tracks, &cfg, mem, sizeof mem),
                     GLINT_E_ARGUMENT);
}

TEST(rejects_invalid_configurations)
{
    struct glint_lamp_tracker_config good, bad;

    glint_lamp_tracker_defaults(&good, 640, 480);
    assert_true(glint_lamp_tracker_bytes(&good) > 0);
    bad = good, bad.width = 0, assert_config_is_rejected(bad);
    bad = good, bad.height = GLINT_MAX_SIDE + 1, assert_config_is_rejected(bad);
    bad = good, bad.max_tracks = 0, assert_config_is_rejected(bad);
    bad = good, bad.max_tracks = 1025, assert_config_is_rejected(bad);
    bad = good, bad.max_shown = 0, assert_config_is_rejected(bad);
    bad = good, bad.max_shown = bad.max_tracks + 1,
    assert_config_is_rejected(bad);
    bad = good, bad.match_q15 = -1, assert_config_is_rejected(bad);
    bad = good, bad.match_q15 = 32769, assert_config_is_rejected(bad);
    bad = good, bad.cut_q15 = 0, assert_config_is_rejected(bad);
    bad = good, bad.attack_ms = 0, assert_config_is_rejected(bad);
    bad = good, bad.release_ms = 60001, assert_config_is_rejected(bad);
    bad = good, bad.leave_ms = 0, assert_config_is_rejected(bad);
    bad = good, bad.memory_ms = 0, assert_config_is_rejected(bad);
    bad = good, bad.smooth_ms = -1, assert_config_is_rejected(bad);
}

/* ---------------------------------------------------------------- stability */

struct moments {
    double sum, square;
    int n;
};

static void add_value_to_moments(struct moments *m, double v)
{
    m->sum += v;
    m->square += v * v;
    m->n++;
}

static double compute_deviation(const struct moments *m)
{
    const double mean = m->sum / m->n;

    return sqrt(fmax(m->square / m->n - mean * mean, 0));
}

static double compute_mean(const struct moments *m)
{
    return m->sum / m->n;
}

/* Checks that the tracks of six lamps do not move in 300 frames with noise of 3
 * codes. Prints the deviation of spots (measured positions) and of tracks. */
TEST(static_lamps_stay_in_place_in_noise)
{
    static const struct night_lamp lamp[] = {
        {60.3, 50.7, 14, 3}, {160.8, 40.2, 8, 2},  {250.4, 60.9, 5, 4},
        {70.1, 150.6, 3, 2}, {170.5, 140.5, 2, 3}, {260.9, 150.3, 4, 1.05}};
    enum { N = sizeof lamp / sizeof *lamp };
    struct moments x[N][2] = {{{0, 0, 0}}}, y[N][2] = {{{0, 0, 0}}};
    struct moments power[N][2] = {{{0, 0, 0}}}, total[2] = {{0, 0, 0}};
    uint32_t id[N];

    open_night_tracker(320, 200, 3);
    for (int frame = 0; frame < 300; frame++) {
        double sum = 0;

        night_draw_and_track(&night, lamp, N, FPS30);
        assert_int_equal(night.n_tracks, N);
        for (int i = 0; i < N; i++) {
            const struct glint_lamp_track *t =
                &night.track[night_find_track(&night, lamp[i].x, lamp[i].y)];
            const struct glint_spot *s =
                &night.spot[night_find_spot(&night, lamp[i].x, lamp[i].y)];

            if (frame == 0)
                id[i] = t->id;
            assert_int_equal(t->id, id[i]);
            assert_int_equal(t->level_q15, FULL);
            add_value_to_moments(&x[i][0], s->x_q8 / 256.0),
                add_value_to_moments(&x[i][1], t->x_q8 / 256.0);
            add_value_to_moments(&y[i][0], s->y_q8 / 256.0),
                add_value_to_moments(&y[i][1], t->y_q8 / 256.0);
            add_value_to_moments(&power[i][0], night_spot_power(s));
            add_value_to_moments(&power[i][1], night_track_power(t));
            sum += night_spot_power(s);
        }
        add_value_to_moments(&total[0], sum),
            add_value_to_moments(&total[1], night_sum_track_energies(&night));
    }
    for (int i = 0; i < N; i++) {
        double px[2], percent[2];

        for (int k = 0; k < 2; k++) {
            px[k] =
                hypot(compute_deviation(&x[i][k]), compute_deviation(&y[i][k]));
            percent[k] = 100 * compute_deviation(&power[i][k]) /
                         compute_mean(&power[i][k]);
        }
        print_message("radius %2.0f, light %.2f: %.3f px -> %.3f px; %.2f %% "
                      "-> %.2f %%\n",
                      lamp[i].radius, lamp[i].light, px[0], px[1], percent[0],
                      percent[1]);
        assert_true(px[1] < 0.25 && px[1] < px[0]);
        assert_true(percent[1] < 0.6 * percent[0]);
    }
    print_message("flare energy: %.3f %% -> %.3f %%\n",
                  100 * compute_deviation(&total[0]) / compute_mean(&total[0]),
                  100 * compute_deviation(&total[1]) / compute_mean(&total[1]));
    assert_true(compute_deviation(&total[1]) < 0.01 * compute_mean(&total[1]));
}

/* Returns the RMS change per frame, degrees, of the axis of the track of a tube
 * at DEGREES, which is observed with noise of 3.5 degrees. */
static double measure_axis_rotation_deg(double degrees)
{
    struct moments turn = {0, 0, 0};

    init_night(320, 200);
    assert_true(night_open_tracker(&night));
    for (int frame = 0; frame < 300; frame++) {
        const double angle =
            (degrees + (rng_int_below(&night.seed, 1201) - 600) / 100.0) *
            3.14159 / 180;
        const struct glint_spot spot = {
            .x_q8 = 160 << 8,
            .y_q8 = 100 << 8,
            .size_q8 = 8 << 8,
            .area = 200,
            .flux_q16 = 200 << 16,
            .power_q16 = 200 << 16,
            .axis_q8 = {8 << 8, 2 << 8},
            .cos_q15 = (int32_t)lrint(32768 * fabs(cos(angle))),
            .sin_q15 =
                (int32_t)lrint(32768 * sin(angle)) * (cos(angle) < 0 ? -1 : 1),
            .rgb_q15 = {1 << 15, 1 << 15, 1 << 15}};
        double off;

        assert_int_equal(glint_lamp_tracker_step(night.tracks, &spot, 1, FPS30,
                                                 night.track, NIGHT_MAX),
                         1);
        off = atan2(night.track[0].sin_q15, night.track[0].cos_q15) * 180 /
                  3.14159 -
              degrees;
        if (frame >= 30)
            add_value_to_moments(&turn, remainder(off, 180));
    }
    return compute_deviation(&turn);
}

TEST(axes_are_steady_in_any_orientation)
{
    const double lying = measure_axis_rotation_deg(0),
                 standing = measure_axis_rotation_deg(90);

    print_message("axes: %.2f degrees lying, %.2f standing\n", lying, standing);
    assert_true(lying < 1 && standing < 1);
}

/* Every EVERY-th frame, one pixel of a dim lamp of 8 x 8 pixels, each time
 * another, is 41 times as bright as the others (code 255 instead of 43, linear
 * 1 instead of 0.0242). Returns the max distance, pixels, that the lamp's track
 * moves. */
static double measure_motion_of_dim_lamp_px(int every, uint32_t seed)
{
    double furthest = 0;

    init_night(320, 200);
    night.seed = seed;
    night.lights.judge = 0;
    night.lights.white_code = 43;
    night.lights.threshold_low_q8 = -20;
    night.lights.threshold_high_q8 = 0;
    assert_true(night_open_tracker(&night));
    for (int frame = 0; frame < 300; frame++) {
        uint8_t *const corner = night.image.plane[0] + 100 * 320 + 150;
        const struct glint_lamp_track *t;

        memset(night.image.plane[0], 5, 320 * 200);
        for (int y = 0; y < 8; y++)
            memset(corner + 320 * y, 43, 8);
        if (frame > 0 && frame % every == 0)
            corner[320 * rng_int_below(&night.seed, 8) +
                   rng_int_below(&night.seed, 8)] = 255;
        night_track_lamps(&night, FPS30);
        t = find_only_track();
        furthest =
            fmax(furthest, hypot(t->x_q8 / 256.0 - 154, t->y_q8 / 256.0 - 104));
    }
    return furthest;
}

TEST(sparkle_moves_less_than_a_pixel)
{
    double always = 0, rarely = 0;

    for (uint32_t seed = 1; seed <= 20; seed++) {
        always = fmax(always, measure_motion_of_dim_lamp_px(1, seed));
        rarely = fmax(rarely, measure_motion_of_dim_lamp_px(7, seed));
    }
    print_message("sparkle in each picture %.2f px, in one of seven %.2f\n",
                  always, rarely);
    assert_true(always < 1);
    assert_true(rarely < 1);
}

/* Checks a lamp whose brightest pixels are near the upper threshold, so that
 * its spot is often classified as faint: its track must continue. The test sets
 * the white level; otherwise it would be that of the lamp, the brightest
 * object, which would then not be faint. */
TEST(faint_spots_keep_a_track)
{
    uint32_t id = 0;
    int n_faint = 0;

    init_night(320, 200);
    night.lights.white_code = 255;
    assert_true(night_open_tracker(&night));
    for (int frame = 0; frame < 100; frame++) {
        const int code = frame == 0 ? 255 : 246 + rng_int_below(&night.seed, 4);

        memset(night.image.plane[0], 5, 320 * 200);
        for (int y = 0; y < 6; y++)
            memset(night.image.plane[0] + 320 * (100 + y) + 150, code, 6);
        night_track_lamps(&night, FPS30);
        n_faint += night.spot[0].faint;
        assert_int_equal(find_only_track()->state, GLINT_LAMP_STEADY);
        if (frame == 0)
            id = find_only_track()->id;
        assert_int_equal(find_only_track()->id, id);
    }
    assert_true(n_faint > 30);
}

/* Checks that a spot (lamp found in one frame) that is faint from the start
 * begins no track. A faint spot much larger than a lamp, such as a wall, must
 * not continue the track of a lamp. */
TEST(faint_spots_begin_no_track)
{
    struct glint_spot spot[2] = {{.x_q8 = 100 << 8,
                                  .y_q8 = 100 << 8,
                                  .area = 40,
                                  .flux_q16 = 40 << 16,
                                  .faint = 1}};

    open_night_tracker(320, 200, 0);
    assert_int_equal(glint_lamp_tracker_step(night.tracks, spot, 1, FPS30,
                                             night.track, NIGHT_MAX),
                     0);
    spot[0].faint = 0;
    assert_int_equal(glint_lamp_tracker_step(night.tracks, spot, 1, 1000000,
                                             night.track, NIGHT_MAX),
                     1);
    spot[0].faint = 1;
    /* The spot is now more than four times as large as the lamp, which has 40
     * pixels. */
    spot[0].area = 161;
    glint_lamp_tracker_step(night.tracks, spot, 1, FPS30, night.track,
                            NIGHT_MAX);
    assert_int_equal(night.track[0].state, GLINT_LAMP_FADING);
    glint_lamp_tracker_step(night.tracks, spot, 1, FPS30, night.track,
                            NIGHT_MAX);
    spot[0].area = 160;
    glint_lamp_tracker_step(night.tracks, spot, 1, FPS30, night.track,
                            NIGHT_MAX);
    assert_int_equal(night.track[0].state, GLINT_LAMP_RISING);
}

/* -------------------------------------------- convergence to a still image */

static bool track_equals_spot(const struct glint_lamp_track *t,
                              const struct glint_spot *s)
{
    return t->state == GLINT_LAMP_STEADY && t->level_q15 == FULL &&
           t->x_q8 == s->x_q8 && t->y_q8 == s->y_q8 &&
           t->size_q8 == s->size_q8 && t->flux_q16 == s->flux_q16 &&
           t->power_q16 == s->power_q16 && t->axis_q8[0] == s->axis_q8[0] &&
           t->axis_q8[1] == s->axis_q8[1] &&
           memcmp(t->rgb_q15, s->rgb_q15, sizeof t->rgb_q15) == 0;
}

/* Returns whether each track equals its spot (lamp of this frame), and each
 * spot that is not marked faint has a track. */
static bool tracks_equal_spots(void)
{
    int n_lights = 0;

    for (int i = 0; i < night.n_spots; i++)
        n_lights += !night.spot[i].faint;
    for (int i = 0; i < night.n_tracks; i++) {
        const struct glint_lamp_track *t = &night.track[i];

        if (!track_equals_spot(
                t, &night.spot[night_find_spot(&night, t->x_q8 / 256.0,
                                               t->y_q8 / 256.0)]))
            return false;
    }
    return night.n_tracks >= n_lights;
}

/* Repeats an image after noise or motion. Checks that tracks become exactly
 * equal to the spots after the attack time + 1 s or after five frames, at any
 * frame rate. */
TEST(tracks_converge_exactly_to_a_still)
{
    static const int32_t rates[] = {1000, FPS60, FPS30, 200000, 1000000};
    double slowest = 0;

    for (int k = 0; k < 5 * 20; k++) {
        struct night_lamp lamp[3] = {
            {80, 60, 7, 2}, {200, 110, 4, 1.2}, {130, 150, 2, 5}};
        const int32_t us = rates[k % 5];
        int n_settled = 0, n_frames = 0;

        open_night_tracker(320, 200, 3);
        night.seed = (uint32_t)k;
        for (int frame = 0; frame < 10; frame++) {
            for (int i = 0; i < 3; i++) {
                lamp[i].x += rng_int_below(&night.seed, 7) - 3;
                lamp[i].light *= 0.8 + rng_int_below(&night.seed, 5) * 0.1;
            }
            night_draw_and_track(&night, lamp, 3, us);
        }
        night.n_spots = glint_lamp_finder_find(night.finder, &night.image,
                                               night.spot, NIGHT_MAX);
        for (; n_frames < 5 || n_frames * (int64_t)us < 1200000; n_frames++) {
            night.n_tracks =
                glint_lamp_tracker_step(night.tracks, night.spot, night.n_spots,
                                        us, night.track, NIGHT_MAX);
            n_settled = tracks_equal_spots() ? n_settled + 1 : 0;
        }
        if (us < 200000)
            slowest = fmax(slowest, (n_frames - n_settled + 1) * (us * 1e-6));
        assert_true(n_settled > 0);
        assert_true(night.n_tracks > 0);
    }
    print_message("settled after %.3f s at most, from 30 to 1000 a second\n",
                  slowest);
}

/* ------------------------------------------------------------------ motion */

/* Checks that the track of a moving lamp is within half a pixel of the lamp at
 * speeds of 0.05 to 12 pixels per frame, with and without noise. */
TEST(moving_lamp_does_not_lag)
{
    static const double speeds[] = {0.05, 0.1, 0.2, 0.5, 1, 2, 4, 8, 12};

    for (int k = 0; k < 18; k++) {
        const double speed = speeds[k % 9];
        struct moments lag = {0, 0, 0};
        double most = 0;
        uint32_t id = 0;

        open_night_tracker(640, 200, k < 9 ? 0 : 3);
        for (int frame = 0; frame < 45; frame++) {
            const struct night_lamp lamp = {40.3 + speed * frame,
                                            100.4 - 0.1 * speed * frame, 6, 3};
            const struct glint_lamp_track *t;

            night_draw_and_track(&night, &lamp, 1, FPS30);
            t = find_only_track();
            id = frame ? id : t->id;
            assert_int_equal(t->id, id);
            if (frame < 15)
                continue;
            most = fmax(most, hypot(t->x_q8 / 256.0 - lamp.x,
                                    t->y_q8 / 256.0 - lamp.y));
            add_value_to_moments(&lag, lamp.x - t->x_q8 / 256.0);
        }
        print_message("%5.2f px a frame%s: behind by %.3f px, off by %.3f\n",
                      speed, k < 9 ? "" : " in noise", compute_mean(&lag),
                      most);
        assert_true(most < 0.5);
    }
}

/* Checks that a wide lamp in a shaky pan, which reverses its direction twice
 * per second, is tracked within a pixel, with and without noise. */
TEST(shaken_lamp_does_not_lag)
{
    for (int k = 0; k < 2; k++) {
        double most = 0;

        open_night_tracker(640, 200, k ? 3 : 0);
        for (int frame = 0; frame < 60; frame++) {
            const struct night_lamp lamp = {
                500.3 - 4 * frame - 25 * sin(frame / 3.0), 100.4, 15, 3};
            const struct glint_lamp_track *t;

            night_draw_and_track(&night, &lamp, 1, FPS30);
            t = find_only_track();
            most = fmax(most, fabs(t->x_q8 / 256.0 - lamp.x));
        }
        print_message("shaken%s: off by %.3f px\n", k ? " in noise" : "", most);
        assert_true(most < 1);
    }
}

/* Checks that a lamp that was stationary for two seconds and then moves by 2
 * pixels per frame is followed from the first frame on. */
TEST(starting_lamp_is_followed_at_once)
{
    for (int k = 0; k < 2; k++) {
        open_night_tracker(320, 200, 2 * k);
        for (int frame = 0; frame < 80; frame++) {
            const struct night_lamp lamp = {
                60 + (frame < 60 ? 0 : 2.0 * (frame - 59)), 100, 6, 3};

            night_draw_and_track(&night, &lamp, 1, FPS30);
            assert_true(fabs(find_only_track()->x_q8 / 256.0 - lamp.x) < 0.5);
        }
    }
}

/* Moves a lamp of RADIUS by SPEED pixels per frame from frame FIRST to frame
 * LAST, and draws 20 frames. Returns the max distance, pixels, between the
 * lamp's track and its centroid. */
static double measure_lag_in_pan_px(double radius, double speed, int first,
                                    int last)
{
    double furthest = 0;

    init_night(speed < 10 ? 320 : (int)(32 * speed), 120);
    night.sigma = 2;
    assert_true(night_open_tracker(&night));
    for (int frame = 0; frame < 20; frame++) {
        const int n_moves =
            frame < first ? 0 : (frame < last ? frame : last) - first;
        const struct night_lamp lamp = {30.3 + speed * n_moves, 60.4, radius,
                                        3};
        const struct glint_lamp_track *t;

        night_draw_and_track(&night, &lamp, 1, 40000);
        t = find_only_track();
        assert_int_equal(t->id, 1);
        furthest = fmax(furthest, hypot(t->x_q8 - night.spot[0].x_q8,
                                        t->y_q8 - night.spot[0].y_q8) /
                                      256);
    }
    return furthest;
}

/* Checks that a lamp in a pan of up to 3 % of the image width per frame is
 * tracked within a pixel from its second frame on, also when the pan starts or
 * stops. */
TEST(lamps_are_followed_in_a_pan)
{
    static const double speeds[] = {3, 13, 40}, radii[] = {1.5, 3, 8};
    static const int range[][2] = {{0, 20}, {8, 20}, {0, 8}, {8, 14}};

    for (int k = 0; k < 3 * 3 * 4; k++) {
        const double speed = speeds[k / 12], radius = radii[k / 4 % 3];
        const int first = range[k % 4][0], last = range[k % 4][1];
        const double off = measure_lag_in_pan_px(radius, speed, first, last);

        print_message("radius %.1f, %2.0f px a frame in %d..%d: %.2f px\n",
                      radius, speed, first, last, off);
        assert_true(off < 1);
    }
}

/* Moves a lamp of RADIUS into the picture at SPEED pixels per frame. Returns
 * the max distance, pixels, between its track and its centroid over the first
 * eight frames in which it is visible. */
static double measure_lag_at_entry_px(double radius, double speed)
{
    double furthest = 0;
    int n = 0;

    init_night((int)fmax(320, 16 * speed), 120);
    night.sigma = 2;
    assert_true(night_open_tracker(&night));
    for (int frame = 0; n < 8; frame++) {
        const struct night_lamp lamp = {0.3 - radius + speed * frame, 60.4,
                                        radius, 3};

        assert_true(frame < 60);
        night_draw_and_track(&night, &lamp, 1, 40000);
        if (night.n_tracks == 0)
            continue;
        assert_int_equal(night.n_spots, 1);
        furthest =
            fmax(furthest, hypot(night.track[0].x_q8 - night.spot[0].x_q8,
                                 night.track[0].y_q8 - night.spot[0].y_q8) /
                               256);
        n++;
    }
    return furthest;
}

/* Checks that a lamp that enters the picture in a fast pan is followed from its
 * second frame on. At 3 pixels per frame, it enters over many frames; the
 * change of its visible shape must not count as motion. */
TEST(lamp_entering_in_a_pan_is_followed)
{
    static const double speeds[] = {3, 13, 40}, radii[] = {1.5, 3, 8, 20};

    for (int k = 0; k < 3 * 4; k++) {
        const double off = measure_lag_at_entry_px(radii[k % 4], speeds[k / 4]);

        print_message("radius %.1f, %2.0f px a frame: %.2f px\n", radii[k % 4],
                      speeds[k / 4], off);
        assert_true(off < (k < 4 ? 5 : 0.5));
    }
}

/* Checks a lamp that is hidden for a second and returns 25 pixels away. Per
 * frame a lamp may move 0.06 of 320 pixels, that is 19, so a new track must
 * fade in there. */
TEST(returning_lamp_gets_a_new_track)
{
    for (int k = 0; k < 2; k++) {
        struct night_lamp lamp[2] = {{60, 60, 5, 3}, {200, 100, 5, 3}};

        open_night_tracker(320, 200, 0);
        for (int frame = 0; frame < 10; frame++)
            night_draw_and_track(&night, lamp, 2, FPS30);
        for (int frame = 0; frame < (k ? 30 : 1); frame++)
            night_draw_and_track(&night, lamp, 1, FPS30);
        lamp[1] = (struct night_lamp){225, 100, 7, 3};
        night_draw_and_track(&night, lamp, 2, FPS30);
        if (k) {
            const struct glint_lamp_track *t =
                &night.track[night_find_track(&night, 225, 100)];

            assert_int_equal(night.n_tracks, 2);
            assert_in_range(t->id, 1, 2);
            assert_int_equal(t->state, GLINT_LAMP_RISING);
            assert_true(fabs(t->x_q8 / 256.0 - 225) < 0.05);
            assert_true(t->flux_q16 ==
                        night.spot[night_find_spot(&night, 225, 100)].flux_q16);
        } else {
            assert_int_equal(night.n_tracks, 3);
            assert_int_equal(night.track[night_find_track(&night, 225, 100)].id,
                             3);
        }
    }
}

/* Checks that two lamps that meet and pass each other keep their ids, as the
 * tracker predicts their motion. */
TEST(passing_lamps_keep_their_ids)
{
    uint32_t id[2] = {0, 0};

    open_night_tracker(640, 200, 2);
    for (int frame = 0; frame < 100; frame++) {
        const struct night_lamp lamp[2] = {{120 + 4.0 * frame, 92, 4, 3},
                                           {520 - 4.0 * frame, 112, 4, 3}};

        night_draw_and_track(&night, lamp, 2, FPS30);
        assert_int_equal(night.n_tracks, 2);
        for (int i = 0; i < 2; i++) {
            const uint32_t is =
                night.track[night_find_track(&night, lamp[i].x, lamp[i].y)].id;

            id[i] = frame ? id[i] : is;
            assert_int_equal(is, id[i]);
        }
    }
    assert_true(id[0] != id[1]);
}

/* Checks a fast lamp that leaves to the right: its track continues off-screen
 * at the same speed and fades out in 400 ms, by at most 1 / 12 per frame. */
TEST(leaving_lamp_continues_and_fades)
{
    double last_x = 0, last_power = 0;
    int n_outside = 0, n_leaving = 0;

    open_night_tracker(320, 200, 2);
    for (int frame = 0; frame < 50; frame++) {
        const struct night_lamp lamp = {100 + 9.0 * frame, 100, 5, 3};
        const struct glint_lamp_track *t;

        night_draw_and_track(&night, &lamp, 1, FPS30);
        if (night.n_tracks == 0)
            break;
        t = find_only_track();
        if (frame > 10 && lamp.x < 310) {
            assert_true(fabs(t->x_q8 / 256.0 - lamp.x) < 0.5);
        } else if (t->state == GLINT_LAMP_LEAVING) {
            n_leaving++;
            assert_true(fabs(t->x_q8 / 256.0 - last_x - 9) < 3);
            assert_true(night_track_power(t) < last_power);
        }
        n_outside += t->x_q8 > 320 << 8;
        last_x = t->x_q8 / 256.0;
        last_power = night_track_power(t);
    }
    assert_int_equal(night.n_tracks, 0);
    /* the twelfth step of the fade reaches 0 */
    assert_int_equal(n_leaving, 11);
    assert_true(n_outside >= 8);
}

/* ---------------------------------------------------------- rise, fade, cut */

/* Returns the fade level, 0 .. 1, of a lamp US microseconds after it was
 * switched on, with a frame every ELAPSED_US. */
static double level_after_switch_on(int32_t us, int32_t elapsed_us,
                                    int32_t attack_ms)
{
    const struct night_lamp lamp[2] = {{60, 60, 5, 3}, {200, 120, 5, 3}};
    double level;

    init_night(320, 200);
    night.cfg.attack_ms = attack_ms;
    assert_true(night_open_tracker(&night));
    night_draw_and_track(&night, lamp, 1, elapsed_us);
    night_draw_and_track(&night, lamp, 1, elapsed_us);
    for (int32_t t = elapsed_us; t <= us + 10; t += elapsed_us) {
        night_draw_and_track(&night, lamp, 2, elapsed_us);
        assert_int_equal(
            night.track[night_find_track(&night, 60, 60)].level_q15, FULL);
    }
    assert_int_equal(night.n_tracks, 2);
    level = night.track[night_find_track(&night, 200, 120)].level_q15 / 32768.0;
    return level;
}

TEST(rise_does_not_depend_on_the_frame_rate)
{
    for (int k = 1; k <= 10; k++) {
        const double at30 = level_after_switch_on(k * FPS30, FPS30, 300);
        const double at60 = level_after_switch_on(k * FPS30, FPS60, 300);
        const double at1000 = level_after_switch_on(k * FPS30, 1000, 300);

        assert_true(fabs(at30 - at60) < 0.02 * at30);
        assert_true(fabs(at30 - at1000) < 0.02);
        assert_true(fabs(at30 - fmin(1, k * FPS30 / 300e3)) < 1e-3);
    }
    assert_true(level_after_switch_on(4 * 50000, 50000, 200) == 1);
}

/* Checks a frame with all lamps at other positions: old tracks must end, and
 * new ones have full power immediately. */
TEST(cut_restarts_in_one_frame)
{
    static const struct night_lamp before[] = {
        {60, 50, 6, 3}, {200, 120, 5, 2}, {120, 160, 3, 4}};
    static const struct night_lamp after[] = {
        {110, 60, 4, 3}, {260, 40, 7, 2}, {62, 120, 3, 4}, {202, 124, 2, 3}};

    open_night_tracker(320, 200, 3);
    for (int frame = 0; frame < 20; frame++) {
        night_draw_and_track(&night, before, 3, FPS30);
        assert_int_equal(glint_lamp_tracker_was_cut(night.tracks), frame == 0);
    }
    for (int frame = 0; frame < 20; frame++) {
        night_draw_and_track(&night, after, 4, FPS30);
        assert_int_equal(glint_lamp_tracker_was_cut(night.tracks), frame == 0);
        assert_int_equal(night.n_tracks, 4);
        for (int i = 0; i < 4; i++) {
            const struct glint_lamp_track *t = &night.track[i];

            assert_true(t->id > 3);
            assert_int_equal(t->level_q15, FULL);
            assert_int_equal(t->state, GLINT_LAMP_STEADY);
            assert_true(
                hypot(t->x_q8 / 256.0 - after[t->id > 7 ? 0 : 0].x, 0) >= 0);
            if (frame == 0) {
                const struct glint_spot *s = &night.spot[night_find_spot(
                    &night, t->x_q8 / 256.0, t->y_q8 / 256.0)];

                assert_true(track_equals_spot(t, s));
            }
        }
    }
}

/* Checks that three lamps vanishing or appearing together are treated as a cut
 * to or from a dark scene, but that two, which may just be hidden, fade. */
TEST(cut_to_a_dark_scene_is_detected)
{
    static const struct night_lamp lamp[] = {
        {60, 50, 6, 3}, {200, 120, 5, 2}, {120, 160, 4, 4}};

    for (int n = 2; n <= 3; n++) {
        open_night_tracker(320, 200, 2);
        for (int frame = 0; frame < 5; frame++)
            night_draw_and_track(&night, lamp, n, FPS30);
        night_draw_and_track(&night, lamp, 0, FPS30);
        assert_int_equal(night.n_tracks, n == 3 ? 0 : 2);
        for (int frame = 0; frame < 20; frame++)
            night_draw_and_track(&night, lamp, 0, FPS30);
        assert_int_equal(night.n_tracks, 0);
        night_draw_and_track(&night, lamp, n, FPS30);
        assert_int_equal(night.n_tracks, n);
        for (int i = 0; i < n; i++) {
            assert_int_equal(night.track[i].level_q15 == FULL, n == 3);
            assert_int_equal(night.track[i].id > (unsigned)n, n == 3);
        }
    }
}

/* Checks that the following are not treated as cuts: one of three lamps
 * vanishes, another appears, the camera pans. */
TEST(single_changes_are_not_cuts)
{
    open_night_tracker(640, 200, 3);
    for (int frame = 0; frame < 60; frame++) {
        const double pan = frame < 20 ? 0 : 7.0 * (frame - 20);
        const struct night_lamp lamp[] = {{60 + pan, 50, 6, 3},
                                          {200 + pan, 120, 6, 3},
                                          {320 + pan, 60, 6, 3},
                                          {120 + pan, 160, 6, 3}};

        night_draw_and_track(&night, lamp + (frame == 30), 3 + (frame > 40),
                             FPS30);
        assert_int_equal(glint_lamp_tracker_was_cut(night.tracks), frame == 0);
    }
}

/* ----------------------------------------------- clipped and limited lamps */

/* Returns the power of the star of a clipped lamp (engine/frame/frame_star.c):
 * the scaled cube of the width of its white spot, clamped to 1 .. 32 times its
 * power. */
static double compute_star_power_of_track(const struct glint_lamp_track *t)
{
    const double photo_airy = 0.55e-3 * 22 / 43.27 * hypot(160, 120);

    return fmin(32 * night_track_power(t),
                fmax(night_track_power(t),
                     0.5 * pow(4.443 * t->size_q8 / 256, 3) / photo_airy));
}

/* Checks the power of a clipped lamp, estimated from the visible pixels of its
 * rim, in noise of 8 codes: it must neither jump nor drift. When the lamp drops
 * to a third of its light, the track must follow within a second. */
TEST(power_of_a_clipped_lamp_is_steady_in_noise)
{
    static const struct night_lamp lamps[] = {
        {80, 60, 4, 1.5}, {80, 60, 1.5, 6}, {80, 60, 2, 6}};

    for (int k = 0; k < 3; k++) {
        struct night_lamp lamp = lamps[k];
        double last = 0, least = HUGE_VAL, most = 0, step = 0;
        double star = 0, star_step = 0;

        open_night_tracker(160, 120, 8);
        for (int i = 0; i < 200; i++) {
            night_draw_and_track(&night, &lamp, 1, 40000);
            if (i < 25)
                continue;
            assert_int_equal(night.n_tracks, 1);
            step = fmax(
                step,
                last > 0 ? fabs(night_track_power(night.track) / last - 1) : 0);
            last = night_track_power(night.track);
            least = fmin(least, last);
            most = fmax(most, last);
            star_step = fmax(
                star_step,
                star ? fabs(compute_star_power_of_track(night.track) / star - 1)
                     : 0);
            star = compute_star_power_of_track(night.track);
        }
        print_message(
            "%g px: steps of %.1f %%, %.0f %% in all, %.1f %% of its star\n",
            lamp.radius, 100 * step, 100 * (most / least - 1), 100 * star_step);
        assert_true(step < 0.1 && most < 1.35 * least && star_step < 0.1);
        lamp.light /= 3;
        for (int i = 0; i < 25; i++)
            night_draw_and_track(&night, &lamp, 1, 40000);
        assert_true(night_track_power(night.track) < 0.6 * last);
    }
}

/* Checks that the same four of ten lamps are drawn in each frame, although
 * noise changes which lamp the finder ranks fourth. When another lamp becomes
 * much brighter, it must fade in while one of the four fades out. */
TEST(limited_lamps_do_not_flicker)
{
    struct night_lamp lamp[10];
    int turns = 0, n = 0;
    uint32_t last = 0;

    init_night(320, 200);
    night.sigma = 3;
    night.cfg.max_shown = 4;
    assert_true(night_open_tracker(&night));
    for (int i = 0; i < 10; i++)
        lamp[i] = (struct night_lamp){30 + 60 * (i % 5), 50 + 100 * (i / 5),
                                      i < 3 ? 8 : 4, 3};
    for (int frame = 0; frame < 100; frame++) {
        night_draw_and_track(&night, lamp, 10, FPS30);
        assert_int_equal(night.n_tracks, 4);
        for (int i = 0; i < 4; i++)
            assert_int_equal(night.track[i].level_q15, FULL);
        turns += frame > 0 && night.spot[3].x_q8 / 2560 != n;
        n = night.spot[3].x_q8 / 2560;
        last = frame ? last : night.track[3].id;
        assert_int_equal(night.track[3].id, last);
    }
    assert_true(turns > 10);
    lamp[9].radius = 10;
    for (int frame = 0; frame < 6; frame++)
        night_draw_and_track(&night, lamp, 10, FPS30);
    n = night_find_track(&night, lamp[9].x, lamp[9].y);
    assert_in_range(night.n_tracks, 4, 5);
    assert_true(night.track[n].level_q15 > 30000);
    night_draw_and_track(&night, lamp, 10, FPS30);
    assert_int_equal(night.n_tracks, 4);
}

/* Checks that if there are more lights than tracks, the five brightest are
 * drawn in each frame. */
TEST(brightest_lights_get_tracks)
{
    static struct glint_spot spot[NIGHT_MAX];

    init_night(640, 480);
    night.cfg.max_tracks = night.cfg.max_shown = 8;
    assert_true(night_open_tracker(&night));
    for (int i = 0; i < 100; i++)
        spot[i] = (struct glint_spot){.x_q8 = i % 10 * 60 << 8,
                                      .y_q8 = i / 10 * 45 << 8,
                                      .area = 10,
                                      .flux_q16 = (1 + i * 37 % 101) << 16,
                                      .power_q16 = (1 + i * 37 % 101) << 16};
    for (int step = 0; step < 3; step++) {
        assert_int_equal(glint_lamp_tracker_step(night.tracks, spot, 100, FPS30,
                                                 night.track, 5),
                         5);
        for (int i = 0; i < 5; i++)
            assert_true(night.track[i].flux_q16 >= 97 << 16);
    }
}
