/* SPDX-License-Identifier: MIT
 *
 * Tests the interpolation of two positions of a zoom lens, with models whose
 * polynomials can be interpolated by hand. Each barrel aperture must be matched
 * to a similar one of the other position. One without a match must open
 * gradually towards the position that lacks it. Energies must be interpolated
 * as the roots that the file stores.
 */
#include "lens/blend.h"
#include "lens/terms.h"
#include "support/model_builder.h"
#include "support/test.h"

enum { ONE = MODEL_ONE_Q30, MOST = 3, EXPONENT = -28 };

#define P(u, v) MODEL_POWER(u, v, 0, 0)

/* Polynomial of a barrel aperture's value at a pupil position: constant, and
 * coefficients of u and v^2. */
struct barrel {
    double middle, u, v2;
};

static int32_t encode_q28(double x)
{
    return (int32_t)lrint(ldexp(x, 28));
}

/* Heads (scale bits) of the energies at both zoom positions, and the number of
 * roots: how often an energy of the file must be squared. */
static uint8_t head[2], roots;

/* centre of the pupil boxes, units of 2^-20 mm */
static int32_t box_middle;

/* Polynomial of the ray's position in the stop: constant, coefficients of u
 * and v. */
struct stop {
    double middle, u, v;
};
static const struct stop usual = {0, 0.5, 0.5};
static struct stop stop = {0, 0.5, 0.5};

/* Makes a system with N barrel apertures. Sensor x is SENSOR times u, mm; the
 * polynomial of the energy is ENERGY, which is squared if there are roots. */
static struct glint_model_system
make_system(struct model_image *m, double sensor, double energy,
            uint8_t head_bits, const struct barrel *barrel, uint32_t n)
{
    const int32_t box[3] = {box_middle, 1 << 22, 1 << 22};
    struct model_polynomial p[5 + MOST] = {
        {GLINT_OUT_SENSOR_X, 1, EXPONENT, {P(1, 0)}, {encode_q28(sensor)}},
        {GLINT_OUT_SENSOR_Y, 1, EXPONENT, {P(0, 1)}, {1 << 27}},
        {GLINT_OUT_STOP_X,
         2,
         EXPONENT,
         {P(0, 0), P(1, 0)},
         {encode_q28(stop.middle), encode_q28(stop.u)}},
        {GLINT_OUT_STOP_Y, 1, EXPONENT, {P(0, 1)}, {encode_q28(stop.v)}},
        {GLINT_OUT_ENERGY, 1, EXPONENT, {P(0, 0)}, {encode_q28(energy)}}};
    struct glint_model_system s = {.sine_hi_q30 = ONE / 2,
                                   .wave_lo_q24 = MODEL_WAVE_LO_Q24,
                                   .wave_hi_q24 = MODEL_WAVE_HI_Q24,
                                   .box_exponent = -20,
                                   .box_terms = 1};
    struct glint_model_output *outputs;

    s.box_at = model_append_items(m, box, sizeof box);
    for (uint32_t k = 0; k < n; k++)
        p[5 + k] = (struct model_polynomial){(uint8_t)(GLINT_OUT_BARREL_0 + k),
                                             3,
                                             EXPONENT,
                                             {P(0, 0), P(1, 0), P(0, 2)},
                                             {encode_q28(barrel[k].middle),
                                              encode_q28(barrel[k].u),
                                              encode_q28(barrel[k].v2)}};
    model_write_outputs(m, &s, p, 5 + n, 0);
    outputs = (void *)(m->data + s.output_at);
    outputs[GLINT_OUT_ENERGY].head = head_bits;
    outputs[GLINT_OUT_ENERGY].roots = roots;
    return s;
}

/* Writes a model with the single system of make_system() to M and opens it. */
static struct glint_lens
open_model_of_system(struct model_image *m, double sensor, double energy,
                     uint8_t head_bits, const struct barrel *barrel, uint32_t n)
{
    static const struct glint_model_ghost ghost = {0, 1, 0, 1};
    struct glint_model_system s;

    model_begin_header(m, GLINT_BASIS_AUTO, "position");
    s = make_system(m, sensor, energy, head_bits, barrel, n);
    model_append_ghosts(m, &ghost, 1, &s, 1);
    return model_open_image(m);
}

static struct glint_transfer mixed;

/* Interpolates between the models A (PART 0) and B (PART 1). */
static void interpolate_models(const struct glint_lens *a,
                               const struct glint_lens *b, double part)
{
    assert_int_equal(glint_transfer_init(&mixed, a, 0, 0, MODEL_WAVE_LO_Q24),
                     1);
    assert_int_equal(glint_transfer_mix_position(&mixed, b, 0, 0,
                                                 MODEL_WAVE_LO_Q24,
                                                 (int32_t)ldexp(part, 30)),
                     1);
}

/* Interpolates between models with the barrel apertures A[N_A] (PART 0) and
 * B[N_B] (PART 1). */
static void interpolate_barrels(const struct barrel *a, uint32_t n_a,
                                const struct barrel *b, uint32_t n_b,
                                double part)
{
    struct model_image at[2];
    const struct glint_lens first =
        open_model_of_system(&at[0], 0.5, 0.25, head[0], a, n_a);
    const struct glint_lens second =
        open_model_of_system(&at[1], 0.25, 0.5, head[1], b, n_b);

    interpolate_models(&first, &second, part);
}

static double evaluate_output(int kind, double u, double v)
{
    struct glint_outputs out;

    glint_transfer_ray(&mixed, (int32_t)ldexp(u, 30), (int32_t)ldexp(v, 30),
                       &out);
    return ldexp(out.at[kind], mixed.exponent[kind]);
}

/* Checks that output KIND of the interpolated model is X at (U, V). */
static void check_output(int kind, double u, double v, double x)
{
    const double got = evaluate_output(kind, u, v);

    if (fabs(got - x) > 1e-6)
        fail_msg("output %d at %g, %g is %.9f, not %.9f", kind, u, v, got, x);
}

static void check_barrel_values(int kind, struct barrel b)
{
    assert_true(mixed.outputs >> (GLINT_OUT_BARREL_0 + kind) & 1);
    check_output(GLINT_OUT_BARREL_0 + kind, 0, 0, b.middle);
    check_output(GLINT_OUT_BARREL_0 + kind, 1, 0, b.middle + b.u);
    check_output(GLINT_OUT_BARREL_0 + kind, 0, 1, b.middle + b.v2);
}

static const struct barrel right = {0.3, 0.5, 0.1}, left = {0.3, -0.5, 0.1};
static const struct barrel more_right = {0.34, 0.54, 0.1};
static const struct barrel more_left = {0.34, -0.58, 0.14};
static const struct barrel high = {0.2, 0, 1.2};

TEST(outputs_are_interpolated)
{
    for (int k = 1; k < 4; k++) {
        const double part = 0.25 * k;

        interpolate_barrels(NULL, 0, NULL, 0, part);
        check_output(GLINT_OUT_SENSOR_X, 1, 0.5, 0.5 - 0.25 * part);
        check_output(GLINT_OUT_SENSOR_Y, 1, 0.5, 0.25);
        check_output(GLINT_OUT_ENERGY, 1, 0.5, 0.25 + 0.25 * part);
    }
}

/* Checks that each barrel aperture is matched to the most similar one of the
 * other position, whatever the order. */
TEST(barrels_match_the_most_similar)
{
    const struct barrel a[] = {right, left};
    const struct barrel same[] = {more_right, more_left};
    const struct barrel turned[] = {more_left, more_right};

    for (int k = 0; k < 2; k++) {
        interpolate_barrels(a, 2, k ? turned : same, 2, 0.25);
        check_barrel_values(0, (struct barrel){0.31, 0.51, 0.1});
        check_barrel_values(1, (struct barrel){0.31, -0.52, 0.11});
        assert_false(mixed.outputs >> (GLINT_OUT_BARREL_0 + 2) & 1);
    }
}

/* Checks a barrel aperture that the first position lacks: towards this position
 * it opens to 1/2; from a quarter of the way on it clips completely. */
TEST(missing_first_barrel_closes_gradually)
{
    const struct barrel a[] = {right}, b[] = {more_right, high};
    const struct barrel twice[] = {more_right, more_right};
    const struct barrel other[] = {left};

    interpolate_barrels(a, 1, b, 2, 0.5);
    check_barrel_values(0, (struct barrel){0.32, 0.52, 0.1});
    check_barrel_values(1, high);
    interpolate_barrels(a, 1, b, 2, 0.125);
    check_barrel_values(1, (struct barrel){0.35, 0, 0.6});
    interpolate_barrels(a, 1, twice, 2, 0.5);
    check_barrel_values(0, (struct barrel){0.32, 0.52, 0.1});
    /* An added barrel aperture begins as a copy of the most similar one. */
    check_barrel_values(1, (struct barrel){0.32, 0.52, 0.1});
    interpolate_barrels(a, 1, other, 1,
                        /* the only other barrel is not similar, so it is not
                         * copied */
                        0.5);
    check_barrel_values(0, right);
    check_barrel_values(1, left);
}

/* Checks a barrel aperture that the second position lacks: it opens after three
 * quarters of the way. */
TEST(missing_second_barrel_opens_gradually)
{
    const struct barrel a[] = {high, right}, b[] = {more_right};

    interpolate_barrels(a, 2, b, 1, 0.5);
    check_barrel_values(0, high);
    check_barrel_values(1, (struct barrel){0.32, 0.52, 0.1});
    interpolate_barrels(a, 2, b, 1, 0.875);
    check_barrel_values(0, (struct barrel){0.35, 0, 0.6});
}

/* Interpolates between a model without barrel apertures, whose stop positions
 * are OURS (PART 0), and a model with the barrel B, whose stop positions are
 * THEIRS (PART 1). TURNED: the two models are exchanged. */
static void interpolate_stops(const struct stop *ours,
                              const struct stop *theirs, struct barrel b,
                              double part, bool turned)
{
    struct model_image at[2];
    struct glint_lens none, one;

    stop = *ours;
    none = open_model_of_system(&at[0], 0.5, 0.25, 0, NULL, 0);
    stop = *theirs;
    one = open_model_of_system(&at[1], 0.5, 0.25, 0, &b, 1);
    stop = usual;
    if (turned)
        interpolate_models(&one, &none, 1 - part);
    else
        interpolate_models(&none, &one, part);
}

static void check_clipped_fraction(struct stop ours, struct stop theirs,
                                   struct barrel b, struct barrel expected)
{
    for (int k = 0; k < 4; k++) {
        /* In the last two rounds, the image of the stop is inverted. */
        if (k == 2) {
            ours = (struct stop){-ours.middle, -ours.u, -ours.v};
            theirs = (struct stop){-theirs.middle, -theirs.u, -theirs.v};
        }
        interpolate_stops(&ours, &theirs, b, 0.5, k & 1);
        check_barrel_values(0, expected);
    }
}

/* Checks a barrel aperture that one position lacks. Where it is added, it must
 * clip the fraction of the stop that it clips at the other position; or the
 * fraction of the pupil box, if that is less or if the stop position moves by
 * more than half a box. */
TEST(missing_barrel_clips_as_much_of_the_stop)
{
    const struct stop wide = {-0.1, 0.8, 0.8}, aside = {0.3, 0.5, 0.5};
    const struct barrel r = {0.9, 0.5, 0}, l = {0.9, -0.5, 0};
    const struct barrel up = {0.4, 0, 0.5};

    check_clipped_fraction(usual, wide, r,
                           (struct barrel){0.93125, 0.40625, 0});
    check_clipped_fraction(wide, usual, r, r);
    check_clipped_fraction(wide, usual, l, l);
    check_clipped_fraction(aside, usual, r, r);
    check_clipped_fraction(aside, usual, l, (struct barrel){0.75, -0.5, 0});
    check_clipped_fraction(usual, wide, up, (struct barrel){0.4, 0, 0.3125});
    check_clipped_fraction(wide, usual, up, up);
    check_clipped_fraction(usual, (struct stop){0, 0, 0}, l, l);
    check_clipped_fraction((struct stop){0, -0.2, 0.5},
                           (struct stop){0, 1.6, 0.5}, r, r);
}

/* Checks that the two most similar barrel apertures are matched, in either
 * order. One that is left over must begin as a copy of the most similar one. */
TEST(most_similar_barrels_are_matched)
{
    const struct barrel one[] = {right};
    const struct barrel two[] = {{0.3, 0.5, 0.5}, more_right};

    interpolate_barrels(one, 1, two, 2, 0.25);
    check_barrel_values(0, (struct barrel){0.31, 0.51, 0.1});
    check_barrel_values(1, (struct barrel){0.3, 0.5, 0.2});
    interpolate_barrels(two, 2, one, 1, 0.25);
    check_barrel_values(0, (struct barrel){0.3, 0.5, 0.4});
    check_barrel_values(1, (struct barrel){0.33, 0.53, 0.1});
}

/* Checks that interpolated energies stay in range if the heads (scale bits) of
 * both positions differ: the smaller head sets the range. */
TEST(energies_keep_the_smaller_head)
{
    const double value = 0.375;

    for (int k = 0; k < 6; k++) {
        roots = (uint8_t)(k / 3);
        head[0] = (uint8_t)(k % 3 ? 3 : 0);
        head[1] = (uint8_t)(k % 3 == 1 ? 1 : 2);
        interpolate_barrels(NULL, 0, NULL, 0, 0.5);
        check_output(GLINT_OUT_ENERGY, 0, 0, roots ? value * value : value);
        glint_blend_scale_energy(&mixed, ONE / 4);
        check_output(GLINT_OUT_ENERGY, 0, 0,
                     (roots ? value * value : value) / 4);
    }
    roots = head[0] = head[1] = 0;
}

/* ------------------------------------------------------ moving pupil boxes */

/* Writes a model to M and opens it. Its pupil box is centred at MIDDLE and has
 * the half sides HALF and RISE, mm; its sensor x and y are the pupil
 * coordinates times SLOPE; its barrel aperture is a circle of 4 mm in the
 * pupil. */
static struct glint_lens open_model_with_pupil_box(struct model_image *m,
                                                   double middle, double half,
                                                   double rise, double slope)
{
    static const struct glint_model_ghost ghost = {0, 1, 0, 1};
    const int32_t box[3] = {(int32_t)ldexp(middle, 20),
                            (int32_t)ldexp(half, 20), (int32_t)ldexp(rise, 20)};
    const struct model_polynomial p[6] = {
        {GLINT_OUT_SENSOR_X,
         2,
         EXPONENT,
         {P(0, 0), P(1, 0)},
         {encode_q28(middle * slope), encode_q28(half * slope)}},
        {GLINT_OUT_SENSOR_Y,
         1,
         EXPONENT,
         {P(0, 1)},
         {encode_q28(rise * slope)}},
        {GLINT_OUT_STOP_X, 1, EXPONENT, {P(1, 0)}, {1 << 27}},
        {GLINT_OUT_STOP_Y, 1, EXPONENT, {P(0, 1)}, {1 << 27}},
        {GLINT_OUT_ENERGY, 1, EXPONENT, {P(0, 0)}, {1 << 26}},
        {GLINT_OUT_BARREL_0,
         4,
         EXPONENT,
         {P(0, 0), P(1, 0), P(2, 0), P(0, 2)},
         {encode_q28(0.5 + middle * middle / 32),
          encode_q28(middle * half / 16), encode_q28(half * half / 32),
          encode_q28(rise * rise / 32)}}};
    struct glint_model_system s;

    model_begin_header(m, GLINT_BASIS_AUTO, "box");
    s = make_system(m, 0, 0, 0, NULL, 0);
    s.box_at = model_append_items(m, box, sizeof box);
    model_write_outputs(m, &s, p, 6, 0);
    model_append_ghosts(m, &ghost, 1, &s, 1);
    return model_open_image(m);
}

/* Checks outputs that are linear in the pupil position: at each pupil position
 * they must be interpolated exactly, even if the pupil boxes of both models
 * differ in position and size. */
TEST(outputs_are_interpolated_across_moving_boxes)
{
    struct model_image at[2];
    const struct glint_lens a =
        open_model_with_pupil_box(&at[0], 0, 4, 3, 0.125);
    const struct glint_lens b =
        open_model_with_pupil_box(&at[1], 0.5, 4.5, 4, 0.0625);

    for (int k = 1; k < 4; k++) {
        const double part = 0.25 * k, slope = 0.125 - 0.0625 * part;

        interpolate_models(&a, &b, part);
        for (int i = -2; i <= 2; i++) {
            check_output(GLINT_OUT_SENSOR_X, 0.5 * i, 0.5,
                         slope * (0.5 * part + (4 + 0.5 * part) * 0.5 * i));
            check_output(GLINT_OUT_SENSOR_Y, 0.5 * i, 0.5,
                         slope * 0.5 * (3 + part));
        }
    }
}

/* Checks that the first barrel aperture is the circle of 4 mm at (U, V), the
 * pupil position (X, Y), mm. The tolerance is large, as the pupil boxes of both
 * models differ much. */
static void check_first_barrel_is_circle(double u, double v, double x, double y)
{
    const double got = evaluate_output(GLINT_OUT_BARREL_0, u, v);

    if (fabs(got - 0.5 - (x * x + y * y) / 32) > 0.1)
        fail_msg("the barrel is %g at %g, %g mm", got, x, y);
}

TEST(barrels_move_with_their_box)
{
    const struct barrel a = {0.3, 0.5, 0.1}, b = {0.3, 0.9, 0.1};
    struct model_image at[2];
    const struct glint_lens first =
        open_model_of_system(&at[0], 0.5, 0.25, 0, &a, 1);
    struct glint_lens second;

    box_middle = 1 << 22; /* both pupil boxes are shifted by half a box */
    second = open_model_of_system(&at[1], 0.5, 0.25, 0, &b, 1);
    box_middle = 0;
    interpolate_models(&first, &second, 0.5);
    assert_true(mixed.outputs >> GLINT_OUT_BARREL_0 & 1);
    assert_false(mixed.outputs >> (GLINT_OUT_BARREL_0 + 1) & 1);
}

/* Checks that barrel apertures of equal shape in the pupil are matched even if
 * their pupil boxes, and so their polynomials, differ much; one in a distant
 * box is not matched. */
TEST(barrels_match_by_shape_in_the_pupil)
{
    struct model_image at[3];
    const struct glint_lens a = open_model_with_pupil_box(&at[0], 0, 4, 2, 0);
    const struct glint_lens b = open_model_with_pupil_box(&at[1], 1, 6.5, 3, 0);
    const struct glint_lens c = open_model_with_pupil_box(&at[2], 7, 0.5, 2, 0);

    for (int k = 0; k < 2; k++) { /* barrels in either order */
        interpolate_models(k ? &b : &a, k ? &a : &b, 0.5);
        assert_false(mixed.outputs >> (GLINT_OUT_BARREL_0 + 1) & 1);
        check_first_barrel_is_circle(1, 0, 0.5 + 5.25, 0);
        check_first_barrel_is_circle(-1, 0, 0.5 - 5.25, 0);
        check_first_barrel_is_circle(0, 1, 0.5, 2.5);
    }
    interpolate_models(&a, &c, 0.5);
    assert_true(mixed.outputs >> (GLINT_OUT_BARREL_0 + 1) & 1);
}

/* Writes a model with one barrel aperture to M and opens it. Its pupil box BOX
 * is in units of 2^EXPONENT, which are unrealistically coarse. */
static struct glint_lens
open_model_with_coarse_box(struct model_image *m, const int32_t box[3],
                           int16_t exponent,
                           const struct model_polynomial *barrel)
{
    static const struct glint_model_ghost ghost = {0, 1, 0, 1};
    struct model_polynomial p[6] = {
        {GLINT_OUT_SENSOR_X, 1, EXPONENT, {P(1, 0)}, {1 << 27}},
        {GLINT_OUT_SENSOR_Y, 1, EXPONENT, {P(0, 1)}, {1 << 27}},
        {GLINT_OUT_STOP_X, 1, EXPONENT, {P(1, 0)}, {1 << 27}},
        {GLINT_OUT_STOP_Y, 1, EXPONENT, {P(0, 1)}, {1 << 27}},
        {GLINT_OUT_ENERGY, 1, EXPONENT, {P(0, 0)}, {1 << 26}}};
    struct glint_model_system s;

    p[5] = *barrel;
    model_begin_header(m, GLINT_BASIS_AUTO, "coarse");
    s = make_system(m, 0, 0, 0, NULL, 0);
    s.box_at = model_append_items(m, box, 3 * sizeof *box);
    s.box_exponent = exponent;
    model_write_outputs(m, &s, p, 6, 0);
    model_append_ghosts(m, &ghost, 1, &s, 1);
    return model_open_image(m);
}

/* Checks a pupil box half a unit wide. Rounding moves positions by more than
 * this width, but barrel apertures must still be evaluated inside the box. */
TEST(narrow_boxes_evaluate_barrels_inside)
{
    static const int32_t wide[3] = {0, 5, 5};
    static const int32_t narrow[3] = {4 << 20, (1 << 19) + 1000,
                                      (1 << 19) + 1000};
    const struct model_polynomial a = {GLINT_OUT_BARREL_0,
                                       2,
                                       EXPONENT,
                                       {P(0, 0), P(1, 0)},
                                       {encode_q28(-1.6), encode_q28(2)}};
    const struct model_polynomial b = {
        GLINT_OUT_BARREL_0, 1, EXPONENT - 2, {P(9, 0)}, {encode_q28(2.4)}};
    struct model_image at[2];
    const struct glint_lens first =
        open_model_with_coarse_box(&at[0], wide, 0, &a);
    const struct glint_lens second =
        open_model_with_coarse_box(&at[1], narrow, -20, &b);

    interpolate_models(&first, &second, 0.5);
    assert_false(mixed.outputs >> (GLINT_OUT_BARREL_0 + 1) & 1);
}

/* ---------------------------------------------------- visibility of ghosts */

enum { WHOLE = 2 };

/* A ghost, or one part of its pupil. I and J are the ghost's pair of surfaces;
 * ANNULUS is that of the pupil box. Sensor x is SENSOR times u; with SENSOR 0,
 * the ghost is dark (it has no polynomials). */
struct part {
    int i, j;
    double sensor;
    int annulus;
};

static bool is_ghost_dark(double sensor)
{
    return !(sensor < 0 || sensor > 0);
}

/* Writes a model of N ghosts and pupil parts to M and opens it; all energies
 * are 1/4. */
static struct glint_lens open_model_of_ghosts_and_parts(struct model_image *m,
                                                        const struct part *part,
                                                        uint32_t n)
{
    struct glint_model_ghost ghost[2 * WHOLE];
    struct glint_model_system s[2 * WHOLE];
    uint32_t n_systems = 0;

    model_begin_header(m, GLINT_BASIS_AUTO, "parts");
    model_header_of(m)->n_parts = n - WHOLE;
    for (uint32_t k = 0; k < n; k++) {
        ghost[k] = (struct glint_model_ghost){(uint8_t)part[k].i,
                                              (uint8_t)part[k].j, n_systems,
                                              !is_ghost_dark(part[k].sensor)};
        if (is_ghost_dark(part[k].sensor))
            continue;
        s[n_systems] = make_system(m, part[k].sensor, 0.25, 0, NULL, 0);
        s[n_systems++].annulus = (uint8_t)part[k].annulus;
    }
    model_append_ghosts(m, ghost, n, s, n_systems);
    return model_open_image(m);
}

static struct glint_zoom_lens zoom;

/* The expected state of GHOST at the zoom position PART, 0 .. 1: sensor x is
 * SENSOR times u, the energy ENERGY. With SENSOR 0, the ghost is dark (not
 * drawn). */
struct sight {
    int ghost;
    double part, sensor, energy;
};

static void check_interpolated_ghosts(const struct sight *sight, size_t n)
{
    for (const struct sight *s = sight; s < sight + n; s++) {
        glint_zoom_set(&zoom, (int32_t)ldexp(s->part, 30));
        if (glint_transfer_init(&mixed, &zoom.lens, s->ghost, 0,
                                MODEL_WAVE_LO_Q24) == is_ghost_dark(s->sensor))
            fail_msg("ghost %d at %g is %s", s->ghost, s->part,
                     is_ghost_dark(s->sensor) ? "not dark" : "dark");
        if (is_ghost_dark(s->sensor))
            continue;
        check_output(GLINT_OUT_SENSOR_X, 1, 0, s->sensor);
        check_output(GLINT_OUT_ENERGY, 0, 0, s->energy);
    }
}

#define SHOWS(sights) \
    check_interpolated_ghosts(sights, sizeof(sights) / sizeof *(sights))

/* A zoom position ALONG, 0 .. 1. Its model contains the N ghosts and pupil
 * parts PART, whose pupil boxes are centred at MIDDLE. */
struct position {
    double along;
    const struct part *part;
    uint32_t n;
    int32_t middle;
};

enum { MOST_POSITIONS = 3 };

static void open_zoom_of_positions(struct model_image at[MOST_POSITIONS],
                                   const struct position *position, int n)
{
    int32_t along_q30[MOST_POSITIONS];
    struct glint_lens lens[MOST_POSITIONS];
    const char *reason = "";

    for (int k = 0; k < n; k++) {
        along_q30[k] = (int32_t)ldexp(position[k].along, 30);
        box_middle = position[k].middle;
        lens[k] = open_model_of_ghosts_and_parts(&at[k], position[k].part,
                                                 position[k].n);
    }
    box_middle = 0;
    if (glint_zoom_join(&zoom, lens, along_q30, n, &reason) != GLINT_OK)
        fail_msg("%s", reason);
}

/* Checks that a ghost without polynomials at one zoom position (a dark ghost)
 * fades out towards that position. */
TEST(dark_ghosts_fade)
{
    static const struct part a[] = {{0, 1, 0.5, 0}, {0, 2, 0, 0}};
    static const struct part b[] = {{0, 1, 0, 0}, {0, 2, 0.75, 0}};
    static const struct position both[] = {{0, a, 2, 0}, {1, b, 2, 0}};
    static const struct sight sights[] = {{0, 0, 0.5, 0.25},
                                          {0, 0.25, 0.5, 0.1875},
                                          {0, 0.75, 0.5, 0.0625},
                                          {0, 1, 0, 0},
                                          {1, 0, 0, 0},
                                          {1, 0.25, 0.75, 0.0625},
                                          {1, 0.75, 0.75, 0.1875},
                                          {1, 1, 0.75, 0.25}};
    struct model_image at[MOST_POSITIONS];

    open_zoom_of_positions(at, both, 2);
    SHOWS(sights);
}

/* Checks that a ghost is extrapolated towards a zoom position at which it is
 * dark if two other positions define its motion. */
TEST(ghosts_are_extrapolated_into_the_dark)
{
    static const struct part a[] = {{0, 1, 0.5, 0}, {0, 2, 0, 0}};
    static const struct part b[] = {{0, 1, 0.4, 0}, {0, 2, 0.25, 0}};
    static const struct part c[] = {{0, 1, 0, 0}, {0, 2, 0.5, 0}};
    static const struct position all[] = {
        {0, a, 2, 0}, {0.5, b, 2, 0}, {1, c, 2, 0}};
    static const struct sight sights[] = {{0, 0.25, 0.45, 0.25},
                                          {0, 0.5, 0.4, 0.25},
                                          {0, 0.75, 0.35, 0.25},
                                          {0, 1, 0, 0},
                                          {1, 0.375, 0.1875, 0.25},
                                          {1, 0.125, 0.0625, 0.25},
                                          {1, 0, 0, 0}};
    struct model_image at[MOST_POSITIONS];

    open_zoom_of_positions(at, all, 3);
    SHOWS(sights);
}

/* Checks that a ghost is extrapolated by at most the distance between the two
 * positions that define its motion. It must not be extrapolated if its pupil is
 * divided into parts, whose number may change, or if its pupil boxes are too
 * far apart. */
TEST(unsafe_ghosts_are_not_extrapolated)
{
    static const struct part a[] = {
        {0, 1, 0.5, 0}, {0, 2, 0.5, 0}, {0, 1, 0.5, 0}};
    static const struct part b[] = {
        {0, 1, 0.4, 0}, {0, 2, 0.5, 0}, {0, 1, 0.5, 0}};
    static const struct part c[] = {{0, 1, 0, 0}, {0, 2, 0.5, 0}, {0, 1, 0, 0}};
    static const struct position all[][3] = {
        {{0, a, 2, 0}, {0.4, b, 2, 0}, {1, c, 2, 0}},
        {{0, a, 3, 0}, {0.5, b, 3, 0}, {1, c, 3, 0}},
        {{0, a, 2, 3 << 20}, {0.5, b, 2, 0}, {1, c, 2, 0}}};
    static const struct sight half[] = {
        {0, 0.7, 0.4, 0.125}, {0, 0.75, 0.4, 0.125}, {0, 0.75, 0.4, 0.125}};

    for (int t = 0; t < 3; t++) {
        struct model_image at[MOST_POSITIONS];

        open_zoom_of_positions(at, all[t], 3);
        check_interpolated_ghosts(&half[t], 1);
    }
}

/* Checks that the magnitudes of coefficients sum to less than 2^30, as SIMD
 * code and the scale bits of energies require. This must hold even if
 * extrapolation would move a ghost to three times the max of a model. */
TEST(extrapolated_sums_stay_in_range)
{
    static const struct part a[] = {{0, 1, -3.9, 0}, {0, 2, 0.5, 0}};
    static const struct part b[] = {{0, 1, 3.9, 0}, {0, 2, 0.5, 0}};
    static const struct part c[] = {{0, 1, 0, 0}, {0, 2, 0.5, 0}};
    static const struct position all[] = {
        {0, a, 2, 0}, {0.5, b, 2, 0}, {1, c, 2, 0}};
    static const struct sight sights[] = {
        {0, 0.96875, 3 * 3.9 - 2 * 3.9 / 16, 0.25}};
    struct model_image at[MOST_POSITIONS];

    open_zoom_of_positions(at, all, 3);
    SHOWS(sights);
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        int64_t sum = 0;

        for (int y = 0; y <= GLINT_MAX_POWER; y++)
            for (int x = 0; x < GLINT_TABLE_WIDTH; x++)
                sum += llabs((long long)mixed.table[kind][y][x]);
        assert_true(!(mixed.outputs >> kind & 1) || sum < ONE);
    }
}

/* Checks two zoom positions that divide a pupil differently: the pupil parts of
 * the nearer position must be drawn. In any order, parts must be interpolated
 * with parts of the same ghost. */
TEST(parts_are_interpolated_with_their_ghost)
{
    static const struct part a[] = {
        {0, 1, 0.5, 0}, {0, 2, 0.25, 0}, {0, 2, 0.375, 0}};
    static const struct part b[] = {
        {0, 1, 0.75, 1}, {0, 2, 0.5, 0}, {0, 1, 0.125, 0}, {0, 2, 0.875, 0}};
    static const struct position both[] = {{0, a, 3, 0}, {1, b, 4, 0}};
    static const struct sight sights[] = {
        {0, 0.25, 0.5, 0.25}, {0, 0.75, 0.75, 0.25},  {1, 0.25, 0.3125, 0.25},
        {2, 0.25, 0, 0},      {2, 0.75, 0.125, 0.25}, {3, 0.25, 0.5, 0.25},
        {3, 0.75, 0.75, 0.25}};
    struct model_image at[MOST_POSITIONS];

    open_zoom_of_positions(at, both, 2);
    assert_int_equal(zoom.header.n_ghosts, 4);
    assert_int_equal(zoom.header.n_parts, 2);
    SHOWS(sights);
}

static double interpolate(double a, double b)
{
    return 0.75 * a + 0.25 * b;
}

/* Checks that the numbers of the lens header are interpolated, each by its own
 * rule. */
TEST(lens_numbers_are_interpolated)
{
    static const struct part part[] = {{0, 1, 0.5, 0}, {0, 2, 0.25, 0}};
    static const struct position both[] = {{0, part, 2, 0}, {1, part, 2, 0}};
    /* The second round has coefficients 96 times as large, which have other
     * exponents. */
    static const double by[2] = {1, 96};
    struct model_image at[MOST_POSITIONS];
    const struct glint_model_header *const z = &zoom.header;
    const char *reason = "";

    open_zoom_of_positions(at, both, 2);
    for (int k = 0; k < 2; k++) {
        struct glint_model_header *const h = model_header_of(&at[k]);

        h->focal_mm = model_real_from_double(50 * by[k]);
        h->back_focal_mm = model_real_from_double(40 * by[1 - k]);
        h->entrance_radius_mm = model_real_from_double(7 * by[k]);
        h->stop_radius_mm = model_real_from_double(5 * by[1 - k]);
        h->f_number = model_real_from_double(2 * by[k]);
        for (int i = 0; i < GLINT_FLUX_TERMS; i++) {
            h->direct_flux[i] = model_real_from_double((i + 1) * by[k]);
            h->stopped_flux[0][i] = model_real_from_double((i + 20) * by[k]);
            h->stopped_flux[1][i] =
                model_real_from_double(-(i + 30) * by[1 - k]);
        }
        model_seal_checksum(&at[k]);
        if (glint_lens_open(&zoom.model[k], at[k].data, at[k].bytes, &reason))
            fail_msg("%s", reason);
    }
    glint_zoom_set(&zoom, ONE / 4);
    assert_true(glint_real_value(z->focal_mm) == interpolate(50, 4800));
    assert_true(glint_real_value(z->back_focal_mm) == interpolate(3840, 40));
    assert_true(glint_real_value(z->entrance_radius_mm) == interpolate(7, 672));
    assert_true(glint_real_value(z->stop_radius_mm) == interpolate(480, 5));
    assert_true(glint_real_value(z->f_number) == interpolate(2, 192));
    for (int i = 0; i < GLINT_FLUX_TERMS; i++) {
        assert_true(glint_real_value(z->direct_flux[i]) ==
                    (i + 1) * interpolate(1, 96));
        assert_true(glint_real_value(z->stopped_flux[0][i]) ==
                    (i + 20) * interpolate(1, 96));
        assert_true(glint_real_value(z->stopped_flux[1][i]) ==
                    -(i + 30) * interpolate(96, 1));
    }
}
