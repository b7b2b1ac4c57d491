/* SPDX-License-Identifier: MIT
 *
 * The mix of two positions of a zoom, of models whose polynomials can be mixed
 * by hand: barrels find their like, others open towards the side that lacks
 * them, and energies are in proportion in the coordinates of their roots. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "lens/blend.h"
#include "lens/terms.h"
#include "support/model_builder.h"

enum { ONE = MODEL_ONE_Q30, MOST = 3, EXPONENT = -28 };

#define P(u, v) MODEL_POWER(u, v, 0, 0)

/* A barrel: its value in the middle, and what it gains with u and v^2. */
struct barrel {
    double middle, u, v2;
};

static int32_t q28(double x)
{
    return (int32_t)lrint(ldexp(x, 28));
}

/* Heads of both positions, and roots, of energies. */
static uint8_t head[2], roots;

/* Opens a model with N barrels at M; sensor x is SENSOR u, mm, and energy is
 * ENERGY, squared if there are roots. */
static struct glint_lens open_position(struct model_image *m, double sensor,
                                       double energy, uint8_t head_bits,
                                       const struct barrel *barrel, uint32_t n)
{
    static const struct glint_model_ghost ghost = {0, 1, 0, 1};
    static const int32_t box[3] = {0, 1 << 22, 1 << 22};
    struct model_polynomial p[5 + MOST] = {
        {GLINT_OUT_SENSOR_X, 1, EXPONENT, {P(1, 0)}, {{q28(sensor)}}},
        {GLINT_OUT_SENSOR_Y, 1, EXPONENT, {P(0, 1)}, {{1 << 27}}},
        {GLINT_OUT_STOP_X, 1, EXPONENT, {P(1, 0)}, {{1 << 27}}},
        {GLINT_OUT_STOP_Y, 1, EXPONENT, {P(0, 1)}, {{1 << 27}}},
        {GLINT_OUT_ENERGY, 1, EXPONENT, {P(0, 0)}, {{q28(energy)}}}};
    struct glint_model_system s = {.sine_hi_q30 = ONE / 2,
                                   .wave_lo_q24 = MODEL_WAVE_LO_Q24,
                                   .wave_hi_q24 = MODEL_WAVE_HI_Q24,
                                   .box_exponent = -20,
                                   .box_terms = 1};
    struct glint_model_output *outputs;

    model_begin(m, GLINT_BASIS_AUTO, "position");
    s.box_at = model_put(m, box, sizeof box);
    for (uint32_t k = 0; k < n; k++)
        p[5 + k] = (struct model_polynomial){
            (uint8_t)(GLINT_OUT_BARREL_0 + k),
            3,
            EXPONENT,
            {P(0, 0), P(1, 0), P(0, 2)},
            {{q28(barrel[k].middle), q28(barrel[k].u), q28(barrel[k].v2)}}};
    model_outputs(m, &s, p, 5 + n, 0);
    outputs = (void *)(m->data + s.output_at);
    outputs[GLINT_OUT_ENERGY].head = head_bits;
    outputs[GLINT_OUT_ENERGY].roots = roots;
    model_end(m, &ghost, 1, &s, 1);
    return model_open(m);
}

static struct glint_transfer mixed;

/* Mixes A and B, of N_A and N_B barrels, at PART. */
static void mix(const struct barrel *a, uint32_t n_a, const struct barrel *b,
                uint32_t n_b, double part)
{
    struct model_image at[2];
    const struct glint_lens first =
        open_position(&at[0], 0.5, 0.25, head[0], a, n_a);
    const struct glint_lens second =
        open_position(&at[1], 0.25, 0.5, head[1], b, n_b);

    assert_int_equal(
        glint_transfer_init(&mixed, &first, 0, 0, MODEL_WAVE_LO_Q24), 1);
    assert_int_equal(glint_transfer_mix(&mixed, &second, 0, 0,
                                        MODEL_WAVE_LO_Q24,
                                        (int32_t)ldexp(part, 30)),
                     1);
    free(at[0].data);
    free(at[1].data);
}

/* Asserts that output KIND is X at U and V. */
static void is(int kind, double u, double v, double x)
{
    struct glint_outputs out;
    double got;

    glint_transfer_ray(&mixed, (int32_t)ldexp(u, 30), (int32_t)ldexp(v, 30),
                       &out);
    got = ldexp(out.at[kind], mixed.exponent[kind]);
    if (fabs(got - x) > 1e-6)
        fail_msg("output %d at %g, %g is %.9f, not %.9f", kind, u, v, got, x);
}

static void is_barrel(int kind, struct barrel b)
{
    assert_true(mixed.outputs >> (GLINT_OUT_BARREL_0 + kind) & 1);
    is(GLINT_OUT_BARREL_0 + kind, 0, 0, b.middle);
    is(GLINT_OUT_BARREL_0 + kind, 1, 0, b.middle + b.u);
    is(GLINT_OUT_BARREL_0 + kind, 0, 1, b.middle + b.v2);
}

static const struct barrel right = {0.3, 0.5, 0.1}, left = {0.3, -0.5, 0.1};
static const struct barrel more_right = {0.34, 0.54, 0.1};
static const struct barrel more_left = {0.34, -0.58, 0.14};
static const struct barrel high = {0.2, 0, 1.2};

static void outputs_are_in_proportion(void **state)
{
    (void)state;
    for (int k = 1; k < 4; k++) {
        const double part = 0.25 * k;

        mix(NULL, 0, NULL, 0, part);
        is(GLINT_OUT_SENSOR_X, 1, 0.5, 0.5 - 0.25 * part);
        is(GLINT_OUT_SENSOR_Y, 1, 0.5, 0.25);
        is(GLINT_OUT_ENERGY, 1, 0.5, 0.25 + 0.25 * part);
    }
}

/* Barrels go with their like, in whatever order they stand. */
static void barrels_find_their_like(void **state)
{
    const struct barrel a[] = {right, left};
    const struct barrel same[] = {more_right, more_left};
    const struct barrel turned[] = {more_left, more_right};

    (void)state;
    for (int k = 0; k < 2; k++) {
        mix(a, 2, k ? turned : same, 2, 0.25);
        is_barrel(0, (struct barrel){0.31, 0.51, 0.1});
        is_barrel(1, (struct barrel){0.31, -0.52, 0.11});
        assert_false(mixed.outputs >> (GLINT_OUT_BARREL_0 + 2) & 1);
    }
}

/* A barrel that the first position lacks is whole from a quarter of the way on,
 * and opens to 1/2 before; one that has its partner already is another. */
static void barrels_that_come(void **state)
{
    const struct barrel a[] = {right}, b[] = {more_right, high};
    const struct barrel twice[] = {more_right, more_right};

    (void)state;
    mix(a, 1, b, 2, 0.5);
    is_barrel(0, (struct barrel){0.32, 0.52, 0.1});
    is_barrel(1, high);
    mix(a, 1, b, 2, 0.125);
    is_barrel(1, (struct barrel){0.35, 0, 0.6});
    mix(a, 1, twice, 2, 0.5);
    is_barrel(0, (struct barrel){0.32, 0.52, 0.1});
    is_barrel(1, more_right);
}

/* One that the second lacks opens behind three quarters of the way. */
static void barrels_that_go(void **state)
{
    const struct barrel a[] = {high, right}, b[] = {more_right};

    (void)state;
    mix(a, 2, b, 1, 0.5);
    is_barrel(0, high);
    is_barrel(1, (struct barrel){0.32, 0.52, 0.1});
    mix(a, 2, b, 1, 0.875);
    is_barrel(0, (struct barrel){0.35, 0, 0.6});
}

/* The mix has room under the smaller of both heads alone. */
static void energies_have_heads_and_roots(void **state)
{
    const double value = 0.375;

    (void)state;
    for (int k = 0; k < 6; k++) {
        roots = (uint8_t)(k / 3);
        head[0] = (uint8_t)(k % 3 ? 3 : 0);
        head[1] = (uint8_t)(k % 3 == 1 ? 1 : 2);
        mix(NULL, 0, NULL, 0, 0.5);
        is(GLINT_OUT_ENERGY, 0, 0, roots ? value * value : value);
        glint_blend_fade(&mixed, ONE / 4);
        is(GLINT_OUT_ENERGY, 0, 0, (roots ? value * value : value) / 4);
    }
    roots = head[0] = head[1] = 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outputs_are_in_proportion),
        cmocka_unit_test(barrels_find_their_like),
        cmocka_unit_test(barrels_that_come),
        cmocka_unit_test(barrels_that_go),
        cmocka_unit_test(energies_have_heads_and_roots),
    };

    return cmocka_run_group_tests_name("zoom_mix", tests, NULL, NULL);
}
