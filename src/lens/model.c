/* SPDX-License-Identifier: MIT
 *
 * Checks a model file once, so that the transfer need not check anything.
 *
 *   in   bytes that may hold anything
 *   out  a lens that points into them, or the reason why not
 *
 * Size, checksum and name are those of any baked file (base/blob.h); systems
 * are checked in model_system.c. The transfer relies on this:
 *   - every table lies inside the file;
 *   - variables are within +-2^30 and so are their powers, and q_mul by them
 *     never makes an integer larger. With the sum of |coefficient| of an output
 *     below 2^30 no product, row or Horner step leaves that range, whatever
 *     the order of additions: between two knots a coefficient is off the line
 *     by half a unit, 120 of them by 60 units, and int32 has a bit to spare;
 *   - the box of the sparse basis stays within +-2^30, or 1 unit more between
 *     two knots: its powers are off by 15 units, and the same bit takes it;
 *   - in the auto basis powers of u and v index a table, and powers of v are
 *     all odd or all even;
 *   - knots rise, and there are none, or two and more. A range may be a single
 *     point.
 * Vertices shift by any exponent; the limits here keep sums of exponents small.
 */
#include "lens/model_check.h"

#include "base/compiler.h"

/* The file is used in place: its layout is what these structs are. */
STATIC_ASSERT(sizeof(struct glint_real) == 8);
STATIC_ASSERT(sizeof(struct glint_model_header) == 344);
STATIC_ASSERT(sizeof(struct glint_model_ghost) == 16);
STATIC_ASSERT(sizeof(struct glint_model_system) == 40);
STATIC_ASSERT(sizeof(struct glint_model_output) == 32);

/* The header begins as that of every baked file does; its basis is the variant.
 */
GLINT_BLOB_HEADER(struct glint_model_header, basis);

enum { MAX_REAL_EXPONENT = 200 };

const char glint_model_outside[] = "a table lies outside of the file";

uint32_t glint_model_crc32(const void *data, size_t bytes)
{
    return glint_blob_crc32(data, bytes);
}

/* --------------------------------------------------------------- the whole */

static const char *const fault_text[GLINT_BLOB_FAULTS] = {
    [GLINT_BLOB_UNALIGNED] = "the model is not aligned to 4 bytes",
    [GLINT_BLOB_FOREIGN] = "this is no glint model",
    [GLINT_BLOB_NEWER] = "the model was made by a newer glint",
    [GLINT_BLOB_NO_VERSION] = "no glint ever made models of this version",
    [GLINT_BLOB_OLDER] = "the model was made by an older glint: bake it again",
    [GLINT_BLOB_TRUNCATED] = "the model is truncated",
    [GLINT_BLOB_LONGER] = "the model goes on after its end",
    [GLINT_BLOB_DAMAGED] = "the checksum is wrong: the model is damaged",
    [GLINT_BLOB_NAME_CONTROL] = "the name has a control character",
    [GLINT_BLOB_NAME_FOREIGN] = "the name has a byte beyond ASCII",
    [GLINT_BLOB_NAME_ENDLESS] = "the name does not end",
    [GLINT_BLOB_NAME_EMPTY] = "the name is empty"};

static int is_normal(const struct glint_real *x)
{
    const int32_t m = x->mantissa;

    return x->exponent >= -MAX_REAL_EXPONENT &&
           x->exponent <= MAX_REAL_EXPONENT &&
           (m == 0 || m >= MODEL_LIMIT ||
            (m <= -MODEL_LIMIT && m != INT32_MIN));
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
    for (int k = 0; k < GLINT_FLUX_TERMS; k++)
        if (!is_normal(&h->direct_flux[k]) ||
            !is_normal(&h->stopped_flux[0][k]) ||
            !is_normal(&h->stopped_flux[1][k]))
            return "the flux of the direct image is not normalised";
    return NULL;
}

static const char *check_header(struct glint_model_check *c)
{
    const struct glint_model_header *h = c->header;
    const char *reason = fault_text[glint_blob_check_name(&c->blob)];

    if (h->basis != GLINT_BASIS_AUTO && h->basis != GLINT_BASIS_SPARSE &&
        !glint_basis_is_lens(h->basis))
        return "the basis is unknown";
    if (!reason)
        reason = check_reals(h);
    if (reason)
        return reason;
    if (h->wave_lo_q24 <= 0 || h->wave_lo_q24 >= h->wave_hi_q24)
        return "the band of wavelengths is empty or not above 0";
    if (h->sine_hi_q30 < 1 || h->sine_hi_q30 > MODEL_LIMIT)
        return "the largest angle is out of range";
    c->ghost = glint_blob_section(&c->blob, h->ghost_at, h->n_ghosts,
                                  sizeof *c->ghost);
    c->system = glint_blob_section(&c->blob, h->system_at, h->n_systems,
                                   sizeof *c->system);
    return c->ghost && c->system ? NULL : glint_model_outside;
}

/* ------------------------------------------------------------------- ghosts */

/* Checks that NEXT may follow LAST among the systems of one ghost. */
static const char *check_order(const struct glint_model_system *last,
                               const struct glint_model_system *next)
{
    return next->sine_lo_q30 < last->sine_hi_q30 &&
                   next->wave_lo_q24 < last->wave_hi_q24
               ? "a ghost's systems overlap, or do not rise"
               : NULL;
}

/* Checks the ghosts. Their lists of systems must rise with the ghosts, so that
 * one pass shows that no two share a system. */
static const char *check_ghosts(const struct glint_model_check *c)
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
        /* In the lens basis ranges of two components lie in no order; of two
         * systems that overlap the first one counts. */
        for (uint32_t m = g->first_system + 1;
             m < next && !glint_basis_is_lens(h->basis); m++) {
            const char *reason = check_order(&c->system[m - 1], &c->system[m]);

            if (reason)
                return reason;
        }
    }
    return NULL;
}

/* ------------------------------------------------------------------ opening */

/* Returns a text that says what is wrong with the header or with anything that
 * it points to, or NULL. */
static const char *check_contents(struct glint_model_check *c)
{
    const char *reason = check_header(c);

    for (uint32_t k = 0; !reason && k < c->header->n_systems; k++)
        reason = glint_model_check_system(c, &c->system[k]);
    return reason ? reason : check_ghosts(c);
}

enum glint_status glint_lens_open(struct glint_lens *lens, const void *data,
                                  size_t bytes, const char **reason)
{
    static const struct glint_blob_kind model = {
        GLINT_MODEL_MAGIC, GLINT_MODEL_VERSION,
        sizeof(struct glint_model_header)};
    struct glint_model_check c = {.header = data};
    const char *wrong =
        fault_text[glint_blob_open(&c.blob, &model, data, bytes)];

    if (!wrong)
        wrong = check_contents(&c);
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
