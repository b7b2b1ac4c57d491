/* SPDX-License-Identifier: MIT
 *
 * Compares a model's polynomials, evaluated for rays and grid vertices, with
 * integers computed by hand.
 */
#include "glint/flare.h"
#include "glint/transfer.h"
#include "support/model_builder.h"
#include "support/shuffle.h"
#include "support/test.h"

/* ------------------------------------------------------------- single rays */

enum { ONE = MODEL_ONE_Q30 };

static struct glint_outputs evaluate_ray(const struct glint_transfer *t,
                                         int32_t u, int32_t v)
{
    struct glint_outputs out;

    glint_transfer_ray(t, u, v, &out);
    return out;
}

/* Checks rays of the first range of angles: sines of 0 .. 1/4, for which the
 * polynomial variable s is -1 .. 1. */
TEST(rays_match_hand_computation)
{
    struct model_image m = model_make_three_ghosts();
    const struct glint_lens lens = model_open_image(&m);
    static struct glint_transfer t;
    struct glint_outputs out;

    /* at s = -1 and w = -1, sensor x is 0.25 + 0.5 u + 0.125 v^2 */
    assert_int_equal(glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_LO_Q24),
                     1);
    out = evaluate_ray(&t, 0, 0);
    assert_int_equal(out.at[GLINT_OUT_SENSOR_X], 1 << 26);
    assert_int_equal(out.at[GLINT_OUT_SENSOR_Y], 0);
    assert_int_equal(out.at[GLINT_OUT_ENERGY], 1 << 27); /* 0.5 - 0.25 */
    assert_int_equal(out.at[GLINT_OUT_BARREL_0], 1 << 27);
    assert_int_equal(out.at[GLINT_OUT_BARREL_1], 0);
    assert_int_equal(out.at[GLINT_OUT_RADIUS], 0);
    out = evaluate_ray(&t, ONE, ONE);
    assert_int_equal(out.at[GLINT_OUT_SENSOR_X], 234881024); /* 0.875 mm */
    assert_int_equal(out.at[GLINT_OUT_SENSOR_Y], 201326592); /* 0.75 mm */
    assert_int_equal(out.at[GLINT_OUT_STOP_X], 268435456);   /* 0.5 */
    assert_int_equal(out.at[GLINT_OUT_STOP_Y], 201326592);   /* 0.375 */
    /* barrel value 1: the ray is at the rim of the barrel aperture */
    assert_int_equal(out.at[GLINT_OUT_BARREL_0], 268435456);
    out = evaluate_ray(&t, -ONE, ONE / 2);
    assert_int_equal(out.at[GLINT_OUT_SENSOR_X], -58720256); /* -0.21875 mm */
    assert_int_equal(out.at[GLINT_OUT_SENSOR_Y], 33554432);  /* 0.125 mm */
    assert_int_equal(out.at[GLINT_OUT_STOP_X], -268435456);
    assert_int_equal(out.at[GLINT_OUT_STOP_Y], 125829120); /* 0.234375 */
    /* the middle of the range of angles (s = 0), and w = 1 */
    glint_transfer_init(&t, &lens, 0, ONE / 8, MODEL_WAVE_HI_Q24);
    out = evaluate_ray(&t, ONE, -ONE);
    assert_int_equal(out.at[GLINT_OUT_SENSOR_X], 201326592);  /* 0.75 mm */
    assert_int_equal(out.at[GLINT_OUT_SENSOR_Y], -201326592); /* -0.75 mm */
    assert_int_equal(out.at[GLINT_OUT_ENERGY], 3 << 27);
}

/* Checks how energies are decoded. The file stores a root of the energy as a
 * polynomial: the energy is the polynomial's value, the square or the fourth
 * power of the value, times 2^head. A value of half the max must give 1/2, 1/4
 * or 1/16, and a negative value 0. */
TEST(energies_are_decoded_from_roots)
{
    const int32_t half = (1 << 28) / 2; /* half of 2^(29 - head), head 1 */
    /* The polynomial is 2^-8; its powers are 2^-8, 2^-16 and 2^-32. */
    static const int scale[3] = {-8 - 28, -16 - 27, -32 - 25};

    for (int roots = 0; roots <= 2; roots++)
        for (int sign = -1; sign <= 1; sign += 2) {
            struct model_image m = model_make_three_ghosts();
            const struct glint_model_system *s =
                (const void *)(m.data + model_header_of(&m)->system_at);
            struct glint_model_output *o =
                (void *)(m.data + s->output_at + 4 * sizeof *o);
            int32_t *coef = (void *)(m.data + o->coef_at);
            static struct glint_transfer t;
            struct glint_lens lens;

            assert_int_equal(o->kind, GLINT_OUT_ENERGY);
            o->head = 1;
            o->roots = (uint8_t)roots;
            coef[0] = sign * half;
            coef[1] = 0;
            model_seal_checksum(&m);
            lens = model_open_image(&m);
            assert_int_equal(
                glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_LO_Q24), 1);
            assert_int_equal(evaluate_ray(&t, 0, 0).at[GLINT_OUT_ENERGY],
                             sign < 0 ? 0 : (1 << 29) >> (1 << roots));
            assert_int_equal(t.exponent[GLINT_OUT_ENERGY], scale[roots]);
        }
}

/* Converts the last N coefficients of output O to int16, at the same
 * address. */
static void convert_coefficients_to_int16(struct model_image *m,
                                          struct glint_model_output *o, int n,
                                          int shift)
{
    int32_t *const coef = (void *)(m->data + o->coef_at);
    int32_t last[2];

    memcpy(last, coef + o->n_terms - n, (size_t)n * sizeof *last);
    for (int k = 0; k < n; k++) {
        const int16_t code = (int16_t)(last[k] >> shift);

        assert_int_equal(code * (1 << shift), last[k]);
        memcpy((int16_t *)(void *)(coef + o->n_terms - n) + k, &code,
               sizeof code);
    }
    o->n_narrow = (uint8_t)n;
    o->narrow_shift = (uint8_t)shift;
}

TEST(int16_coefficients_give_the_same_rays)
{
    struct model_image wide = model_make_three_ghosts(),
                       m = model_make_three_ghosts();
    const struct glint_lens lens = model_open_image(&wide);
    struct glint_lens narrowed;
    static struct glint_transfer t[2];

    for (uint32_t k = 0; k < lens.system->n_outputs; k++) {
        struct glint_model_output *const o =
            (struct glint_model_output *)(void *)(m.data +
                                                  lens.system->output_at) +
            k;

        convert_coefficients_to_int16(&m, o, o->n_terms > 1 ? 2 : 1,
                                      o->n_terms > 2 ? 13 : 14);
    }
    model_seal_checksum(&m);
    narrowed = model_open_image(&m);
    glint_transfer_init(&t[0], &lens, 0, ONE / 7, MODEL_WAVE_LO_Q24 + 12345);
    glint_transfer_init(&t[1], &narrowed, 0, ONE / 7,
                        MODEL_WAVE_LO_Q24 + 12345);
    for (int k = -3; k <= 3; k++) {
        const struct glint_outputs a =
            evaluate_ray(&t[0], ONE / 3 * k, ONE / 5 * k);
        const struct glint_outputs b =
            evaluate_ray(&t[1], ONE / 3 * k, ONE / 5 * k);

        for (int i = 0; i < GLINT_OUT_KINDS; i++)
            if (t[0].outputs >> i & 1)
                assert_int_equal(a.at[i], b.at[i]);
    }
}

TEST(uses_the_system_of_angle_and_wavelength)
{
    struct model_image m = model_make_three_ghosts();
    const struct glint_lens lens = model_open_image(&m);
    static struct glint_transfer t;
    const int32_t middle = (MODEL_WAVE_LO_Q24 + MODEL_WAVE_HI_Q24) / 2;

    assert_int_equal(
        glint_transfer_init(&t, &lens, 0, ONE / 2 + 1, MODEL_WAVE_LO_Q24), 0);
    assert_int_equal(glint_transfer_init(&t, &lens, 0, ONE, middle), 0);
    assert_int_equal(glint_transfer_init(&t, &lens, 1, 0, middle), 0);
    assert_int_equal(glint_transfer_init(&t, &lens, 2, ONE / 8 - 1, middle), 0);
    assert_int_equal(glint_transfer_init(&t, &lens, 2, ONE / 8, middle + 1), 1);
    assert_ptr_equal(t.system, &lens.system[3]);
    assert_int_equal(glint_transfer_init(&t, &lens, 2, ONE / 8, middle), 1);
    assert_ptr_equal(t.system, &lens.system[3]);
    assert_int_equal(glint_transfer_init(&t, &lens, 2, ONE / 8, middle - 1), 1);
    assert_ptr_equal(t.system, &lens.system[2]);
    assert_int_equal(glint_transfer_init(&t, &lens, 2, ONE / 8, INT32_MIN), 1);
    assert_ptr_equal(t.system, &lens.system[2]);
    assert_int_equal(glint_transfer_init(&t, &lens, 2, ONE / 8, INT32_MAX), 1);
    assert_ptr_equal(t.system, &lens.system[3]);
    ((struct glint_model_system *)(uintptr_t)&lens.system[3])->wave_lo_q24++;
    assert_int_equal(glint_transfer_init(&t, &lens, 2, ONE / 8, middle), 0);
    assert_int_equal(glint_transfer_init(&t, &lens, 0, ONE / 2, middle), 1);
    assert_ptr_equal(t.system, &lens.system[1]);
    /* here s = 1 and w = 0; coefficients are halved */
    assert_int_equal(evaluate_ray(&t, ONE, ONE).at[GLINT_OUT_SENSOR_X],
                     5 << 24);
    assert_int_equal(evaluate_ray(&t, 0, 0).at[GLINT_OUT_ENERGY], 1 << 27);
    assert_int_equal(t.box[0], 3 << 19); /* 1.5 mm */
    assert_int_equal(t.box[1], 3 << 20);
    assert_int_equal(t.box[2], 3 << 20);
    assert_int_equal(t.box_exponent, -20);
}

/* Checks a pupil box whose half width is (s - 1/32)^2 - 1/2048: positive at all
 * values of s that the validity check tests, but negative between two of them,
 * where it must be clamped to 0. */
TEST(half_width_below_0_is_clamped)
{
    struct model_image m = model_make_three_ghosts();
    struct glint_model_system *s =
        (void *)(m.data + model_header_of(&m)->system_at);
    const int32_t box[3][3] = {
        {1 << 20, 0, 0},
        {(ONE >> 11) - (ONE >> 12), -(ONE >> 5), ONE / 2},
        {3 << 20, 0, 0}};
    static struct glint_transfer t;
    struct glint_lens lens;

    s->box_terms = 1 | 2 | 4;
    s->box_at = model_append_items(&m, box, sizeof box);
    model_seal_checksum(&m);
    lens = model_open_image(&m);
    assert_int_equal(glint_transfer_init(&t, &lens, 0, 33 * (ONE / 256), 1), 1);
    assert_int_equal(t.box[0], 1 << 20);
    assert_int_equal(t.box[1], 0);
    assert_int_equal(t.box[2], 3 << 20);
    assert_int_equal(glint_transfer_init(&t, &lens, 0, ONE / 8, 1), 1);
    assert_int_equal(t.box[1], (ONE >> 11) - (ONE >> 12));
}

/* Sets the coefficients of the first system to random values with the largest
 * allowed sums of magnitudes. SEED determines sizes and signs. */
static void set_largest_coefficients(struct model_image *m, uint32_t *seed)
{
    const struct glint_model_header *h = model_header_of(m);
    const struct glint_model_system *s = (const void *)(m->data + h->system_at);
    const struct glint_model_output *o = (const void *)(m->data + s->output_at);

    for (uint32_t k = 0; k < s->n_outputs; k++) {
        int32_t *coef = (void *)(m->data + o[k].coef_at);
        int32_t left = ONE - 1;

        for (uint32_t c = 0; c < o[k].n_terms; c++) {
            const int last = c + 1 == o[k].n_terms;
            const int32_t size =
                last ? left : (int32_t)(rng_xorshift(seed) % (uint32_t)left);

            coef[c] = rng_xorshift(seed) % 2 ? size : -size;
            left -= size;
        }
    }
    model_seal_checksum(m);
}

/* Checks that no output leaves its range; with CONFIG=qcheck every intermediate
 * step is checked as well. */
TEST(extreme_coefficients_stay_in_range)
{
    struct model_image m = model_make_three_ghosts();
    static struct glint_transfer t;
    uint32_t seed = 1;

    for (int k = 0; k < 20000; k++) {
        const int32_t sine_q30 = (int32_t)(rng_xorshift(&seed) % (ONE / 4));
        const int32_t wave_q24 = (int32_t)(rng_xorshift(&seed) >> 4);
        const int32_t u_q30 = k % 3 ? ONE * (k % 3 * 2 - 3) : sine_q30;
        const int32_t v_q30 = k % 5 ? -ONE : sine_q30 * 2;
        struct glint_outputs out;
        struct glint_lens lens;

        if (k % 20 == 0)
            set_largest_coefficients(&m, &seed);
        lens = model_open_image(&m);
        assert_int_equal(glint_transfer_init(&t, &lens, 0, sine_q30, wave_q24),
                         1);
        out = evaluate_ray(&t, u_q30, v_q30);
        for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
            assert_in_range((int64_t)out.at[kind] + 2 * (int64_t)ONE,
                            (uint64_t)ONE - 8, 3 * (uint64_t)ONE + 8);
    }
}

/* ------------------------------------------------------- grids of vertices */

/* Returns a sensor-to-image transform: 64 pixels per mm, origin at pixel (1000,
 * 500), no rotation. */
static struct glint_place make_sensor_to_image_transform(void)
{
    const struct glint_place place = {.cos_q30 = ONE,
                                      .pixels_per_mm = {1 << 30, -24},
                                      .middle_x_q8 = 1000 << 8,
                                      .middle_y_q8 = 500 << 8};

    return place;
}

TEST(grid_covers_the_pupil_box)
{
    struct model_image m = model_make_three_ghosts();
    const struct glint_lens lens = model_open_image(&m);
    struct glint_place place = make_sensor_to_image_transform();
    static struct glint_transfer t;
    struct glint_vertex v[9], turned[9];

    glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_HI_Q24);
    glint_transfer_grid(&t, &place, 2, v);
    /* at u = v = 1: sensor (0.875, 0.75) mm, stop (0.5, 0.375) */
    assert_int_equal(v[8].x_q8, (1000 + 56) << 8);
    assert_int_equal(v[8].y_q8, (500 - 48) << 8);
    assert_int_equal(v[8].stop_x_q16, 32768);
    assert_int_equal(v[8].stop_y_q16, 24576);
    assert_int_equal(v[8].barrel_q16[0], 65536);
    assert_int_equal(v[8].barrel_q16[1], 0);
    assert_int_equal(v[8].energy_q16, 49152);
    /* at u = -1, v = 1: sensor (-0.125, 0.25) mm; v increases from row to
     * row */
    assert_int_equal(v[6].x_q8, (1000 - 8) << 8);
    assert_int_equal(v[6].y_q8, (500 - 16) << 8);
    /* the first row is the last row mirrored at the plane of the light */
    for (int i = 0; i < 3; i++) {
        assert_int_equal(v[i].x_q8, v[6 + i].x_q8);
        assert_int_equal(v[i].y_q8 - (500 << 8), (500 << 8) - v[6 + i].y_q8);
        assert_int_equal(v[i].stop_x_q16, v[6 + i].stop_x_q16);
        assert_int_equal(v[i].stop_y_q16, -v[6 + i].stop_y_q16);
        assert_int_equal(v[3 + i].y_q8, 500 << 8);
    }
    place.cos_q30 = 0;
    /* at an azimuth of 90 degrees, sensor x points up and y to the left */
    place.sin_q30 = ONE;
    glint_transfer_grid(&t, &place, 2, turned);
    for (int k = 0; k < 9; k++) {
        assert_int_equal(turned[k].x_q8 - (1000 << 8), v[k].y_q8 - (500 << 8));
        assert_int_equal(turned[k].y_q8 - (500 << 8), (1000 << 8) - v[k].x_q8);
        assert_int_equal(turned[k].stop_x_q16, -v[k].stop_y_q16);
        assert_int_equal(turned[k].stop_y_q16, v[k].stop_x_q16);
        assert_int_equal(turned[k].energy_q16, v[k].energy_q16);
    }
}

/* Checks an annular grid: its rows lie between the inner rim and the edge of
 * the pupil box, on both sides of the middle. Its vertices must equal those of
 * a finer grid over the complete box. */
TEST(annular_grid_rows_leave_the_hole_out)
{
    enum { N = 16, NODES = N + 1, ANNULUS = 3, SHELL = 6 };
    struct model_image m = model_make_three_ghosts();
    const struct glint_lens lens = model_open_image(&m);
    const struct glint_place place = make_sensor_to_image_transform();
    static struct glint_transfer t;
    static struct glint_vertex whole[NODES][NODES], shell[SHELL + 1][SHELL + 1];

    glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_HI_Q24);
    glint_transfer_grid(&t, &place, N, whole[0]);
    t.annulus = ANNULUS;
    glint_transfer_grid(&t, &place, SHELL, shell[0]);
    for (int j = 0; j <= SHELL; j++)
        for (int i = 0; i <= SHELL; i += SHELL / 2) {
            const struct glint_vertex *v = &shell[j][i];
            const struct glint_vertex *same =
                &whole[2 * j < SHELL ? j : N - (SHELL - j)][i * N / SHELL];

            assert_int_equal(v->energy_q16,
                             2 * j == SHELL ? -1 : same->energy_q16);
            if (2 * j != SHELL) {
                assert_true(v->energy_q16 > 0);
                assert_int_equal(v->x_q8, same->x_q8);
                assert_int_equal(v->y_q8, same->y_q8);
                assert_int_equal(v->stop_y_q16, same->stop_y_q16);
            }
        }
}

TEST(positions_out_of_range_are_invalid)
{
    struct model_image m = model_make_three_ghosts();
    const struct glint_lens lens = model_open_image(&m);
    struct glint_place place = make_sensor_to_image_transform();
    static struct glint_transfer t;
    struct glint_vertex v[4];

    glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_HI_Q24);
    place.pixels_per_mm.exponent = -10; /* a scale of 2^20 pixels per mm */
    glint_transfer_grid(&t, &place, 1, v);
    assert_true(v[1].energy_q16 < 0 && v[3].energy_q16 < 0);
    /* rays that land 0.25 mm from the sensor's centre */
    assert_true(v[0].energy_q16 > 0 && v[2].energy_q16 > 0);
    for (int e = -200; e <= 200; e++) {
        place.pixels_per_mm.exponent = e;
        glint_transfer_grid(&t, &place, 1, v);
        assert_true((v[3].energy_q16 < 0) == (e >= -10));
    }
}
