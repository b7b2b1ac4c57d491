/* SPDX-License-Identifier: MIT
 *
 * Checks the systems of a model: knots, boxes, outputs, terms, coefficients.
 * model.c says which of their properties the transfer relies on. */
#include "base/q.h"
#include "lens/box.h"
#include "lens/model_check.h"

enum {
    MAX_SHIFT = 20, /* most bits that narrow coefficients are shifted by */
    MAX_ROOTS = 2,
    MAX_HEAD = 28,
    /* least and most binary exponent of outputs and boxes */
    MIN_EXPONENT = -80,
    MAX_EXPONENT = 40,
    NEEDED_KINDS = GLINT_OUT_ENERGY + 1,
    /* log2 of the number of intervals of angle at whose ends a box is checked
     */
    BOX_NODES_LOG2 = 5,
    MAX_SHARED = 8 /* largest size of all tables that systems refer to, in sizes
                      of the file; otherwise systems that share large tables
                      would take quadratic time */
};

/* ---------------------------------------------------------- angles and box */

static int64_t magnitude(int32_t x)
{
    return x < 0 ? -(int64_t)x : x;
}

static int64_t magnitudes(const int32_t *x, uint32_t n)
{
    int64_t sum = 0;

    for (uint32_t k = 0; k < n; k++)
        sum += magnitude(x[k]);
    return sum;
}

/* Checks the range of the y component. */
static const char *check_across(struct glint_model_check *c,
                                const struct glint_model_system *s)
{
    const int32_t *y_q30 =
        glint_blob_section(&c->blob, s->knot_at, 2, sizeof *y_q30);

    if (!y_q30)
        return glint_model_outside;
    return y_q30[0] < -MODEL_LIMIT || y_q30[0] >= y_q30[1] ||
                   y_q30[1] > MODEL_LIMIT
               ? "a system's angles are out of range"
               : NULL;
}

static const char *check_knots(struct glint_model_check *c,
                               const struct glint_model_system *s)
{
    const int32_t *knot_q30;

    if ((c->header->basis == GLINT_BASIS_SPARSE) != (s->n_knots > 0))
        return "knots do not go with the basis";
    if (glint_basis_is_lens(c->header->basis))
        return check_across(c, s);
    if (s->n_knots == 0)
        return NULL;
    if (s->n_knots == 1)
        return "a system has a single knot";
    knot_q30 =
        glint_blob_section(&c->blob, s->knot_at, s->n_knots, sizeof *knot_q30);
    if (!knot_q30)
        return glint_model_outside;
    for (uint32_t k = 1; k < s->n_knots; k++)
        if (knot_q30[k] <= knot_q30[k - 1])
            return "a system's knots do not rise";
    if (knot_q30[0] < 0 || knot_q30[0] > s->sine_lo_q30 ||
        knot_q30[s->n_knots - 1] < s->sine_hi_q30 ||
        knot_q30[s->n_knots - 1] > MODEL_LIMIT)
        return "a system's knots do not cover its angles";
    return NULL;
}

/* Checks the box at one knot: middle, half width, half height. */
static const char *check_box_at_knot(const int32_t box[3])
{
    if (box[1] < 0 || box[2] < 0)
        return "a box has a size below 0";
    /* Differences between neighbours must fit an int32. */
    if (magnitude(box[0]) >= MODEL_LIMIT ||
        magnitude(box[0]) + box[1] > MODEL_LIMIT || box[2] > MODEL_LIMIT)
        return "a box reaches too far";
    return NULL;
}

/* Returns whether the polynomial P of a half size is below 0 at any of a row of
 * angles, at either end of the band. */
static int shrinks_below_0(const int32_t p[GLINT_BOX_TERMS])
{
    const int32_t half = 1 << (BOX_NODES_LOG2 - 1);

    for (int32_t k = -half; k <= half; k++) {
        const int32_t s_q30 = k * (MODEL_LIMIT / half);

        if (box_side(p, s_q30, -MODEL_LIMIT) < 0 ||
            box_side(p, s_q30, MODEL_LIMIT) < 0)
            return 1;
    }
    return 0;
}

/* Does the same for a box of the lens basis, at a grid of directions. */
static int lens_side_below_0(const int32_t p[GLINT_BOX_TERMS])
{
    const int32_t half = 1 << (BOX_NODES_LOG2 - 2), step = MODEL_LIMIT / half;

    for (int32_t k = -half; k <= half; k++)
        for (int32_t m = -half; m <= half; m++)
            if (box_lens_side(p, k * step, m * step, -MODEL_LIMIT) < 0 ||
                box_lens_side(p, k * step, m * step, MODEL_LIMIT) < 0)
                return 1;
    return 0;
}

static const char *check_box(struct glint_model_check *c,
                             const struct glint_model_system *s)
{
    const uint64_t terms = s->n_knots ? s->n_knots : bits_set(s->box_terms);
    const int lens = glint_basis_is_lens(c->header->basis);
    const int sides = lens ? GLINT_LENS_SIDES : 3;
    const int32_t *box;
    int32_t side[GLINT_BOX_TERMS];

    if (s->box_exponent < MIN_EXPONENT || s->box_exponent > MAX_EXPONENT)
        return "the exponent of a box is out of range";
    if (s->n_knots && s->box_terms)
        return "a box at knots has terms";
    box = glint_blob_section(&c->blob, s->box_at, (uint64_t)sides * terms,
                             sizeof *box);
    if (!box)
        return glint_model_outside;
    for (uint32_t k = 0; k < s->n_knots; k++) {
        const char *reason = check_box_at_knot(box + 3 * (size_t)k);

        if (reason)
            return reason;
    }
    for (int k = 0; k < sides && s->n_knots == 0; k++) {
        box = box_unpack(box, s->box_terms, side);
        if (magnitudes(side, GLINT_BOX_TERMS) >= MODEL_LIMIT)
            return "a box reaches too far";
        if ((k == 1 || k == 2) &&
            (lens ? lens_side_below_0(side) : shrinks_below_0(side)))
            return "a box has a size below 0";
    }
    return NULL;
}

/* ------------------------------------------------------------------ outputs */

static const char *check_power(const struct glint_model_output *o,
                               uint16_t power)
{
    const int u = power & 15, v = power >> 4 & 15;
    const int odd =
        o->kind == GLINT_OUT_SENSOR_Y || o->kind == GLINT_OUT_STOP_Y;

    if (u > GLINT_MAX_POWER || v > GLINT_MAX_POWER)
        return "a power of u or v is too high";
    return v % 2 == odd ? NULL : "a power of v has the wrong parity";
}

static const char *check_lens_power(uint16_t power)
{
    const int u = power & 15, v = power >> 4 & 15;
    const int most =
        GLINT_LENS_POWERS * GLINT_LENS_POWERS * GLINT_LENS_WAVE_POWERS;

    if (u > GLINT_MAX_POWER || v > GLINT_MAX_POWER)
        return "a power of u or v is too high";
    return power >> 8 < most ? NULL : "a power of w is too high";
}

static const char *check_terms(struct glint_model_check *c,
                               const struct glint_model_output *o)
{
    const uint16_t *power;

    power = glint_blob_section(&c->blob, o->term_at, (o->n_terms + 1U) / 2,
                               2 * sizeof *power);
    if (!power)
        return glint_model_outside;
    for (uint32_t k = 0; k < o->n_terms; k++) {
        const char *reason =
            c->header->basis == GLINT_BASIS_AUTO    ? check_power(o, power[k])
            : glint_basis_is_lens(c->header->basis) ? check_lens_power(power[k])
                                                    : NULL;

        if (reason)
            return reason;
        for (uint32_t m = 0; m < k; m++) /* An output has few enough terms, 120
                                            at most, to compare all. */
            if (power[m] == power[k])
                return "an output has a term twice";
    }
    return NULL;
}

/* Checks coefficients of two sizes: see n_narrow in struct glint_model_output.
 */
static const char *check_narrow(struct glint_model_check *c,
                                const struct glint_model_output *o)
{
    static const char too_large[] =
        "the coefficients of an output are too large";
    const uint32_t n_narrow = o->n_narrow, shift = o->narrow_shift;
    const uint32_t n_wide = o->n_terms - n_narrow;
    const int32_t *wide;
    const int16_t *narrow;
    int64_t sum;

    if (n_narrow > o->n_terms || shift > MAX_SHIFT)
        return "an output has no such narrow coefficients";
    wide = glint_blob_section(&c->blob, o->coef_at, n_wide + (n_narrow + 1) / 2,
                              sizeof *wide);
    if (!wide)
        return glint_model_outside;
    narrow = (const int16_t *)(const void *)(wide + n_wide);
    sum = magnitudes(wide, n_wide);
    for (uint32_t k = 0; k < n_narrow; k++)
        sum += magnitude(narrow[k]) * (INT64_C(1) << shift);
    return sum < MODEL_LIMIT ? NULL : too_large;
}

static const char *check_coefficients(struct glint_model_check *c,
                                      const struct glint_model_system *s,
                                      const struct glint_model_output *o)
{
    const int32_t *coef;

    if (s->n_knots == 0)
        return check_narrow(c, o);
    if (o->n_narrow || o->narrow_shift)
        return "an output has no such narrow coefficients";
    coef = glint_blob_section(&c->blob, o->coef_at,
                              (uint64_t)s->n_knots * o->n_terms, sizeof *coef);
    if (!coef)
        return glint_model_outside;
    for (uint32_t k = 0; k < s->n_knots; k++, coef += o->n_terms)
        if (magnitudes(coef, o->n_terms) >= MODEL_LIMIT)
            return "the coefficients of an output are too large";
    return NULL;
}

static const char *check_output(struct glint_model_check *c,
                                const struct glint_model_system *s,
                                const struct glint_model_output *o)
{
    const char *reason;

    if ((o->roots || o->head) && (o->kind != GLINT_OUT_ENERGY || s->n_knots ||
                                  o->roots > MAX_ROOTS || o->head > MAX_HEAD))
        return "an output has no such roots or head";
    if (o->n_terms < 1 || o->n_terms > GLINT_MAX_MODEL_TERMS)
        return "an output has no terms or too many";
    if (o->exponent < MIN_EXPONENT || o->exponent > MAX_EXPONENT)
        return "the exponent of an output is out of range";
    if (o->bound >= MODEL_LIMIT)
        return "the bound of an output is too large";
    reason = check_terms(c, o);
    return reason ? reason : check_coefficients(c, s, o);
}

static const char *check_outputs(struct glint_model_check *c,
                                 const struct glint_model_system *s)
{
    const struct glint_model_output *o;

    if (s->n_outputs < NEEDED_KINDS || s->n_outputs > GLINT_OUT_KINDS)
        return "a system has too few outputs or too many";
    o = glint_blob_section(&c->blob, s->output_at, s->n_outputs, sizeof *o);
    if (!o)
        return glint_model_outside;
    for (uint32_t k = 0; k < s->n_outputs; k++) {
        const char *reason;

        if (k < NEEDED_KINDS && o[k].kind != k)
            return "a system lacks an output, or its kinds do not rise";
        if (o[k].kind >= GLINT_OUT_KINDS || (k && o[k].kind <= o[k - 1].kind))
            return "an output's kind is unknown, or kinds do not rise";
        reason = check_output(c, s, &o[k]);
        if (reason)
            return reason;
    }
    return o[GLINT_OUT_SENSOR_X].exponent != o[GLINT_OUT_SENSOR_Y].exponent ||
                   o[GLINT_OUT_STOP_X].exponent != o[GLINT_OUT_STOP_Y].exponent
               ? "x and y of an output differ in exponent"
               : NULL;
}

const char *glint_model_check_system(struct glint_model_check *check,
                                     const struct glint_model_system *s)
{
    const int lens = glint_basis_is_lens(check->header->basis);
    const char *reason;

    if (s->sine_lo_q30 < (lens ? -MODEL_LIMIT : 0) ||
        s->sine_lo_q30 >= s->sine_hi_q30 || s->sine_hi_q30 > MODEL_LIMIT)
        return "a system's angles are out of range";
    if (s->annulus > GLINT_MAX_ANNULUS ||
        (s->annulus && (s->n_knots || lens)) || s->zero)
        return "a system's annulus is out of range";
    if (s->wave_lo_q24 <= 0 || s->wave_lo_q24 > s->wave_hi_q24)
        return "a system's band is out of range";
    reason = check_knots(check, s);
    if (!reason)
        reason = check_box(check, s);
    if (!reason)
        reason = check_outputs(check, s);
    if (!reason && check->blob.referred / MAX_SHARED > check->blob.bytes)
        reason = "systems share too many tables";
    return reason;
}
