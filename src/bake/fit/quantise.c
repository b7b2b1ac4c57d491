/* SPDX-License-Identifier: MIT */
#include "bake/fit/quantise.h"

#include <math.h>
#include <stdlib.h>

#include "glint/real.h"

/* ------------------------------------------------------------------ scaling */

/* Returns the sum of the magnitudes of N values. */
static double sum_of(const double *value, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += fabs(value[i]);
    return sum;
}

enum { LEAST_EXPONENT = -80 }; /* min binary exponent of a model */

/* Returns the exponent at which the sum of N values, of magnitude SUM before
 * each was rounded, stays below the limit. */
static int exponent_for(double sum, int n)
{
    int exponent;

    frexp(sum, &exponent);
    exponent = exponent - 29 > LEAST_EXPONENT ? exponent - 29 : LEAST_EXPONENT;
    while (ldexp(sum, -exponent) + n > (double)GLINT_COEF_LIMIT)
        exponent++;
    return exponent;
}

static bool all_finite(const double *value, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(value[i]))
            return false;
    return true;
}

static enum glint_status to_integers(const double *value, int n, int exponent,
                                     int32_t **out)
{
    *out = malloc((size_t)n * sizeof **out);
    if (!*out)
        return GLINT_E_MEMORY;
    for (int i = 0; i < n; i++)
        (*out)[i] = (int32_t)lrint(ldexp(value[i], -exponent));
    return GLINT_OK;
}

/* ---------------------------------------------------------------- intervals */

/* The range of a number computed at run time, and the max distance between its
 * rounded and its true value, in its unit. Doubles hold these exactly enough:
 * they stay below 2^31, and errors are rounded up at the end. */
struct range {
    double lo, hi, error;
};

static double reach(struct range r)
{
    return fmax(fabs(r.lo), fabs(r.hi)) + r.error;
}

struct proof {
    double bound; /* largest magnitude of all intermediates so far */
};

static struct range seen(struct proof *p, struct range r)
{
    p->bound = fmax(p->bound, reach(r));
    return r;
}

static struct range plus(struct proof *p, struct range a, struct range b)
{
    return seen(p, (struct range){a.lo + b.lo, a.hi + b.hi, a.error + b.error});
}

/* Returns the range of q_mul(a, x, 30). X is a variable within -1 .. 1; its
 * error is in units of 2^-30. */
static struct range multiply_range(struct proof *p, struct range a,
                                   struct range x)
{
    const double c[4] = {a.lo * x.lo, a.lo * x.hi, a.hi * x.lo, a.hi * x.hi};
    const double most_x = fmax(fabs(x.lo), fabs(x.hi));

    return seen(
        p, (struct range){fmin(fmin(c[0], c[1]), fmin(c[2], c[3])),
                          fmax(fmax(c[0], c[1]), fmax(c[2], c[3])),
                          a.error * (most_x + x.error * 0x1p-30) +
                              fmax(fabs(a.lo), fabs(a.hi)) * x.error * 0x1p-30 +
                              0.5});
}

/* Returns the range of X^N as the run time works it out; X is a variable with
 * an error of its own. */
static struct range power_of(struct range x, int n)
{
    struct range r = {n % 2 ? x.lo : fmax(0, x.lo), 1,
                      n * x.error + (n > 1 ? 0.5 * n : 0)};

    if (n % 2 == 0 && x.lo >= 0)
        r.lo = 0;
    return r;
}

static const struct range both_ways = {-1, 1, 0};

/* Returns the range of COEF. Its error includes rounding to an integer, or to a
 * multiple of 2^SHIFT. */
static struct range coefficient(int32_t coef, int shift)
{
    return (struct range){coef, coef, 0.5 + (shift ? ldexp(0.5, shift) : 0)};
}

/* Proves the step that puts angle and wavelength in: TABLE receives the
 * coefficients of u and v. */
static void prove_table(struct proof *p, const struct glint_fitted_output *o,
                        const struct glint_quantised_output *q,
                        struct range table[][GLINT_MAX_POWER + 1])
{
    for (int i = 0; i < o->n_terms; i++) {
        const int k = q->order[i];
        const int shift = i < o->n_terms - q->n_narrow ? 0 : q->shift;
        struct range value = seen(p, coefficient(q->coef[k], shift));
        struct range *to = &table[o->power[k][1]][o->power[k][0]];

        for (int x = 2; x < GLINT_VARIABLES; x++)
            if (o->power[k][x])
                value = multiply_range(p, value,
                                       power_of(both_ways, o->power[k][x]));
        *to = plus(p, *to, value);
    }
}

/* Returns the range of the terms of TABLE with u to the power A and odd, or
 * even, powers of v. */
static struct range across(struct proof *p,
                           struct range table[][GLINT_MAX_POWER + 1], int a,
                           bool odd)
{
    const struct range v2 = {0, 1, 0.5};
    struct range sum = {0, 0, 0};

    for (int b = GLINT_MAX_POWER - 1 + odd; b >= 0; b -= 2)
        sum = plus(p, multiply_range(p, sum, v2), table[b][a]);
    return odd ? multiply_range(p, sum, both_ways) : sum;
}

static void prove_output(struct proof *p, const struct glint_fitted_output *o,
                         const struct glint_quantised_output *q, bool skew,
                         struct range *result)
{
    struct range table[GLINT_MAX_POWER + 1][GLINT_MAX_POWER + 1] = {
        {{0, 0, 0}}};
    const bool odd =
        o->kind == GLINT_OUT_SENSOR_Y || o->kind == GLINT_OUT_STOP_Y;

    prove_table(p, o, q, table);
    for (int a = GLINT_MAX_POWER; a >= 0; a--) {
        struct range sum = across(p, table, a, odd && !skew);

        if (skew)
            sum = plus(p, sum, across(p, table, a, true));
        *result = plus(p, multiply_range(p, *result, both_ways), sum);
    }
}

/* Returns the range of the energy that the run time makes of its polynomial. */
static struct range energy_of(struct range x, int head, int roots)
{
    if (head || roots)
        x = (struct range){0, fmin(fmax(0, ldexp(x.hi, head)), 0x1p29),
                           ldexp(x.error, head)};
    for (int k = 0; k < roots; k++)
        x = (struct range){0, x.hi * x.hi * 0x1p-29,
                           (2 * x.hi + x.error) * x.error * 0x1p-29 + 0.5};
    return x;
}

static void prove(const struct glint_fitted_system *s,
                  const struct glint_fitted_output *o,
                  struct glint_quantised_output *out)
{
    struct proof p = {0};
    struct range result = {0, 0, 0};

    prove_output(&p, o, out, s->skew, &result);
    while (out->head > 0 &&
           energy_of(result, out->head, o->roots).error >= 0x1p22)
        out->head--; /* only rounding would go up there */
    result = energy_of(result, out->head, o->roots);
    out->proven = p.bound < 0x1p30 && result.error < 0x1p23;
    out->bound = out->proven ? (uint32_t)ceil(p.bound) : 0;
    out->rounding_q8 = out->proven ? (uint32_t)ceil(256 * result.error) : 0;
}

/* ------------------------------------------------------------------- narrow */

/* Moves coefficients for which 16 bits are enough to the end of the order. */
static void narrow(const struct glint_fitted_output *o,
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

/* Returns 1 or -1, the offset in the list of outputs from KIND to the other
 * coordinate of its pair, or 0 if KIND is not a coordinate of a pair. Both
 * coordinates have the same exponent so that they can be rotated together. */
static int offset_to_pair(enum glint_channel kind)
{
    return kind == GLINT_OUT_SENSOR_X || kind == GLINT_OUT_STOP_X   ? 1
           : kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y ? -1
                                                                    : 0;
}

static int output_exponent(const struct glint_fitted_system *s, int k)
{
    const struct glint_fitted_output *o = &s->output[k];

    return exponent_for(sum_of(o->coef, o->n_terms), o->n_terms);
}

/* Returns by how many bits a polynomial can be scaled up so that, where light
 * gets through, it stays below half of the largest allowed integer. For a
 * fourth root the energy must stay below that, and one bit of the root is four
 * bits of the energy. */
static int head_of(const struct glint_fitted_output *o, int exponent)
{
    const double most = o->roots ? 0x1.ap28 : 0x1p28;
    int head = 0;

    while (o->most > 0 && head < 28 &&
           ldexp(o->most, head + 1 - exponent) < most)
        head++;
    return head;
}

static enum glint_status quantise_output(const struct glint_fitted_system *s,
                                         int k,
                                         struct glint_quantised_output *out)
{
    const struct glint_fitted_output *o = &s->output[k];
    const int pair = offset_to_pair(o->kind);
    enum glint_status status;

    out->exponent = output_exponent(s, k);
    if (pair) {
        const int other = output_exponent(s, k + pair);

        out->exponent = out->exponent > other ? out->exponent : other;
    }
    out->head = head_of(o, out->exponent);
    status = to_integers(o->coef, o->n_terms, out->exponent, &out->coef);
    for (int i = 0; i < o->n_terms; i++)
        out->order[i] = (uint8_t)i;
    if (status == GLINT_OK) {
        narrow(o, out);
        prove(s, o, out);
        status = out->proven ? GLINT_OK : GLINT_E_LENS;
    }
    return status;
}

static int box_size(const struct glint_fitted_system *s)
{
    return (s->skew ? GLINT_LENS_SIDES : 3) * GLINT_BOX_TERMS;
}

/* Returns whether every output has terms and all numbers are finite. */
static bool is_sound(const struct glint_fitted_system *s)
{
    const int n_box = box_size(s);

    for (int k = 0; k < s->n_outputs; k++) {
        const struct glint_fitted_output *o = &s->output[k];

        if (o->n_terms < 1 || !all_finite(o->coef, o->n_terms))
            return false;
    }
    return all_finite(s->box, n_box);
}

enum glint_status glint_quantise(const struct glint_fitted_system *system,
                                 struct glint_quantised_system *out)
{
    enum glint_status status;
    double most = 0;

    *out = (struct glint_quantised_system){.box_exponent = 0};
    out->n_box = box_size(system);
    if (!is_sound(system))
        return GLINT_E_LENS;
    for (int k = 0; k < out->n_box; k += GLINT_BOX_TERMS)
        most = fmax(most, sum_of(system->box + k, GLINT_BOX_TERMS));
    out->box_exponent = exponent_for(most, GLINT_BOX_TERMS);
    status = to_integers(system->box, out->n_box, out->box_exponent, &out->box);
    for (int k = 0; k < system->n_outputs && status == GLINT_OK; k++)
        status = quantise_output(system, k, &out->output[k]);
    return status;
}

void glint_quantised_finish(struct glint_quantised_system *system)
{
    for (int k = 0; k < GLINT_OUT_KINDS; k++)
        free(system->output[k].coef);
    free(system->box);
}
