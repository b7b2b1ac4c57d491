/* SPDX-License-Identifier: MIT
 *
 * Tests a zoom lens baked at three positions. At each position it must equal
 * the model of that position. Between positions its rays must land where exact
 * rays do. Files that are not zooms must be rejected.
 */
#include "base/blob.h"
#include "glint/transfer.h"
#include "support/lens_check.h"

enum { POSITIONS = 3 };

static const char table[] = "name t\n"
                            "f-number 20\n"
                            "film 24 16\n"
                            "surface  60    4  12  1.52 60\n"
                            "surface -200  2/8/15  12  air\n"
                            "stop     6/5/3  8\n"
                            "surface  90    4  12  1.62 36\n"
                            "surface -90   40/38/35  12  air\n";

static struct glint_prescription lens;
static struct glint_bake_model model[POSITIONS];
static unsigned char *file;
static size_t bytes;
static struct glint_zoom_lens zoom;

TEST_OPEN
{
    static struct glint_prescription at;
    struct glint_bake_options options;
    struct glint_bake_report report;
    struct glint_error error = {""};
    const char *reason = "";

    parse_lens_text(&lens, table);
    glint_bake_defaults(&options);
    options.max_deg = 8;
    for (int k = 0; k < POSITIONS; k++) {
        unsigned char *data;

        set_lens_at_position(&at, &lens, 0.5 * k);
        if (glint_bake(&at, &options, &data, &model[k].bytes, &report,
                       &error) != GLINT_OK)
            fail_msg("%s", error.text);
        model[k].data = data;
        model[k].along_q30 = k << 29;
    }
    if (glint_bake_zoom(model, POSITIONS, &file, &bytes, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    if (glint_zoom_open(&zoom, file, bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
}

TEST_CLOSE
{
    for (int k = 0; k < POSITIONS; k++)
        free(model[k].data);
    free(file);
}

static const int32_t middle_q24 = (int32_t)(1e6 / (532. * 532.) * (1 << 24));

TEST(zoom_at_a_position_equals_its_model)
{
    static struct glint_transfer a, b;

    for (int k = 0; k < POSITIONS; k++) {
        struct glint_lens alone;
        const char *reason;
        int lit = 0;

        assert_ok(
            glint_lens_open(&alone, model[k].data, model[k].bytes, &reason));
        glint_zoom_set(&zoom, model[k].along_q30);
        assert_int_equal(zoom.header.n_ghosts - zoom.header.n_parts,
                         alone.header->n_ghosts - alone.header->n_parts);
        assert_true(glint_real_value(zoom.header.focal_mm) ==
                    glint_real_value(alone.header->focal_mm));
        for (int g = 0; g < (int)alone.header->n_ghosts; g++)
            for (int32_t s_q30 = 0; s_q30 < 1 << 27; s_q30 += 12345678) {
                const int there =
                    glint_transfer_init(&a, &alone, g, s_q30, middle_q24);

                assert_int_equal(
                    glint_transfer_init(&b, &zoom.lens, g, s_q30, middle_q24),
                    there);
                lit += there;
                if (there)
                    assert_memory_equal(a.table, b.table, sizeof a.table);
            }
        assert_true(lit > 4);
    }
}

/* RMS errors, against exact rays, of the zoom's rays that pass the stop: of the
 * position, pixels of an image 1920 wide, and of the energy, relative. */
struct off {
    double pixels, energies;
};

static struct off measure_error_at_position(double along)
{
    static struct glint_transfer t;
    static struct glint_prescription at;
    static struct glint_path path;
    struct glint_ghost ghost[8];
    struct glint_optics optics;
    double sum = 0, energies = 0;
    int n = 0, n_ghosts;

    set_lens_at_position(&at, &lens, along);
    glint_optics_of(&at, &optics);
    glint_zoom_set(&zoom, (int32_t)lrint(along * 0x1p30));
    n_ghosts = glint_ghost_list(&at, ghost, 8);
    for (int g = 0; g < n_ghosts; g++)
        for (int k = 0; k < 5; k++) {
            const double sine = 0.025 * k;
            const double direction[3] = {sine, 0, sqrt(1 - sine * sine)};

            glint_path_init(&path, &at, &ghost[g], 532);
            if (!glint_transfer_init(&t, &zoom.lens, g,
                                     (int32_t)(sine * 0x1p30), middle_q24))
                continue;
            for (int i = 0; i < 99; i++) {
                const double u = i % 11 / 5. - 1, v = i / 11 / 8.;
                const double x = t.box[0] + u * t.box[1], y = v * t.box[2];
                struct glint_outputs out;
                struct glint_ray ray;

                if (glint_trace(&path, ldexp(x, t.box_exponent),
                                ldexp(y, t.box_exponent), direction, &ray,
                                NULL) != GLINT_RAY_OK ||
                    hypot(ray.stop_x_mm, ray.stop_y_mm) >
                        optics.stop_radius_mm ||
                    hypot(ray.sensor_x_mm, ray.sensor_y_mm) > 14)
                    continue;
                glint_transfer_ray(&t, (int32_t)(u * 0x1p30 - (u > 0)),
                                   (int32_t)(v * 0x1p30 - (v > 0)), &out);
                sum += pow(ldexp(out.at[GLINT_OUT_SENSOR_X],
                                 t.exponent[GLINT_OUT_SENSOR_X]) -
                               ray.sensor_x_mm,
                           2) +
                       pow(ldexp(out.at[GLINT_OUT_SENSOR_Y],
                                 t.exponent[GLINT_OUT_SENSOR_Y]) -
                               ray.sensor_y_mm,
                           2);
                energies += pow(ldexp(out.at[GLINT_OUT_ENERGY],
                                      t.exponent[GLINT_OUT_ENERGY]) /
                                        ray.energy -
                                    1,
                                2);
                n++;
            }
        }
    assert_true(n > 100);
    return (struct off){sqrt(sum / n) * 1920 / 24, sqrt(energies / n)};
}

TEST(interpolation_is_accurate_between_positions)
{
    for (int k = 0; k <= 4; k++) {
        const struct off off = measure_error_at_position(0.25 * k);

        print_message("at %g: %.3f pixels, %.4f of the energy\n", 0.25 * k,
                      off.pixels, off.energies);
        assert_true(off.pixels < (k % 2 ? 8 : 0.1));
        assert_true(off.energies < 0.01);
    }
    assert_true(measure_error_at_position(0.48).pixels < 1 &&
                measure_error_at_position(0.52).pixels < 1);
}

/* -------------------------------------------------- partly baked positions */

/* Checks that ghost G is equal in the zooms A and B at the positions 1/8, 2/8
 * .. 7/8. */
static void check_ghosts_are_equal(struct glint_zoom_lens *a,
                                   struct glint_zoom_lens *b, int g)
{
    static struct glint_transfer from, to;

    for (int k = 1; k < 8; k++) {
        int there;

        memset(&from, 0, sizeof from);
        memset(&to, 0, sizeof to);
        glint_zoom_set(a, k << 27);
        glint_zoom_set(b, k << 27);
        there = glint_transfer_init(&from, &a->lens, g, 1 << 25, middle_q24);
        assert_int_equal(
            glint_transfer_init(&to, &b->lens, g, 1 << 25, middle_q24), there);
        if (there)
            assert_memory_equal(from.table, to.table, sizeof to.table);
    }
}

/* Checks that if only one ghost is baked at the middle position, this ghost is
 * interpolated between three positions and the others between two. */
TEST(partly_baked_position_interpolates_its_ghosts)
{
    static struct glint_zoom_lens some, two;
    static struct glint_prescription at;
    struct glint_bake_model pair[2] = {model[0], model[2]};
    struct glint_bake_model three[POSITIONS] = {model[0], model[1], model[2]};
    bool ghosts[GLINT_MAX_GHOSTS] = {false, true};
    struct glint_bake_options options;
    struct glint_bake_report report;
    struct glint_error error = {""};
    unsigned char *of_some, *of_two;
    const char *reason = "";
    struct glint_lens alone;
    size_t n_some, n_two;

    glint_bake_defaults(&options);
    options.max_deg = 8;
    options.ghosts = three[1].ghosts = ghosts;
    set_lens_at_position(&at, &lens, 0.5);
    assert_ok(glint_bake(&at, &options, &three[1].data, &three[1].bytes,
                         &report, &error));
    assert_ok(glint_lens_open(&alone, three[1].data, three[1].bytes, &reason));
    for (uint32_t g = 0; g < alone.header->n_ghosts; g++)
        assert_int_equal(alone.ghost[g].n_systems > 0,
                         g == 1 || g + alone.header->n_parts >=
                                       alone.header->n_ghosts);
    assert_ok(glint_bake_zoom(three, 3, &of_some, &n_some, &error));
    assert_ok(glint_bake_zoom(pair, 2, &of_two, &n_two, &error));
    assert_ok(glint_zoom_open(&some, of_some, n_some, &reason));
    assert_ok(glint_zoom_open(&two, of_two, n_two, &reason));
    check_ghosts_are_equal(&some, &two, 0);
    check_ghosts_are_equal(&some, &zoom, 1);
    free(three[1].data);
    free(of_some);
    free(of_two);
}

/* ---------------------------------------------------------- rejected files */

static void expect_open_error(const char *cause)
{
    const char *reason = "";

    glint_blob_set_size_and_checksum(file, bytes);
    assert_int_equal(glint_zoom_open(&zoom, file, bytes, &reason),
                     GLINT_E_LENS);
    if (!strstr(reason, cause))
        fail_msg("'%s' does not contain '%s'", reason, cause);
}

TEST(rejects_invalid_zooms)
{
    struct glint_zoom_header *const h = (void *)file;
    struct glint_zoom_model *const m = (void *)(file + h->model_at);
    const struct glint_zoom_model kept = m[1];
    const char *reason = "";

    assert_int_equal(glint_zoom_open(&zoom, file, bytes - 4, &reason),
                     GLINT_E_LENS);
    file[bytes / 2] ^= 1;
    assert_int_equal(glint_zoom_open(&zoom, file, bytes, &reason),
                     GLINT_E_LENS);
    file[bytes / 2] ^= 1;
    m[1].along_q30 = 1 << 30;
    expect_open_error("must ascend");
    m[1] = kept;
    m[0].along_q30 = 1;
    expect_open_error("must begin at 0");
    m[0].along_q30 = 0;
    m[1].at = (uint32_t)bytes;
    expect_open_error("outside");
    m[1] = kept;
    m[1].at += 4;
    expect_open_error("glint model");
    m[1] = kept;
    m[1].has_at = (uint32_t)bytes;
    expect_open_error("list of ghosts");
    m[1] = kept;
    m[0].has_at = h->model_at;
    expect_open_error("lacks ghosts");
    m[0].has_at = 0;
    h->n_models = 1;
    expect_open_error("fewer than 2");
    h->n_models = 1000;
    expect_open_error("or too many");
    h->n_models = POSITIONS;
    glint_blob_set_size_and_checksum(file, bytes);
    assert_ok(glint_zoom_open(&zoom, file, bytes, &reason));
}
