/* SPDX-License-Identifier: MIT
 *
 * Tests plans: exactly the visible ghosts are planned, and rays computed row
 * by row give the same image as rays stored in a grid.
 */
#include "base/real.h"
#include "flare/plan.h"
#include "glint/kernels.h"
#include "support/canvas.h"
#include "support/model_builder.h"
#include "support/models/frame_parts.h"
#include "support/shuffle.h"
#include "support/test.h"

enum { WIDTH = 160, HEIGHT = 120 };

/* ---------------------------------------------- reals (mantissa, exponent) */

static void assert_relatively_near(struct glint_real got, double want)
{
    assert_true(fabs(glint_real_value(got) - want) <= fabs(want) * 0x1p-28);
    assert_true(got.mantissa == 0 || llabs(got.mantissa) >= 1 << 30);
}

TEST(sums_of_reals_are_right)
{
    uint32_t seed = 3;

    for (int k = 0; k < 20000; k++) {
        int64_t a, b;
        int e, f;

        rng_bits32(&seed);
        a = (int64_t)((uint64_t)seed << 30 >> (seed % 61)) + 1;
        e = (int)(seed >> 8 & 127) - 64;
        rng_bits32(&seed);
        b = (int64_t)((uint64_t)seed << 30 >> (seed % 61)) + 1;
        f = (int)(seed >> 8 & 127) - 64;
        {
            const struct glint_real x = real_of(a, e), y = real_of(-b, f);
            const struct glint_real z = real_of(b, f);
            const double p = ldexp((double)a, e), q = ldexp((double)b, f);

            assert_relatively_near(x, p);
            assert_relatively_near(y, -q);
            assert_relatively_near(real_times(x, y), -p * q);
            assert_relatively_near(real_over(x, y), -p / q);
            assert_relatively_near(real_plus(x, z), p + q);
            assert_true(fabs(glint_real_value(x) - glint_real_value(z)) <
                            0x1p-28 * p ||
                        real_less(x, z) == (p < q));
            assert_true(fabs((double)real_integer(x, 4, INT64_C(1) << 40) -
                             fmin(16 * p, 0x1p40)) <=
                        1 + fmin(16 * p, 0x1p40) * 0x1p-28);
        }
    }
    assert_int_equal(real_of(0, 5).mantissa, 0);
    assert_int_equal(real_integer(real_of(-7, -1), 0, 100), -3);
    assert_int_equal(real_integer(real_of(-7, 200), 0, 100), -100);
}

/* -------------------------------------------------------------------- plan */

struct fixture {
    struct model_image m;
    struct glint_lens lens;
    struct glint_wave wave[2];
    struct glint_light light;
    struct glint_flare_frame rays;
    struct glint_flare_config cfg;
    void *mem;
    struct glint_flare *flare;
};

static void open_model_and_light(struct fixture *f)
{
    *f = (struct fixture){.m = model_make_three_ghosts()};
    f->lens = model_open_image(&f->m);
    set_frame_wavelengths(f->wave);
    f->light = make_axial_light();
    f->rays = make_frame_rays(&f->lens, f->wave, 64);
    f->cfg = make_frame_config(WIDTH, HEIGHT, 5);
    f->cfg.max_bundles = 16;
    f->cfg.max_vertices = 40000;
    f->cfg.max_primitives = 20000;
    f->cfg.max_refs = 40000;
}

static void allocate_and_init_flare(struct fixture *f)
{
    const size_t bytes = glint_flare_bytes(&f->cfg);

    assert_int_equal(posix_memalign(&f->mem, 64, bytes), 0);
    assert_ok(glint_flare_init(&f->flare, &f->cfg, f->mem, bytes));
}

static void free_model_and_images(struct fixture *f)
{
    free(f->mem);
}

static struct fixture fx;

TEST_BEFORE
{
    open_model_and_light(&fx);
}

TEST_AFTER
{
    free_model_and_images(&fx);
}

static struct glint_flare_stats plan_and_bin_lights(struct fixture *f,
                                                    int n_lights)
{
    struct glint_flare_stats s;

    allocate_and_init_flare(f);
    glint_flare_plan(f->flare, &f->rays, &f->light, n_lights);
    glint_flare_bin(f->flare, &s);
    free(f->mem);
    f->mem = NULL;
    return s;
}

TEST(visible_lights_are_planned)
{
    int all;

    all = plan_and_bin_lights(&fx, 1).bundles;
    assert_true(all >= 1);
    assert_int_equal(plan_and_bin_lights(&fx, 0).bundles, 0);
    fx.light.power = real_of(0, 0);
    assert_int_equal(plan_and_bin_lights(&fx, 1).bundles, 0);
    fx.light.power = real_of(1000, 0);
    /* FAINTEST is brighter than any ghost, so all ghosts are dropped */
    fx.rays.faintest = real_of(1, 60);
    assert_int_equal(plan_and_bin_lights(&fx, 1).bundles, 0);
    fx.rays.faintest = real_of(1, -60);
    assert_int_equal(plan_and_bin_lights(&fx, 1).bundles, all);
    fx.light.rgb_q14[0] = 0; /* no red light */
    assert_true(plan_and_bin_lights(&fx, 1).bundles < all);
}

/* Checks that the plan of an annular pupil counts no invalid rays in the
 * pupil's middle, which has no rays. */
TEST(annular_pupil_has_no_invalid_rays)
{
    struct glint_model_system *system;
    struct glint_flare_stats s;

    system =
        (struct glint_model_system *)(void *)(fx.m.data + model_header_of(&fx.m)
                                                              ->system_at);
    for (uint32_t i = 0; i < model_header_of(&fx.m)->n_systems; i++)
        system[i].annulus = 1;
    s = plan_and_bin_lights(&fx, 1);
    assert_true(s.bundles >= 1 && s.primitives > 0);
    assert_int_equal(s.dropped_cells, 0);
}

/* Returns the max light that the flare adds to a pixel, 1 = display white. */
static double find_peak_light(struct fixture *f)
{
    static int32_t px_q20[3 * WIDTH * HEIGHT];
    struct glint_image image =
        glint_image_over(px_q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);
    struct glint_flare_stats s;
    int32_t most = 0;

    memset(px_q20, 0, sizeof px_q20);
    allocate_and_init_flare(f);
    glint_flare_plan(f->flare, &f->rays, &f->light, 1);
    glint_flare_bin(f->flare, &s);
    glint_flare_draw(f->flare, &image);
    free(f->mem);
    f->mem = NULL;
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        most = px_q20[i] > most ? px_q20[i] : most;
    return most * 0x1p-20;
}

/* Checks that dropped ghosts are fainter than FAINTEST in every pixel, and that
 * drawn ghosts reach at least an eighth of FAINTEST in some pixel. */
TEST(dropped_ghosts_are_invisible)
{
    int n_left_out = 0, n_kept = 0;

    fx.rays.n_waves = 1;
    for (int e = -24; e < 10; e++) {
        double light;
        int bundles;

        fx.light.power = real_of(1, e);
        fx.rays.faintest = real_of(0, 0);
        light = find_peak_light(&fx);
        fx.rays.faintest = real_of(1, -10);
        bundles = plan_and_bin_lights(&fx, 1).bundles;
        n_left_out += bundles == 0 && light > 0x1p-18;
        n_kept += bundles > 0;
        assert_true(bundles > 0 || light <= 0x1p-10);
        assert_true(bundles == 0 || light > 0x1p-13);
    }
    assert_true(n_left_out > 3 && n_kept > 3);
}

static void draw_flare_image(struct fixture *f, int32_t *px_q20,
                             struct glint_flare_stats *s)
{
    struct glint_image image =
        glint_image_over(px_q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);

    memset(px_q20, 0, sizeof(int32_t) * 3 * WIDTH * HEIGHT);
    allocate_and_init_flare(f);
    glint_flare_plan(f->flare, &f->rays, &f->light, 1);
    glint_flare_bin(f->flare, s);
    glint_flare_draw(f->flare, &image);
    free(f->mem);
    f->mem = NULL;
}

/* Checks that the plan for pixel codes draws faint light with fewer edges and
 * nearly the same codes (50 dB), and that the plan for linear images uses as
 * many edges for faint as for bright light. */
TEST(faint_light_gets_fewer_edges)
{
    static int32_t linear[3 * WIDTH * HEIGHT], coded[3 * WIDTH * HEIGHT];
    int n_fewer = 0;

    fx.cfg.irradiance_steps = 70;
    for (int e = 8; e > -12; e--) {
        struct glint_flare_stats all, fewer;
        double sum = 0;

        fx.light.power = real_of(1, e);
        fx.rays.faintest = real_of(0, 0);
        draw_flare_image(&fx, linear, &all);
        fx.rays.faintest = real_of(1, -20);
        draw_flare_image(&fx, coded, &fewer);
        assert_true(fewer.primitives <= all.primitives);
        assert_true(e < 0 || all.primitives > 2100);

        n_fewer += 2 * fewer.primitives < all.primitives;
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
            const double off = canvas_encode_srgb_exactly(coded[i] * 0x1p-20) -
                               canvas_encode_srgb_exactly(linear[i] * 0x1p-20);

            sum += off * off;
        }
        assert_true(sum / (3 * WIDTH * HEIGHT) < (e > 4 ? 0.65 : 0.1));
    }
    assert_true(n_fewer > 15);
}

/* The extent of an image: its total light, its centroid (X, Y), and SQUARE, the
 * mean squared distance of light from the centroid. Lengths are in pixels. */
struct extent {
    double light, x, y, square;
};

static struct extent compute_image_extent(const int32_t *px_q20)
{
    struct extent e = {0, 0, 0, 0};

    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const double l = (double)px_q20[3 * i] + px_q20[3 * i + 1];
            const double x = i % WIDTH, y = i / WIDTH; /* NOLINT: rows */

            if (pass)
                e.square += l * (pow(x - e.x, 2) + pow(y - e.y, 2)) / e.light;
            else
                e.light += l, e.x += l * x, e.y += l * y;
            if (!pass && i == WIDTH * HEIGHT - 1)
                e.x /= e.light, e.y /= e.light;
        }
    return e;
}

/* Checks a lamp of several points: distant points give wider ghosts with the
 * same position and light; near points give those of a single light. */
TEST(distant_lamp_points_widen_ghosts)
{
    static int32_t px_q20[3 * WIDTH * HEIGHT];
    struct glint_flare_stats s;
    struct extent alone, near, far;

    fx.cfg.stop.apothem_q16 /= 3;
    fx.light.sine_q30 = 1 << 27;
    fx.light.cosine_q30 = (int32_t)(sqrt(63 / 64.0) * (1 << 30));
    fx.light.cos_q30 = (int32_t)(0.6 * (1 << 30));
    fx.light.sin_q30 = (int32_t)(0.8 * (1 << 30));
    draw_flare_image(&fx, px_q20, &s);
    alone = compute_image_extent(px_q20);
    fx.light.apart_q30 = 1 << 10;
    draw_flare_image(&fx, px_q20, &s);
    near = compute_image_extent(px_q20);
    fx.light.apart_q30 = 1 << 28;
    draw_flare_image(&fx, px_q20, &s);
    far = compute_image_extent(px_q20);
    assert_true(near.square == alone.square);
    assert_true(far.square > 1.15 * alone.square);
    assert_true(fabs(far.light / alone.light - 1) < 1e-3);
    assert_true(hypot(far.x - alone.x, far.y - alone.y) < 0.3);
}

/* Checks that snapping edges to pixels preserves the total light, and the codes
 * of nearly all pixels. */
TEST(pixel_snapped_edges_keep_the_light)
{
    static int32_t smooth[3 * WIDTH * HEIGHT], whole[3 * WIDTH * HEIGHT];
    struct glint_flare_stats s;
    int n_changed = 0;

    fx.rays.faintest = real_of(1, -20);
    fx.cfg.irradiance_steps = 70;
    for (int e = 8; e > -8; e--) {
        double flux[2] = {0, 0}, sum = 0;

        fx.light.power = real_of(1, e);
        fx.rays.snap_codes_q8 = 0;
        draw_flare_image(&fx, smooth, &s);
        fx.rays.snap_codes_q8 = 4 << 8;
        draw_flare_image(&fx, whole, &s);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
            const double off = canvas_encode_srgb_exactly(whole[i] * 0x1p-20) -
                               canvas_encode_srgb_exactly(smooth[i] * 0x1p-20);

            n_changed += whole[i] != smooth[i];
            flux[0] += smooth[i];
            flux[1] += whole[i];
            sum += off * off;
            assert_true(fabs(off) < 5);
        }
        /* a PSNR of at least 61 dB */
        assert_true(sum / (3 * WIDTH * HEIGHT) < 0.05);
        /* An upright outline may move by half a pixel when it is snapped. */
        assert_true(fabs(flux[1] - flux[0]) < (e > 2 ? 1e-3 : 1e-2) * flux[0]);
    }
    assert_true(n_changed > 10000);
}

/* Draws a frame of F into IMAGE; at half resolution if HALF is set. */
static void draw_at_half_resolution(struct fixture *f, int half,
                                    struct glint_image *image, void *mem)
{
    struct glint_flare_stats s;

    f->cfg.width = image->width;
    f->cfg.height = image->height;
    f->cfg.irradiance_steps = 70;
    f->light.power = real_of(1, 2);
    f->rays.faintest = real_of(163, -22);
    f->rays.half = half ? &glint_half : NULL;
    glint_image_place(image, mem);
    allocate_and_init_flare(f);
    glint_flare_plan(f->flare, &f->rays, &f->light, 1);
    glint_flare_bin(f->flare, &s);
    glint_flare_draw(f->flare, image);
    free(f->mem);
    f->mem = NULL;
}

/* Checks that drawing at half resolution displaces hardly any light. */
TEST(half_resolution_keeps_light_in_place)
{
    static uint8_t codes[2][3 * WIDTH * HEIGHT];
    const int width = WIDTH - 7, height = HEIGHT - 3, n = 3 * width * height;
    double flux[2] = {0, 0}, sum = 0;

    for (int half = 0; half < 2; half++) {
        struct glint_image image = {
            .format = GLINT_RGB24, .width = width, .height = height};

        draw_at_half_resolution(&fx, half, &image, codes[half]);
    }
    for (int i = 0; i < n; i++) {
        const double off = codes[1][i] - codes[0][i];

        sum += off * off;
        flux[0] += pow(codes[0][i], 2.2);
        flux[1] += pow(codes[1][i], 2.2);
    }
    assert_true(fabs(flux[1] - flux[0]) < 0.02 * flux[0]);
    /* The images differ, but have a PSNR of more than 32 dB. */
    assert_true(sum > 0.01 * n && sum < 40 * n);
}

/* Checks that at half resolution all pixels of a 2 x 2 block get the same
 * light, also in the last row and column. */
TEST(half_resolution_shares_linear_light)
{
    static int32_t light_q20[2][3 * WIDTH * HEIGHT];
    const int width = WIDTH - 7, height = HEIGHT - 3;
    double sum[2] = {0, 0};

    for (int half = 0; half < 2; half++) {
        struct glint_image image = {
            .format = GLINT_LINEAR_Q20, .width = width, .height = height};

        draw_at_half_resolution(&fx, half, &image, light_q20[half]);
    }
    for (int i = 0; i < 3 * width * height; i++) {
        const int x = i / 3 % width, y = i / 3 / width;

        sum[0] += light_q20[0][i];
        sum[1] += light_q20[1][i];
        assert_int_equal(
            light_q20[1][i],
            light_q20[1][3 * ((y & ~1) * width + (x & ~1)) + i % 3]);
    }
    assert_true(sum[0] > 0 && fabs(sum[1] / sum[0] - 1) < 0.02);
}

/* Draws a textured image at half resolution. Checks that the light that the
 * four pixels of a block share is close to the light of each of them at full
 * resolution. */
TEST(half_resolution_of_yuyv_is_close)
{
    static uint8_t px[2][2 * WIDTH * HEIGHT];
    double sum = 0, changed = 0;

    for (int half = 0; half < 2; half++) {
        struct glint_image image = {
            .format = GLINT_YUYV, .width = WIDTH, .height = HEIGHT};

        for (int i = 0; i < 2 * WIDTH * HEIGHT; i++)
            px[half][i] = (uint8_t)(i % 2 ? 128 : 40 + i * 7 / 2 % 13);
        draw_at_half_resolution(&fx, half, &image, px[half]);
    }
    for (int i = 0; i < 2 * WIDTH * HEIGHT; i += 2) {
        const double off = px[1][i] - px[0][i];

        sum += off * off;
        changed += px[0][i] != 40 + i * 7 / 2 % 13;
    }
    assert_true(changed > WIDTH * HEIGHT / 20.);
    assert_true(sum < 30. * WIDTH * HEIGHT);
}

/* Checks, for every setting of the plan, that an image is bit-identical for all
 * tile sizes, numbers of workers, orders of jobs and kernels. */
TEST(image_is_bit_identical_for_all_settings)
{
    static const int whole_q8[] = {0, 64, 1024, 1 << 15};
    static const enum glint_pixel_format formats[] = {GLINT_RGB24, GLINT_YUYV,
                                                      GLINT_LINEAR_Q20};
    static int32_t px[2][3 * WIDTH * HEIGHT];
    uint32_t seed = 7;

    fx.cfg.irradiance_steps = 70;
    fx.light.power = real_of(1, 2);
    fx.rays.faintest = real_of(163, -22);
    for (int i = 0; i < 2 * 4 * 3 * 12; i++) {
        struct glint_image image = {.format = formats[i / 12 % 3],
                                    .width = WIDTH - 7,
                                    .height = HEIGHT - 3};
        const int first = i % 12 == 0;
        struct glint_flare_stats s;
        struct shuffle shuffle;

        init_shuffled_workers(&shuffle, first ? 1 : 1 + i % 3,
                              rng_xorshift(&seed));
        fx.rays.snap_codes_q8 = whole_q8[i / 36 % 4];
        fx.rays.half = i / 144 ? &glint_half : NULL;
        fx.cfg.width = image.width;
        fx.cfg.height = image.height;
        fx.cfg.workers = &shuffle.workers;
        fx.cfg.tile_log2 = first ? 6 : 3 + (int)(rng_xorshift(&seed) % 4);
        fx.cfg.sets = first ? 0 : rng_xorshift(&seed) & glint_sets_here();
        memset(px[!first], 0, sizeof px[0]);
        glint_image_place(&image, px[!first]);
        allocate_and_init_flare(&fx);
        glint_flare_plan(fx.flare, &fx.rays, &fx.light, 1);
        glint_flare_bin(fx.flare, &s);
        assert_true(s.bundles > 0 && s.dropped_bundles == 0);
        glint_flare_draw(fx.flare, &image);
        free(fx.mem);
        fx.mem = NULL;
        if (!first)
            assert_memory_equal(px[0], px[1], sizeof px[0]);
    }
}

/* Draws N faint lights with F into a linear image and into one of pixel codes.
 * Returns the mean square difference, codes squared. Checks that the brightest
 * code is between 4 and 40. */
static double compare_faint_lights(struct fixture *f, int n)
{
    enum { MANY = 1024 };
    static struct glint_light light[MANY];
    static int32_t linear[3 * WIDTH * HEIGHT];
    static uint8_t codes[3 * WIDTH * HEIGHT];
    struct glint_image image =
        glint_image_over(codes, GLINT_RGB24, WIDTH, HEIGHT);
    struct glint_image layer = {
        .format = GLINT_LINEAR_Q20, .width = WIDTH, .height = HEIGHT};
    struct glint_flare_stats s;
    double sum = 0, most = 0;

    f->cfg.max_bundles = 16 * n;
    f->cfg.max_primitives = 4000000;
    f->cfg.max_refs = 4000000;
    for (int i = 0; i < n; i++) {
        light[i] = f->light;
        light[i].cos_q30 = (int32_t)lrint(0x1p30 * cos(0.001 * i));
        light[i].sin_q30 = (int32_t)lrint(0x1p30 * sin(0.001 * i));
        light[i].power = real_of((1000 + i) * (MANY / n), -18);
    }
    glint_image_place(&layer, linear);
    memset(linear, 0, sizeof linear);
    memset(codes, 0, sizeof codes);
    allocate_and_init_flare(f);
    for (int turn = 0; turn < 2; turn++) {
        /* FAINTEST: light that changes a code by 1/8 */
        f->rays.faintest = real_of(turn ? 163 : 0, -22);
        glint_flare_plan(f->flare, &f->rays, light, n);
        glint_flare_bin(f->flare, &s);
        assert_int_equal(s.dropped_bundles, 0);
        assert_true(s.bundles > n);
        glint_flare_draw(f->flare, turn ? &image : &layer);
    }
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        const double want = canvas_encode_srgb_exactly(linear[i] * 0x1p-20);

        most = fmax(most, want);
        sum += (codes[i] - want) * (codes[i] - want);
    }
    assert_true(most > 4 && most < 40);
    return sum / (3 * WIDTH * HEIGHT);
}

/* Checks that lights too faint to be visible singly are visible together, also
 * as pixel codes. With soft edges, each light is drawn as several outlines, so
 * fewer lights must suffice. */
TEST(many_faint_lights_are_visible_together)
{
    const struct glint_shade soft = {.method = &glint_shade_method,
                                     .soft_q16 = 6554};

    assert_true(compare_faint_lights(&fx, 1024) < 0.1);
    free(fx.mem);
    fx.cfg.stop.shade = &soft;
    assert_true(compare_faint_lights(&fx, 128) < 0.2);
}

TEST(too_little_capacity_drops_bundles)
{
    struct glint_flare_stats all, less;

    all = plan_and_bin_lights(&fx, 1);
    fx.cfg.max_bundles = 1;
    less = plan_and_bin_lights(&fx, 1);
    assert_int_equal(less.need_bundles, all.need_bundles);
    assert_true(less.bundles <= 1);
    assert_true(less.dropped_bundles > 0);
}

static void draw_planned_flare(struct fixture *f, int32_t *px_q20)
{
    struct glint_image image =
        glint_image_over(px_q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);
    struct glint_flare_stats s;

    memset(px_q20, 0, sizeof(int32_t) * 3 * WIDTH * HEIGHT);
    glint_flare_bin(f->flare, &s);
    assert_true(s.bundles > 0);
    glint_flare_draw(f->flare, &image);
}

/* Checks that edges computed row by row, discarding each row of rays after use,
 * equal those of a stored grid. */
static void check_row_edges_equal_grid_edges(int32_t opening_q30)
{
    static int32_t rows[3 * WIDTH * HEIGHT], grid[3 * WIDTH * HEIGHT];
    static struct glint_plan_scratch scratch;
    struct fixture f;
    struct glint_plan plan;
    int64_t light = 0;

    open_model_and_light(&f);
    f.cfg.stop.opening_q30 = opening_q30;
    allocate_and_init_flare(&f);
    glint_flare_plan(f.flare, &f.rays, &f.light, 1);
    draw_planned_flare(&f, rows);
    plan = (struct glint_plan){.frame = &f.rays,
                               .light = &f.light,
                               .n_lights = 1,
                               .width = WIDTH,
                               .height = HEIGHT,
                               .opening_q30 = opening_q30};
    glint_flare_begin(f.flare);
    for (int ghost = 0; ghost < (int)f.lens.header->n_ghosts; ghost++)
        for (int wave = 0; wave < 2; wave++) {
            struct glint_bundle_plan planned = {.ghost = ghost, .wave = wave};
            struct glint_place place;
            struct glint_bundle bundle;
            struct glint_vertex *v;

            glint_plan_bundle(&plan, &f.light, &planned, &bundle, &scratch);
            if (bundle.n_cells == 0)
                continue;
            assert_int_equal(bundle.n_cells % 4, 0);
            place = glint_plan_map_sensor_to_picture(&plan, &planned);
            v = glint_flare_add(f.flare, &bundle);
            assert_non_null(v);
            glint_plan_set_transfer(&plan, &planned, &scratch.transfer);
            glint_transfer_grid(&scratch.transfer, &place, bundle.n_cells, v);
        }
    draw_planned_flare(&f, grid);
    assert_memory_equal(rows, grid, sizeof rows);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        light += rows[i];
    assert_true(light > 0);
    free_model_and_images(&f);
}

TEST(rows_and_grids_give_the_same_edges)
{
    check_row_edges_equal_grid_edges(1 << 30);
    check_row_edges_equal_grid_edges(1 << 28);
}

/* Checks that a hole of radius 0.4 in a stop as wide as the model's gives the
 * light of a hole of 0.8 in a stop half as wide, except at the corners of
 * cells, and that closing the stop further reduces the light. */
TEST(stop_radius_scales_the_opening)
{
    static int32_t whole[3 * WIDTH * HEIGHT], half[3 * WIDTH * HEIGHT];
    static int32_t less[3 * WIDTH * HEIGHT];
    int64_t light = 0, off = 0, left = 0;
    struct glint_flare_stats s;

    /* With so much light, rounding to 2^-20 is negligible. */
    fx.light.power = real_of(1000, 4);
    draw_flare_image(&fx, whole, &s);
    fx.cfg.stop.apothem_q16 *= 2;
    fx.cfg.stop.opening_q30 = 1 << 29;
    draw_flare_image(&fx, half, &s);
    fx.cfg.stop.opening_q30 = 1 << 28;
    draw_flare_image(&fx, less, &s);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        light += whole[i];
        off += llabs((int64_t)whole[i] - half[i]);
        left += less[i];
    }
    print_message("%.5f of the light is elsewhere, %.3f left\n",
                  (double)off / (double)light, (double)left / (double)light);
    assert_true(light > 1 << 20);
    assert_true(off < light / 250);
    /* At the rim of the hole, stop x = 0.5 u^3 is 0.4 at u = 0.9283 or 0.2 at u
     * = 0.7368. Stop y = 0.5 v - 0.125 v^3 is below 0.4 everywhere, and 0.2 at
     * v = 0.4183. */
    assert_true(fabs((double)left / (double)light - 0.7368 / 0.9283 * 0.4183) <
                0.003);
}

/* Checks that changing the stop between frames gives the image of a flare
 * created with that stop, and that stop openings out of range are rejected. */
TEST(changed_stop_equals_a_new_flare)
{
    static const int32_t bad[] = {-1, 1, (1 << 20) - 1, (1 << 30) + 1};
    static int32_t set[3 * WIDTH * HEIGHT], first[3 * WIDTH * HEIGHT];
    struct glint_flare_stats s;
    struct glint_stop stop;

    allocate_and_init_flare(&fx);
    stop = fx.cfg.stop;
    for (int k = 0; k < 4; k++) {
        stop.opening_q30 = bad[k];
        assert_int_equal(glint_flare_set_stop(fx.flare, &stop),
                         GLINT_E_ARGUMENT);
    }
    stop.opening_q30 = 1 << 28;
    assert_ok(glint_flare_set_stop(fx.flare, &stop));
    glint_flare_plan(fx.flare, &fx.rays, &fx.light, 1);
    draw_planned_flare(&fx, set);
    free(fx.mem);
    fx.cfg.stop.opening_q30 = 1 << 28;
    draw_flare_image(&fx, first, &s);
    assert_memory_equal(set, first, sizeof set);
    fx.cfg.stop.opening_q30 = 1;
    assert_int_equal(glint_flare_bytes(&fx.cfg), 0);
}

/* Checks that the finest grid has exactly the max number of cells per row,
 * however much a ghost is bent. */
TEST(finest_grid_has_the_max_cells)
{
    static struct glint_plan_scratch scratch;
    struct glint_plan plan;
    int most = 0;

    fx.rays.pixels_per_mm = real_of(12000, 0);
    fx.rays.fineness = GLINT_MAX_CELLS;
    plan = (struct glint_plan){.frame = &fx.rays,
                               .light = &fx.light,
                               .n_lights = 1,
                               .width = WIDTH,
                               .height = HEIGHT,
                               .opening_q30 = 1 << 30};
    for (int ghost = 0; ghost < (int)fx.lens.header->n_ghosts; ghost++) {
        struct glint_bundle_plan planned = {.ghost = ghost};
        struct glint_bundle bundle;

        glint_plan_bundle(&plan, &fx.light, &planned, &bundle, &scratch);
        most = bundle.n_cells > most ? bundle.n_cells : most;
    }
    assert_int_equal(most, GLINT_MAX_CELLS);
}

/* Checks the sag: how far exact rays lie from the chords between grid points.
 * The barrel's value 0.5 + u^2 / 2 depends on u only. With u in units of the
 * box width, its second derivative is 4, so the chords of n cells lie 4 / 12 /
 * n^2 above it in the mean. */
TEST(sag_matches_the_second_derivative)
{
    static struct glint_plan_scratch scratch;
    struct glint_bundle_plan planned = {.ghost = 0};
    struct glint_bundle bundle;
    struct glint_plan plan;
    double sag;

    plan = (struct glint_plan){.frame = &fx.rays,
                               .light = &fx.light,
                               .n_lights = 1,
                               .width = WIDTH,
                               .height = HEIGHT,
                               .opening_q30 = 1 << 30};
    glint_plan_bundle(&plan, &fx.light, &planned, &bundle, &scratch);
    assert_true(bundle.n_cells >= 8);
    sag = 65536 * 4.0 / 12 / (bundle.n_cells * bundle.n_cells);
    assert_true(fabs(planned.sag_q16[0] - sag) <= 1 + 0.01 * sag);
    assert_int_equal(planned.sag_q16[1], 0);
}

/* Checks that lights outside the model's range of angles are not drawn,
 * whatever the polynomials give there, and need memory only if another light
 * follows. */
TEST(lights_outside_the_model_are_not_drawn)
{
    const int32_t inside_q30 = 1 << 28, outside_q30 = 3 << 27;
    int alone;

    fx.light.sine_q30 = inside_q30;
    alone = plan_and_bin_lights(&fx, 1).bundles;
    fx.light.sine_q30 = outside_q30;
    assert_true(plan_and_bin_lights(&fx, 1).bundles > 0);
    ((struct glint_model_header *)fx.m.data)->sine_hi_q30 = inside_q30;
    assert_int_equal(plan_and_bin_lights(&fx, 1).need_bundles, 0);
    for (int last = 0; last < 2; last++) {
        struct glint_light light[2] = {fx.light, fx.light};
        struct glint_flare_stats s;

        light[last].sine_q30 = inside_q30;
        allocate_and_init_flare(&fx);
        glint_flare_plan(fx.flare, &fx.rays, light, 2);
        glint_flare_bin(fx.flare, &s);
        assert_int_equal(s.need_bundles, last ? 12 : 6);
        assert_int_equal(s.bundles, alone);
        free(fx.mem);
        fx.mem = NULL;
    }
}

/* Checks that a frame without light does not change the image, also after a
 * frame with light. */
TEST(frame_without_light_changes_nothing)
{
    static int32_t px_q20[3 * WIDTH * HEIGHT];
    struct glint_image image =
        glint_image_over(px_q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);
    struct glint_flare_stats s;

    allocate_and_init_flare(&fx);
    glint_flare_plan(fx.flare, &fx.rays, &fx.light, 1);
    draw_planned_flare(&fx, px_q20);
    assert_true(glint_flare_tiles(fx.flare) > 0);
    memset(px_q20, 0, sizeof px_q20);
    glint_flare_plan(fx.flare, &fx.rays, &fx.light, 0);
    glint_flare_bin(fx.flare, &s);
    glint_flare_draw(fx.flare, &image);
    assert_int_equal(s.primitives + s.refs + s.bundles, 0);
    assert_int_equal(glint_flare_tiles(fx.flare), 0);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_int_equal(px_q20[i], 0);
}
