/* SPDX-License-Identifier: MIT
 *
 * Checks the engine's public API: invalid arguments are rejected, reports match
 * the frame, and images are equal in the engine's and in the caller's memory.
 */
#include "support/opened.h"

static struct glint_error error;
static struct glint_engine_config cfg;
static struct glint_engine *engine;
static struct glint_engine_report report;

enum { WIDTH = 160, HEIGHT = 120, BYTES = 3 * WIDTH * HEIGHT };

/* Draws two white lamps on grey into PX and returns the image. */
static struct glint_image draw_lamp_picture(uint8_t *px)
{
    struct glint_image image = glint_image_over(px, GLINT_RGB24, WIDTH, HEIGHT);

    memset(px, 40, BYTES);
    for (int k = 0; k < 2; k++)
        for (int y = 0; y < 4; y++)
            memset(px + 3 * ((30 + 50 * k + y) * WIDTH + 40 + 60 * k), 255,
                   3 * (size_t)(4 + 2 * k));
    return image;
}

static struct glint_engine *create_engine(void)
{
    struct glint_engine *created;

    assert_ok(glint_engine_create(&created, &cfg, &error));
    return created;
}

/* Replaces the engine of the test by one of the configuration CFG. */
static void open_engine(void)
{
    glint_engine_destroy(engine);
    engine = create_engine();
}

TEST_BEFORE
{
    glint_engine_defaults(&cfg, WIDTH, HEIGHT);
    cfg.model = &opened.lens.model.lens;
    open_engine();
}

TEST_AFTER
{
    glint_engine_destroy(engine);
    engine = NULL;
}

/* Draws the picture of draw_lamp_picture() into PX, US microseconds after the
 * previous one, and adds the flare of the lamps that the engine finds in it.
 * Returns the number of lamps. */
static int draw_flare_of_found_lamps(int32_t us, uint8_t *px)
{
    struct glint_engine_lamp lamps[8];
    const struct glint_image image = draw_lamp_picture(px);
    const int n = glint_engine_find(engine, &image, us, lamps, 8);

    assert_ok(glint_engine_draw(engine, lamps, n, &image, &report));
    return n;
}

TEST(draws_flares_of_found_lamps)
{
    static uint8_t px[BYTES], plain[BYTES];

    draw_lamp_picture(plain);
    assert_int_equal(draw_flare_of_found_lamps(0, px), 2);
    assert_int_equal(report.lights, 2);
    assert_true(report.ghosts > 0 && report.stats.bundles > 0 &&
                report.scale > 0);
    assert_int_equal(report.stats.dropped_bundles, 0);
    assert_true(report.need_bytes > 0 &&
                report.need_bytes <= report.arena_bytes);
    assert_memory_not_equal(px, plain, BYTES);
}

/* Checks that the engine draws the same image in its own and in the caller's
 * memory, and that it reports the required size if the caller's memory is too
 * small. */
TEST(callers_memory_gives_the_same_image)
{
    static uint8_t want[BYTES], got[BYTES];
    size_t need_bytes;

    cfg.arena_bytes = 16 << 20;
    open_engine();
    draw_flare_of_found_lamps(0, want);
    need_bytes = report.need_bytes;
    assert_int_equal(posix_memalign(&cfg.arena, 64, 16 << 20), 0);
    open_engine();
    draw_flare_of_found_lamps(0, got);
    assert_memory_equal(got, want, BYTES);
    assert_int_equal(report.stats.dropped_bundles, 0);
    cfg.arena_bytes = 1100 << 10;
    open_engine();
    draw_flare_of_found_lamps(0, got);
    assert_true(report.stats.dropped_bundles > 0);
    assert_int_equal(report.need_bytes, need_bytes);
    glint_engine_destroy(engine);
    engine = NULL;
    free(cfg.arena);
}

/* Checks that both lamps of a video are found after 30 frames, and that lower
 * quality parameters draw fewer ray bundles. */
TEST(tracked_lamps_are_present_after_30_frames)
{
    static uint8_t px[BYTES];
    int n = 0, bundles;

    for (int i = 0; i < 30; i++)
        n = draw_flare_of_found_lamps(40000, px);
    assert_int_equal(n, 2);
    bundles = report.stats.bundles;
    glint_engine_set_dials(
        engine,
        glint_dials_coarser(glint_dials_at(1 << 14), glint_dials_at(1 << 12)));
    draw_flare_of_found_lamps(40000, px);
    assert_in_range(report.stats.bundles, 1, bundles - 1);
}

/* Draws LAMP alone on grey into PX, with its flare, US microseconds after the
 * previous image; US < 0: time unknown. Returns the exposure. */
static double draw_flare_of_given_lamp(const struct glint_lamp *lamp,
                                       int32_t us, uint8_t *px)
{
    struct glint_engine_lamp one = glint_engine_lamp_of(lamp, 1);
    const struct glint_image image = draw_lamp_picture(px);

    memset(px, 40, BYTES);
    if (us >= 0)
        glint_engine_elapsed(engine, us);
    assert_ok(glint_engine_draw(engine, &one, 1, &image, &report));
    return report.scale;
}

/* Checks that a lamp given by the caller is exposed like a lamp that the engine
 * finds. In a still image, a small rendering of its flare sets the exposure,
 * whatever was drawn before. In a video, the exposure changes by small
 * steps. */
TEST(given_lamp_is_exposed_like_a_found_one)
{
    static uint8_t px[BYTES], found[BYTES], again[BYTES];
    const struct glint_image image = draw_lamp_picture(px);
    const struct glint_lamp dim = {12, 0, 20, {1, 1, 1}, {0, 0}, 0};
    const struct glint_lamp lit = {12, 0, 2e6, {1, 1, 1}, {0, 0}, 0};
    struct glint_engine_lamp lamps[8];
    double alone, scale;
    int n;

    memcpy(found, px, BYTES);
    n = glint_engine_find(engine, &image, 0, lamps, 8);
    for (int i = 0; i < n; i++)
        /* given, not found */
        lamps[i] = glint_engine_lamp_of(&lamps[i].lamp, 1);
    assert_ok(glint_engine_draw(engine, lamps, n, &image, &report));
    scale = report.scale;
    draw_flare_of_found_lamps(0, found);
    assert_true(fabs(report.scale / scale - 1) < 1e-6);
    alone = draw_flare_of_given_lamp(&dim, -1, px);
    draw_flare_of_given_lamp(&lit, -1, again);
    assert_true(draw_flare_of_given_lamp(&dim, -1, again) == alone);
    assert_memory_equal(px, again, BYTES);
    scale = draw_flare_of_given_lamp(&lit, 0, px);
    for (int i = 0; i < 8; i++) {
        const double next = draw_flare_of_given_lamp(&dim, 40000, px);

        assert_true(next >= scale && next <= 1.1 * scale);
        scale = next;
    }
    assert_true(scale < alone);
}

/* Checks that setting a stop later gives the image of an engine created with
 * that stop, and that a stop wider than the model's is rejected. */
TEST(stop_set_later_equals_stop_at_creation)
{
    static uint8_t open[BYTES], set[BYTES], made[BYTES];
    const double f = glint_real_value(opened.lens.model.lens.header->f_number);

    draw_flare_of_found_lamps(0, open);
    assert_int_equal(glint_engine_stop(engine, f / 2, &error),
                     GLINT_E_ARGUMENT);
    draw_flare_of_found_lamps(0, set);
    assert_memory_equal(set, open, BYTES);
    assert_ok(glint_engine_stop(engine, 3 * f, &error));
    draw_flare_of_found_lamps(0, set);
    assert_memory_not_equal(set, open, BYTES);
    cfg.camera.f_number = 3 * f;
    open_engine();
    draw_flare_of_found_lamps(0, made);
    assert_memory_equal(set, made, BYTES);
    assert_ok(glint_engine_stop(engine, f, &error));
    draw_flare_of_found_lamps(0, set);
    assert_memory_equal(set, open, BYTES);
}

/* Checks that an image of a wrong size, and too many lamps, are rejected by all
 * functions that draw. */
TEST(rejects_images_of_wrong_size)
{
    static uint8_t px[BYTES];
    static float rgb[BYTES];
    struct glint_engine_lamp lamps[8];
    struct glint_image image = draw_lamp_picture(px);
    const int n = glint_engine_find(engine, &image, 0, lamps, 8);
    const int many = GLINT_ENGINE_MAX_LAMPS + 1;

    assert_ok(glint_engine_expose(engine, lamps, n, &image, 1));
    assert_int_equal(glint_engine_draw(engine, lamps, many, &image, &report),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_engine_draw_layer(engine, lamps, many,
                                             GLINT_ENGINE_ALL, rgb, &report),
                     GLINT_E_ARGUMENT);
    image.width--;
    assert_int_equal(glint_engine_draw(engine, lamps, n, &image, &report),
                     GLINT_E_ARGUMENT);
    assert_int_equal(
        glint_engine_draw_at(engine, &lamps[0].lamp, 1, 1, &image, &report),
        GLINT_E_ARGUMENT);
}

/* Checks that the layers of a flare add up to the complete flare, that a given
 * lamp gets a flare without being detected, twice as bright at twice the gain,
 * and that a manual exposure applies from the next image on. */
TEST(layers_add_up_to_the_whole_flare)
{
    static uint8_t px[BYTES];
    static float part[BYTES], all[BYTES], sum[BYTES];
    const struct glint_lamp lamp = {12, 30, 1e5, {1, 1, 1}, {0, 0}, 0};
    const struct glint_image image = draw_lamp_picture(px);
    struct glint_engine_lamp known = glint_engine_lamp_of(&lamp, 1);
    double once = 0, twice = 0;

    cfg.search.max_found = 0;
    cfg.search.more_lamps = 1;
    open_engine();
    assert_int_equal(glint_engine_find(engine, &image, 0, &known, 1), 0);
    assert_ok(glint_engine_expose(engine, &known, 1, &image, 1));
    assert_ok(glint_engine_draw_layer(engine, &known, 1, GLINT_ENGINE_ALL, all,
                                      &report));
    for (unsigned k = GLINT_ENGINE_GHOSTS; k <= GLINT_ENGINE_STAR; k *= 2) {
        assert_ok(glint_engine_draw_layer(engine, &known, 1, k, part, &report));
        for (int i = 0; i < BYTES; i++)
            sum[i] += part[i];
    }
    for (int i = 0; i < BYTES; i++)
        assert_true(fabsf(sum[i] - all[i]) <= 1e-4F * (1 + fabsf(all[i])));
    for (int k = 1; k <= 2; k++) {
        assert_ok(glint_engine_render(engine, &lamp, 1, k, GLINT_ENGINE_GHOSTS,
                                      part, &report));
        for (int i = 0; i < BYTES; i++)
            *(k == 1 ? &once : &twice) += (double)part[i];
    }
    assert_true(once > 0 && fabs(twice / once - 2) < 1e-6);
    cfg.light.by_hand = 1;
    cfg.light.exposure_ev = 3;
    glint_engine_set_light(engine, &cfg.light);
    assert_ok(glint_engine_expose(engine, &known, 1, &image, 1));
    assert_true(glint_engine_exposed(engine)->scale == 8);
}

/* Returns the light of one component of the flare of LAMP, PART (such as
 * GLINT_ENGINE_GHOSTS), US microseconds after the previous picture. */
static double sum_layer_light(const struct glint_lamp *lamp, int32_t us,
                              unsigned part)
{
    static uint8_t px[BYTES];
    static float layer[BYTES];
    struct glint_engine_lamp one = glint_engine_lamp_of(lamp, 1);
    const struct glint_image image = draw_lamp_picture(px);
    double sum = 0;

    glint_engine_elapsed(engine, us);
    assert_ok(glint_engine_expose(engine, &one, 1, &image, 1));
    assert_ok(glint_engine_draw_layer(engine, &one, 1, part, layer, &report));
    for (int i = 0; i < BYTES; i++)
        sum += (double)layer[i];
    return sum;
}

/* Checks that a layer for 16 bits contains the ghosts of a lamp that is just
 * too faint for a visible ghost in 8 bits, with the light that a layer of
 * floats has, at less work. */
TEST(layers_for_16_bits_keep_faint_ghosts)
{
    struct glint_lamp lamp = {12, 30, 1e5, {1, 1, 1}, {0, 0}, 0};
    const unsigned ghosts = GLINT_ENGINE_GHOSTS;
    double floats, codes_16;
    int primitives;

    cfg.light.by_hand = 1;
    open_engine();
    while (sum_layer_light(&lamp, 0, ghosts | GLINT_ENGINE_CODES) > 0)
        lamp.power /= 2;
    floats = sum_layer_light(&lamp, 0, ghosts);
    primitives = report.stats.primitives;
    codes_16 = sum_layer_light(&lamp, 0, ghosts | GLINT_ENGINE_CODES_16);
    assert_true(floats > 0 && fabs(codes_16 / floats - 1) < 0.2);
    assert_true(report.stats.primitives < primitives);
}

/* Checks a lamp that becomes too bright for the exposure of a video: its ghosts
 * are limited, but not its starburst, as the exposure does not change
 * starbursts. */
TEST(limited_lamp_keeps_its_starburst)
{
    const struct glint_lamp faint = {5, 30, 1e2, {1, 1, 1}, {0, 0}, 0};
    const struct glint_lamp sun = {5, 30, 1e6, {1, 1, 1}, {0, 0}, 0};
    double still[2], video[2];

    for (int k = 0; k < 2; k++) {
        const unsigned part = k ? GLINT_ENGINE_STAR : GLINT_ENGINE_GHOSTS;

        still[k] = sum_layer_light(&sun, 0, part);
        sum_layer_light(&faint, 0, part);
        for (int i = 0; i < 3; i++)
            sum_layer_light(&faint, 40000, part);
        video[k] = sum_layer_light(&sun, 40000, part);
        open_engine();
    }
    assert_true(still[0] > 0 && video[0] < 2 * still[0]);
    assert_true(fabs(video[1] / still[1] - 1) < 1e-3);
}

/* Returns the light of the ghosts of the N lamps of LAMPS, whose powers include
 * the exposure. */
static double sum_ghost_light(const struct glint_engine_lamp *lamps, int n)
{
    static float layer[BYTES];
    double sum = 0;

    assert_ok(glint_engine_draw_layer(engine, lamps, n, GLINT_ENGINE_GHOSTS,
                                      layer, &report));
    for (int i = 0; i < BYTES; i++)
        sum += (double)layer[i];
    return sum;
}

/* Checks that the layers of single lamps, one of which has limited ghosts, add
 * up to the layer of all lamps. */
TEST(layers_of_single_lamps_add_up)
{
    static uint8_t px[BYTES];
    const struct glint_lamp faint = {5, 30, 1e2, {1, 1, 1}, {0, 0}, 0};
    const struct glint_lamp sun = {9, -140, 1e6, {1, 1, 1}, {0, 0}, 0};
    struct glint_engine_lamp both[2] = {glint_engine_lamp_of(&faint, 1),
                                        glint_engine_lamp_of(&sun, 2)};
    const struct glint_image image = draw_lamp_picture(px);
    double sum;

    for (int i = 0; i < 4; i++)
        sum_layer_light(&faint, 40000, GLINT_ENGINE_GHOSTS);
    glint_engine_elapsed(engine, 40000);
    assert_ok(glint_engine_expose(engine, both, 2, &image, 1));
    sum = sum_ghost_light(both, 2);
    assert_true(sum > 0);
    assert_true(
        fabs((sum_ghost_light(&both[0], 1) + sum_ghost_light(&both[1], 1)) /
                 sum -
             1) < 1e-3);
}

/* Draws frame I of a video. Lamps appear in frames 1 and 3, fade in, and change
 * the exposure. */
static void draw_frame_of_fading_lamps(struct glint_engine *drawing, int i,
                                       uint8_t *px)
{
    struct glint_engine_lamp lamps[8];
    const struct glint_image image = draw_lamp_picture(px);
    int n;

    if (i < 3) /* The second lamp is in the lower half. */
        memset(px + (i < 1 ? 0 : BYTES / 2), 40, i < 1 ? BYTES : BYTES / 2);
    n = glint_engine_find(drawing, &image, 40000, lamps, 8);
    assert_ok(glint_engine_draw(drawing, lamps, n, &image, &report));
}

/* Checks that the frames of a video are the same if another engine continues it
 * while lamps fade in, and that an engine for pictures of another size
 * cannot. */
TEST(engine_continues_the_video_of_another)
{
    static uint8_t want[BYTES], got[BYTES];
    struct glint_engine *const whole = create_engine();
    struct glint_engine *const first = create_engine();
    struct glint_engine *small;

    for (int i = 0; i < 12; i++) {
        draw_frame_of_fading_lamps(whole, i, want);
        if (i == 5)
            assert_ok(glint_engine_continue(engine, first));
        draw_frame_of_fading_lamps(i < 5 ? first : engine, i, got);
        assert_memory_equal(got, want, BYTES);
    }
    glint_engine_defaults(&cfg, WIDTH, HEIGHT - 2);
    cfg.model = &opened.lens.model.lens;
    small = create_engine();
    assert_int_equal(glint_engine_continue(small, engine), GLINT_E_ARGUMENT);
    draw_frame_of_fading_lamps(whole, 12, want);
    draw_frame_of_fading_lamps(engine, 12, got);
    assert_memory_equal(got, want, BYTES);
    glint_engine_destroy(small);
    glint_engine_destroy(first);
    glint_engine_destroy(whole);
}

/* Returns the max difference between the mean codes of blocks of 16 x 16 pixels
 * of A and B, per channel. */
static double find_max_block_step(const uint8_t *a, const uint8_t *b)
{
    enum { SIDE = 16 };
    double most = 0;

    for (int at = 0; at < BYTES / SIDE / SIDE; at++) {
        const int c = at % 3, x = at / 3 % (WIDTH / SIDE) * SIDE;
        const int y = at / 3 / (WIDTH / SIDE) * SIDE;
        double sum = 0;

        for (int k = 0; k < SIDE * SIDE && y + SIDE <= HEIGHT; k++) {
            const int i = 3 * ((y + k / SIDE) * WIDTH + x + k % SIDE) + c;

            sum += a[i] - b[i];
        }
        most = fmax(most, fabs(sum) / (SIDE * SIDE));
    }
    return most;
}

/* Checks that no block of a video steps visibly when a model takes over from
 * exact rays while lamps fade in: against a video drawn by exact rays only. */
TEST(model_takes_over_from_exact_rays_without_a_step)
{
    static uint8_t want[BYTES], got[BYTES];
    struct glint_engine *whole, *first;
    static struct glint_setup setup;
    double step = 0;

    glint_engine_defaults(&cfg, WIDTH, HEIGHT);
    assert_ok(glint_setup_init(&setup, &opened.lens.table, 8, 0,
                               (const double[]){650, 532, 450}, 3, &error));
    cfg.camera.setup = &setup;
    cfg.camera.rays = &glint_frame_traces;
    cfg.camera.sensor_width_mm = opened.lens.table.film_width_mm;
    cfg.camera.sensor_height_mm = opened.lens.table.film_height_mm;
    whole = create_engine();
    first = create_engine();
    cfg.model = &opened.lens.model.lens;
    cfg.camera.rays = NULL;
    open_engine();
    for (int i = 0; i < 12; i++) {
        draw_frame_of_fading_lamps(whole, i, want);
        if (i == 5)
            assert_ok(glint_engine_continue(engine, first));
        draw_frame_of_fading_lamps(i < 5 ? first : engine, i, got);
        step = fmax(step, find_max_block_step(got, want));
    }
    assert_true(step > 0 && step < 1);
    glint_engine_destroy(first);
    glint_engine_destroy(whole);
}

TEST(rejects_invalid_configurations)
{
    static uint8_t px[BYTES];
    const struct glint_lamp place = {5, 0, 1, {1, 1, 1}, {0, 0}, 0};
    struct glint_engine_lamp lamp = glint_engine_lamp_of(&place, 1);
    struct glint_image image = draw_lamp_picture(px);

    image.height--;
    assert_int_equal(glint_engine_draw(engine, &lamp, 1, &image, &report),
                     GLINT_E_ARGUMENT);
    glint_engine_destroy(engine);
    glint_engine_destroy(NULL);
    for (int k = 0; k < 16; k++) {
        glint_engine_defaults(&cfg, k == 0 ? 0 : WIDTH, HEIGHT);
        cfg.model = k == 1 ? NULL : &opened.lens.model.lens;
        cfg.search.max_found = k == 2 ? 1025 : cfg.search.max_found;
        cfg.light.strength = k == 3 ? -1 : cfg.light.strength;
        cfg.search.threshold_ev[1] = k == 4 ? 0 : cfg.search.threshold_ev[1];
        cfg.camera.n_blades = k == 5 ? 2 : cfg.camera.n_blades;
        cfg.size = k == 6 ? 8 : k == 11 ? cfg.size + 1 : cfg.size;
        cfg.drawing.tile_log2 = k == 7 ? 2 : cfg.drawing.tile_log2;
        cfg.drawing.only_ghost = k == 8 ? 1000 : -1;
        cfg.light.gain = k == 9 ? (double)INFINITY : 1;
        cfg.search.max_drawn = k == 10 ? -1 : 0;
        cfg.light.reserved[15] = k == 12;
        cfg.drawing.dials.reserved[0] = k == 13;
        if (k >= 14)
            cfg.camera.waves = (struct glint_waves){k == 14 ? GLINT_WAVES_COUNT
                                                            : GLINT_WAVES_LIST,
                                                    k == 14 ? 33 : 0,
                                                    {0}};
        *error.text = '\0';
        assert_int_equal(glint_engine_create(&engine, &cfg, &error),
                         GLINT_E_ARGUMENT);
        assert_null(engine);
        assert_true(*error.text != '\0');
    }
}

/* Checks a setup of the lens table with a model, whose ghosts may have several
 * pupil regions (parts): tints and only_ghost are those of the model. */
TEST(ghosts_are_those_of_the_model)
{
    const struct glint_model_header *const h = opened.lens.model.lens.header;
    struct glint_tint *const tints =
        test_free_later(calloc(h->n_ghosts, sizeof *tints));
    const int n = (int)(h->n_ghosts - h->n_parts);
    static uint8_t px[BYTES], plain[BYTES];
    static struct glint_setup setup;

    assert_ok(glint_setup_init(&setup, &opened.lens.table, 8, 0,
                               (const double[]){650, 532, 450}, 3, &error));
    cfg.camera.setup = &setup;
    cfg.camera.tints = tints;
    cfg.drawing.parts = GLINT_ENGINE_GHOSTS;
    open_engine();
    draw_flare_of_found_lamps(0, px);
    draw_lamp_picture(plain);
    assert_memory_equal(px, plain, BYTES);
    setup.n_ghosts = n + 1;
    cfg.drawing.only_ghost = n;
    glint_engine_destroy(engine);
    assert_int_equal(glint_engine_create(&engine, &cfg, &error),
                     GLINT_E_ARGUMENT);
}

/* Checks a program compiled for an older library, whose configuration struct is
 * shorter: missing members must get their defaults, whatever the memory behind
 * the struct contains. */
TEST(shorter_config_of_older_programs_gets_defaults)
{
    const size_t bytes = offsetof(struct glint_engine_config, cache);

    memset(&cfg, 0x55, sizeof cfg);
    glint_engine_defaults_sized(&cfg, bytes, WIDTH, HEIGHT);
    assert_int_equal(((unsigned char *)&cfg)[bytes], 0x55);
    cfg.model = &opened.lens.model.lens;
    open_engine();
}

/* Checks the options struct of an older program, which lacks the last option.
 * The library must not write behind the end of the struct. All other options
 * must have an effect, and the missing option must be unknown and have its
 * default. */
TEST(shorter_options_of_older_programs_are_respected)
{
    const size_t bytes = offsetof(struct glint_options, tile);
    struct glint_options o, *const older = test_free_later(malloc(bytes));

    memset(&o, 0x55, sizeof o);
    glint_options_defaults_sized(&o, bytes);
    assert_int_equal(((unsigned char *)&o)[bytes], 0x55);
    assert_ok(glint_options_set(&o, "strength", 0.25, &error));
    assert_ok(glint_options_set(&o, "whole", 3, &error));
    assert_int_equal(glint_options_set(&o, "tile", 1, &error),
                     GLINT_E_ARGUMENT);
    memcpy(older, &o, bytes);
    assert_int_equal(glint_options_quality(older).dials.fineness,
                     glint_dials_at(1 << 14).fineness);
    glint_engine_configure(&cfg, older);
    assert_true(cfg.light.strength == 0.25);
    assert_int_equal(cfg.drawing.dials.snap_codes_q8, 3 << 8);
    assert_int_equal(cfg.drawing.tile_log2, 6);
}

/* Checks that options set by name draw the same image as a configuration with
 * the same values, and that fixed, unknown or out-of-range options change
 * nothing. */
TEST(options_by_name_equal_the_configuration)
{
    static uint8_t set[BYTES], made[BYTES];
    const char *const bad[] = {"veil", "strengt", "gain"};

    assert_ok(glint_engine_set(engine, "exposure", 3, &error));
    assert_ok(glint_engine_set_text(engine, "gain", "2", &error));
    for (int k = 0; k < 3; k++) {
        assert_int_equal(glint_engine_set(engine, bad[k], -1, &error),
                         GLINT_E_ARGUMENT);
        assert_true(error.text[0] != '\0');
    }
    draw_flare_of_found_lamps(0, set);
    cfg.light.by_hand = 1;
    cfg.light.exposure_ev = 3;
    cfg.light.gain = 2;
    open_engine();
    draw_flare_of_found_lamps(0, made);
    assert_memory_equal(set, made, BYTES);
}

static bool is_option_accepted(struct glint_options *o, const char *name,
                               const char *text)
{
    const bool is_set =
        glint_options_set_text(o, name, text, &error) == GLINT_OK;

    assert_true(is_set || *error.text);
    return is_set;
}

/* Checks that stop, dust and colours set by options equal a setup made step by
 * step. The option front-dust must set the engine's dirt, the option stop must
 * act like glint_engine_iris(). */
TEST(camera_options_equal_a_setup_by_steps)
{
    static uint8_t want[BYTES], got[BYTES];
    const double nm[] = {610, 470};
    const struct glint_lens *const lens = &opened.lens.model.lens;
    struct glint_iris iris = {
        .roundness = 0.3, .softness = 0.1, .dust = 0.02, .dust_seed = 7};
    const struct glint_front front = {.dust = 0.05, .dust_seed = 1};
    struct glint_setup *const setup = test_free_later(malloc(sizeof *setup));
    struct glint_dirt *dirt = NULL;
    struct glint_front_dirt *on_front = NULL;
    struct glint_options o;

    assert_ok(glint_setup_from_model(setup, lens, 6, 10, nm, 2, &error));
    assert_ok(glint_setup_iris(setup, &iris, &dirt, &error));
    glint_setup_balance(setup);
    assert_ok(glint_front_make(&on_front, &front, &error));
    cfg.camera.setup = setup;
    cfg.camera.front = on_front;
    cfg.arena_has_all = 1;
    open_engine();
    draw_flare_of_found_lamps(0, want);

    glint_options_defaults(&o);
    assert_true(
        is_option_accepted(&o, "stop", "polygon:6,10,round:0.3,soft:0.1"));
    assert_true(is_option_accepted(&o, "dust", "0.02,7"));
    assert_true(is_option_accepted(&o, "front-dust", "0.05"));
    assert_true(is_option_accepted(&o, "wavelengths", "610,470"));
    assert_true(is_option_accepted(&o, "balance", NULL));
    glint_engine_defaults(&cfg, WIDTH, HEIGHT);
    glint_engine_configure(&cfg, &o);
    cfg.model = lens;
    open_engine();
    draw_flare_of_found_lamps(0, got);
    assert_memory_equal(got, want, BYTES);

    iris.roundness = iris.softness = 0;
    assert_ok(glint_engine_iris(engine, 5, 0, &iris, &error));
    draw_flare_of_found_lamps(0, want);
    assert_memory_not_equal(got, want, BYTES);
    assert_ok(glint_engine_iris(engine, 0, 0, &iris, &error));
    assert_ok(glint_engine_set_text(engine, "stop", "polygon:5", &error));
    draw_flare_of_found_lamps(0, got);
    assert_memory_equal(got, want, BYTES);
    glint_front_free(on_front);
    glint_dirt_free(dirt);
}

/* Checks that dust in the stop is drawn if it is the only option of the iris
 * that is set. */
TEST(dust_is_drawn_behind_straight_blades)
{
    static uint8_t dusty[BYTES], clean[BYTES];
    const struct glint_iris iris = {.dust = 0.02, .dust_seed = 7};

    draw_flare_of_found_lamps(0, clean);
    assert_ok(glint_engine_iris(engine, 8, 0, &iris, &error));
    draw_flare_of_found_lamps(0, dusty);
    assert_memory_not_equal(dusty, clean, BYTES);
}

/* Checks that a configuration whose member STOPS is NULL accepts only stops
 * with straight blades and without dirt. */
TEST(config_without_stops_accepts_only_clean_blades)
{

    for (int k = 0; k < 3; k++) {
        glint_engine_defaults(&cfg, WIDTH, HEIGHT);
        cfg.model = &opened.lens.model.lens;
        cfg.camera.iris.roundness = k == 1 ? 0.2 : 0;
        cfg.camera.front_dirt.dust = k == 2 ? 0.02 : 0;
        glint_engine_destroy(engine);
        *error.text = '\0';
        assert_int_equal(glint_engine_create(&engine, &cfg, &error),
                         k ? GLINT_E_ARGUMENT : GLINT_OK);
        assert_true(!k == !strstr(error.text, "camera.stops"));
        cfg.camera.stops = &glint_engine_all_stops;
        open_engine();
    }
}

/* Checks that each numeric option accepts its lower limit, rejects values
 * beyond its limits, and counts as given only after it was set. Strength and
 * exposure exclude each other, as do quality and error: the option that was set
 * last is used. */
TEST(options_accept_their_limits)
{
    struct glint_options o;

    glint_options_defaults(&o);
    for (int i = 0; i < GLINT_N_OPTIONS; i++) {
        const struct glint_option *const row = glint_option(i);

        if (row->type != GLINT_OPTION_REAL && row->type != GLINT_OPTION_INTEGER)
            continue;
        *error.text = '\0';
        assert_int_equal(glint_options_set(&o, row->name, row->low - 1, &error),
                         GLINT_E_ARGUMENT);
        if (isfinite(row->high))
            assert_int_equal(
                glint_options_set(&o, row->name, row->high + 1, &error),
                GLINT_E_ARGUMENT);
        assert_true(*error.text != '\0' && !o.given[i]);
        assert_ok(glint_options_set(&o, row->name, row->low, &error));
        assert_true(o.given[i]);
    }
    assert_ok(glint_options_set(&o, "strength", 1, &error));
    assert_false(GLINT_OPTION_GIVEN(&o, exposure));
    assert_ok(glint_options_set(&o, "exposure", 1, &error));
    assert_false(GLINT_OPTION_GIVEN(&o, strength));
    assert_ok(glint_options_set(&o, "quality", 1, &error));
    assert_false(GLINT_OPTION_GIVEN(&o, error));
    assert_ok(glint_options_set(&o, "error", 1, &error));
    assert_false(GLINT_OPTION_GIVEN(&o, quality));
}

/* Checks that every default can be set explicitly, that numbers must be finite,
 * that an empty text restores the default, that flags accept yes and no, and
 * that spaces may precede numbers. */
TEST(options_accept_their_defaults)
{
    struct glint_options o, initial;
    double v[3];

    glint_options_defaults(&o);
    initial = o;
    for (int i = 0; i < GLINT_N_OPTIONS; i++) {
        const struct glint_option *const row = glint_option(i);

        if (row->type == GLINT_OPTION_TEXT) {
            assert_true(!*row->text ||
                        is_option_accepted(&o, row->name, row->text));
            assert_true(is_option_accepted(&o, row->name, "") && !o.given[i]);
            continue;
        }
        assert_true(isnan(row->initial) ||
                    glint_options_set(&o, row->name, row->initial, &error) ==
                        GLINT_OK);
        assert_int_equal(glint_options_set(&o, row->name, INFINITY, &error),
                         GLINT_E_ARGUMENT);
        assert_int_equal(glint_options_set(&o, row->name, NAN, &error),
                         GLINT_E_ARGUMENT);
        assert_true(row->type == GLINT_OPTION_FLAG ||
                    !is_option_accepted(&o, row->name, NULL));
    }
    assert_string_equal(o.wavelengths, initial.wavelengths);
    assert_string_equal(o.threshold, initial.threshold);
    assert_true(is_option_accepted(&o, "half", "yes") && o.half);
    assert_true(is_option_accepted(&o, "half", "no") && !o.half);
    assert_false(is_option_accepted(&o, "half", "maybe"));
    assert_true(is_option_accepted(&o, "strength", " 1.5e0") &&
                o.strength == 1.5);
    assert_false(is_option_accepted(&o, "strength", "1,5"));
    assert_false(is_option_accepted(&o, "no-such-option", "1"));
    assert_int_equal(glint_option_numbers("-1.25, 3", v, 3), 2);
    assert_true(v[0] == -1.25 && v[1] == 3);
    assert_ok(glint_options_set(&o, "veil", 0.5, &error));
    assert_int_equal(glint_options_set(&o, "haze", 0.5, &error),
                     GLINT_E_ARGUMENT);
}

TEST_GROUP(open_heliar_lens, close_opened_lens);
