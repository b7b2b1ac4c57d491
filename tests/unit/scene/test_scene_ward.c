/* SPDX-License-Identifier: MIT
 *
 * Tests Ward's reflection lobe over an environment map: samples and levels, a
 * lobe in uniform light (white furnace), and the lookups in double precision.
 */
#include "glint/view.h"
#include "support/models/texel.h"
#include "support/models/ward_ball.h"
#include "support/test.h"

enum { WIDTH = 128, HEIGHT = 64, SIDE_LOG2 = 6 };

static float pixels[HEIGHT][WIDTH][3];
static const struct glint_float_image image = {WIDTH, HEIGHT, (float *)pixels};

struct map {
    unsigned char *data;
    struct glint_environment e;
};

static void paint_environment_image(int is_even)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double a = x * .1, b = y * .1;
            const double light = 1 + fmax(0, 3 * sin(3 * a) * sin(4 * b)) +
                                 (x % 37 < 3 && y % 23 < 3 ? 40 : 0);

            for (int c = 0; c < 3; c++)
                pixels[y][x][c] = is_even ? 1 : (float)(light * (3 - c) / 3);
        }
}

static void bake_and_open_environment(struct map *m, int levels)
{
    struct glint_environment_options o;
    struct glint_environment_report report;
    struct glint_error error;
    const char *reason = "";
    size_t bytes;

    glint_environment_defaults(&o);
    o.side_log2 = SIDE_LOG2;
    o.levels = (enum glint_environment_levels)levels;
    o.max_lights = 0;
    assert_ok(glint_environment_bake(&image, &o, "x", 0, &m->data, &bytes,
                                     &report, &error));
    test_free_later(m->data);
    assert_ok(glint_environment_open(&m->e, m->data, bytes, &reason));
}

static struct glint_ward_material make_metal_material(double x, double y)
{
    return (struct glint_ward_material){
        {32768, 32768, 32768},
        {(int32_t)lrint(0x1p24 * x), (int32_t)lrint(0x1p24 * y)},
        GLINT_WARD_BOUNDED};
}

static const struct glint_ward_options eight = {8, GLINT_WARD_CONSTANT, 0, 0};

/* ------------------------------------------------- albedo in uniform light */

/* Returns the albedo of the lobe with normalisation NORM in uniform light of 1,
 * integrated in double precision. NO: cosine of the angle between normal and
 * view. */
static double integrate_lobe_albedo(int norm, double no, double alpha)
{
    const double frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double view[3] = {sqrt(1 - no * no), 0, no};
    const double both[2] = {alpha, alpha};
    enum { N = 600 };
    double sum = 0;

    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            const double z = (i + .5) / N, phi = 2 * GLINT_PI * (j + .5) / N;
            const double in[3] = {sqrt(1 - z * z) * cos(phi),
                                  sqrt(1 - z * z) * sin(phi), z};

            sum += ward_evaluate_lobe(frame, view, both, norm, in);
        }
    return sum * 2 * GLINT_PI / (N * N);
}

TEST(furnace_albedo_is_1)
{
    static const double cosine[4] = {1, .7, .3, .1};
    /* albedos at these cosines with the bounded normalisation, which is below 1
     * at grazing angles */
    static const double stated[4] = {.998, .996, .984, .889};
    const int32_t frame_q14[3][3] = {
        {16384, 0, 0}, {0, 16384, 0}, {0, 0, 16384}};
    struct glint_ward_options o = {32, GLINT_WARD_PUBLISHED, 0, 0};
    struct map m;

    paint_environment_image(1);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    for (int norm = 0; norm < 2; norm++)
        for (int k = 0; k < 4; k++) {
            const double no = cosine[k];
            const int32_t view_q14[3] = {
                (int32_t)lrint(0x1p14 * sqrt(1 - no * no)), 0,
                (int32_t)lrint(0x1p14 * no)};
            struct glint_ward_material material = make_metal_material(.05, .05);
            struct glint_ward_lobe lobe;
            int32_t rgb_q15[3];
            double want = integrate_lobe_albedo(norm, no, .05), got;

            material.norm = (enum glint_ward_norm)norm;
            glint_ward_prepare(&lobe, &m.e, &material, &o);
            glint_ward_light(&lobe, &m.e, frame_q14, view_q14, rgb_q15);
            got = rgb_q15[0] * 0x1p-15;
            print_message("furnace, norm %s, n.o %.1f: %.3f, albedo %.3f\n",
                          norm ? "of 1992" : "bounded", no, got, want);
            assert_true(fabs(got - want) < .01);
            if (norm == GLINT_WARD_BOUNDED)
                assert_true(fabs(got - stated[k]) < .01);
        }
}

/* --------------------------------------------- lookups in double precision */

static double look_up_level_in_double(const struct glint_environment *e, int k,
                                      const double toward[3], int c)
{
    const int side = 1 << e->level[k].side_log2;
    double u, v, x, y, sum = 0;

    glint_sphere_locate_direction(toward, &u, &v);
    x = u * side - .5;
    y = v * side - .5;
    for (int j = 0; j < 4; j++) {
        const int i = (int)floor(x) + (j & 1), l = (int)floor(y) + (j >> 1);

        sum += (1 - fabs(x - i)) * (1 - fabs(y - l)) *
               decode_texel(e, k, glint_sphere_get_texel_index(side, i, l), c);
    }
    return sum;
}

static double look_up_between_levels(const struct glint_environment *e,
                                     const double toward[3], double level,
                                     int c)
{
    const double last = e->header->n_levels - 1;
    const int k = (int)(level = fmin(fmax(level, 0), last));

    return level <= k ? look_up_level_in_double(e, k, toward, c)
                      : (4 - pow(4, level - k)) / 3 *
                                look_up_level_in_double(e, k, toward, c) +
                            (pow(4, level - k) - 1) / 3 *
                                look_up_level_in_double(e, k + 1, toward, c);
}

/* Sets SLOPE to the slopes of N half vectors that sample Ward's lobe of alpha
 * 1, all with the same footprint. Returns the factor of the footprints. */
static double compute_half_vector_slopes(int n, const double alpha[2],
                                         double slope[GLINT_WARD_SAMPLES][2])
{
    const double f = (n == 1 ? 1 : n == 4 ? 1.4 : n == 32 ? 3 : 2) / n;
    const double least = fmin(alpha[0], alpha[1]);
    const double b = fmin(f * alpha[0] * alpha[1], .75 * least * least);

    for (int k = 0; k < n; k++) {
        double v = 0;

        for (int bit = 0; bit < 5; bit++)
            v += (k >> bit & 1) * ldexp(1, -1 - bit);
        slope[k][0] = sqrt(-log((k + .5) / n)) * cos(2 * GLINT_PI * v);
        slope[k][1] = sqrt(-log((k + .5) / n)) * sin(2 * GLINT_PI * v);
    }
    for (int axis = 0; axis < 2; axis++) {
        const double matched = 1 - b / (alpha[axis] * alpha[axis]);
        const double spread = (1 - f + fmax(matched, 0)) / 2;
        double mean = 0, square = 0;

        for (int k = 0; k < n; k++)
            mean += slope[k][axis] / n;
        for (int k = 0; k < n; k++) {
            slope[k][axis] -= mean;
            square += slope[k][axis] * slope[k][axis] / n;
        }
        for (int k = 0; k < n; k++)
            slope[k][axis] *= square > .01 ? sqrt(spread / 2 / square) : 0;
    }
    return b;
}

static void compute_pixel_by_samples(const struct glint_environment *e,
                                     const double alpha[2], int n,
                                     const double frame[3][3], double rgb[3])
{
    double slope[GLINT_WARD_SAMPLES][2];
    const double blur = 2 * compute_half_vector_slopes(n, alpha, slope);
    const double texel = sqrt(4 * GLINT_PI) / (1 << SIDE_LOG2);

    for (int k = 0; k < n; k++) {
        double h[3] = {alpha[0] * slope[k][0], alpha[1] * slope[k][1], 1};
        double toward[3], ho = 0, ni = 0, length;

        length = sqrt(h[0] * h[0] + h[1] * h[1] + 1);
        for (int j = 0; j < 3; j++)
            ho -= h[j] / length * frame[j][2]; /* the viewer is at -z */
        for (int j = 0; j < 3; j++) {
            toward[j] = j == 2 ? 1 : 0;
            for (int i = 0; i < 3; i++)
                toward[j] += 2 * ho * h[i] / length * frame[i][j];
            ni += toward[j] * frame[2][j];
        }
        if (ho <= 0 || ni <= 0)
            continue;
        for (int c = 0; c < 3; c++)
            rgb[c] += fmin(ni / (ho / length), 8) / n *
                      look_up_between_levels(
                          e, toward, log2(2 * sqrt(blur * ho) / texel), c);
    }
}

TEST(samples_approximate_the_sum_over_texels)
{
    static const int samples[5] = {1, 4, 8, 16, 32};
    static ward_picture want, got;
    double least = 200;
    struct map m;

    paint_environment_image(0);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    for (int k = 0; k < 10; k++) {
        const double alpha[2] = {.05, k / 5 ? .05 : .3};
        const struct glint_ward_material material =
            make_metal_material(alpha[0], alpha[1]);
        struct glint_ward_options o = eight;

        o.samples = samples[k % 5];
        memset(want, 0, sizeof want);
        for (int i = 0; i < WARD_PIXELS; i++) {
            double frame[3][3];

            if (ward_build_frame(i, frame))
                compute_pixel_by_samples(&m.e, alpha, o.samples,
                                         (const double(*)[3])frame, want[i]);
        }
        ward_render_by_lookups(&m.e, &material, &o, got);
        least = fmin(least, ward_compute_psnr(want, got));
    }
    print_message("reference: %.1f dB at least\n", least);
    assert_true(least >= 60);
}

/* ------------------------------------------------------ samples and levels */

/* Sets TO to the ball's image, averaged over N uniform directions of the
 * hemisphere. Each is looked up in the mipmap level that matches its solid
 * angle. */
static void render_by_uniform_directions(const struct glint_environment *e,
                                         const double alpha[2], int n,
                                         ward_picture to)
{
    const double view[3] = {0, 0, -1};
    const double level =
        .5 * log2(2 * GLINT_PI / n * ldexp(1, 2 * SIDE_LOG2) / (4 * GLINT_PI));

    for (int i = 0; i < WARD_PIXELS; i++) {
        double frame[3][3];

        memset(to[i], 0, sizeof to[i]);
        for (int k = 0; k < n && ward_build_frame(i, frame); k++) {
            const double z = (k + .5) / n, turn = 2 * GLINT_PI * .618034 * k;
            double toward[3], w;

            for (int j = 0; j < 3; j++)
                toward[j] = z * frame[2][j] +
                            sqrt(1 - z * z) * (cos(turn) * frame[0][j] +
                                               sin(turn) * frame[1][j]);
            w = ward_evaluate_lobe((const double(*)[3])frame, view, alpha,
                                   GLINT_WARD_BOUNDED, toward) *
                2 * GLINT_PI / n;
            for (int c = 0; c < 3; c++)
                to[i][c] += w * look_up_between_levels(e, toward, level, c);
        }
    }
}

struct reference {
    struct glint_sphere sphere;
    ward_picture want;
};

static void render_by_sum_of_texels(const double alpha[2], struct reference *r)
{
    struct glint_environment_options o;
    struct glint_environment_report report = {0};

    glint_environment_defaults(&o);
    assert_true(glint_sphere_allocate(&r->sphere, 1 << SIDE_LOG2));
    assert_true(glint_sphere_project_panorama(&r->sphere, &image, &o, &report));
    ward_render_by_texel_sums(&r->sphere, alpha, r->want);
    glint_sphere_free(&r->sphere);
}

/* Half vectors drawn by the published density of the lobe must have a smaller
 * error than uniform directions, for every number of samples and alphas up to
 * .2. With 8 samples, Gaussian levels must have a smaller error than
 * mipmaps. */
TEST(b1_b4_sampled_lobe_beats_uniform_directions)
{
    static const double alphas[3][2] = {{.05, .05}, {.2, .2}, {.05, .2}};
    static const int samples[4] = {1, 4, 8, 32};
    static struct reference r;
    static ward_picture got;
    struct map gauss, mip;

    paint_environment_image(0);
    bake_and_open_environment(&gauss, GLINT_ENVIRONMENT_GAUSS);
    bake_and_open_environment(&mip, GLINT_ENVIRONMENT_MIP);
    for (int a = 0; a < 3; a++) {
        const struct glint_ward_material material =
            make_metal_material(alphas[a][0], alphas[a][1]);
        double by_gauss, by_mip;

        render_by_sum_of_texels(alphas[a], &r);
        for (int k = 0; k < 4; k++) {
            const struct glint_ward_options o = {samples[k],
                                                 GLINT_WARD_PUBLISHED, 0, 0};
            double ward, whole;

            ward_render_by_lookups(&mip.e, &material, &o, got);
            ward = ward_compute_psnr(r.want, got);
            render_by_uniform_directions(&mip.e, alphas[a], samples[k], got);
            whole = ward_compute_psnr(r.want, got);
            print_message("B1, alpha %g, %g, N %d: %.1f dB, hemisphere %.1f\n",
                          alphas[a][0], alphas[a][1], samples[k], ward, whole);
            assert_true(ward > whole);
        }
        ward_render_by_lookups(&gauss.e, &material, &eight, got);
        by_gauss = ward_compute_psnr(r.want, got);
        ward_render_by_lookups(&mip.e, &material, &eight, got);
        by_mip = ward_compute_psnr(r.want, got);
        print_message("B4, alpha %g, %g: %.1f dB, mips %.1f\n", alphas[a][0],
                      alphas[a][1], by_gauss, by_mip);
        assert_true(by_gauss > by_mip);
    }
}

/* Changes colours and alphas of materials that share one baked environment.
 * Checks that each lobe is that of its material, and that it is proportional to
 * the colour. */
TEST(b2_materials_share_an_environment)
{
    static ward_picture red, white, wide;
    struct glint_ward_material material = make_metal_material(.05, .1);
    struct map m;
    double differ = 0;

    paint_environment_image(0);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    ward_render_by_lookups(&m.e, &material, &eight, white);
    material.specular_q15[0] = 1 << 14;
    material.specular_q15[1] = 0;
    ward_render_by_lookups(&m.e, &material, &eight, red);
    material = make_metal_material(.3, .1);
    ward_render_by_lookups(&m.e, &material, &eight, wide);
    for (int i = 0; i < WARD_PIXELS; i++) {
        assert_true(fabs(red[i][0] - white[i][0] / 2) <= 0x1p-15);
        assert_true(red[i][1] == 0 && red[i][2] == white[i][2]);
        differ = fmax(differ, fabs(wide[i][0] - white[i][0]));
    }
    assert_true(differ > .2);
}

/* Checks that 8 samples are sufficient: they must reach 30 dB in display codes,
 * on a map of spots and waves. */
TEST(b8_eight_samples_are_sufficient)
{
    static const double alphas[3][2] = {{.05, .05}, {.1, .1}, {.05, .2}};
    static struct reference r;
    static ward_picture got;
    struct map m;

    paint_environment_image(0);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    for (int a = 0; a < 3; a++) {
        const struct glint_ward_material material =
            make_metal_material(alphas[a][0], alphas[a][1]);
        double db;

        render_by_sum_of_texels(alphas[a], &r);
        ward_render_by_lookups(&m.e, &material, &eight, got);
        db = ward_compute_psnr_of_codes(r.want, got);
        print_message("B8, alpha %g, %g: %.1f dB\n", alphas[a][0], alphas[a][1],
                      db);
        assert_true(db >= 30);
    }
}

/* Checks that images with more samples are closer to the sum over all
 * texels. */
TEST(b6_more_samples_come_closer)
{
    static const int samples[3] = {1, 8, 32};
    static const double alpha[2] = {.1, .1};
    const struct glint_ward_material material = make_metal_material(.1, .1);
    static struct reference r;
    static ward_picture got;
    struct map m;
    double last = 0;

    paint_environment_image(0);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    render_by_sum_of_texels(alpha, &r);
    for (int k = 0; k < 3; k++) {
        struct glint_ward_options o = eight;
        double db;

        o.samples = samples[k];
        ward_render_by_lookups(&m.e, &material, &o, got);
        db = ward_compute_psnr(r.want, got);
        print_message("B6, N %d: %.1f dB\n", samples[k], db);
        assert_true(db > last + 1);
        last = db;
    }
}

/* Checks that extreme environments (black, one texel of 1e9, scales of 1e-6 ..
 * 1e9) only scale the image of a ball. */
TEST(extreme_environments_only_scale_the_image)
{
    static ward_picture one, got;
    const struct glint_ward_material material = make_metal_material(.1, .1);
    struct map m;

    memset(pixels, 0, sizeof pixels);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    ward_render_by_lookups(&m.e, &material, &eight, got);
    for (int i = 0; i < WARD_PIXELS; i++)
        assert_true(got[i][0] == 0 && got[i][1] == 0 && got[i][2] == 0);
    paint_environment_image(0);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    ward_render_by_lookups(&m.e, &material, &eight, one);
    for (int power = -12; power <= 12; power += 6) {
        paint_environment_image(0);
        for (int i = 0; i < HEIGHT * WIDTH * 3; i++)
            ((float *)pixels)[i] *= ldexpf(1, power);
        bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
        ward_render_by_lookups(&m.e, &material, &eight, got);
        for (int i = 0; i < WARD_PIXELS; i++)
            assert_true(
                fabs(got[i][0] - fmin(ldexp(one[i][0], power), 1 << 15)) <=
                0x1p-14 + fabs(got[i][0]) * 1e-3);
    }
    memset(pixels, 0, sizeof pixels);
    pixels[HEIGHT / 2][WIDTH / 2][1] = 1e9f;
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    ward_render_by_lookups(&m.e, &material, &eight, got);
    for (int i = 0; i < WARD_PIXELS; i++)
        assert_true(got[i][0] == 0 && got[i][1] >= 0 && got[i][1] <= 1 << 15);
}

/* Checks that an anisotropy ratio of 200 is clamped to 10, and that the call
 * reports this. */
TEST(b7_extreme_anisotropy_is_clamped)
{
    struct glint_ward_lobe held, plain;
    struct glint_ward_material material = make_metal_material(.001, .2);
    struct map m;

    paint_environment_image(0);
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_GAUSS);
    memset(&held, 0, sizeof held);
    memset(&plain, 0, sizeof plain);
    assert_int_equal(glint_ward_prepare(&held, &m.e, &material, &eight), 1);
    material.alpha_q24[0] = (material.alpha_q24[1] + 9) / 10;
    assert_int_equal(glint_ward_prepare(&plain, &m.e, &material, &eight), 0);
    assert_memory_equal(&held, &plain, sizeof held);
    material = make_metal_material(.2, .001);
    assert_int_equal(glint_ward_prepare(&held, &m.e, &material, &eight), 1);
}

/* Checks that any valid material, view and file give light in the allowed
 * range. */
TEST(any_valid_material_gives_light_in_range)
{
    static const double alpha[4] = {.001, .01, .5, 1};
    struct map m;
    int32_t most = 0;

    paint_environment_image(0);
    pixels[9][9][0] = 1e9f;
    bake_and_open_environment(&m, GLINT_ENVIRONMENT_MIP);
    for (int k = 0; k < 16 * GLINT_WARD_SAMPLES; k++) {
        struct glint_ward_material material =
            make_metal_material(alpha[k & 3], alpha[k >> 2 & 3]);
        const struct glint_ward_options o = {
            1 + k / 16, (enum glint_ward_rule)(k & 1), k % 7 * 200 - 600, 0};
        const int32_t frame_q14[3][3] = {
            {0, 16384, 0}, {0, 0, 16384}, {16384, 0, 0}};
        struct glint_ward_lobe lobe;

        material.norm = (enum glint_ward_norm)(k >> 1 & 1);
        glint_ward_prepare(&lobe, &m.e, &material, &o);
        for (int i = -1; i <= 64; i++) {
            const double no = i / 64.;
            const int32_t view_q14[3] = {
                (int32_t)lrint(0x1p14 * no),
                (int32_t)lrint(0x1p14 * sqrt(1 - no * no)), 0};
            int32_t rgb_q15[3];

            glint_ward_light(&lobe, &m.e, frame_q14, view_q14, rgb_q15);
            for (int c = 0; c < 3; c++)
                assert_true(rgb_q15[c] >= 0 && rgb_q15[c] <= 1 << 30);
            assert_true(i > 0 || rgb_q15[0] == 0);
            most = rgb_q15[0] > most ? rgb_q15[0] : most;
        }
    }
    assert_int_equal(most, 1 << 30);
}
