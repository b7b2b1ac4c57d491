/* SPDX-License-Identifier: MIT
 *
 * Tests the choice of wavelengths. Each ghost must get as many as its
 * dispersion and brightness require, without colour steps that 31 wavelengths
 * would not have. Explicit lists of wavelengths must be used as given.
 */
#include "glint/area.h"
#include "glint/quality.h"
#include "support/settings_frame.h"
#include "support/test.h"

enum { WIDTH = 640, HEIGHT = 360, SAMPLES = 3 * WIDTH * HEIGHT };

static struct tool tool = {.name = "test", .quiet = true, .n_threads = 2};
static struct opened chosen, three, all;
static const struct glint_lamp lamp = {
    .theta_deg = 12, .phi_deg = 33, .power = 3e6, .rgb = {1, 1, 1}};

/* RMS extent of the lamp, tangent; 0: a point */
static double extent;

static struct glint_engine_report draw_lamp_frame(struct glint_frame *frame,
                                                  const struct opened *opened,
                                                  int width, double power,
                                                  uint8_t *rgb)
{
    struct glint_lamp light = lamp;
    struct glint_image image =
        glint_image_over(rgb, GLINT_RGB24, width, width * 9 / 16);
    struct glint_engine_report report;

    light.power *= power;
    glint_area_set_round(&light, extent);
    assert_ok(
        make_frame_from_settings(&tool, opened, width, width * 9 / 16, frame));
    memset(rgb, 0, (size_t)width * (size_t)(width * 9 / 16) * 3);
    assert_ok(glint_frame_draw(frame, &light, 1, 1, &image, &report));
    return report;
}

/* Returns the number of wavelengths planned for GHOST in FRAME. Sets *N_DRAWN
 * to the number of these wavelengths that were drawn. */
static int count_wavelengths_of_ghost(struct glint_frame *frame, int ghost,
                                      int *n_drawn)
{
    int n = 0;

    *n_drawn = 0;
    for (int wave = 0; wave < frame->plan.rays.n_waves; wave++) {
        struct glint_account a;

        glint_flare_account(frame->memory.flare, ghost, 0, wave, &a);
        n += a.outcome != GLINT_OUTCOME_OTHER_SET;
        *n_drawn += a.outcome == GLINT_OUTCOME_DRAWN ||
                    a.outcome == GLINT_OUTCOME_EMPTY;
    }
    return n;
}

/* Sets ghosts[n] to the number of drawn ghosts with n wavelengths, and *BUNDLES
 * to the number of drawn ray bundles. */
static void count_ghosts_by_wavelengths(struct glint_frame *frame,
                                        int ghosts[GLINT_MAX_WAVELENGTHS + 1],
                                        int *bundles)
{
    memset(ghosts, 0, (GLINT_MAX_WAVELENGTHS + 1) * sizeof *ghosts);
    *bundles = 0;
    for (int ghost = 0; ghost < frame->setup->n_ghosts; ghost++) {
        int n_drawn;
        const int n = count_wavelengths_of_ghost(frame, ghost, &n_drawn);

        assert_true(n == 4 || n == 6 || n == 10 || n == 17 || n == 28);
        assert_true(n_drawn <= n);
        ghosts[n] += n_drawn > 0;
        *bundles += n_drawn;
    }
}

/* --------------------------------------------------- number of wavelengths */

static uint8_t picture[SAMPLES], other[SAMPLES], truth[SAMPLES];

TEST(small_image_needs_few_wavelengths)
{
    int ghosts[GLINT_MAX_WAVELENGTHS + 1], bundles;
    struct glint_frame frame;
    struct glint_engine_report report;

    /* In an image only 32 pixels wide, dispersion moves no outline by as much
     * as a pixel. */
    report = draw_lamp_frame(&frame, &chosen, 32, 1, picture);
    count_ghosts_by_wavelengths(&frame, ghosts, &bundles);
    assert_true(ghosts[4] > 0);
    assert_int_equal(ghosts[6] + ghosts[10] + ghosts[17] + ghosts[28], 0);
    assert_int_equal(bundles, report.stats.bundles);
    glint_frame_finish(&frame);
}

TEST(large_image_needs_more_wavelengths)
{
    int ghosts[GLINT_MAX_WAVELENGTHS + 1], bundles, more;
    struct glint_frame frame;
    struct glint_engine_report report;

    report = draw_lamp_frame(&frame, &chosen, WIDTH, 100, picture);
    count_ghosts_by_wavelengths(&frame, ghosts, &bundles);
    more = ghosts[6] + ghosts[10] + ghosts[17] + ghosts[28];
    /* Different ghosts have different numbers of wavelengths. */
    assert_true(ghosts[4] > 0 && more > 0);
    assert_int_equal(bundles, report.stats.bundles);
    assert_int_equal(report.stats.dropped_bundles, 0);
    glint_frame_finish(&frame);
    /* Faint ghosts get at most four wavelengths. */
    draw_lamp_frame(&frame, &chosen, WIDTH, 0.01, other);
    count_ghosts_by_wavelengths(&frame, ghosts, &bundles);
    assert_true(ghosts[4] > 0);
    assert_int_equal(ghosts[6] + ghosts[10] + ghosts[17] + ghosts[28], 0);
    glint_frame_finish(&frame);
}

TEST(dispersion_sets_the_number_of_wavelengths)
{
    int ghosts[GLINT_MAX_WAVELENGTHS + 1], least, bundles, before = 0;
    struct opened set = chosen;
    struct glint_frame frame;

    set.lens.setup.lens = &chosen.lens.table;
    for (double px = 8; px > 0.1; px /= 2) {
        set.settings.dials.dispersion_q8 = (int)(px * 256);
        draw_lamp_frame(&frame, &set, WIDTH, 100, picture);
        count_ghosts_by_wavelengths(&frame, ghosts, &bundles);
        assert_true(bundles >= before);
        least = before ? least : bundles;
        before = bundles;
        glint_frame_finish(&frame);
    }
    assert_true(before > 2 * least);
}

/* Checks that with a dispersion of 0 each ghost has the three default
 * wavelengths, bit by bit. */
TEST(dispersion_of_0_gives_default_wavelengths)
{
    struct opened set = chosen;
    struct glint_frame frame;

    set.settings.dials.dispersion_q8 = 0;
    draw_lamp_frame(&frame, &set, WIDTH, 1, picture);
    glint_frame_finish(&frame);
    draw_lamp_frame(&frame, &three, WIDTH, 1, other);
    glint_frame_finish(&frame);
    assert_memory_equal(picture, other, SAMPLES);
}

/* The engine chooses one of several sets of wavelengths for each ghost. Checks
 * that, if there is only one set, the image equals that of an explicit list of
 * the same wavelengths. */
TEST(single_set_equals_the_list)
{
    struct opened set = chosen, list = three;
    struct glint_frame frame;

    set.lens.setup.n_sets = 1;
    assert_true(settings_set_text(&list.settings, "wavelengths", "4"));
    set.settings.dials.cull_codes = list.settings.dials.cull_codes = 0;
    assert_int_equal(list.settings.n_wavelengths, 4);
    list.lens.setup.n_wavelengths = 4;
    for (int i = 0; i < 4; i++) {
        list.lens.setup.wavelength_nm[i] = list.settings.wavelength_nm[i];
        memcpy(list.lens.setup.rgb[i], set.lens.setup.set_wave[i].rgb,
               sizeof list.lens.setup.rgb[i]);
        list.lens.setup.unit_flux[i] = set.lens.setup.set_wave[i].unit_flux;
    }
    draw_lamp_frame(&frame, &set, WIDTH, 10, picture);
    glint_frame_finish(&frame);
    draw_lamp_frame(&frame, &list, WIDTH, 10, other);
    glint_frame_finish(&frame);
    assert_memory_equal(picture, other, SAMPLES);
}

/* Checks that ghosts for which a larger set of wavelengths would need too much
 * memory use the first set, and that no ghost is dropped. */
TEST(too_little_memory_uses_the_first_set)
{
    int ghosts[GLINT_MAX_WAVELENGTHS + 1], bundles, most = 0;
    struct glint_flare_stats stats;
    struct opened set = chosen;
    struct glint_frame frame;
    size_t bytes;
    void *mem;

    set.settings.dials.dispersion_q8 = 64;
    draw_lamp_frame(&frame, &set, WIDTH, 100, picture);
    most = frame.cfg.max_bundles;
    frame.cfg.max_bundles = 4 * frame.setup->n_ghosts;
    /* drawing has raised the capacity to more than 4 ray bundles per ghost */
    assert_true(most > frame.cfg.max_bundles);
    bytes = glint_flare_bytes(&frame.cfg);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    free(frame.memory.mem);
    frame.memory.mem = mem;
    frame.memory.bytes = bytes;
    assert_ok(glint_flare_init(&frame.memory.flare, &frame.cfg, mem, bytes));
    glint_flare_plan(frame.memory.flare, &frame.plan.rays, frame.lights.light,
                     frame.lights.n);
    glint_flare_bin(frame.memory.flare, &stats);
    assert_int_equal(stats.need_bundles, most);
    assert_int_equal(stats.dropped_bundles, 0);
    assert_true(stats.bundles <= 4 * frame.setup->n_ghosts);
    count_ghosts_by_wavelengths(&frame, ghosts, &bundles);
    assert_int_equal(bundles, stats.bundles);
    assert_true(ghosts[4] > 0);
    glint_frame_finish(&frame);
}

/* Checks that the image of three lamps is bit-identical, whether one worker
 * plans the ghosts or several. */
TEST(image_does_not_depend_on_workers)
{
    const struct glint_lamp lamps[3] = {
        lamp,
        {.theta_deg = 5, .phi_deg = 200, .power = 2e6, .rgb = {1, 0.8, 0.5}},
        {.theta_deg = 15, .phi_deg = 120, .power = 5e6, .rgb = {0.5, 0.8, 1}}};
    struct glint_workers *pool = tool.workers;
    uint8_t *rgb[2] = {picture, other};

    for (int i = 0; i < 2; i++) {
        struct glint_image image =
            glint_image_over(rgb[i], GLINT_RGB24, WIDTH, HEIGHT);
        struct glint_engine_report report;
        struct glint_frame frame;

        tool.workers = i ? NULL : pool;
        assert_ok(
            make_frame_from_settings(&tool, &chosen, WIDTH, HEIGHT, &frame));
        memset(rgb[i], 0, SAMPLES);
        assert_ok(glint_frame_draw(&frame, lamps, 3, 1, &image, &report));
        glint_frame_finish(&frame);
    }
    tool.workers = pool;
    assert_memory_equal(picture, other, SAMPLES);
}

/* ------------------------------------------------------- colours of images */

static int compare_ints(const void *a, const void *b)
{
    return *(const int *)b - *(const int *)a;
}

/* Returns the hue step, codes, that only 0.1 % of all pairs of neighbouring
 * pixels exceed: the error of the change of R - G or B - G within the pair. */
static int measure_hue_step(const uint8_t *rgb)
{
    static int step[WIDTH * HEIGHT];
    int n = 0;

    for (int i = 0; i + 1 < WIDTH * HEIGHT; i++) {
        int e[2][3], most = 0;

        if (i % WIDTH == WIDTH - 1)
            continue;
        for (int k = 0; k < 2; k++)
            for (int c = 0; c < 3; c++)
                e[k][c] = rgb[3 * (i + k) + c] - truth[3 * (i + k) + c];
        for (int c = 0; c < 3; c += 2) {
            const int d = e[1][c] - e[1][1] - e[0][c] + e[0][1];

            most = abs(d) > most ? abs(d) : most;
        }
        step[n++] = most;
    }
    qsort(step, (size_t)n, sizeof *step, compare_ints);
    return step[n / 1000];
}

static double compute_psnr(const uint8_t *rgb)
{
    double squares = 0;

    for (int i = 0; i < SAMPLES; i++) {
        const double e = rgb[i] - truth[i];

        squares += e * e;
    }
    return 10 * log10(255. * 255 * SAMPLES / squares);
}

TEST(more_wavelengths_smooth_the_outlines)
{
    static uint8_t few[SAMPLES];
    struct glint_frame frame;
    double db[2];
    int step[2];

    draw_lamp_frame(&frame, &all, WIDTH, 20, truth);
    glint_frame_finish(&frame);
    draw_lamp_frame(&frame, &three, WIDTH, 20, few);
    glint_frame_finish(&frame);
    draw_lamp_frame(&frame, &chosen, WIDTH, 20, picture);
    glint_frame_finish(&frame);
    db[0] = compute_psnr(few), db[1] = compute_psnr(picture);
    step[0] = measure_hue_step(few), step[1] = measure_hue_step(picture);
    print_message("three: %.1f dB, step %d; chosen: %.1f dB, step %d\n", db[0],
                  step[0], db[1], step[1]);
    assert_true(db[1] > 44 && db[1] > db[0] + 10);
    assert_true(step[1] <= 9 && 3 * step[1] < 2 * step[0]);
}

/* Checks that the points of a wide lamp get fewer wavelengths than the same
 * lights as lamps of their own, as their ghosts hide the steps between
 * wavelengths, and that a frame of a video has about the ghosts of the
 * 121 points of a still picture. */
TEST(points_of_a_wide_lamp_need_fewer_wavelengths)
{
    const int points = (int)glint_quality_at(0.5).dials.area_points;
    struct glint_frame frame;
    int alone, together;

    alone = draw_lamp_frame(&frame, &chosen, WIDTH, 100, picture).stats.bundles;
    glint_frame_finish(&frame);
    extent = 0.03;
    together = draw_lamp_frame(&frame, &chosen, WIDTH, 100 * points, picture)
                   .stats.bundles;
    glint_frame_finish(&frame);
    draw_lamp_frame(&frame, &chosen, WIDTH, 20, picture);
    glint_frame_finish(&frame);
    chosen.settings.options.area_samples = 121;
    draw_lamp_frame(&frame, &chosen, WIDTH, 20, truth);
    glint_frame_finish(&frame);
    chosen.settings.options.area_samples = 0;
    extent = 0;
    print_message("bundles: %d of %d; %.1f dB\n", together, points * alone,
                  compute_psnr(picture));
    assert_true(together < points * alone);
    assert_true(compute_psnr(picture) > 48);
}

/* ------------------------------------------------------------ option texts */

TEST(parses_texts_of_wavelengths)
{
    struct settings s;

    settings_set_defaults(&s);
    assert_true(s.camera.waves.kind == GLINT_WAVES_LIST &&
                s.n_wavelengths == 3);
    assert_true(settings_set_text(&s, "wavelengths", "auto") &&
                s.camera.waves.kind == GLINT_WAVES_AUTO);
    assert_true(settings_set_text(&s, "wavelengths", "9") &&
                s.camera.waves.kind == GLINT_WAVES_COUNT &&
                s.n_wavelengths == 9);
    assert_true(s.wavelength_nm[0] > 400 && s.wavelength_nm[8] < 700);
    assert_true(settings_set_text(&s, "wavelengths", "532") &&
                s.camera.waves.kind == GLINT_WAVES_LIST &&
                s.n_wavelengths == 1 && s.wavelength_nm[0] == 532);
    assert_true(settings_set_text(&s, "wavelengths", "300,1100") &&
                s.n_wavelengths == 2);
    assert_false(settings_set_text(&s, "wavelengths", "0"));
    assert_false(settings_set_text(&s, "wavelengths", "33"));
    assert_false(settings_set_text(&s, "wavelengths", "2.5"));
    assert_false(settings_set_text(&s, "wavelengths", "0.55"));
    assert_false(settings_set_text(&s, "wavelengths", "650,532,1101"));
    assert_false(settings_set_text(&s, "wavelengths", "9,17"));
    s.camera.waves.kind = GLINT_WAVES_AUTO;
    /* with exact rays, wavelengths are chosen per ghost, as with models */
    s.options.rays = GLINT_RAYS_EXACT;
    assert_true(s.camera.waves.kind == GLINT_WAVES_AUTO);
}

/* Checks that the sum of all ghosts of a white lamp is white, in a lens without
 * coatings. */
TEST(sum_of_ghosts_of_a_white_lamp_is_white)
{
    static float rgb[SAMPLES];
    static struct opened bare;
    double sum[3] = {0, 0, 0};
    struct glint_engine_report report;
    struct glint_frame frame;

    settings_set_defaults(&bare.settings);
    bare.settings.camera.waves.kind = GLINT_WAVES_AUTO;
    assert_int_equal(
        coating_parse_option(&tool, &bare.settings.coating, "none"), -1);
    assert_ok(opened_lens_open(&tool, &bare.lens, &bare.settings,
                               "lenses/heliar-tronnier.lens"));
    assert_ok(make_frame_from_settings(&tool, &bare, WIDTH, HEIGHT, &frame));
    assert_ok(glint_frame_draw_flare_alone(&frame, &lamp, 1, 1, rgb, &report));
    for (int i = 0; i < SAMPLES; i++)
        sum[i % 3] += (double)rgb[i];
    print_message("uncoated: %.3f 1 %.3f\n", sum[0] / sum[1], sum[2] / sum[1]);
    assert_true(fabs(sum[0] / sum[1] - 1) < 0.06);
    assert_true(fabs(sum[2] / sum[1] - 1) < 0.06);
    glint_frame_finish(&frame);
    opened_lens_close(&bare.lens);
}

static void open_lens_with_wavelengths(struct opened *opened, const char *waves)
{
    settings_set_defaults(&opened->settings);
    opened->settings.coating.kind = COATING_TABLE;
    assert_true(settings_set_text(&opened->settings, "wavelengths", waves));
    assert_ok(opened_lens_open(&tool, &opened->lens, &opened->settings,
                               "lenses/heliar-tronnier.lens"));
}

TEST_OPEN
{
    assert_ok(tool_start_threads(&tool));
    open_lens_with_wavelengths(&chosen, "auto");
    open_lens_with_wavelengths(&three, "650,532,450");
    open_lens_with_wavelengths(
        &all, "400,410,420,430,440,450,460,470,480,490,500,510,520,530,540,550,"
              "560,570,580,590,600,610,620,630,640,650,660,670,680,690,700");
    all.settings.dials.cull_codes = 0;
}

TEST_CLOSE
{
    opened_lens_close(&chosen.lens);
    opened_lens_close(&three.lens);
    opened_lens_close(&all.lens);
    tool_stop_threads(&tool);
}
