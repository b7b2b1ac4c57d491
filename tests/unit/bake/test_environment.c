/* SPDX-License-Identifier: MIT
 *
 * Checks baked environment maps: directions map to the octahedron and back,
 * negative and non-finite samples are clamped and counted, blurred levels
 * equal sums over all texels, known lights are found, and invalid files are
 * rejected.
 */
#include "bake/environment/sphere.h"
#include "base/blob.h"
#include "glint/view.h"
#include "support/models/texel.h"
#include "support/rng.h"
#include "support/test.h"

enum { WIDTH = 128, HEIGHT = 64, SIDE_LOG2 = 5, SIDE = 1 << SIDE_LOG2 };

static double compute_dot_product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void random_unit_vector(uint32_t *seed, double d[3])
{
    double length;

    do {
        for (int k = 0; k < 3; k++)
            d[k] = rng_signed(seed);
        length = sqrt(compute_dot_product(d, d));
    } while (length > 1 || length < .1);
    for (int k = 0; k < 3; k++)
        d[k] /= length;
}

/* --------------------------------------------------------- octahedral map */

TEST(octahedral_mapping_inverts)
{
    uint32_t seed = 7;
    double sum = 0;

    for (int i = 0; i < 2000; i++) {
        double d[3], back[3], u, v;

        random_unit_vector(&seed, d);
        glint_sphere_locate_direction(d, &u, &v);
        assert_true(u >= 0 && u <= 1 && v >= 0 && v <= 1);
        glint_sphere_compute_direction(u, v, back);
        assert_true(compute_dot_product(d, back) > 1 - 1e-12);
    }
    for (int i = 0; i < 128 * 128; i++) {
        double d[3];

        sum += glint_sphere_compute_direction(
            (i % 128 + .5) / 128, ((double)(i / 128) + .5) / 128, d);
    }
    assert_true(fabs(sum / (128 * 128) / (4 * GLINT_PI) - 1) < 1e-3);
}

/* The octahedral map folds over at its edges. Checks that a texel outside an
 * edge is replaced by its neighbour on the sphere. */
TEST(texels_outside_an_edge_map_to_neighbours)
{
    struct glint_sphere s;

    assert_true(glint_sphere_allocate(&s, SIDE));
    for (int k = -1; k <= SIDE; k++) {
        const int across[4][4] = {{-1, k, 0, k},
                                  {SIDE, k, SIDE - 1, k},
                                  {k, -1, k, 0},
                                  {k, SIDE, k, SIDE - 1}};

        for (int e = 0; e < 4; e++) {
            const size_t a =
                glint_sphere_get_texel_index(SIDE, across[e][0], across[e][1]);
            const size_t b =
                glint_sphere_get_texel_index(SIDE, across[e][2], across[e][3]);

            assert_true(a < SIDE * SIDE && b < SIDE * SIDE);
            /* Neighbours on the sphere are at most as far apart as the diagonal
             * of the largest texel. */
            assert_true(
                compute_dot_product(s.texel[a].toward, s.texel[b].toward) >
                cos(2 * sqrt(6) / SIDE));
        }
    }
    glint_sphere_free(&s);
}

/* ------------------------------------------------------- levels of the map */

struct baked {
    unsigned char *data;
    size_t bytes;
    struct glint_environment_report report;
    struct glint_environment environment;
};

static float picture[HEIGHT][WIDTH][3];
static const struct glint_float_image image = {WIDTH, HEIGHT, (float *)picture};

/* Fills the picture with LIGHT(direction) in R, half of this in G, and a
 * quarter in B. */
static void paint_panorama(double (*light)(const double d[3]))
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double east = 2 * GLINT_PI * ((x + .5) / WIDTH - .5);
            const double up = GLINT_PI * (.5 - (y + .5) / HEIGHT);
            const double d[3] = {cos(up) * sin(east), sin(up),
                                 cos(up) * cos(east)};

            for (int c = 0; c < 3; c++)
                picture[y][x][c] = (float)ldexp(light(d), -c);
        }
}

static void bake_panorama(struct baked *b,
                          const struct glint_environment_options *o)
{
    struct glint_error error;
    const char *reason = "";

    if (glint_environment_bake(&image, o, "a night!", UINT64_C(0x123456789),
                               &b->data, &b->bytes, &b->report,
                               &error) != GLINT_OK)
        fail_msg("%s", error.text);
    test_free_later(b->data);
    if (glint_environment_open(&b->environment, b->data, b->bytes, &reason) !=
        GLINT_OK)
        fail_msg("%s", reason);
}

static struct glint_environment_options make_environment_options(void)
{
    struct glint_environment_options o;

    glint_environment_defaults(&o);
    o.side_log2 = SIDE_LOG2;
    return o;
}

static double compute_uniform_light(const double d[3])
{
    (void)d;
    return 12.5;
}

TEST(uniform_light_stays_uniform)
{
    const struct glint_environment_options o = make_environment_options();
    struct baked b;

    paint_panorama(compute_uniform_light);
    bake_panorama(&b, &o);
    assert_string_equal(b.environment.header->name, "anight");
    assert_int_equal(b.environment.header->key[1], 1);
    assert_int_equal(b.environment.header->n_lights, 0);
    assert_true(b.report.negative == 0 && b.report.not_finite == 0);
    for (int k = 0; k <= SIDE_LOG2; k++)
        for (size_t i = 0; i >> (2 * b.environment.level[k].side_log2) == 0;
             i++)
            assert_true(fabs(decode_texel(&b.environment, k, i, 0) - 12.5) <
                        12.5 / 1000);
    for (int i = 0; i < 1024; i++)
        assert_true(
            fabs(decode_rgb9e5(&b.environment, b.environment.irradiance[i], 1) -
                 6.25) < 6.25 * .003);
}

static double compute_linear_light(const double d[3])
{
    return 1 + d[1];
}

/* Returns light that is brightest in front. If the environment is rotated to
 * the right by 90 degrees, the light is 1 + x. The irradiance of a white
 * surface is then proportional to 1 + 2/3 x. */
static double compute_forward_light(const double d[3])
{
    return 1 + d[2];
}

TEST(irradiance_matches_closed_form)
{
    struct glint_environment_options o = make_environment_options();
    double worst = 0;

    for (int turned = 0; turned < 2; turned++) {
        struct baked b;

        o.turn_deg = 90 * turned;
        o.scale = 1 + turned;
        paint_panorama(turned ? compute_forward_light : compute_linear_light);
        bake_panorama(&b, &o);
        for (int i = 0; i < 1024; i++) {
            double n[3], want;

            glint_sphere_compute_direction((i % 32 + .5) / 32,
                                           ((double)(i / 32) + .5) / 32, n);
            want = o.scale * (1 + 2. / 3 * n[turned ? 0 : 1]);
            worst =
                fmax(worst, fabs(decode_rgb9e5(&b.environment,
                                               b.environment.irradiance[i], 0) /
                                     want -
                                 1));
        }
    }
    print_message("irradiance: off by %.3f %% at most\n", 100 * worst);
    assert_true(worst < .006);
}

static double compute_patchy_light(const double d[3])
{
    return 1 + fmax(0, sin(9 * d[0]) * sin(7 * d[1] + 1) + sin(11 * d[2])) +
           (d[0] > .3 && d[1] > .2 ? 5 : 0);
}

/* Checks that every Gaussian level equals the weighted sum over all texels,
 * except for the weight outside four sigma, where the bake skips blocks. */
TEST(levels_equal_sums_over_all_texels)
{
    struct glint_environment_options o = make_environment_options();
    struct glint_environment_report report = {0};
    struct glint_sphere s;
    struct baked b;
    double worst = 0;

    paint_panorama(compute_patchy_light);
    o.max_lights = 0;
    bake_panorama(&b, &o);
    assert_true(glint_sphere_allocate(&s, 2 * SIDE));
    assert_true(glint_sphere_project_panorama(&s, &image, &o, &report));
    for (int k = 0; k <= SIDE_LOG2; k++) {
        const double sigma = sqrt(4 * GLINT_PI) / SIDE * ldexp(1, k - 1);
        const int side = 1 << b.environment.level[k].side_log2;

        for (int i = 0; i < side * side; i += side * side / 16 + 1) {
            double d[3], sum = 0, weight = 0;

            glint_sphere_compute_direction((i % side + .5) / side,
                                           ((double)(i / side) + .5) / side, d);
            for (int j = 0; j < 4 * SIDE * SIDE; j++) {
                const double w =
                    s.texel[j].weight *
                    exp((compute_dot_product(d, s.texel[j].toward) - 1) /
                        (sigma * sigma));

                sum += w * s.texel[j].light[0];
                weight += w;
            }
            worst =
                fmax(worst, fabs(decode_texel(&b.environment, k, (size_t)i, 0) /
                                     (sum / weight) -
                                 1));
        }
    }
    print_message("blur: off by %.3f %% at most\n", 100 * worst);
    assert_true(worst < .004);
    glint_sphere_free(&s);
}

/* Checks the numbers of texels of a map of side 256. The side of a Gaussian
 * level is twice that of a mipmap level. */
TEST(b5_levels_have_the_published_sizes)
{
    long mip = 0, full = 0, ours = 0;

    for (uint32_t k = 0; k <= 8; k++) {
        mip += 1L << (2 *
                      glint_environment_side_log2(GLINT_ENVIRONMENT_MIP, 8, k));
        full += 1L << 16;
        ours += 1L << (2 * glint_environment_side_log2(GLINT_ENVIRONMENT_GAUSS,
                                                       8, k));
    }
    assert_true(mip == 87381 && full == 589824 && ours == 152928);
}

TEST(mipmap_levels_average_light)
{
    struct glint_environment_options o = make_environment_options();
    struct baked b;

    paint_panorama(compute_patchy_light);
    o.max_lights = 0;
    o.levels = GLINT_ENVIRONMENT_MIP;
    bake_panorama(&b, &o);
    for (int k = 1; k <= SIDE_LOG2; k++) {
        const size_t side = SIDE >> k;

        for (size_t i = 0; i < side * side; i++) {
            const size_t at = 4 * side * (i / side) + 2 * (i % side);
            const double mean =
                (decode_texel(&b.environment, k - 1, at, 0) +
                 decode_texel(&b.environment, k - 1, at + 1, 0) +
                 decode_texel(&b.environment, k - 1, at + 2 * side, 0) +
                 decode_texel(&b.environment, k - 1, at + 2 * side + 1, 0)) /
                4;

            assert_true(fabs(decode_texel(&b.environment, k, i, 0) / mean - 1) <
                        .004);
        }
    }
}

/* -------------------------------------------------------- extracted lights */

static const double sun[3] = {.48, .6, .64};

static double compute_sky_and_sun_light(const double d[3])
{
    return (compute_dot_product(d, sun) > cos(4 * GLINT_PI / 180) ? 4000 : 0) +
           1 + .5 * d[1];
}

/* Checks that the bake extracts a disc of radius 4 degrees as a light, with the
 * direction, power and size of the disc, and fills the resulting hole in the
 * map with the surrounding light. */
TEST(disc_light_is_extracted)
{
    struct glint_environment_options o = make_environment_options();
    const struct glint_environment_light *l;
    double solid = 0; /* solid angle of the pixels of the disc, steradians */
    struct baked b;
    double d[3], power, u, v;

    paint_panorama(compute_sky_and_sun_light);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if (picture[y][x][0] > 100)
                solid += 2 * GLINT_PI / WIDTH * GLINT_PI / HEIGHT *
                         cos(GLINT_PI * (.5 - (y + .5) / HEIGHT));
    bake_panorama(&b, &o);
    assert_int_equal(b.environment.header->n_lights, 1);
    l = b.environment.light;
    for (int k = 0; k < 3; k++)
        d[k] = ldexp(l->toward_q30[k], -30);
    power = glint_real_value(l->rgb[0]) / (4000 * solid / GLINT_PI);
    print_message("light: %.3f deg off, %.4f of its power, %.2f deg, share "
                  "%.4f, rest %.3f\n",
                  180 / GLINT_PI * acos(compute_dot_product(d, sun)), power,
                  180 / GLINT_PI * asin(ldexp(l->radius_q30, -30)),
                  b.report.light_share, b.report.residual_largest);
    assert_true(compute_dot_product(d, sun) > cos(.5 * GLINT_PI / 180));
    assert_true(fabs(power - 1) < .002);
    assert_true(fabs(asin(ldexp(l->radius_q30, -30)) * 180 / GLINT_PI - 4) <
                .8);
    assert_true(fabs(glint_real_value(l->rgb[1]) / glint_real_value(l->rgb[0]) -
                     .5) < 1e-6);
    assert_true(b.report.residual_largest < 1.6);
    glint_sphere_locate_direction(sun, &u, &v);
    assert_true(fabs(decode_texel(&b.environment, 0,
                                  glint_sphere_get_texel_index(
                                      SIDE, (int)(SIDE * u), (int)(SIDE * v)),
                                  0) -
                     1.3) < .08);
    /* the map levels and the extracted lights together have the light of the
     * picture */
    assert_true(fabs(b.report.light_share -
                     (power * 4000 * solid) /
                         (power * 4000 * solid + 4 * GLINT_PI)) < .002);
    o.max_lights = 0;
    bake_panorama(&b, &o);
    assert_int_equal(b.environment.header->n_lights, 0);
    assert_true(b.report.residual_largest > 2000);
}

static double compute_bright_window_light(const double d[3])
{
    return (d[2] > .9 ? 500 : 0) + 1;
}

/* Checks that wide lights are not extracted from the map, and that the
 * extraction of two discs that touch loses no light. */
TEST(wide_and_touching_lights_lose_no_light)
{
    const struct glint_environment_options o = make_environment_options();
    struct baked b;

    paint_panorama(compute_bright_window_light);
    bake_panorama(&b, &o);
    assert_int_equal(b.environment.header->n_lights, 0);
    assert_true(b.report.residual_largest > 250);
}

/* -------------------------------------------------- samples and cube maps */

TEST(clamps_invalid_samples)
{
    const struct glint_environment_options o = make_environment_options();
    struct glint_environment_options odd;
    struct glint_error error;
    struct glint_float_image narrow = image;
    struct baked b;

    paint_panorama(compute_uniform_light);
    picture[3][4][1] = -1;
    picture[5][6][0] = -2e30f;
    picture[10][8][2] = NAN;
    picture[12][8][0] = INFINITY;
    picture[14][9][0] = -INFINITY;
    bake_panorama(&b, &o);
    assert_true(b.report.negative == 2 && b.report.not_finite == 3);
    assert_true(b.report.largest < 12.6 * .9 && b.report.mean > 6);
    narrow.width = 100;
    assert_int_equal(glint_environment_bake(&narrow, &o, "x", 0, &b.data,
                                            &b.bytes, &b.report, &error),
                     GLINT_E_UNSUPPORTED);
    assert_non_null(strstr(error.text, "100x64"));
    for (int k = 0; k < 4; k++) {
        odd = o;
        odd.side_log2 = k == 0 ? 3 : k == 1 ? 11 : odd.side_log2;
        odd.max_lights = k == 2 ? 17 : 0;
        odd.scale = k == 3 ? 0 : 1;
        assert_int_equal(glint_environment_bake(&image, &odd, "x", 0, &b.data,
                                                &b.bytes, &b.report, &error),
                         GLINT_E_ARGUMENT);
    }
    memset(picture, 0, sizeof picture); /* a black picture is valid */
    bake_panorama(&b, &o);
    assert_true(decode_texel(&b.environment, 2, 3, 0) == 0);
}

/* Checks that the six faces of a cube map, each of a different light, appear in
 * the right directions. */
TEST(cube_faces_have_their_directions)
{
    static const double middle[6][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                                        {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    struct glint_environment_options o = make_environment_options();
    struct glint_environment_report report = {0};
    float faces[16][24][3];
    const struct glint_float_image cube = {24, 16, (float *)faces};
    struct glint_sphere s;

    for (int y = 0; y < 16; y++)
        for (int x = 0; x < 24; x++)
            for (int c = 0; c < 3; c++)
                faces[y][x][c] = (float)(1 + x / 8 + 3 * (y / 8));
    assert_true(glint_sphere_allocate(&s, SIDE));
    assert_true(glint_sphere_project_panorama(&s, &cube, &o, &report));
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int f = 0; f < 6; f++)
            if (compute_dot_product(s.texel[i].toward, middle[f]) > .82)
                assert_true(fabs(s.texel[i].light[0] - (1 + f)) < 1e-9);
    glint_sphere_free(&s);
}

/* ------------------------------------------------------------ RGB9E5 codes */

TEST(rgb9e5_codes_round_trip)
{
    enum { N = 4096 };
    static double light[N][3];
    static uint32_t words[N];
    uint32_t seed = 3;

    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++)
            light[i][c] =
                ldexp(rng_int_below(&seed, 65536), -rng_int_below(&seed, 20));
    light[0][0] = 65536;
    glint_environment_encode_9e5((const double(*)[3])light, N, 0x1p-8, words);
    for (int i = 0; i < N; i++) {
        const double top = fmax(light[i][0], fmax(light[i][1], light[i][2]));
        const int e = (int)(words[i] >> 27);

        for (int c = 0; c < 3; c++) {
            assert_true(fabs(ldexp(words[i] >> (9 * c) & 511, e - 12 - 8) -
                             light[i][c]) <= fmax(top / 510, 0x1p-21));
        }
    }
}

/* ------------------------------------------------------------------- files */

static void expect_damaged(const struct baked *b, size_t at, uint32_t value,
                           const char *why)
{
    unsigned char *copy = test_free_later(malloc(b->bytes));
    struct glint_environment e;
    const char *reason = "nothing";

    memcpy(copy, b->data, b->bytes);
    memcpy(copy + at, &value, sizeof value);
    if (at != offsetof(struct glint_environment_header, crc32))
        glint_blob_set_size_and_checksum(copy, b->bytes);
    assert_int_equal(glint_environment_open(&e, copy, b->bytes, &reason),
                     GLINT_E_FORMAT);
    if (!strstr(reason, why))
        fail_msg("%zu: %s, not %s", at, reason, why);
}

#define AT(field) offsetof(struct glint_environment_header, field)

TEST(rejects_damaged_files)
{
    const struct glint_environment_options o = make_environment_options();
    struct baked b;
    const struct glint_environment_header *h;

    paint_panorama(compute_sky_and_sun_light);
    bake_panorama(&b, &o);
    h = b.environment.header;
    expect_damaged(&b, AT(magic), 0, "not a baked environment");
    expect_damaged(&b, AT(version), 9, "newer");
    expect_damaged(&b, AT(crc32), 0, "checksum");
    expect_damaged(&b, AT(variant), 2, "unknown");
    expect_damaged(&b, AT(code), 2, "unknown");
    expect_damaged(&b, AT(name), 0, "name is empty");
    expect_damaged(&b, AT(side_log2), 11, "out of range");
    expect_damaged(&b, AT(side_log2), 6, "out of range");
    expect_damaged(&b, AT(unit_log2), 101, "scale");
    expect_damaged(&b, AT(n_levels), 5, "out of range");
    expect_damaged(&b, AT(n_lights), 17, "out of range");
    expect_damaged(&b, AT(level_at), (uint32_t)b.bytes, "outside");
    expect_damaged(&b, AT(irradiance_at), 8, "outside");
    expect_damaged(&b, AT(light_at), (uint32_t)b.bytes - 4, "outside");
    expect_damaged(&b, h->level_at, 4, "size of a mip level");
    expect_damaged(&b, h->level_at + 4, 2, "outside");
    expect_damaged(&b, h->level_at + 8, (1u << 28) + 1, "size of a mip level");
    expect_damaged(&b, h->level_at + 12, 1, "size of a mip level");
    expect_damaged(&b, h->light_at, 0, "unit vector");
    expect_damaged(&b, h->light_at + 12, 1u << 30, "too large");
    expect_damaged(&b, h->light_at + 16, 5, "normalised");
}

/* ------------------------------------------------------------------- texts */

static enum glint_status
parse_environment_text(const char *text, struct glint_environment_options *o,
                       char *source, struct glint_error *error)
{
    return glint_environment_parse(o, source, text, strlen(text),
                                   "n.environment", error);
}

static void check_text_is_rejected(const char *text, const char *why)
{
    struct glint_environment_options o;
    char source[GLINT_ENVIRONMENT_FILE_BYTES];
    struct glint_error error;

    assert_int_equal(parse_environment_text(text, &o, source, &error),
                     GLINT_E_LENS);
    if (!strstr(error.text, why))
        fail_msg("%s\nnot\n%s", error.text, why);
}

TEST(parses_environment_text)
{
    struct glint_environment_options o;
    char source[GLINT_ENVIRONMENT_FILE_BYTES];
    struct glint_error error;

    assert_ok(parse_environment_text("# night\nsource a night.exr\nsize 128\n"
                                     "turn -90\nscale .5\n"
                                     "lights 3 radius 2.5 above 20\n",
                                     &o, source, &error));
    assert_string_equal(source, "a night.exr");
    assert_true(o.side_log2 == 7 && o.turn_deg == -90 && o.scale == .5 &&
                o.max_lights == 3 && o.light_deg == 2.5 && o.light_above == 20);
    check_text_is_rejected(
        "size 128\n", "n.environment:2:1: the line 'source FILE' is missing");
    check_text_is_rejected(
        "source\n",
        "n.environment:1:7: the file name is missing: source PICTURE");
    check_text_is_rejected("source x\nsize 100\n",
                           "2:6: size accepts 16, 32, 64, 128, 256, 512 or "
                           "1024, not '100'");
    check_text_is_rejected("source x\nturn 400\n", "turn");
    check_text_is_rejected("source x\nlights 17\n", "lights");
    check_text_is_rejected("source x\nlights 3 radios 2\n",
                           "did you mean 'radius'?");
    check_text_is_rejected("source x\nsize 64 64\n",
                           "'64' is one value too many for size");
    check_text_is_rejected("source x\nsource y\n",
                           "2:1: a second source; the first is on line 1");
    check_text_is_rejected("sources x\n",
                           "unknown word 'sources'; did you mean 'source'?");
}
