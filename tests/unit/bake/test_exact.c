/* SPDX-License-Identifier: MIT
 *
 * Compares exact reference pictures with pictures of an independent program, of
 * a finer grid and of mirrored input. Then compares the integer engine, which
 * draws with exactly traced rays, with the exact pictures.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/frame.h"
#include "engine/response.h"
#include "glint/measure.h"
#include "glint/pool.h"
#include "glint/quality.h"
#include "formats/pnm.h"
#include "posix/input.h"
#include "support/lens_check.h"

enum { MAX_PIXELS = 480 * 270 };

static struct glint_prescription lens;
static struct glint_setup setup;
static struct glint_workers *workers;
static double rgb[3 * MAX_PIXELS], other[3 * MAX_PIXELS];
static double swapped[3 * 120 * 120];
static float floats[2][3 * MAX_PIXELS];

TEST_OPEN
{
    assert_ok(glint_pool_create(&workers, 0));
}

TEST_CLOSE
{
    glint_pool_destroy(workers);
}

static void render_exact_flare(double *out, struct glint_view view,
                               const struct glint_lamp *lamps, int n_lamps,
                               int grid)
{
    const struct glint_exact_config cfg = {.setup = &setup,
                                           .view = view,
                                           .lamps = lamps,
                                           .n_lamps = n_lamps,
                                           .grid = grid,
                                           .only_ghost = -1,
                                           .workers = workers};

    assert_ok(glint_exact_render(&cfg, out));
}

static struct glint_lamp make_white_lamp(double theta, double phi)
{
    return (struct glint_lamp){theta, phi, 1, {1, 1, 1}, {0, 0}, 0};
}

static struct glint_float_image convert_to_floats(const double *from, int slot,
                                                  struct glint_view view)
{
    for (int i = 0; i < 3 * view.width * view.height; i++)
        floats[slot][i] = (float)from[i];
    return (struct glint_float_image){view.width, view.height, floats[slot]};
}

static double compute_psnr(const double *a, const double *b,
                           struct glint_view view)
{
    const struct glint_float_image x = convert_to_floats(a, 0, view);
    const struct glint_float_image y = convert_to_floats(b, 1, view);
    struct glint_measure m;

    assert_true(glint_measure_compare(&x, &y, false, &m));
    return m.psnr_db;
}

/* --------------------------------------------------------- golden pictures */

struct golden {
    const char *name;
    double theta, phi;
    int grid;
};

/* Loads the picture NAME, rendered by an independent program, from ../shared or
 * from the folder that GLINT_SHARED names. Returns whether it was loaded. */
static bool load_golden_picture(const char *name,
                                struct glint_float_image *image)
{
    const char *shared = getenv("GLINT_SHARED");
    struct glint_error error = {""};
    uint8_t *data = NULL;
    size_t bytes = 0;
    char path[512];
    bool ok;

    snprintf(path, sizeof path, "%s/golden/pictures/%s.pfm",
             shared ? shared : "../shared", name);
    ok = glint_input_read_whole_file(&data, &bytes, path, 1 << 26, &error) ==
             GLINT_OK &&
         glint_pfm_read(image, data, bytes, path, &error) == GLINT_OK;
    free(data);
    return ok;
}

static void compare_with_golden_picture(const struct golden *g)
{
    const struct glint_view view = {
        .width = 480, .height = 270, .sensor_width_mm = 36};
    const struct glint_lamp lamp = make_white_lamp(g->theta, g->phi);
    struct glint_float_image want, got;
    struct glint_measure m;

    if (!load_golden_picture(g->name, &want)) {
        print_message("no golden picture of %s here\n", g->name);
        skip();
    }
    load_setup(&setup, &lens, g->name);
    render_exact_flare(rgb, view, &lamp, 1, g->grid);
    got = convert_to_floats(rgb, 0, view);
    assert_true(glint_measure_compare(&want, &got, true, &m));
    print_message("%s: %.1f dB\n", g->name, m.psnr_db);
    free(want.rgb);
    assert_true(m.psnr_db >= 50);
}

TEST(heliar_matches_golden_picture)
{
    compare_with_golden_picture(
        &(struct golden){"heliar-tronnier", 7.58, 33.2, 128});
}

TEST(angenieux_matches_golden_picture)
{
    compare_with_golden_picture(
        &(struct golden){"double-gauss-angenieux", 5.33, -20.8, 96});
}

TEST(canon_matches_golden_picture)
{
    if (getenv("GLINT_QUICK") &&
        *getenv("GLINT_QUICK")) /* takes minutes under sanitizers */
        skip();
    compare_with_golden_picture(
        &(struct golden){"canon-zoom-mid", 5.06, 10.2, 64});
}

/* -------------------------------------------------------------- symmetries */

TEST(light_on_axis_gives_a_symmetric_picture)
{
    const struct glint_view view = {
        .width = 160, .height = 160, .sensor_width_mm = 24};
    const struct glint_lamp lamp = make_white_lamp(0, 0);
    double worst = 0, peak = 0;

    load_setup(&setup, &lens, "heliar-tronnier");
    render_exact_flare(rgb, view, &lamp, 1, 128);
    for (int y = 0; y < 160; y++)
        for (int x = 0; x < 160; x++)
            for (int c = 0; c < 3; c++) {
                const double v = rgb[3 * (y * 160 + x) + c];
                const double up = rgb[3 * ((159 - y) * 160 + x) + c];
                const double side = rgb[3 * (y * 160 + 159 - x) + c];

                worst = fmax(worst, fmax(fabs(v - up), fabs(v - side)));
                peak = fmax(peak, v);
            }
    assert_true(peak > 0);
    /* Up and down are mirror images to the last bits; left and right are,
     * within the precision of the grid. */
    assert_true(worst < 2e-3 * peak);
}

/* Checks that rotating the light by 90 degrees rotates the picture: a quarter
 * turn does not change an octagonal stop and a square picture. */
TEST(quarter_turn_of_the_light_rotates_the_picture)
{
    const struct glint_view view = {
        .width = 160, .height = 160, .sensor_width_mm = 24};
    const struct glint_lamp lamp = make_white_lamp(6, 20),
                            turned = make_white_lamp(6, 110);

    load_setup(&setup, &lens, "double-gauss-angenieux");
    render_exact_flare(rgb, view, &lamp, 1, 96);
    render_exact_flare(other, view, &turned, 1, 96);
    for (int y = 0; y < 160; y++) /* (x, y) becomes (y, 159 - x) */
        for (int x = 0; x < 160; x++)
            for (int c = 0; c < 3; c++)
                floats[0][3 * (y * 160 + x) + c] =
                    (float)other[3 * ((159 - x) * 160 + y) + c];
    for (int i = 0; i < 3 * 160 * 160; i++)
        other[i] = (double)floats[0][i];
    assert_true(compute_psnr(rgb, other, view) > 80);
}

/* ---------------------------------------------------------------- accuracy */

TEST(doubling_the_grid_changes_little)
{
    const struct glint_view view = {
        .width = 240, .height = 135, .sensor_width_mm = 36};
    const struct glint_lamp lamp = make_white_lamp(7.58, 33.2);
    double db;

    load_setup(&setup, &lens, "heliar-tronnier");
    render_exact_flare(rgb, view, &lamp, 1, 256);
    render_exact_flare(other, view, &lamp, 1, 512);
    db = compute_psnr(other, rgb, view);
    print_message("256 against 512: %.1f dB\n", db);
    assert_true(db > 60);
}

/* 13 pairs of surfaces reflect at most 5 % at each of two reflections. So all
 * ghosts together have less than 13 * 0.05^2 of the light that enters the
 * lens. */
TEST(flux_is_bounded)
{
    const struct glint_view view = {
        .width = 200, .height = 200, .sensor_width_mm = 2000};
    const struct glint_lamp lamp = make_white_lamp(10, 45);
    const double front = 3.14159265 * 14.5 * 14.5;
    double sum[3] = {0, 0, 0};

    load_setup(&setup, &lens, "heliar-tronnier");
    render_exact_flare(rgb, view, &lamp, 1, 64);
    for (int i = 0; i < 3 * 200 * 200; i++)
        sum[i % 3] += rgb[i];
    for (int c = 0; c < 3; c++) {
        assert_true(sum[c] > 0);
        assert_true(sum[c] * setup.unit_flux[c] <
                    13 * 0.05 * 0.05 * front * cos(10 * 3.14159265 / 180));
    }
}

TEST(picture_does_not_depend_on_threads)
{
    const struct glint_view view = {
        .width = 120, .height = 67, .sensor_width_mm = 36};
    const struct glint_lamp lamps[2] = {make_white_lamp(5, 33),
                                        make_white_lamp(9, -120)};
    struct glint_workers *const pool = workers;

    load_setup(&setup, &lens, "heliar-tronnier");
    workers = NULL;
    render_exact_flare(rgb, view, lamps, 2, 64);
    for (int n = 2; n <= 8; n += 3) {
        assert_ok(glint_pool_create(&workers, n));
        render_exact_flare(other, view, lamps, 2, 64);
        glint_pool_destroy(workers);
        assert_memory_equal(rgb, other, sizeof(double) * 3 * 120 * 67);
    }
    workers = pool;
}

/* --------------------------------------------------------- integer renderer */

static void draw_flare_by_integers(struct glint_view view,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   double *out,
                                   struct glint_engine_report *report)
{
    static float linear[3 * MAX_PIXELS];
    struct glint_frame frame;

    glint_frame_init(&frame, &setup, view, workers);
    frame.trace = &glint_frame_traces;
    assert_ok(glint_frame_draw_flare_alone(&frame, lamps, n_lamps, 1, linear,
                                           report));
    for (int i = 0; i < 3 * view.width * view.height; i++)
        out[i] = (double)linear[i];
    glint_frame_finish(&frame);
}

TEST(integer_renderer_matches_exact_renderer)
{
    static const char *const names[] = {"heliar-tronnier",
                                        "double-gauss-angenieux"};
    const struct glint_view view = {
        .width = 480, .height = 270, .sensor_width_mm = 36};
    const struct glint_lamp lamps[2] = {make_white_lamp(7.58, 33.2),
                                        make_white_lamp(3.1, -100)};

    for (int i = 0; i < 2; i++) {
        struct glint_engine_report report;
        double db;

        load_setup(&setup, &lens, names[i]);
        render_exact_flare(rgb, view, lamps, 1 + i, 192);
        draw_flare_by_integers(view, lamps, 1 + i, other, &report);
        db = compute_psnr(rgb, other, view);
        print_message("%s, %d light(s): %.1f dB\n", names[i], 1 + i, db);
        assert_true(db >= 45);
        assert_true(report.arena_bytes >= report.peak_bytes);
        assert_int_equal(report.stats.dropped_bundles, 0);
    }
}

/* At these angles a barrel begins to vignette a ghost in blue light, but not
 * yet in green light. */
TEST(barrels_that_block_only_blue_light_vignette)
{
    static const struct {
        const char *name;
        double theta, phi;
    } of[] = {{"normal/biotar-merte-50", 1.72, 33},
              {"normal/planar-contarex-55", 20.37, -52}};
    static const double nm[3] = {619, 541, 460};
    const struct glint_view view = {
        .width = 240, .height = 160, .sensor_width_mm = 36};

    for (int i = 0; i < 2; i++) {
        const struct glint_lamp lamp = make_white_lamp(of[i].theta, of[i].phi);
        struct glint_engine_report report;
        struct glint_error error;
        double db;

        load_lens(&lens, of[i].name);
        assert_ok(glint_prescription_set_f_number(&lens, 11, &error));
        assert_ok(glint_setup_init(&setup, &lens, 0, 0, nm, 3, &error));
        render_exact_flare(rgb, view, &lamp, 1, 128);
        draw_flare_by_integers(view, &lamp, 1, other, &report);
        db = compute_psnr(rgb, other, view);
        print_message("%s: %.1f dB\n", of[i].name, db);
        assert_true(db >= 48);
    }
}

/* At this angle a ghost enters near total reflection. Red rays reach the sensor
 * from a part of the pupil where blue ones are totally reflected. */
TEST(rays_that_only_blue_light_loses_are_drawn_in_red)
{
    static const double nm[3] = {620, 540, 460};
    const struct glint_view view = {
        .width = 240, .height = 160, .sensor_width_mm = 36};
    const struct glint_lamp lamp = make_white_lamp(37.7, 33);
    struct glint_engine_report report;
    double sum[2][3] = {{0}};
    struct glint_error error;

    load_lens(&lens, "wide/double-gauss-canon-28");
    assert_ok(glint_prescription_set_f_number(&lens, 11, &error));
    assert_ok(glint_setup_init(&setup, &lens, 0, 0, nm, 3, &error));
    render_exact_flare(rgb, view, &lamp, 1, 256);
    draw_flare_by_integers(view, &lamp, 1, other, &report);
    for (int i = 0; i < 3 * view.width * view.height; i++) {
        sum[0][i % 3] += rgb[i];
        sum[1][i % 3] += other[i];
    }
    for (int c = 0; c < 3; c++) {
        print_message("channel %d: %.4f of the light\n", c,
                      sum[1][c] / sum[0][c]);
        assert_true(fabs(sum[1][c] / sum[0][c] - 1) < 0.02);
    }
}

/* Checks that a frame whose rays and edges exceed the memory limit is drawn in
 * several passes, with bit-identical result. The test uses one thread, as each
 * thread has a memory limit of its own. */
TEST(picture_does_not_depend_on_memory)
{
    const struct glint_view view = {
        .width = 240, .height = 135, .sensor_width_mm = 36};
    const struct glint_lamp lamps[2] = {make_white_lamp(7.58, 33.2),
                                        make_white_lamp(3.1, -100)};
    static float linear[2][3 * 240 * 135];
    struct glint_engine_report report[2];

    load_setup(&setup, &lens, "heliar-tronnier");
    for (int i = 0; i < 2; i++) {
        struct glint_frame frame;

        glint_frame_init(&frame, &setup, view, NULL);
        frame.trace = &glint_frame_traces;
        frame.cfg.tile_log2 = 4;
        if (i)
            frame.limits.most_bytes = 1 << 20;
        assert_ok(glint_frame_draw_flare_alone(&frame, lamps, 2, 1, linear[i],
                                               &report[i]));
        glint_frame_finish(&frame);
    }
    print_message("%zu and %zu bytes\n", report[0].arena_bytes,
                  report[1].arena_bytes);
    assert_true(report[1].arena_bytes < report[0].arena_bytes);
    assert_true(report[1].arena_bytes <= 1 << 20);
    assert_memory_equal(linear[0], linear[1], sizeof linear[0]);
}

/* Each colour channel is rounded to irradiance steps of its own: a lamp whose
 * green is a hundredth of its power must give the same green light as a green
 * lamp of that hundredth. The hot spot of this lens is much fainter than the
 * size of its bounding box suggests. */
TEST(faint_colour_keeps_its_irradiance_steps)
{
    const struct glint_view view = {
        .width = 480, .height = 270, .sensor_width_mm = 36};
    const struct glint_lamp green = {5.3, 33, 0.01, {0, 1, 0}, {0, 0}, 0};
    const struct glint_lamp reddish = {5.3, 33, 1, {1, 0.01, 0}, {0, 0}, 0};
    struct glint_engine_report report;
    double apart = 0, sum = 0;

    load_setup(&setup, &lens, "itoh-zoom-short");
    draw_flare_by_integers(view, &green, 1, rgb, &report);
    draw_flare_by_integers(view, &reddish, 1, other, &report);
    for (int i = 1; i < 3 * view.width * view.height; i += 3) {
        apart += fabs(rgb[i] - other[i]);
        sum += rgb[i];
    }
    print_message("apart by %.5f of the light\n", apart / sum);
    assert_true(apart < 0.001 * sum);
}

/* --------------------------------------- lenses without rotational symmetry */

/* Loads a triplet into LENS. Its table contains the line BEFORE in front of the
 * first surface, FIRST after the first surface, and SECOND after the second. */
static void load_triplet_with_shapes(const char *before, const char *first,
                                     const char *second)
{
    static const double rgb_nm[] = {650, 532, 450};
    struct glint_error error = {""};
    char text[900];

    snprintf(text, sizeof text,
             "name t\nf-number 8\nfilm 36 24\n%s"
             "surface 40.1 6 12 1.6 60\n%ssurface -537 8 12 air\n%s"
             "surface -47 1 9 1.62 36\nsurface 40 3 9 air\nstop 6 8\n"
             "surface 234 6 9 1.6 60\nsurface -37.9 80 9 air\n",
             before, first, second);
    if (glint_prescription_parse(&lens, text, strlen(text), "t.lens", &error) !=
            GLINT_OK ||
        glint_setup_init(&setup, &lens, 0, 0, rgb_nm, 3, &error) != GLINT_OK)
        fail_msg("%s", error.text);
}

/* Checks that a toric surface with two equal radii gives the picture of a
 * sphere. The toric lens counts as one without rotational symmetry, so rays are
 * traced over its whole pupil, rotated by the azimuth of the light. */
TEST(toric_with_equal_radii_equals_a_sphere)
{
    const struct glint_view view = {
        .width = 180, .height = 120, .sensor_width_mm = 36};
    const struct glint_lamp lamp = make_white_lamp(7, 37);
    struct glint_engine_report report;
    double db, flux;

    load_triplet_with_shapes("", "", "");
    flux = setup.direct_flux[1];
    render_exact_flare(rgb, view, &lamp, 1, 128);
    load_triplet_with_shapes("", "shape toric x 40.1\n",
                             "shape toric y -537\n");
    assert_false(glint_prescription_is_round(&lens));
    assert_true(fabs(setup.direct_flux[1] / flux - 1) < 1e-5);
    render_exact_flare(other, view, &lamp, 1, 128);
    db = compute_psnr(rgb, other, view);
    print_message("spheres and torics: %.1f dB\n", db);
    assert_true(db > 60);
    draw_flare_by_integers(view, &lamp, 1, rgb, &report);
    db = compute_psnr(other, rgb, view);
    print_message("torics in integers: %.1f dB\n", db);
    assert_true(db >= 50);
}

/* Draws LAMPS with FRAME into LINEAR, an image of size VIEW. */
static void draw_lamps_linear(struct glint_frame *frame, struct glint_view view,
                              const struct glint_lamp *lamps, int n,
                              float *linear)
{
    struct glint_engine_report report;

    glint_frame_init(frame, &setup, view, NULL);
    frame->trace = &glint_frame_traces;
    assert_ok(
        glint_frame_draw_flare_alone(frame, lamps, n, 1, linear, &report));
}

/* Checks that a frame that adopts the pupil boxes found by a smaller frame,
 * whose lamps may differ, draws the same bits as a frame that searches for
 * them. */
TEST(adopted_rays_do_not_change_the_picture)
{
    const struct glint_view view = {
        .width = 240, .height = 135, .sensor_width_mm = 36};
    const struct glint_view small = {
        .width = 96, .height = 54, .sensor_width_mm = 36};
    const struct glint_lamp lamps[3] = {
        {7.58, 33.2, 1, {1, 1, 1}, {4e-3, 2e-3}, 30},
        {7.9, -70, 1, {1, 1, 1}, {3e-3, 3e-3}, 0},
        make_white_lamp(3.1, -100)};
    static float linear[2][3 * 240 * 135], other_size[3 * 96 * 54];

    for (int k = 0; k < 2; k++) {
        struct glint_frame own, adopting, from;
        struct glint_engine_report report;

        load_triplet_with_shapes("", k ? "shape toric x 41\n" : "", "");
        draw_lamps_linear(&own, view, lamps + k, 2, linear[0]);
        draw_lamps_linear(&adopting, view, lamps + 1 - k, 2, linear[1]);
        draw_lamps_linear(&from, small, lamps + k, 2, other_size);
        glint_frame_traces.adopt(&adopting, &from);
        assert_ok(glint_frame_draw_flare_alone(&adopting, lamps + k, 2, 1,
                                               linear[1], &report));
        assert_memory_equal(linear[0], linear[1], sizeof linear[0]);
        glint_frame_finish(&from);
        glint_frame_finish(&own);
        glint_frame_finish(&adopting);
    }
}

/* Checks that a frame that has drawn other pictures draws the same bits as a
 * new one. In one of these pictures, lamps had another extent, which exact rays
 * of point lights do not show; in another, all ghosts were muted. */
TEST(earlier_pictures_do_not_change_the_picture)
{
    static float linear[2][3 * 240 * 135];
    static struct glint_tint tints[GLINT_MAX_GHOSTS];
    const struct glint_view view = {
        .width = 240, .height = 135, .sensor_width_mm = 36};
    struct glint_lamp lamps[2] = {make_white_lamp(7.58, 33.2),
                                  make_white_lamp(3.1, -100)};

    for (int k = 0; k < 4; k++) {
        struct glint_frame fresh, used;
        struct glint_engine_report report;

        load_triplet_with_shapes("", k & 1 ? "shape toric x 41\n" : "", "");
        draw_lamps_linear(&fresh, view, lamps, 2, linear[0]);
        lamps[0].axis[0] = k < 2 ? 5e-3 : 0;
        glint_frame_init(&used, &setup, view, NULL);
        used.trace = &glint_frame_traces;
        used.dials.area_points = used.asked.area_points = 1;
        used.tints = k < 2 ? NULL : tints;
        assert_ok(glint_frame_draw_flare_alone(&used, lamps, 2, 1, linear[1],
                                               &report));
        lamps[0].axis[0] = 0;
        used.tints = NULL;
        assert_ok(glint_frame_draw_flare_alone(&used, lamps, 2, 1, linear[1],
                                               &report));
        assert_memory_equal(linear[0], linear[1], sizeof linear[0]);
        glint_frame_finish(&fresh);
        glint_frame_finish(&used);
    }
}

/* Checks that a draft, whose ghosts are measured with fewer rays, resembles the
 * picture, and that the frame then draws the same bits as a new one. */
TEST(drafts_resemble_the_picture)
{
    static float linear[2][3 * 240 * 135], draft[3 * 240 * 135];
    const struct glint_view view = {
        .width = 240, .height = 135, .sensor_width_mm = 36};
    const struct glint_lamp lamps[2] = {make_white_lamp(7.58, 33.2),
                                        make_white_lamp(3.1, -100)};
    static const char *const names[] = {"heliar-tronnier",
                                        "double-gauss-angenieux"};

    for (int k = 0; k < 2; k++) {
        struct glint_frame fresh, used;
        struct glint_engine_report report;
        struct glint_dials dials;
        double db;

        load_setup(&setup, &lens, names[k]);
        draw_lamps_linear(&fresh, view, lamps, 2, linear[0]);
        glint_frame_init(&used, &setup, view, NULL);
        used.trace = &glint_frame_traces;
        dials = used.dials;
        used.dials = used.asked = glint_quality_at(0.25).dials;
        assert_ok(
            glint_frame_draw_flare_alone(&used, lamps, 2, 1, draft, &report));
        used.dials = used.asked = dials;
        assert_ok(glint_frame_draw_flare_alone(&used, lamps, 2, 1, linear[1],
                                               &report));
        assert_memory_equal(linear[0], linear[1], sizeof linear[0]);
        for (int i = 0; i < 3 * 240 * 135; i++) {
            rgb[i] = (double)linear[0][i];
            other[i] = (double)draft[i];
        }
        db = compute_psnr(rgb, other, view);
        print_message("draft of %s: %.1f dB\n", names[k], db);
        assert_true(db >= 30);
        glint_frame_finish(&fresh);
        glint_frame_finish(&used);
    }
}

/* Checks that lamps that use the same traced rays are each drawn at their own
 * position. Their picture must equal the sum of the pictures of single lamps,
 * each with rays traced in its own direction. */
TEST(lamps_that_share_rays_keep_their_places)
{
    static float linear[3][3 * 240 * 135];
    const struct glint_view view = {
        .width = 240, .height = 135, .sensor_width_mm = 36};
    const struct glint_lamp lamps[2] = {make_white_lamp(7.58, 33.2),
                                        make_white_lamp(8.1, 33.9)};

    for (int k = 0; k < 2; k++) {
        struct glint_frame frame;
        double db;

        load_triplet_with_shapes("", k ? "shape toric x 41\n" : "", "");
        for (int i = 0; i < 3; i++) {
            draw_lamps_linear(&frame, view, i < 2 ? &lamps[i] : lamps,
                              i < 2 ? 1 : 2, linear[i]);
            glint_frame_finish(&frame);
        }
        for (int i = 0; i < 3 * 240 * 135; i++) {
            rgb[i] = (double)linear[0][i] + (double)linear[1][i];
            other[i] = (double)linear[2][i];
        }
        db = compute_psnr(rgb, other, view);
        print_message("lamps that share rays: %.1f dB\n", db);
        assert_true(db >= 55);
    }
}

/* Checks a decentred lens: a decentre in x with light at an azimuth of 30
 * degrees equals a decentre in y at 60 degrees, mirrored at the diagonal. Both
 * differ from the centred lens. */
TEST(decentred_lens_is_mirrored_at_the_diagonal)
{
    const struct glint_view view = {
        .width = 120, .height = 120, .sensor_width_mm = 30};
    const struct glint_lamp at[2] = {make_white_lamp(6, 30),
                                     make_white_lamp(6, 60)};
    double db;

    load_triplet_with_shapes("group decentre 0.7 0\n", "", "end\n");
    render_exact_flare(rgb, view, &at[0], 1, 64);
    load_triplet_with_shapes("group decentre 0 0.7\n", "", "end\n");
    render_exact_flare(other, view, &at[1], 1, 64);
    for (int y = 0; y < 120; y++)
        for (int x = 0; x < 120; x++)
            for (int c = 0; c < 3; c++) {
                /* the vertical axis of one picture is the horizontal axis of
                 * the other */
                const int to = ((119 - x) * 120 + 119 - y) * 3 + c;

                swapped[to] = other[(y * 120 + x) * 3 + c];
            }
    db = compute_psnr(rgb, swapped, view);
    print_message("decentred, mirrored: %.1f dB\n", db);
    assert_true(db > 55);
    load_triplet_with_shapes("", "", "");
    render_exact_flare(other, view, &at[0], 1, 64);
    assert_true(compute_psnr(rgb, other, view) < 40);
}

/* Progress reports of a frame. N: all reports; N_EXPOSING: those while a small
 * picture is drawn to determine the exposure. LAST and EXPOSED: last reported
 * fractions of both; RISES: all reports rose. */
struct reports {
    int n, n_exposing;
    double last, exposed;
    bool rises;
};

static void record_progress_report(void *ctx, double done)
{
    struct reports *const r = ctx;

    r->rises = r->rises && done > r->last;
    r->last = done;
    r->n++;
}

/* Checks that the reported progress rises while the exposure is determined
 * (this includes the search for ghosts), and then until the picture is
 * drawn. */
TEST(progress_rises_from_exposure_to_picture)
{
    const struct glint_view view = {
        .width = 240, .height = 135, .sensor_width_mm = 36};
    /* The small picture for the exposure has only the first lamp. */
    const struct glint_lamp lamp[2] = {make_white_lamp(7.58, 33.2),
                                       make_white_lamp(3.1, -100)};
    static float linear[3 * 240 * 135];
    struct reports reports = {.rises = true};
    struct glint_response_light light;
    struct glint_engine_report report;
    struct glint_frame frame;

    load_triplet_with_shapes("", "", "");
    glint_frame_init(&frame, &setup, view, NULL);
    frame.trace = &glint_frame_traces;
    frame.progress = record_progress_report;
    frame.progress_ctx = &reports;
    assert_ok(glint_response_draw_and_measure(&frame, lamp, 1, 5000, NULL,
                                              &light, NULL));
    reports.n_exposing = reports.n;
    reports.exposed = reports.last;
    assert_ok(
        glint_frame_draw_flare_alone(&frame, lamp, 2, 1, linear, &report));
    glint_frame_finish(&frame);
    assert_true(reports.n_exposing > 1);
    assert_true(reports.exposed == GLINT_FRAME_FOUND);
    assert_true(reports.n > reports.n_exposing);
    assert_true(reports.last == 1);
    assert_true(reports.rises);
}
