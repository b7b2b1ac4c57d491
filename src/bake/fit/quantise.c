/* SPDX-License-Identifier: MIT */
#include "bake/fit/quantise.h"

#include <math.h>
#include <stdlib.h>

#include "glint/real.h"

/* ------------------------------------------------------------------ scaling */

/* Returns the sum of the magnitudes of VALUE[N]. */
static double sum_magnitudes(const double *value, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += fabs(value[i]);
    return sum;
}

/* range of the binary exponents in a model */
enum { LEAST_EXPONENT = -80, MOST_EXPONENT = 40 };

/* Returns the smallest exponent E such that N values, divided by 2^E and
 * rounded, have magnitudes that sum to less than GLINT_COEF_LIMIT. SUM: sum of
 * the magnitudes before division. */
static int choose_coefficient_exponent(double sum, int n)
{
    int exponent;

    frexp(sum, &exponent);
    exponent = exponent - 29 > LEAST_EXPONENT ? exponent - 29 : LEAST_EXPONENT;
    while (ldexp(sum, -exponent) + n > (double)GLINT_COEF_LIMIT)
        exponent++;
    return exponent;
}

static bool are_all_finite(const double *value, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(value[i]))
            return false;
    return true;
}

/* Allocates ALL integers, of which the first N are VALUE / 2^EXPONENT, rounded,
 * and the others 0. */
static enum glint_status round_to_integers(const double *value, int n, int all,
                                           int exponent, int32_t **out)
{
    *out = calloc((size_t)all, sizeof **out);
    if (!*out)
        return GLINT_E_MEMORY;
    for (int i = 0; i < n; i++)
        (*out)[i] = (int32_t)lrint(ldexp(value[i], -exponent));
    return GLINT_OK;
}

/* ---------------------------------------------------------------- intervals */

/* Interval of the values that a number of the run time can have, and its max
 * rounding error, both in the number's unit. Doubles are precise enough: values
 * stay below 2^31, and errors are rounded up at the end. */
struct range {
    double lo, hi, error;
};

static double get_max_range_magnitude(struct range r)
{
    return fmax(fabs(r.lo), fabs(r.hi)) + r.error;
}

struct proof {
    /* max magnitude of all intermediate results so far, units of the output */
    double bound;
};

static struct range record_max_magnitude(struct proof *p, struct range r)
{
    p->bound = fmax(p->bound, get_max_range_magnitude(r));
    return r;
}

static struct range add_ranges(struct proof *p, struct range a, struct range b)
{
    return record_max_magnitude(
        p, (struct range){a.lo + b.lo, a.hi + b.hi, a.error + b.error});
}

/* Returns the interval of q_mul(a, x, 30), where X is a variable in -1 .. 1
 * whose error is in units of 2^-30. */
static struct range multiply_range_by_variable(struct proof *p, struct range a,
                                               struct range x)
{
    const double c[4] = {a.lo * x.lo, a.lo * x.hi, a.hi * x.lo, a.hi * x.hi};
    const double most_x = fmax(fabs(x.lo), fabs(x.hi));

    return record_max_magnitude(
        p, (struct range){fmin(fmin(c[0], c[1]), fmin(c[2], c[3])),
                          fmax(fmax(c[0], c[1]), fmax(c[2], c[3])),
                          a.error * (most_x + x.error * 0x1p-30) +
                              fmax(fabs(a.lo), fabs(a.hi)) * x.error * 0x1p-30 +
                              0.5});
}

/* Returns the interval of X^N as computed at run time, including the error of
 * X. */
static struct range compute_power_range(struct range x, int n)
{
    struct range r = {n % 2 ? x.lo : fmax(0, x.lo), 1,
                      n * x.error + (n > 1 ? 0.5 * n : 0)};

    if (n % 2 == 0 && x.lo >= 0)
        r.lo = 0;
    return r;
}

static const struct range unit_range = {-1, 1, 0};

/* Returns the interval of coefficient COEF, including its rounding to an
 * integer or to a multiple of 2^SHIFT. */
static struct range compute_coefficient_range(int32_t coef, int shift)
{
    return (struct range){coef, coef, 0.5 + (shift ? ldexp(0.5, shift) : 0)};
}

/* Computes the coefficients' intervals after angle and wavelength are
 * substituted into all terms: TABLE[v power][u power] receives them. */
static void compute_term_ranges(struct proof *p,
                                const struct glint_fitted_output *o,
                                const struct glint_quantised_output *q,
                                struct range table[][GLINT_MAX_POWER + 1])
{
    for (int i = 0; i < o->n_terms; i++) {
        const int k = q->order[i];
        const int shift = i < o->n_terms - q->n_narrow ? 0 : q->shift;
        struct range value = record_max_magnitude(
            p, compute_coefficient_range(q->coef[k], shift));
        struct range *to = &table[o->power[k][1]][o->power[k][0]];

        for (int x = 2; x < GLINT_VARIABLES; x++)
            if (o->power[k][x])
                value = multiply_range_by_variable(
                    p, value, compute_power_range(unit_range, o->power[k][x]));
        *to = add_ranges(p, *to, value);
    }
}

/* Returns the interval of the sum over all odd or over all even powers of v of
 * the terms of TABLE with u^A. */
static struct range compute_row_range(struct proof *p,
                                      struct range table[][GLINT_MAX_POWER + 1],
                                      int a, bool odd)
{
    const struct range v2 = {0, 1, 0.5};
    struct range sum = {0, 0, 0};

    for (int b = GLINT_MAX_POWER - 1 + odd; b >= 0; b -= 2)
        sum =
            add_ranges(p, multiply_range_by_variable(p, sum, v2), table[b][a]);
    return odd ? multiply_range_by_variable(p, sum, unit_range) : sum;
}

static void compute_output_range(struct proof *p,
                                 const struct glint_fitted_output *o,
                                 const struct glint_quantised_output *q,
                                 bool skew, struct range *result)
{
    struct range table[GLINT_MAX_POWER + 1][GLINT_MAX_POWER + 1] = {
        {{0, 0, 0}}};
    const bool odd =
        o->kind == GLINT_OUT_SENSOR_Y || o->kind == GLINT_OUT_STOP_Y;

    compute_term_ranges(p, o, q, table);
    for (int a = GLINT_MAX_POWER; a >= 0; a--) {
        struct range sum = compute_row_range(p, table, a, odd && !skew);

        if (skew)
            sum = add_ranges(p, sum, compute_row_range(p, table, a, true));
        *result = add_ranges(
            p, multiply_range_by_variable(p, *result, unit_range), sum);
    }
}

/* Returns the interval of the energy that the run time computes from the value
 * X of its polynomial: X scaled by 2^HEAD and squared ROOTS times. */
static struct range compute_energy_range(struct range x, int head, int roots)
{
    if (head || roots)
        x = (struct range){0, fmin(fmax(0, ldexp(x.hi, head)), 0x1p29),
                           ldexp(x.error, head)};
    for (int k = 0; k < roots; k++)
        x = (struct range){0, x.hi * x.hi * 0x1p-29,
                           (2 * x.hi + x.error) * x.error * 0x1p-29 + 0.5};
    return x;
}

static void prove_no_overflow(const struct glint_fitted_system *s,
                              const struct glint_fitted_output *o,
                              struct glint_quantised_output *out)
{
    struct proof p = {0};
    struct range result = {0, 0, 0};

    compute_output_range(&p, o, out, s->skew, &result);
    while (out->head > 0 &&
           compute_energy_range(result, out->head, o->roots).error >= 0x1p22)
        out->head--; /* a larger scale would only enlarge rounding errors */
    result = compute_energy_range(result, out->head, o->roots);
    out->proven = p.bound < 0x1p30 && result.error < 0x1p23;
    out->bound = out->proven ? (uint32_t)ceil(p.bound) : 0;
    out->rounding_q8 = out->proven ? (uint32_t)ceil(256 * result.error) : 0;
}

/* ------------------------------------------------------------------- narrow */

/* Moves coefficients for which 16 bits are precise enough to the end of the
 * order of terms. */
static void move_16_bit_terms_to_end(const struct glint_fitted_output *o,
                                     struct glint_quantised_output *out)
{
    const double steps = ldexp(o->grain, -out->exponent);
    int n_wide = 0, end = o->n_terms;

    for (out->shift = 0; out->shift < 16 && ldexp(1, out->shift + 1) <= steps;)
        out->shift++;
    for (int k = 0; k < o->n_terms; k++) {
        const int32_t step = INT32_C(1) << out->shift;
        const double part = rint((double)out->coef[k] / step);

        if (out->shift < 4 || fabs(part) > INT16_MAX) {
            out->order[n_wide++] = (uint8_t)k;
            continue;
        }
        out->coef[k] = (int32_t)part * step;
        out->order[--end] = (uint8_t)k;
    }
    out->n_narrow = o->n_terms - n_wide;
}

/* ------------------------------------------------------------------ systems */

/* Returns the distance in the list of outputs from position coordinate KIND to
 * the other one (from x to y or y to x): 1 or -1; 0 if KIND is not a position.
 * Both coordinates have the same exponent, so that they can be rotated. */
static int find_paired_output_offset(enum glint_channel kind)
{
    return kind == GLINT_OUT_SENSOR_X || kind == GLINT_OUT_STOP_X   ? 1
           : kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y ? -1
                                                                    : 0;
}

static int choose_output_exponent(const struct glint_fitted_system *s, int k)
{
    const struct glint_fitted_output *o = &s->output[k];

    return choose_coefficient_exponent(sum_magnitudes(o->coef, o->n_terms),
                                       o->n_terms);
}

/* Returns the number of bits by which values of the energy polynomial can be
 * scaled up while they stay below half of the max integer for all rays that
 * reach the sensor. If the energy is the fourth power of the polynomial, the
 * limit holds for the energy, and one bit of the polynomial is four bits of the
 * energy. */
static int choose_energy_scale(const struct glint_fitted_output *o,
                               int exponent)
{
    const double most = o->roots ? 0x1.ap28 : 0x1p28;
    int head = 0;

    while (o->most > 0 && head < 28 &&
           ldexp(o->most, head + 1 - exponent) < most)
        head++;
    return head;
}

/* Returns whether the fit of a system has diverged: the coefficients of an
 * output are too large for a model, and would cancel each other. */
static bool has_fit_diverged(const struct glint_fitted_system *s)
{
    for (int k = 0; k < s->n_outputs; k++)
        if (choose_output_exponent(s, k) > MOST_EXPONENT)
            return true;
    return false;
}

/* Quantises output K of S, or sets it to 0 if IS_DARK. */
static enum glint_status quantise_output(const struct glint_fitted_system *s,
                                         int k, bool is_dark,
                                         struct glint_quantised_output *out)
{
    const struct glint_fitted_output *o = &s->output[k];
    const int pair = find_paired_output_offset(o->kind);
    enum glint_status status;

    out->exponent = choose_output_exponent(s, k);
    if (pair) {
        const int other = choose_output_exponent(s, k + pair);

        out->exponent = out->exponent > other ? out->exponent : other;
    }
    if (is_dark)
        out->exponent = MOST_EXPONENT;
    out->head = is_dark ? 0 : choose_energy_scale(o, out->exponent);
    status = round_to_integers(o->coef, is_dark ? 0 : o->n_terms, o->n_terms,
                               out->exponent, &out->coef);
    for (int i = 0; i < o->n_terms; i++)
        out->order[i] = (uint8_t)i;
    if (status == GLINT_OK) {
        move_16_bit_terms_to_end(o, out);
        prove_no_overflow(s, o, out);
        status = out->proven ? GLINT_OK : GLINT_E_LENS;
    }
    return status;
}

static int count_box_terms(const struct glint_fitted_system *s)
{
    return (s->skew ? GLINT_LENS_SIDES : 3) * GLINT_BOX_TERMS;
}

/* Returns whether each output has terms and all coefficients are finite. */
static bool is_system_finite(const struct glint_fitted_system *s)
{
    const int n_box = count_box_terms(s);

    for (int k = 0; k < s->n_outputs; k++) {
        const struct glint_fitted_output *o = &s->output[k];

        if (o->n_terms < 1 || !are_all_finite(o->coef, o->n_terms))
            return false;
    }
    return are_all_finite(s->box, n_box);
}

enum glint_status
glint_quantise_system(const struct glint_fitted_system *system,
                      struct glint_quantised_system *out)
{
    enum glint_status status;
    double most = 0;
    bool is_dark;

    *out = (struct glint_quantised_system){.box_exponent = 0};
    out->n_box = count_box_terms(system);
    if (!is_system_finite(system))
        return GLINT_E_LENS;
    is_dark = has_fit_diverged(system);
    for (int k = 0; k < out->n_box; k += GLINT_BOX_TERMS)
        most = fmax(most, sum_magnitudes(system->box + k, GLINT_BOX_TERMS));
    out->box_exponent = choose_coefficient_exponent(most, GLINT_BOX_TERMS);
    status = round_to_integers(system->box, out->n_box, out->n_box,
                               out->box_exponent, &out->box);
    for (int k = 0; k < system->n_outputs && status == GLINT_OK; k++)
        status = quantise_output(system, k, is_dark, &out->output[k]);
    return status;
}

void glint_quantised_free_system(struct glint_quantised_system *system)
{
    for (int k = 0; k < GLINT_OUT_KINDS; k++)
        free(system->output[k].coef);
    free(system->box);
}
