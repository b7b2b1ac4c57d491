/* SPDX-License-Identifier: MIT
 *
 * Checks a model file once, so that transfer.c may take it at its word.
 *
 *   in   bytes that may hold anything
 *   out  a lens that points into them, or the reason why not
 *
 * What transfer.c relies on:
 *   - every table lies inside the file;
 *   - variables are within +-2^30 and so are their powers, and q_mul by them
 *     never makes an integer larger. With the sum of |coefficient| of an output
 *     below 2^30 no product, row or Horner step leaves that range, whatever
 *     the order of additions: between two knots a coefficient strays half a
 *     step from the line, 120 of them 60 steps, and int32 has a bit to spare;
 *   - the box of the sparse basis stays within +-2^30, or 1 step more between
 *     two knots: its powers stray 15 steps, and the same bit takes it;
 *   - in the auto basis powers of u and v index a table, and powers of v are
 *     all odd or all even;
 *   - knots rise, and there are none or two. A range may be a single point.
 * Vertices shift by any exponent; the limits here keep sums of exponents small.
 */
#include "glint/lens.h"

#include "base/compiler.h"
#include "base/q.h"
#include "lens/box.h"

/* The file is used in place: its layout is what these structs are. */
STATIC_ASSERT(sizeof(struct glint_real) == 8);
STATIC_ASSERT(sizeof(struct glint_model_header) == 248);
STATIC_ASSERT(sizeof(struct glint_model_ghost) == 16);
STATIC_ASSERT(sizeof(struct glint_model_system) == 40);
STATIC_ASSERT(sizeof(struct glint_model_output) == 32);

enum {
    LIMIT = 1 << 30, /* of sums of magnitudes; also 1 as a q30 */
    MAX_REAL_EXPONENT = 200,
    MAX_SHIFT = 20, /* of narrow coefficients */
    MAX_ROOTS = 2,
    MAX_HEAD = 28,
    MIN_EXPONENT = -80, /* of outputs and boxes */
    MAX_EXPONENT = 40,
    NEEDED_KINDS = GLINT_OUT_ENERGY + 1,
    BOX_NODES_LOG2 = 5, /* angles at which a box is looked at, less one */
    MAX_SHARED = 8 /* times the file: what systems may refer to. Else systems
                      with the same large tables took quadratic time */
};

static const char outside[] = "a table lies outside of the file";

/* ---------------------------------------------------------------------- CRC */

/* Half a byte at a time: 16 words of table. */
static uint32_t crc32_more(uint32_t crc, const unsigned char *byte, size_t n)
{
    static const uint32_t table[16] = {
        0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
        0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
        0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};

    for (size_t i = 0; i < n; i++) {
        crc = crc >> 4 ^ table[(crc ^ byte[i]) & 15];
        crc = crc >> 4 ^ table[(crc ^ byte[i] >> 4) & 15];
    }
    return crc;
}

uint32_t glint_model_crc32(const void *data, size_t bytes)
{
    return ~crc32_more(UINT32_MAX, data, bytes);
}

/* ----------------------------------------------------------------- the whole
 */

struct check {
    const unsigned char *data;
    size_t bytes;
    uint64_t referred; /* bytes of all tables, once for each use */
    const struct glint_model_header *header;
    const struct glint_model_ghost *ghost;
    const struct glint_model_system *system;
};

/* COUNT items of BYTES each lie behind the header and end inside the file.
 * COUNT is below 2^38, so that nothing overflows. */
static int inside(struct check *c, uint32_t at, uint64_t count, size_t bytes)
{
    const uint64_t all = count * bytes;

    c->referred += all;
    return at % 4 == 0 && at >= sizeof *c->header && at <= c->bytes &&
           all <= c->bytes - at;
}

static const void *table(const struct check *c, uint32_t at)
{
    return c->data + at;
}

static const char *check_file(const struct check *c)
{
    const size_t summed_from = offsetof(struct glint_model_header, basis);
    const struct glint_model_header *h = c->header;

    if ((uintptr_t)c->data % sizeof(uint32_t))
        return "the model is not aligned to 4 bytes";
    if (c->bytes < 2 * sizeof(uint32_t) || h->magic != GLINT_MODEL_MAGIC)
        return "this is no glint model";
    if (h->version > GLINT_MODEL_VERSION)
        return "the model was made by a newer glint";
    if (h->version == 0)
        return "no glint ever made models of this version";
    if (h->version < GLINT_MODEL_VERSION)
        return "the model was made by an older glint: bake it again";
    if (c->bytes < sizeof *h || c->bytes < h->bytes)
        return "the model is truncated";
    if (c->bytes > h->bytes)
        return "the model goes on after its end";
    if (glint_model_crc32(&h->basis, c->bytes - summed_from) != h->crc32)
        return "the checksum is wrong: the model is damaged";
    return NULL;
}

static int is_normal(const struct glint_real *x)
{
    const int32_t m = x->mantissa;

    return x->exponent >= -MAX_REAL_EXPONENT &&
           x->exponent <= MAX_REAL_EXPONENT &&
           (m == 0 || m >= LIMIT || (m <= -LIMIT && m != INT32_MIN));
}

/* A name must do no harm on a terminal. */
static const char *check_name(const char *name, size_t size)
{
    size_t n = 0;

    while (n < size && name[n]) {
        const unsigned char c = (unsigned char)name[n++];

        if (c < 0x20 || c == 0x7f)
            return "the name has a control character";
        if (c >= 0x80) /* 0x9b begins a command to a terminal */
            return "the name has a byte beyond ASCII";
    }
    if (n == size)
        return "the name does not end";
    return n ? NULL : "the name is empty";
}

static const char *check_reals(const struct glint_model_header *h)
{
    const struct glint_real *const positive[] = {&h->entrance_radius_mm,
                                                 &h->stop_radius_mm,
                                                 &h->f_number,
                                                 &h->film_width_mm,
                                                 &h->film_height_mm,
                                                 &h->field_mm,
                                                 &h->front_mm};

    if (!is_normal(&h->focal_mm) || !is_normal(&h->back_focal_mm))
        return "a number of the header is not normalised";
    if (h->focal_mm.mantissa == 0)
        return "the focal length is 0";
    for (size_t k = 0; k < sizeof positive / sizeof *positive; k++) {
        if (!is_normal(positive[k]))
            return "a number of the header is not normalised";
        if (positive[k]->mantissa <= 0)
            return "a length or the f-number is not above 0";
    }
    for (size_t k = 0; k < sizeof h->direct_flux / sizeof *h->direct_flux; k++)
        if (!is_normal(&h->direct_flux[k]))
            return "the flux of the direct image is not normalised";
    return NULL;
}

static const char *check_header(struct check *c)
{
    const struct glint_model_header *h = c->header;
    const char *reason = check_name(h->name, sizeof h->name);

    if (h->basis != GLINT_BASIS_AUTO && h->basis != GLINT_BASIS_SPARSE)
        return "the basis is unknown";
    if (!reason)
        reason = check_reals(h);
    if (reason)
        return reason;
    if (h->wave_lo_q24 <= 0 || h->wave_lo_q24 >= h->wave_hi_q24)
        return "the band of wavelengths is empty or not above 0";
    if (h->sine_hi_q30 < 1 || h->sine_hi_q30 > LIMIT)
        return "the largest angle is out of range";
    if (!inside(c, h->ghost_at, h->n_ghosts, sizeof *c->ghost) ||
        !inside(c, h->system_at, h->n_systems, sizeof *c->system))
        return outside;
    c->ghost = table(c, h->ghost_at);
    c->system = table(c, h->system_at);
    return NULL;
}

/* ------------------------------------------------------------------- ghosts */

/* NEXT follows LAST among the systems of one ghost. */
static const char *check_order(const struct glint_model_system *last,
                               const struct glint_model_system *next)
{
    return next->sine_lo_q30 < last->sine_hi_q30 &&
                   next->wave_lo_q24 < last->wave_hi_q24
               ? "a ghost's systems overlap, or do not rise"
               : NULL;
}

/* Lists in the order of the ghosts: that no two share a system then shows in
 * one pass. */
static const char *check_ghosts(const struct check *c)
{
    const struct glint_model_header *h = c->header;
    uint32_t next = 0;

    if (h->n_parts > h->n_ghosts)
        return "there are more parts than ghosts";
    for (uint32_t k = 0; k < h->n_ghosts; k++) {
        const struct glint_model_ghost *g = &c->ghost[k];

        if (g->i >= g->j || g->j >= h->n_surfaces)
            return "a ghost's surfaces are out of range";
        if (g->n_systems == 0)
            continue;
        if (g->first_system >= h->n_systems ||
            g->n_systems > h->n_systems - g->first_system)
            return "a ghost's systems are out of range";
        if (g->first_system < next)
            return "two ghosts share a system, or their lists do not rise";
        next = g->first_system + g->n_systems;
        for (uint32_t m = g->first_system + 1; m < next; m++) {
            const char *reason = check_order(&c->system[m - 1], &c->system[m]);

            if (reason)
                return reason;
        }
    }
    return NULL;
}

/* ------------------------------------------------------------------ systems */

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

static const char *check_knots(struct check *c,
                               const struct glint_model_system *s)
{
    const int32_t *knot_q30;

    if ((c->header->basis == GLINT_BASIS_SPARSE) != (s->n_knots > 0))
        return "knots do not go with the basis";
    if (s->n_knots == 0)
        return NULL;
    if (s->n_knots == 1)
        return "a system has a single knot";
    if (!inside(c, s->knot_at, s->n_knots, sizeof *knot_q30))
        return outside;
    knot_q30 = table(c, s->knot_at);
    for (uint32_t k = 1; k < s->n_knots; k++)
        if (knot_q30[k] <= knot_q30[k - 1])
            return "a system's knots do not rise";
    if (knot_q30[0] < 0 || knot_q30[0] > s->sine_lo_q30 ||
        knot_q30[s->n_knots - 1] < s->sine_hi_q30 ||
        knot_q30[s->n_knots - 1] > LIMIT)
        return "a system's knots do not cover its angles";
    return NULL;
}

/* A box of one corner of the polynomial: middle, half width, half height. */
static const char *check_box_at_knot(const int32_t box[3])
{
    if (box[1] < 0 || box[2] < 0)
        return "a box has a size below 0";
    /* and neighbours' differences stay within an int32 */
    if (magnitude(box[0]) >= LIMIT || magnitude(box[0]) + box[1] > LIMIT ||
        box[2] > LIMIT)
        return "a box reaches too far";
    return NULL;
}

/* Whether the polynomial of a half size is below 0 anywhere on a grid of
 * angles, at either end of the band. */
static int shrinks_below_0(const int32_t p[GLINT_BOX_TERMS])
{
    const int32_t half = 1 << (BOX_NODES_LOG2 - 1);

    for (int32_t k = -half; k <= half; k++) {
        const int32_t s_q30 = k * (LIMIT / half);

        if (box_side(p, s_q30, -LIMIT) < 0 || box_side(p, s_q30, LIMIT) < 0)
            return 1;
    }
    return 0;
}

static const char *check_box(struct check *c,
                             const struct glint_model_system *s)
{
    const uint64_t sides = s->n_knots ? s->n_knots : bits_set(s->box_terms);
    const int32_t *box;
    int32_t side[GLINT_BOX_TERMS];

    if (s->box_exponent < MIN_EXPONENT || s->box_exponent > MAX_EXPONENT)
        return "the exponent of a box is out of range";
    if (s->n_knots && s->box_terms)
        return "a box at knots has terms";
    if (!inside(c, s->box_at, 3 * sides, sizeof *box))
        return outside;
    box = table(c, s->box_at);
    for (uint32_t k = 0; k < s->n_knots; k++) {
        const char *reason = check_box_at_knot(box + 3 * (size_t)k);

        if (reason)
            return reason;
    }
    for (int k = 0; k < 3 && s->n_knots == 0; k++) {
        box = box_unpack(box, s->box_terms, side);
        if (magnitudes(side, GLINT_BOX_TERMS) >= LIMIT)
            return "a box reaches too far";
        if (k > 0 && shrinks_below_0(side))
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

static const char *check_terms(struct check *c,
                               const struct glint_model_output *o)
{
    const uint16_t *power;

    if (!inside(c, o->term_at, (o->n_terms + 1U) / 2, 2 * sizeof *power))
        return outside;
    power = table(c, o->term_at);
    for (uint32_t k = 0; k < o->n_terms; k++) {
        const char *reason = c->header->basis == GLINT_BASIS_AUTO
                                 ? check_power(o, power[k])
                                 : NULL;

        if (reason)
            return reason;
        for (uint32_t m = 0; m < k; m++) /* at most 120 of them */
            if (power[m] == power[k])
                return "an output has a term twice";
    }
    return NULL;
}

/* Coefficients in two sizes: see n_narrow in struct glint_model_output. */
static const char *check_narrow(struct check *c,
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
    if (!inside(c, o->coef_at, n_wide + (n_narrow + 1) / 2, sizeof *wide))
        return outside;
    wide = table(c, o->coef_at);
    narrow = (const int16_t *)(const void *)(wide + n_wide);
    sum = magnitudes(wide, n_wide);
    for (uint32_t k = 0; k < n_narrow; k++)
        sum += magnitude(narrow[k]) * (INT64_C(1) << shift);
    return sum < LIMIT ? NULL : too_large;
}

static const char *check_coefficients(struct check *c,
                                      const struct glint_model_system *s,
                                      const struct glint_model_output *o)
{
    const int32_t *coef;

    if (s->n_knots == 0)
        return check_narrow(c, o);
    if (o->n_narrow || o->narrow_shift)
        return "an output has no such narrow coefficients";
    if (!inside(c, o->coef_at, (uint64_t)s->n_knots * o->n_terms, sizeof *coef))
        return outside;
    coef = table(c, o->coef_at);
    for (uint32_t k = 0; k < s->n_knots; k++, coef += o->n_terms)
        if (magnitudes(coef, o->n_terms) >= LIMIT)
            return "the coefficients of an output are too large";
    return NULL;
}

static const char *check_output(struct check *c,
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
    if (o->bound >= LIMIT)
        return "the bound of an output is too large";
    reason = check_terms(c, o);
    return reason ? reason : check_coefficients(c, s, o);
}

static const char *check_outputs(struct check *c,
                                 const struct glint_model_system *s)
{
    const struct glint_model_output *o;

    if (s->n_outputs < NEEDED_KINDS || s->n_outputs > GLINT_OUT_KINDS)
        return "a system has too few outputs or too many";
    if (!inside(c, s->output_at, s->n_outputs, sizeof *o))
        return outside;
    o = table(c, s->output_at);
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

static const char *check_system(struct check *c,
                                const struct glint_model_system *s)
{
    const char *reason;

    if (s->sine_lo_q30 < 0 || s->sine_lo_q30 >= s->sine_hi_q30 ||
        s->sine_hi_q30 > LIMIT)
        return "a system's angles are out of range";
    if (s->hollow > GLINT_MAX_HOLLOW || (s->hollow && s->n_knots) || s->zero)
        return "a system is hollow in a way that there is not";
    if (s->wave_lo_q24 <= 0 || s->wave_lo_q24 > s->wave_hi_q24)
        return "a system's band is out of range";
    reason = check_knots(c, s);
    if (!reason)
        reason = check_box(c, s);
    if (!reason)
        reason = check_outputs(c, s);
    if (!reason && c->referred / MAX_SHARED > c->bytes)
        reason = "systems share too many tables";
    return reason;
}

/* ------------------------------------------------------------------ opening */

static const char *check_all(struct check *c)
{
    const char *reason = check_file(c);

    if (!reason)
        reason = check_header(c);
    for (uint32_t k = 0; !reason && k < c->header->n_systems; k++)
        reason = check_system(c, &c->system[k]);
    return reason ? reason : check_ghosts(c);
}

enum glint_status glint_lens_open(struct glint_lens *lens, const void *data,
                                  size_t bytes, const char **reason)
{
    struct check c = {.data = data, .bytes = bytes, .header = data};
    const char *wrong = check_all(&c);

    if (wrong) {
        *reason = wrong;
        return GLINT_E_LENS;
    }
    lens->header = c.header;
    lens->ghost = c.ghost;
    lens->system = c.system;
    return GLINT_OK;
}
