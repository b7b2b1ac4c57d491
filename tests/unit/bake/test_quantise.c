/* SPDX-License-Identifier: MIT
 *
 * Checks that values computed from the integers of a model differ from the
 * fitted polynomials by at most the proven bounds.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/fit/quantise.h"
#include "bake/write_model.h"
#include "base/q.h"
#include "glint/transfer.h"
#include "support/lens_check.h"
#include "support/shuffle.h"
#include "support/rng.h"

enum { ONE_Q30 = 1 << 30, KINDS = GLINT_OUT_BARREL_0 + 1 };

static uint32_t seed = 1;

/* Returns a random number, -1 .. 1. */
static double random_signed_unit(void)
{
    return 2.0 * rng_xorshift(&seed) / UINT32_MAX - 1;
}

static int random_int(int lo, int hi)
{
    return lo + (int)(rng_xorshift(&seed) % (uint32_t)(hi - lo + 1));
}

/* Returns a random number, -2^30 .. 2^30; a quarter of them are -2^30, 2^30, 0,
 * or a neighbour of these. */
static int32_t random_number_q30(void)
{
    static const int32_t corner[] = {-ONE_Q30, 1 - ONE_Q30, -1,     0,
                                     1,        ONE_Q30 - 1, ONE_Q30};

    if (random_int(0, 3) == 0)
        return corner[random_int(0, 6)];
    return (int32_t)lrint(random_signed_unit() * 0x1p30);
}

/* ---------------------------------------------------------- random systems */

/* A fitted ghost with one polynomial system, and the model made from it. */
struct made {
    struct glint_fitted_ghost fitted;
    struct glint_quantised_system quantised;
    struct glint_draft draft;
    struct glint_lens lens;
};

static void make_random_output(struct glint_fitted_system *s,
                               enum glint_channel kind)
{
    struct glint_fitted_output *o = &s->output[s->n_outputs++];
    const int odd = kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y;
    const int scale = random_int(-40, 20);
    const int most = random_int(1, 40);

    *o = (struct glint_fitted_output){.kind = kind, .n_terms = 0};
    for (int k = 0; k < most; k++) {
        uint8_t *power = o->power[o->n_terms];
        bool twice = false;

        power[0] = (uint8_t)random_int(0, GLINT_MAX_POWER);
        power[1] = (uint8_t)(2 * random_int(0, 4) + odd);
        power[2] = (uint8_t)random_int(0, random_int(0, 15));
        power[3] = (uint8_t)random_int(0, random_int(0, 15));
        for (int i = 0; i < o->n_terms; i++)
            twice |= memcmp(o->power[i], power, sizeof o->power[i]) == 0;
        o->n_terms += !twice;
    }
    o->coef = malloc((size_t)o->n_terms * sizeof *o->coef);
    assert_non_null(o->coef);
    for (int k = 0; k < o->n_terms; k++) {
        const double unit = random_signed_unit();

        /* coefficients of the same sign bring some sums near their bound */
        o->coef[k] = ldexp(most % 3 ? unit : fabs(unit),
                           scale - random_int(0, most % 5 ? 3 : 20));
    }
    if (kind == GLINT_OUT_ENERGY) {
        o->roots = random_int(0, 2);
        o->most = random_int(0, 2) ? ldexp(1, scale - random_int(0, 12)) : 0;
    }
}

static void make_random_box(struct glint_fitted_system *s)
{
    s->box = calloc(3 * GLINT_BOX_TERMS, sizeof *s->box);
    assert_non_null(s->box);
    s->box[0] = 7 * random_signed_unit();
    s->box[1] = random_signed_unit();
    s->box[GLINT_BOX_TERMS] = 3 + random_signed_unit();
    s->box[2 * GLINT_BOX_TERMS] = 5;
}

static void make_random_system(struct made *m)
{
    struct glint_fitted_system *s = calloc(1, sizeof *s);

    assert_non_null(s);
    *m = (struct made){.fitted = {1, s}};
    *s = (struct glint_fitted_system){.sine_lo = 0.125,
                                      .sine_hi = 0.6,
                                      .wave_lo = 1 / 0.49,
                                      .wave_hi = 1 / 0.16};
    make_random_box(s);
    for (int kind = 0; kind < KINDS; kind++)
        make_random_output(s, (enum glint_channel)kind);
}

/* Quantises M, writes its model file, and opens this file as programs do. */
static void quantise_and_open_model(struct made *m)
{
    static struct glint_setup setup;
    struct glint_quantised_system *const quantised = &m->quantised;
    const struct glint_real one = glint_real_of(1);
    const struct glint_model_header header = {
        .magic = GLINT_MODEL_MAGIC,
        .version = GLINT_MODEL_VERSION,
        .basis = GLINT_BASIS_AUTO,
        .name = "made up",
        .focal_mm = one,
        .back_focal_mm = one,
        .entrance_radius_mm = one,
        .stop_radius_mm = one,
        .f_number = one,
        .film_width_mm = one,
        .film_height_mm = one,
        .field_mm = one,
        .front_mm = one,
        .wave_lo_q24 = (int32_t)(0x1p24 / 0.49),
        .wave_hi_q24 = (int32_t)(0x1p24 / 0.16),
        .sine_hi_q30 = ONE_Q30,
        .n_surfaces = 2};
    const char *reason = "";

    setup.n_ghosts = 1;
    setup.ghost[0] = (struct glint_ghost){0, 1};
    assert_ok(glint_quantise_system(m->fitted.system, &m->quantised));
    assert_ok(glint_draft_write_model(&m->draft, &setup, &header, &m->fitted,
                                      &quantised));
    glint_blob_set_size_and_checksum(m->draft.data, m->draft.bytes);
    if (glint_lens_open(&m->lens, m->draft.data, m->draft.bytes, &reason))
        fail_msg("%s", reason);
}

static void free_quantised_model(struct made *m)
{
    glint_quantised_free_system(&m->quantised);
    glint_fitted_free_ghost(&m->fitted);
    free(m->draft.data);
}

/* ----------------------------------------------------------- proven bounds */

static double decode_q30(int32_t x_q30)
{
    return ldexp(x_q30, -30);
}

/* Maps X from LO .. HI to -1 .. 1, Q30, with the rounding of the run time. */
static int32_t map_range_to_q30(int32_t x, int32_t lo, int32_t hi)
{
    const int64_t twice = 2 * (int64_t)x - lo - hi;

    return (int32_t)(twice * ONE_Q30 / ((int64_t)hi - lo));
}

/* Returns the value of the fitted polynomial O, given the powers of its
 * variables. */
static double evaluate_polynomial(const struct glint_fitted_output *o,
                                  double power[4][16])
{
    double sum = 0;

    for (int k = 0; k < o->n_terms; k++) {
        double term = o->coef[k];

        for (int i = 0; i < 4; i++)
            term *= power[i][o->power[k][i]];
        sum += term;
    }
    return sum;
}

static void set_powers_of_variables(double power[4][16], const double x[4])
{
    for (int i = 0; i < 4; i++) {
        power[i][0] = 1;
        for (int k = 1; k < 16; k++)
            power[i][k] = power[i][k - 1] * x[i];
    }
}

/* How closely values and rounding errors approached their proven bounds:
 * largest ratio to the bound, 0 .. 1. */
struct used {
    double bound, rounding;
    long n;
};

/* Returns the energy that the run time computes from VALUE, the result of the
 * energy polynomial: clamps it to 0 .. 2^(29 - HEAD), scales it up by 2^HEAD
 * and squares it ROOTS times. If HEAD and ROOTS are 0, returns VALUE. */
static double compute_energy_of_polynomial(int head, int roots, double value)
{
    if (head || roots)
        value = ldexp(fmin(fmax(value, 0), ldexp(1, 29 - head)), head);
    for (int k = 0; k < roots; k++)
        value = value * value * 0x1p-29;
    return value;
}

/* Compares OUT, the outputs of the run time, with the fitted polynomials at X,
 * the exact values of the variables. Raises the maxima in USED. */
static void compare_outputs_with_polynomials(const struct made *m,
                                             const struct glint_outputs *out,
                                             const double x[4],
                                             struct used *used)
{
    double power[4][16];

    set_powers_of_variables(power, x);
    for (int k = 0; k < m->fitted.system->n_outputs; k++) {
        const struct glint_fitted_output *o = &m->fitted.system->output[k];
        const struct glint_quantised_output *q = &m->quantised.output[k];
        const double truth = compute_energy_of_polynomial(
            q->head, o->roots,
            ldexp(evaluate_polynomial(o, power), -q->exponent));
        const double error = fabs(out->at[o->kind] - truth);
        const double most = ldexp(q->rounding_q8, -8) + 1e-6;

        /* energies are limited to 2^29, not by the proven bound */
        if (q->head || o->roots) {
            assert_true(error <= most && out->at[o->kind] <= 1 << 29);
            continue;
        }
        if (error > most || fabs((double)out->at[o->kind]) > q->bound)
            fail_msg("kind %d at %.9g %.9g %.9g %.9g: %d for %.3f, proven %g "
                     "and %lu",
                     (int)o->kind, x[0], x[1], x[2], x[3],
                     (int)out->at[o->kind], truth, most,
                     (unsigned long)q->bound);
        used->rounding = fmax(used->rounding, error / most);
        used->bound =
            fmax(used->bound, fabs((double)out->at[o->kind]) / q->bound);
        used->n++;
    }
}

static void compare_rays_with_polynomials(const struct made *m,
                                          int32_t sine_q30, int32_t wave_q24,
                                          int rays, struct used *used)
{
    struct glint_transfer t;

    assert_true(glint_transfer_init(&t, &m->lens, 0, sine_q30, wave_q24));
    for (int k = 0; k < rays; k++) {
        const int32_t u_q30 = random_number_q30(), v_q30 = random_number_q30();
        const struct glint_model_system *s = t.system;
        const double x[4] = {decode_q30(u_q30), decode_q30(v_q30),
                             decode_q30(map_range_to_q30(
                                 sine_q30, s->sine_lo_q30, s->sine_hi_q30)),
                             decode_q30(map_range_to_q30(
                                 wave_q24, s->wave_lo_q24, s->wave_hi_q24))};
        struct glint_outputs out;

        glint_transfer_ray(&t, u_q30, v_q30, &out);
        compare_outputs_with_polynomials(m, &out, x, used);
    }
}

static struct used check_proven_bounds(int systems)
{
    enum { BUNDLES = 8, RAYS = 50 };
    struct used used = {0, 0, 0};

    for (int k = 0; k < systems; k++) {
        const struct glint_model_system *s;
        struct made m;

        seed = 100 * (uint32_t)k + 1;
        make_random_system(&m);
        quantise_and_open_model(&m);
        s = m.lens.system;
        for (int i = 0; i < BUNDLES; i++) {
            const double a = 0.5 + 0.5 * decode_q30(random_number_q30());
            const double b = 0.5 + 0.5 * decode_q30(random_number_q30());
            const int32_t sine_q30 =
                s->sine_lo_q30 +
                (int32_t)(a * (s->sine_hi_q30 - s->sine_lo_q30));
            const int32_t wave_q24 =
                s->wave_lo_q24 +
                (int32_t)(b * (s->wave_hi_q24 - s->wave_lo_q24));

            compare_rays_with_polynomials(&m, sine_q30, wave_q24, RAYS, &used);
        }
        free_quantised_model(&m);
    }
    return used;
}

/* Checks that no value exceeds its proven bound, that some value is near it,
 * and that some rounding error is at least 2 % of its bound. */
TEST(rounding_stays_below_its_proven_bound)
{
    const struct used used = check_proven_bounds(240);

    assert_true(used.n > 300000);
    assert_in_range((long)(1000 * used.bound), 800, 1000);
    assert_in_range((long)(1000 * used.rounding), 20, 1000);
}

/* Checks that a coefficient with an error of a thousandth exceeds the proven
 * rounding error, which shows that the test above can fail. */
TEST(wrong_coefficient_exceeds_the_proven_bound)
{
    struct glint_outputs out;
    struct glint_transfer t;
    struct glint_fitted_output *o;
    double power[4][16], truth;
    struct made m;
    int largest = 0;

    seed = 5;
    make_random_system(&m);
    m.fitted.system->output[GLINT_OUT_ENERGY].roots = 0;
    m.fitted.system->output[GLINT_OUT_ENERGY].most = 0;
    quantise_and_open_model(&m);
    o = &m.fitted.system->output[GLINT_OUT_ENERGY];
    for (int k = 1; k < o->n_terms; k++)
        largest = fabs(o->coef[k]) > fabs(o->coef[largest]) ? k : largest;
    o->coef[largest] *= 1.001;
    assert_true(glint_transfer_init(&t, &m.lens, 0, m.lens.system->sine_hi_q30,
                                    m.lens.system->wave_hi_q24));
    glint_transfer_ray(&t, ONE_Q30, ONE_Q30, &out);
    set_powers_of_variables(power, (const double[4]){1, 1, 1, 1});
    truth = ldexp(evaluate_polynomial(o, power),
                  -m.quantised.output[GLINT_OUT_ENERGY].exponent);
    assert_true(fabs(out.at[GLINT_OUT_ENERGY] - truth) >
                ldexp(m.quantised.output[GLINT_OUT_ENERGY].rounding_q8, -8));
    free_quantised_model(&m);
}

/* --------------------------------------------------- conversion of doubles */

TEST(doubles_convert_to_reals)
{
    static const double exact[] = {
        1, -1, 0.5, 3, -0.1875, 0x1.fffffffcp+40, 0x1p-150, 123456789};

    for (size_t k = 0; k < sizeof exact / sizeof *exact; k++)
        assert_true(glint_real_value(glint_real_of(exact[k])) == exact[k]);
    assert_int_equal(glint_real_of(1).mantissa, ONE_Q30);
    assert_int_equal(glint_real_of(1).exponent, -30);
    assert_int_equal(glint_real_of(-6).mantissa, -3 * (ONE_Q30 / 2));
    assert_int_equal(glint_real_of(-6).exponent, -28);
    for (int k = 0; k < 100000; k++) {
        const double x = ldexp(random_signed_unit(), random_int(-150, 150));
        const struct glint_real real = glint_real_of(x);

        assert_near(glint_real_value(real), x, 0x1p-30 * fabs(x));
        assert_true(x == 0 || abs(real.mantissa) >= ONE_Q30);
    }
}

TEST(zero_and_infinite_doubles_convert)
{
    static const double odd[] = {0, -0.0, HUGE_VAL, -HUGE_VAL, (double)NAN};

    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
        assert_int_equal(glint_real_of(odd[k]).mantissa, 0);
        assert_int_equal(glint_real_of(odd[k]).exponent, 0);
    }
    /* the largest double below 2 */
    assert_int_equal(glint_real_of(nextafter(2, 0)).mantissa, INT32_MAX);
}

/* ---------------------------------------------------------------- exponents */

static int64_t
sum_coefficient_magnitudes(const struct glint_fitted_output *o,
                           const struct glint_quantised_output *q)
{
    int64_t sum = 0;

    for (int t = 0; t < o->n_terms; t++) {
        sum += labs(q->coef[t]);
        assert_near(q->coef[t], ldexp(o->coef[t], -q->exponent), 0.5);
    }
    return sum;
}

/* Checks that the exponents are chosen so that sums of coefficients fit into
 * their range and use at least half of it. */
TEST(exponents_use_half_of_the_range)
{
    for (int k = 0; k < 1000; k++) {
        struct made m;

        seed = 7 + (uint32_t)k;
        make_random_system(&m);
        assert_ok(glint_quantise_system(m.fitted.system, &m.quantised));
        for (int i = 0; i < KINDS; i++) {
            const struct glint_quantised_output *q = &m.quantised.output[i];
            const int64_t sum =
                sum_coefficient_magnitudes(&m.fitted.system->output[i], q);

            assert_true(sum <= GLINT_COEF_LIMIT);
            assert_true(q->bound < ONE_Q30);
            if (i >= GLINT_OUT_ENERGY && q->exponent > -80)
                assert_true(sum >= GLINT_COEF_LIMIT / 2 - 64);
        }
        for (int i = 0; i < GLINT_OUT_ENERGY; i += 2)
            assert_int_equal(m.quantised.output[i].exponent,
                             m.quantised.output[i + 1].exponent);
        free_quantised_model(&m);
    }
}

/* Checks that the upper limit of a ghost's energy is at least 1.2 times the
 * largest energy of the ghost's unblocked rays. */
TEST(energy_limit_has_headroom)
{
    int cut = 0;

    for (int k = 0; k < 1000; k++) {
        const struct glint_fitted_output *o;
        const struct glint_quantised_output *q;
        struct made m;

        seed = 11 + (uint32_t)k;
        make_random_system(&m);
        assert_ok(glint_quantise_system(m.fitted.system, &m.quantised));
        o = &m.fitted.system->output[GLINT_OUT_ENERGY];
        q = &m.quantised.output[GLINT_OUT_ENERGY];
        if (q->head > 0)
            assert_true(ldexp(1.2 * o->most, q->head - q->exponent) < 0x1p29);
        cut += q->head > 0;
        free_quantised_model(&m);
    }
    assert_in_range(cut, 300, 900);
}

/* Checks that coefficients too small for any exponent of the file format are
 * rounded to steps of the smallest exponent. */
TEST(tiny_coefficients_use_the_smallest_exponent)
{
    struct made m;

    seed = 3;
    make_random_system(&m);
    for (int k = 0; k < KINDS; k++)
        for (int t = 0; t < m.fitted.system->output[k].n_terms; t++)
            m.fitted.system->output[k].coef[t] = k % 2 ? 0 : 0x1p-200;
    quantise_and_open_model(
        &m); /* its checks include that the run time opens the model */
    assert_int_equal(m.quantised.output[GLINT_OUT_ENERGY].exponent, -80);
    free_quantised_model(&m);
}

/* Checks that a system whose fit has diverged draws nothing: its coefficients
 * are too large for a model. */
TEST(diverged_fits_have_no_light)
{
    struct made m;

    seed = 3;
    make_random_system(&m);
    m.fitted.system->output[1].coef[0] = 0x1p90;
    assert_int_equal(glint_quantise_system(m.fitted.system, &m.quantised),
                     GLINT_OK);
    for (int k = 0; k < KINDS; k++)
        for (int t = 0; t < m.fitted.system->output[k].n_terms; t++)
            assert_int_equal(m.quantised.output[k].coef[t], 0);
    free_quantised_model(&m);
}

/* ---------------------------------------------------- rejected polynomials */

static void check_system_is_rejected(struct made *m)
{
    assert_int_equal(glint_quantise_system(m->fitted.system, &m->quantised),
                     GLINT_E_LENS);
    free_quantised_model(m);
}

TEST(rejects_numbers_that_are_not_finite)
{
    static const double odd[] = {(double)NAN, HUGE_VAL, -HUGE_VAL};

    for (int k = 0; k < 6 * KINDS; k++) {
        struct glint_fitted_output *o;
        struct made m;

        make_random_system(&m);
        o = &m.fitted.system->output[k / 6];
        o->coef[o->n_terms - 1] = odd[k % 3];
        check_system_is_rejected(&m);
        make_random_system(&m);
        m.fitted.system->box[k % 9] = odd[k % 3];
        check_system_is_rejected(&m);
    }
}

TEST(rejects_outputs_without_terms)
{
    struct made m;

    make_random_system(&m);
    m.fitted.system->output[GLINT_OUT_STOP_Y].n_terms = 0;
    check_system_is_rejected(&m);
}
