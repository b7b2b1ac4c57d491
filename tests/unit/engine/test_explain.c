/* SPDX-License-Identifier: MIT
 *
 * Tests the reports of glint explain. Counts must equal those of the drawn
 * frame, and counts per ghost, light and wavelength must add up to them. Each
 * reason for not drawing a ghost must occur where it is expected. The image
 * must shade the tiles that ghosts touch.
 */
#include "explain/explain.h"
#include "engine/explain_frame.h"
#include "support/opened.h"

enum { WIDTH = 320, HEIGHT = 200, BYTES = 3 * WIDTH * HEIGHT, SIDE = 16 };

static uint8_t rgb[BYTES];
static const struct glint_image image = {.format = GLINT_RGB24,
                                         .width = WIDTH,
                                         .height = HEIGHT,
                                         .plane = {rgb},
                                         .stride_bytes = {3 * WIDTH}};

static const struct glint_lamp lamps[] = {{12, 20, 3e6, {1, 1, 1}, {0, 0}, 0},
                                          {8, 140, 2e5, {1, .5, .2}, {0, 0}, 0},
                                          {75, 250, 4e9, {1, 1, 1}, {0, 0}, 0}};

enum { N_LAMPS = (int)(sizeof lamps / sizeof *lamps) };

static void make_test_frame(struct glint_frame *frame)
{
    assert_ok(make_frame_from_settings(&tool, &opened, WIDTH, HEIGHT, frame));
    frame->cfg.tile_log2 = 4;
}

static void draw_explained_frame(struct glint_frame *frame,
                                 const struct glint_lamp *lamp, int n,
                                 struct glint_engine_report *report)
{
    memset(rgb, 0, sizeof rgb);
    assert_ok(glint_frame_draw(frame, lamp, n, 1, &image, report));
}

static double sum_explained_parts(const struct glint_explain_part *part, int n,
                                  int cost)
{
    double s = 0;

    for (int i = 0; i < n; i++)
        s += cost ? part[i].cost : part[i].share;
    return s;
}

static int count_drawn_ghosts(const struct glint_explain *e)
{
    int n = 0;

    for (int i = 0; i < e->n_ghosts; i++)
        n += glint_explain_drawn(&e->ghost[i]) > 0;
    return n;
}

/* Checks that the explanation E agrees with REPORT, and that the counts per
 * ghost, per light and per wavelength each add up to those of the frame. */
static void
assert_explanation_matches_report(const struct glint_explain *e,
                                  const struct glint_engine_report *report)
{
    const double pixels = e->stage[GLINT_COST_LIT] / e->all.work;
    const struct glint_explain_part *parts[3] = {e->ghost, e->light, e->wave};
    const int n[3] = {e->n_ghosts, e->n_lights, e->n_waves};

    assert_int_equal(e->all.edges, report->stats.primitives);
    assert_int_equal(e->all.refs, report->stats.refs);
    assert_int_equal(glint_explain_drawn(&e->all), report->stats.bundles);
    assert_int_equal(e->all.of[GLINT_OUTCOME_NO_ROOM],
                     report->stats.dropped_bundles);
    assert_int_equal(e->all.tiles, report->tiles);
    assert_int_equal(count_drawn_ghosts(e), report->ghosts);
    for (int by = 0; by < 3; by++) {
        long long edges = 0, vertices = 0;
        int bundles = 0;

        assert_true(fabs(sum_explained_parts(parts[by], n[by], 0) - 1) < 0.002);
        assert_true(
            fabs(sum_explained_parts(parts[by], n[by], 1) + pixels - 1) < 1e-9);
        for (int i = 0; i < n[by]; i++) {
            edges += parts[by][i].edges;
            vertices += parts[by][i].vertices;
            bundles += glint_explain_bundles(&parts[by][i]);
            assert_true(parts[by][i].lit <= e->all.lit);
            assert_true(parts[by][i].brightest <= e->all.brightest);
        }
        assert_int_equal(edges, e->all.edges);
        assert_int_equal(vertices, e->all.vertices);
        assert_int_equal(bundles, glint_explain_bundles(&e->all));
    }
}

/* -------------------------------------------------------- explained frames */

/* Explains a frame of three lights: one is outside the angles of the model;
 * each of the other two is drawn without some ghosts. */
TEST(explains_lights_outside_and_inside_the_model)
{
    struct glint_engine_report report;
    struct glint_frame frame;
    struct glint_explain e;

    make_test_frame(&frame);
    draw_explained_frame(&frame, lamps, N_LAMPS, &report);
    assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
    assert_explanation_matches_report(&e, &report);
    assert_int_equal(e.n_lights, 2);
    assert_int_equal(glint_explain_bundles(&e.all), 2 * 13 * 3);
    for (int i = 0; i < N_LAMPS; i++)
        assert_int_equal(glint_frame_is_lamp_outside_model(&frame, &lamps[i]),
                         i == 2);
    /* At 12 degrees ghosts 5 and 7 are closed: they pass no light. At 8 degrees
     * they pass light, but ghost 5 falls off-screen. */
    assert_int_equal(e.light[0].of[GLINT_OUTCOME_CLOSED], 2 * 3);
    assert_int_equal(e.ghost[5].of[GLINT_OUTCOME_CLOSED], 3);
    assert_int_equal(e.ghost[5].of[GLINT_OUTCOME_OUTSIDE], 3);
    assert_int_equal(e.ghost[7].of[GLINT_OUTCOME_CLOSED], 3);
    glint_explain_close(&e);
    glint_frame_finish(&frame);
}

/* Checks that peak light and flux are proportional to UNIT, and that the peak
 * is that of the largest code. */
TEST(light_is_linear_in_the_unit)
{
    struct glint_engine_report report;
    struct glint_explain e, twice;
    struct glint_frame frame;
    double light;
    int most = 0;

    make_test_frame(&frame);
    frame.only_ghost = 11;
    draw_explained_frame(
        &frame, (struct glint_lamp[]){{12, 20, 1e7, {1, 1, 1}, {0, 0}, 0}}, 1,
        &report);
    for (int i = 0; i < BYTES; i++)
        most = rgb[i] > most ? rgb[i] : most;
    assert_true(most > 30 && most < 250);
    light = pow((most / 255.0 + 0.055) / 1.055, 2.4);
    assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
    assert_ok(glint_explain_open_for_frame(&twice, &frame, 2));
    assert_true(fabs(e.all.brightest / light - 1) < 0.03);
    assert_true(fabs(twice.all.brightest - 2 * e.all.brightest) < 1e-12);
    assert_true(fabs(twice.all.flux - 2 * e.all.flux) < 1e-6 * e.all.flux);
    assert_true(e.ghost[11].share == 1);
    assert_int_equal(e.all.of[GLINT_OUTCOME_OTHER], 12 * 3);
    glint_explain_close(&e);
    glint_explain_close(&twice);
    glint_frame_finish(&frame);
}

/* Checks that each outcome in the table occurs in a frame made for it, and that
 * a frame whose only lamp is outside the model's range of angles has no ray
 * bundles. */
TEST(every_reason_occurs)
{
    static const struct {
        struct glint_lamp lamp;
        int only_ghost;
        enum glint_outcome outcome;
    } cases[] = {
        {{12, 20, 1e7, {1, 1, 1}, {0, 0}, 0}, -1, GLINT_OUTCOME_DRAWN},
        {{12, 20, 1e7, {1, 1, 1}, {0, 0}, 0}, -1, GLINT_OUTCOME_CLOSED},
        {{12, 20, 1e7, {1, 1, 0}, {0, 0}, 0}, -1, GLINT_OUTCOME_DARK},
        {{12, 20, 1e7, {1, 1, 1}, {0, 0}, 0}, 3, GLINT_OUTCOME_OTHER},
        {{12, 20, 1e5, {1, 1, 1}, {0, 0}, 0}, -1, GLINT_OUTCOME_FAINT},
        {{25, 20, 1e7, {1, 1, 1}, {0, 0}, 0}, -1, GLINT_OUTCOME_OUTSIDE},
    };
    struct glint_engine_report report;
    struct glint_frame frame;
    struct glint_explain e;

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        make_test_frame(&frame);
        frame.only_ghost = cases[i].only_ghost;
        draw_explained_frame(&frame, &cases[i].lamp, 1, &report);
        assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
        assert_true(e.all.of[cases[i].outcome] > 0);
        if (e.all.edges)
            assert_explanation_matches_report(&e, &report);
        glint_explain_close(&e);
        glint_frame_finish(&frame);
    }
    make_test_frame(&frame);
    draw_explained_frame(&frame, &lamps[2], 1, &report);
    assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
    assert_int_equal(glint_explain_bundles(&e.all), 0);
    assert_true(e.all.flux == 0);
    glint_explain_close(&e);
    glint_frame_finish(&frame);
}

/* Checks a frame whose setup is that of the table, which has no pupil regions:
 * the last ghost of the model becomes a second region of ghost 11. */
TEST(pupil_regions_of_the_model_are_not_ghosts)
{
    enum { GHOST = 11 };
    static struct glint_setup setup;
    struct glint_engine_report report, first;
    struct glint_model_header *header;
    struct glint_model_ghost *ghosts;
    struct glint_frame frame;
    struct glint_lens lens;
    struct glint_explain e;

    make_test_frame(&frame);
    header = malloc(frame.lens->header->bytes);
    assert_non_null(header);
    memcpy(header, frame.lens->header, frame.lens->header->bytes);
    ghosts = (void *)((char *)header + header->ghost_at);
    header->n_parts = 1;
    ghosts[header->n_ghosts - 1].i = ghosts[GHOST].i;
    ghosts[header->n_ghosts - 1].j = ghosts[GHOST].j;
    lens = *frame.lens;
    lens.header = header;
    lens.ghost = ghosts;
    setup = *frame.setup;
    setup.n_ghosts = (int)header->n_ghosts - 1;
    frame.lens = &lens;
    frame.setup = &setup;
    draw_explained_frame(&frame, lamps, N_LAMPS, &first);
    assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
    assert_int_equal(e.n_ghosts, setup.n_ghosts);
    assert_explanation_matches_report(&e, &first);
    assert_int_equal(glint_explain_bundles(&e.ghost[GHOST]), 2 * 2 * 3);
    glint_explain_close(&e);
    draw_explained_frame(&frame, lamps, N_LAMPS, &report);
    assert_int_equal(report.ghosts, first.ghosts);
    glint_frame_finish(&frame);
    free(header);
}

TEST(explains_bundles_dropped_for_memory)
{
    struct glint_engine_report report;
    struct glint_frame frame;
    struct glint_explain e;
    size_t need;

    make_test_frame(&frame);
    draw_explained_frame(&frame, lamps, N_LAMPS, &report);
    need = report.peak_bytes;
    glint_frame_finish(&frame);
    make_test_frame(&frame);
    assert_ok(glint_frame_reserve_memory(&frame, NULL, need * 9 / 10, N_LAMPS,
                                         N_LAMPS));
    draw_explained_frame(&frame, lamps, N_LAMPS, &report);
    assert_true(report.stats.dropped_bundles > 0);
    assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
    assert_explanation_matches_report(&e, &report);
    glint_explain_close(&e);
    glint_frame_finish(&frame);
}

TEST(ghosts_are_sorted_by_light)
{
    int at[GLINT_MAX_GHOSTS];
    struct glint_engine_report report;
    struct glint_frame frame;
    struct glint_explain e;

    make_test_frame(&frame);
    draw_explained_frame(&frame, lamps, N_LAMPS, &report);
    assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
    glint_explain_sort(&e, at);
    for (int i = 1; i < e.n_ghosts; i++)
        assert_true(e.ghost[at[i]].flux <= e.ghost[at[i - 1]].flux);
    glint_explain_close(&e);
    glint_frame_finish(&frame);
}

struct progress {
    int n;
    double last;
};

static void record_progress(void *ctx, double done)
{
    struct progress *const p = ctx;

    assert_true(done > p->last && done <= 1);
    p->last = done;
    p->n++;
}

/* Draws a disc and a point, and explains the frame. All points of the disc must
 * be one lamp, whose light is their sum, and the progress must end at 1. */
TEST(points_of_a_lamp_are_summed)
{
    const struct glint_lamp two[] = {{8, 140, 2e6, {1, 1, 1}, {0, 0}, 0},
                                     {12, 20, 3e6, {1, 1, 1}, {0.01, 0.01}, 0}};
    const struct glint_engine_lamp known[] = {glint_engine_lamp_of(&two[0], 1),
                                              glint_engine_lamp_of(&two[1], 2)};
    struct progress progress = {0, 0};
    const struct glint_explain_config config = {.lamps = known,
                                                .n_lamps = 2,
                                                .progress = record_progress,
                                                .progress_ctx = &progress};
    struct glint_engine_report report;
    struct glint_engine_config cfg;
    struct glint_engine *engine;
    struct glint_error error;
    struct glint_explain e;
    double flux[2] = {0, 0}, brightest = 0;
    int n[2] = {0, 0}, disc;

    glint_engine_defaults(&cfg, WIDTH, HEIGHT);
    cfg.model = &opened.lens.model.lens;
    assert_ok(glint_engine_create(&engine, &cfg, &error));
    memset(rgb, 0, sizeof rgb);
    assert_ok(glint_engine_draw_at(engine, two, 2, 1, &image, &report));
    assert_ok(glint_explain_open(&e, engine, &config));
    assert_true(e.n_lights > 5);
    assert_int_equal(e.n_lamps, 2);
    for (int i = 0; i < e.n_lights; i++) {
        flux[e.lamp_of[i]] += e.light[i].flux;
        n[e.lamp_of[i]]++;
    }
    disc = n[1] > n[0];
    assert_int_equal(n[!disc], 1);
    for (int i = 0; i < e.n_lights; i++)
        if (e.lamp_of[i] == disc)
            brightest = fmax(brightest, e.light[i].brightest);
    for (int k = 0; k < 2; k++)
        assert_true(fabs(e.lamp[k].flux / flux[k] - 1) < 1e-9);
    assert_true(fabs(e.lamp[0].share + e.lamp[1].share - 1) < 0.002);
    assert_true(e.lamp[disc].brightest > brightest &&
                e.lamp[disc].brightest <= e.all.brightest);
    assert_int_equal(glint_explain_bundles(&e.lamp[0]) +
                         glint_explain_bundles(&e.lamp[1]),
                     glint_explain_bundles(&e.all));
    assert_true(progress.n > e.n_lights && progress.last == 1);
    glint_explain_close(&e);
    glint_engine_destroy(engine);
}

/* Returns whether most of the tile at (X0, Y0) has the colour that marks a
 * touched tile on a black image. */
static int is_tile_shaded(const struct glint_image *marked, int x0, int y0)
{
    static const uint8_t shade[3] = {6, 12, 34};
    int n = 0, all = 0;

    for (int y = y0 + 1; y < y0 + SIDE && y < HEIGHT; y++)
        for (int x = x0 + 1; x < x0 + SIDE && x < WIDTH; x++, all++)
            n += memcmp(marked->plane[0] + y * marked->stride_bytes[0] + 3 * x,
                        shade, 3) == 0;
    return 2 * n > all;
}

/* Checks that the image shades exactly the tiles that one ghost touches. */
TEST(picture_shades_the_tiles_of_a_ghost)
{
    struct explain_title title = {.lens = "heliar", .top = 20};
    struct glint_image marked, unmarked;
    struct glint_engine_report report;
    struct glint_frame frame;
    struct glint_explain e;
    int n = 0, outlined = 0;

    make_test_frame(&frame);
    frame.only_ghost = 4;
    draw_explained_frame(
        &frame, (struct glint_lamp[]){{12, 20, 1e8, {1, 1, 1}, {0, 0}, 0}}, 1,
        &report);
    assert_true(report.tiles > 10 && report.tiles < 200);
    assert_ok(glint_explain_open_for_frame(&e, &frame, 1));
    memset(rgb, 0, sizeof rgb);
    assert_ok(explain_draw_marks(&e, &title, &image, &marked));
    assert_int_equal(marked.width, WIDTH);
    assert_int_equal(marked.height, HEIGHT + 8 * 2 + 3);
    for (int y = 0; y < HEIGHT; y += SIDE)
        for (int x = 0; x < WIDTH; x += SIDE)
            n += is_tile_shaded(&marked, x, y);
    /* A tile that the label and the outline cover for the most part does not
     * count as shaded. */
    assert_true(n <= report.tiles && n >= report.tiles - 2);
    title.top = 0;
    assert_ok(explain_draw_marks(&e, &title, &image, &unmarked));
    assert_int_equal(unmarked.height, HEIGHT + 8 + 3);
    for (int i = 0; i < BYTES; i += 3)
        outlined += memcmp(marked.plane[0] + i, unmarked.plane[0] + i, 3) != 0;
    assert_true(outlined > 100 && outlined < WIDTH * HEIGHT / 8);
    free(marked.plane[0]);
    free(unmarked.plane[0]);
    glint_explain_close(&e);
    glint_frame_finish(&frame);
}

TEST_GROUP(open_heliar_lens, close_opened_lens);
