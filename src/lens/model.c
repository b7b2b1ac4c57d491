/* SPDX-License-Identifier: MIT
 *
 * Checks a model file once, so that drawing needs no checks.
 *
 *    in   bytes with any contents
 *    out  a lens that points into them, or an error text
 *
 * Size, checksum and name are checked as in any baked file (base/blob.h).
 * transfer.c relies on these properties:
 *   - every table lies inside the file;
 *   - variables and their powers are within +-2^30, so q_mul by them never
 *     increases a magnitude. The sum of |coefficient| of an output is below
 *     2^30, so no product, row or Horner step exceeds 2^30, whatever the order
 *     of additions;
 *   - in the auto basis powers of u and v index a table, and powers of v are
 *     all odd or all even.
 *
 * The exponents of outputs determine by how many bits values are shifted when
 * they become vertices. The limits in this file keep sums of exponents small.
 */
#include "glint/model.h"

#include "base/blob.h"
#include "base/compiler.h"
#include "base/q.h"
#include "lens/box.h"

/* The file is used in place: its layout is the layout of these structs. */
STATIC_ASSERT(sizeof(struct glint_real) == 8);
STATIC_ASSERT(sizeof(struct glint_model_header) == 344);
STATIC_ASSERT(sizeof(struct glint_model_ghost) == 16);
STATIC_ASSERT(sizeof(struct glint_model_system) == 40);
STATIC_ASSERT(sizeof(struct glint_model_output) == 32);

/* The header begins with the members of every baked file's header. The member
 * basis corresponds to their member variant. */
GLINT_BLOB_HEADER(struct glint_model_header, basis);

enum {
    /* 1 in _q30; also the limit of the sum of magnitudes of an output's
     * coefficients. */
    LIMIT = 1 << 30,
    MAX_REAL_EXPONENT = 200,
    /* max number of bits by which narrow (16-bit) coefficients are shifted */
    MAX_SHIFT = 20,
    MAX_ROOTS = 2,
    MAX_HEAD = 28,
    /* range of the binary exponents of outputs and boxes */
    MIN_EXPONENT = -80,
    MAX_EXPONENT = 40,
    NEEDED_KINDS = GLINT_OUT_ENERGY + 1,
    /* Log2 of the number of intervals of angle at whose ends the half sizes of
     * a box are checked not to be negative. */
    BOX_NODES_LOG2 = 5,
    /* Max total size of the tables of all systems, as a multiple of the file
     * size. Systems may share tables. Without a limit, many systems that share
     * large tables would take quadratic time to check. */
    MAX_SHARED = 8
};

static const char outside[] = "damaged model: a table lies outside the file";

struct check {
    struct glint_blob blob;
    const struct glint_model_header *header;
    const struct glint_model_ghost *ghost;
    const struct glint_model_system *system;
};

uint32_t glint_model_crc32(const void *data, size_t bytes)
{
    return glint_blob_compute_crc32(data, bytes);
}

/* ------------------------------------------------------------------ header */

static const char *const fault_text[GLINT_BLOB_FAULTS] = {
    [GLINT_BLOB_UNALIGNED] =
        "the model's address in memory is not a multiple of 4 bytes",
    [GLINT_BLOB_FOREIGN] = "this is not a glint model",
    [GLINT_BLOB_NEWER] = "the model was made by a newer glint",
    [GLINT_BLOB_NO_VERSION] =
        "this is not a glint model, or its version is damaged",
    [GLINT_BLOB_OLDER] = "the model was made by an older glint: bake it again",
    [GLINT_BLOB_TRUNCATED] = "the model is truncated",
    [GLINT_BLOB_LONGER] = "the model file is longer than its header says",
    [GLINT_BLOB_DAMAGED] = "the checksum is wrong: the model is damaged",
    [GLINT_BLOB_NAME_CONTROL] =
        "damaged model: its name has a control character",
    [GLINT_BLOB_NAME_FOREIGN] =
        "damaged model: its name has a byte outside ASCII",
    [GLINT_BLOB_NAME_ENDLESS] =
        "damaged model: its name is not zero-terminated",
    [GLINT_BLOB_NAME_EMPTY] = "damaged model: its name is empty"};

static int is_real_normalised(const struct glint_real *x)
{
    const int32_t m = x->mantissa;

    return x->exponent >= -MAX_REAL_EXPONENT &&
           x->exponent <= MAX_REAL_EXPONENT &&
           (m == 0 || m >= LIMIT || (m <= -LIMIT && m != INT32_MIN));
}

static const char *check_header_reals(const struct glint_model_header *h)
{
    const struct glint_real *const positive[] = {&h->entrance_radius_mm,
                                                 &h->stop_radius_mm,
                                                 &h->f_number,
                                                 &h->film_width_mm,
                                                 &h->film_height_mm,
                                                 &h->field_mm,
                                                 &h->front_mm};

    if (!is_real_normalised(&h->focal_mm) ||
        !is_real_normalised(&h->back_focal_mm))
        return "damaged model: a number of the header is not normalised";
    if (h->focal_mm.mantissa == 0)
        return "damaged model: the focal length is 0";
    for (size_t k = 0; k < sizeof positive / sizeof *positive; k++) {
        if (!is_real_normalised(positive[k]))
            return "damaged model: a number of the header is not normalised";
        if (positive[k]->mantissa <= 0)
            return "damaged model: a length or the f-number is not above 0";
    }
    for (int k = 0; k < GLINT_FLUX_TERMS; k++)
        if (!is_real_normalised(&h->direct_flux[k]) ||
            !is_real_normalised(&h->stopped_flux[0][k]) ||
            !is_real_normalised(&h->stopped_flux[1][k]))
            return "damaged model: the flux of the direct image is not "
                   "normalised";
    return NULL;
}

static const char *check_model_header(struct check *c)
{
    const struct glint_model_header *h = c->header;
    const char *reason = fault_text[glint_blob_check_name(&c->blob)];

    if (h->basis != GLINT_BASIS_AUTO && !glint_basis_is_lens(h->basis))
        return "damaged model: the basis is unknown";
    if (!reason)
        reason = check_header_reals(h);
    if (reason)
        return reason;
    if (h->wave_lo_q24 <= 0 || h->wave_lo_q24 >= h->wave_hi_q24)
        return "damaged model: the band of wavelengths is empty or not above 0";
    if (h->sine_hi_q30 < 1 || h->sine_hi_q30 > LIMIT)
        return "damaged model: the largest angle is out of range";
    c->ghost = glint_blob_find_section(&c->blob, h->ghost_at, h->n_ghosts,
                                       sizeof *c->ghost);
    c->system = glint_blob_find_section(&c->blob, h->system_at, h->n_systems,
                                        sizeof *c->system);
    return c->ghost && c->system ? NULL : outside;
}

/* ---------------------------------------------------------- angles and box */

static int64_t get_magnitude(int32_t x)
{
    return x < 0 ? -(int64_t)x : x;
}

static int64_t sum_magnitudes(const int32_t *x, uint32_t n)
{
    int64_t sum = 0;

    for (uint32_t k = 0; k < n; k++)
        sum += get_magnitude(x[k]);
    return sum;
}

static const char *check_direction_range(struct check *c,
                                         const struct glint_model_system *s)
{
    const int32_t *y_q30 =
        glint_blob_find_section(&c->blob, s->across_at, 2, sizeof *y_q30);

    if (!y_q30)
        return outside;
    return y_q30[0] < -LIMIT || y_q30[0] >= y_q30[1] || y_q30[1] > LIMIT
               ? "damaged model: a system's angles are out of range"
               : NULL;
}

/* Returns whether P, the polynomial of a box's half size, is negative at any of
 * a series of angles, at either end of the wavelength band. */
static int has_negative_size(const int32_t p[GLINT_BOX_TERMS])
{
    const int32_t half = 1 << (BOX_NODES_LOG2 - 1);

    for (int32_t k = -half; k <= half; k++) {
        const int32_t s_q30 = k * (LIMIT / half);

        if (evaluate_box_polynomial(p, s_q30, -LIMIT) < 0 ||
            evaluate_box_polynomial(p, s_q30, LIMIT) < 0)
            return 1;
    }
    return 0;
}

/* Returns whether P, the polynomial of a box's half size in the lens basis, is
 * negative at any of a grid of directions, at either end of the wavelength
 * band. */
static int has_negative_lens_size(const int32_t p[GLINT_BOX_TERMS])
{
    const int32_t half = 1 << (BOX_NODES_LOG2 - 2), step = LIMIT / half;

    for (int32_t k = -half; k <= half; k++)
        for (int32_t m = -half; m <= half; m++)
            if (evaluate_lens_box_polynomial(p, k * step, m * step, -LIMIT) <
                    0 ||
                evaluate_lens_box_polynomial(p, k * step, m * step, LIMIT) < 0)
                return 1;
    return 0;
}

static const char *check_system_box(struct check *c,
                                    const struct glint_model_system *s)
{
    const uint64_t terms = count_set_bits(s->box_terms);
    const int lens = glint_basis_is_lens(c->header->basis);
    const int sides = lens ? GLINT_LENS_SIDES : 3;
    const int32_t *box;
    int32_t side[GLINT_BOX_TERMS];

    if (s->box_exponent < MIN_EXPONENT || s->box_exponent > MAX_EXPONENT)
        return "damaged model: the exponent of a box is out of range";
    box = glint_blob_find_section(&c->blob, s->box_at, (uint64_t)sides * terms,
                                  sizeof *box);
    if (!box)
        return outside;
    for (int k = 0; k < sides; k++) {
        box = unpack_box_polynomial(box, s->box_terms, side);
        if (sum_magnitudes(side, GLINT_BOX_TERMS) >= LIMIT)
            return "damaged model: the terms of a box are too large";
        if ((k == 1 || k == 2) &&
            (lens ? has_negative_lens_size(side) : has_negative_size(side)))
            return "damaged model: a box has a negative size";
    }
    return NULL;
}

/* ------------------------------------------------------------------ outputs */

static const char *check_auto_power(const struct glint_model_output *o,
                                    uint16_t power)
{
    const int u = power & 15, v = power >> 4 & 15;
    const int odd =
        o->kind == GLINT_OUT_SENSOR_Y || o->kind == GLINT_OUT_STOP_Y;

    if (u > GLINT_MAX_POWER || v > GLINT_MAX_POWER)
        return "damaged model: a power of u or v is too high";
    return v % 2 == odd ? NULL
                        : "damaged model: a power of v has the wrong parity";
}

static const char *check_lens_power(uint16_t power)
{
    const int u = power & 15, v = power >> 4 & 15;
    const int most =
        GLINT_LENS_POWERS * GLINT_LENS_POWERS * GLINT_LENS_WAVE_POWERS;

    if (u > GLINT_MAX_POWER || v > GLINT_MAX_POWER)
        return "damaged model: a power of u or v is too high";
    return power >> 8 < most ? NULL : "damaged model: a power of w is too high";
}

static const char *check_output_terms(struct check *c,
                                      const struct glint_model_output *o)
{
    const uint16_t *power;

    power = glint_blob_find_section(&c->blob, o->term_at, (o->n_terms + 1U) / 2,
                                    2 * sizeof *power);
    if (!power)
        return outside;
    for (uint32_t k = 0; k < o->n_terms; k++) {
        const char *reason = glint_basis_is_lens(c->header->basis)
                                 ? check_lens_power(power[k])
                                 : check_auto_power(o, power[k]);

        if (reason)
            return reason;
        /* an output has at most 120 terms, few enough to compare all pairs */
        for (uint32_t m = 0; m < k; m++)
            if (power[m] == power[k])
                return "damaged model: an output has a term twice";
    }
    return NULL;
}

/* Checks the coefficients of an output, which are stored as int32 and int16;
 * see n_narrow in struct glint_model_output. */
static const char *check_output_coefficients(struct check *c,
                                             const struct glint_model_output *o)
{
    static const char too_large[] =
        "damaged model: the coefficients of an output are too large";
    const uint32_t n_narrow = o->n_narrow, shift = o->narrow_shift;
    const uint32_t n_wide = o->n_terms - n_narrow;
    const int32_t *wide;
    const int16_t *narrow;
    int64_t sum;

    if (n_narrow > o->n_terms || shift > MAX_SHIFT)
        return "damaged model: an output's 16-bit coefficients are out of "
               "range";
    wide = glint_blob_find_section(&c->blob, o->coef_at,
                                   n_wide + (n_narrow + 1) / 2, sizeof *wide);
    if (!wide)
        return outside;
    narrow = (const int16_t *)(const void *)(wide + n_wide);
    sum = sum_magnitudes(wide, n_wide);
    for (uint32_t k = 0; k < n_narrow; k++)
        sum += get_magnitude(narrow[k]) * (INT64_C(1) << shift);
    return sum < LIMIT ? NULL : too_large;
}

static const char *check_system_output(struct check *c,
                                       const struct glint_model_output *o)
{
    const char *reason;

    if ((o->roots || o->head) && (o->kind != GLINT_OUT_ENERGY ||
                                  o->roots > MAX_ROOTS || o->head > MAX_HEAD))
        return "damaged model: an output's roots or head are out of range";
    if (o->n_terms < 1 || o->n_terms > GLINT_MAX_MODEL_TERMS)
        return "damaged model: an output has no terms or too many";
    if (o->exponent < MIN_EXPONENT || o->exponent > MAX_EXPONENT)
        return "damaged model: the exponent of an output is out of range";
    if (o->bound >= LIMIT)
        return "damaged model: the bound of an output is too large";
    reason = check_output_terms(c, o);
    return reason ? reason : check_output_coefficients(c, o);
}

static const char *check_system_outputs(struct check *c,
                                        const struct glint_model_system *s)
{
    const struct glint_model_output *o;

    if (s->n_outputs < NEEDED_KINDS || s->n_outputs > GLINT_OUT_KINDS)
        return "damaged model: a system has too few outputs or too many";
    o = glint_blob_find_section(&c->blob, s->output_at, s->n_outputs,
                                sizeof *o);
    if (!o)
        return outside;
    for (uint32_t k = 0; k < s->n_outputs; k++) {
        const char *reason;

        if (k < NEEDED_KINDS && o[k].kind != k)
            return "damaged model: a system lacks an output, or outputs are "
                   "unsorted";
        if (o[k].kind >= GLINT_OUT_KINDS || (k && o[k].kind <= o[k - 1].kind))
            return "damaged model: an output's kind is unknown, or outputs are "
                   "unsorted";
        reason = check_system_output(c, &o[k]);
        if (reason)
            return reason;
    }
    return o[GLINT_OUT_SENSOR_X].exponent != o[GLINT_OUT_SENSOR_Y].exponent ||
                   o[GLINT_OUT_STOP_X].exponent != o[GLINT_OUT_STOP_Y].exponent
               ? "damaged model: x and y of a position have different exponents"
               : NULL;
}

static const char *check_ghost_system(struct check *check,
                                      const struct glint_model_system *s)
{
    const int lens = glint_basis_is_lens(check->header->basis);
    const char *reason;

    if (s->sine_lo_q30 < (lens ? -LIMIT : 0) ||
        s->sine_lo_q30 >= s->sine_hi_q30 || s->sine_hi_q30 > LIMIT)
        return "damaged model: a system's angles are out of range";
    if (s->annulus > GLINT_MAX_ANNULUS || (s->annulus && lens) || s->zero ||
        s->zero_word)
        return "damaged model: a system's annulus is out of range";
    if (s->wave_lo_q24 <= 0 || s->wave_lo_q24 > s->wave_hi_q24)
        return "damaged model: a system's band is out of range";
    reason = lens ? check_direction_range(check, s) : NULL;
    if (!reason)
        reason = check_system_box(check, s);
    if (!reason)
        reason = check_system_outputs(check, s);
    if (!reason && check->blob.referred / MAX_SHARED > check->blob.bytes)
        reason = "damaged model: systems share too many tables";
    return reason;
}

/* ------------------------------------------------------------------- ghosts */

/* Checks that system NEXT may follow system LAST in the list of one ghost: NEXT
 * must begin at or after the end of LAST, in angle or in wavelength. */
static const char *check_system_order(const struct glint_model_system *last,
                                      const struct glint_model_system *next)
{
    return next->sine_lo_q30 < last->sine_hi_q30 &&
                   next->wave_lo_q24 < last->wave_hi_q24
               ? "damaged model: a ghost's systems overlap or are unsorted"
               : NULL;
}

/* Checks all ghosts. Each ghost's list of systems must begin after the list of
 * the previous ghost. One pass then shows that no two ghosts share a system. */
static const char *check_ghost_lists(const struct check *c)
{
    const struct glint_model_header *h = c->header;
    uint32_t next = 0;

    if (h->n_parts > h->n_ghosts)
        return "damaged model: there are more additional pupil regions than "
               "ghosts";
    for (uint32_t k = 0; k < h->n_ghosts; k++) {
        const struct glint_model_ghost *g = &c->ghost[k];

        if (g->i >= g->j || g->j >= h->n_surfaces)
            return "damaged model: a ghost's surfaces are out of range";
        if (g->n_systems == 0)
            continue;
        if (g->first_system >= h->n_systems ||
            g->n_systems > h->n_systems - g->first_system)
            return "damaged model: a ghost's systems are out of range";
        if (g->first_system < next)
            return "damaged model: two ghosts share a system, or systems are "
                   "unsorted";
        next = g->first_system + g->n_systems;
        /* Directions in the lens basis have two components and no order, so
         * overlaps are allowed. Where two systems overlap, the run time uses
         * the first one. */
        for (uint32_t m = g->first_system + 1;
             m < next && !glint_basis_is_lens(h->basis); m++) {
            const char *reason =
                check_system_order(&c->system[m - 1], &c->system[m]);

            if (reason)
                return reason;
        }
    }
    return NULL;
}

/* ------------------------------------------------------------------ opening */

/* Returns the text of the first error in the header or in any table to which it
 * points, or NULL. */
static const char *check_model_contents(struct check *c)
{
    const char *reason = check_model_header(c);

    for (uint32_t k = 0; !reason && k < c->header->n_systems; k++)
        reason = check_ghost_system(c, &c->system[k]);
    return reason ? reason : check_ghost_lists(c);
}

enum glint_status glint_lens_open(struct glint_lens *lens, const void *data,
                                  size_t bytes, const char **reason)
{
    static const struct glint_blob_kind model = {
        GLINT_MODEL_MAGIC, GLINT_MODEL_VERSION,
        sizeof(struct glint_model_header)};
    struct check c = {.header = data};
    const char *wrong =
        fault_text[glint_blob_open(&c.blob, &model, data, bytes)];

    if (!wrong)
        wrong = check_model_contents(&c);
    if (wrong) {
        *reason = wrong;
        return GLINT_E_LENS;
    }
    lens->header = c.header;
    lens->ghost = c.ghost;
    lens->system = c.system;
    lens->zoom = NULL;
    return GLINT_OK;
}
