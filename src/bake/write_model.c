/* SPDX-License-Identifier: MIT */
#include "bake/write_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/blob.h"
#include "base/compiler.h"
#include "glint/bake.h"

STATIC_ASSERT(sizeof(struct glint_model_ghost) == 16);
STATIC_ASSERT(sizeof(struct glint_model_system) == 40);
STATIC_ASSERT(sizeof(struct glint_model_output) == 32);
STATIC_ASSERT(sizeof(struct glint_model_note) == 220);

static uint32_t append_output_terms(struct glint_draft *d,
                                    const struct glint_fitted_output *o,
                                    const struct glint_quantised_output *q,
                                    bool skew)
{
    uint16_t power[GLINT_MAX_MODEL_TERMS];

    for (int k = 0; k < o->n_terms; k++) {
        const uint8_t *p = o->power[q->order[k]];

        const int upper =
            skew
                ? p[GLINT_S] + GLINT_LENS_POWERS *
                                   (p[GLINT_P] + GLINT_LENS_POWERS * p[GLINT_W])
                : p[GLINT_S] | p[GLINT_W] << 4;

        power[k] = (uint16_t)(p[GLINT_U] | p[GLINT_V] << 4 | upper << 8);
    }
    return glint_draft_append(d, power, (size_t)o->n_terms * sizeof *power);
}

/* Appends the coefficients of an output, the 32-bit ones before the 16-bit
 * ones. */
static uint32_t
append_output_coefficients(struct glint_draft *d,
                           const struct glint_fitted_output *o,
                           const struct glint_quantised_output *q)
{
    const int n_wide = o->n_terms - q->n_narrow;
    int32_t wide[GLINT_MAX_MODEL_TERMS];
    int16_t narrow[GLINT_MAX_MODEL_TERMS];
    uint32_t where;

    for (int k = 0; k < o->n_terms; k++) {
        const int32_t coef = q->coef[q->order[k]];

        if (k < n_wide)
            wide[k] = coef;
        else
            narrow[k - n_wide] = (int16_t)(coef / (INT32_C(1) << q->shift));
    }
    where = glint_draft_append(d, wide, (size_t)n_wide * sizeof *wide);
    glint_draft_append(d, narrow, (size_t)q->n_narrow * sizeof *narrow);
    return where;
}

static struct glint_model_output
append_model_output(struct glint_draft *d, const struct glint_fitted_output *o,
                    const struct glint_quantised_output *q, bool skew)
{
    const uint32_t term_at = append_output_terms(d, o, q, skew);
    const uint32_t coef_at = append_output_coefficients(d, o, q);

    return (struct glint_model_output){
        .kind = (uint8_t)o->kind,
        .n_terms = (uint8_t)o->n_terms,
        .n_narrow = (uint8_t)q->n_narrow,
        .narrow_shift = (uint8_t)(q->n_narrow ? q->shift : 0),
        .head = (uint8_t)q->head,
        .roots = (uint8_t)o->roots,
        .exponent = (int16_t)q->exponent,
        .term_at = term_at,
        .coef_at = coef_at,
        .bound = q->bound,
        .rounding_q8 = q->rounding_q8};
}

static uint32_t append_system_outputs(struct glint_draft *d,
                                      const struct glint_fitted_system *f,
                                      const struct glint_quantised_system *q)
{
    struct glint_model_output out[GLINT_OUT_KINDS];

    for (int k = 0; k < f->n_outputs; k++)
        out[k] = append_model_output(d, &f->output[k], &q->output[k], f->skew);
    return glint_draft_append(d, out, (size_t)f->n_outputs * sizeof *out);
}

static int32_t round_to_q30(double x)
{
    return (int32_t)lrint(x * 0x1p30);
}

/* Appends the polynomials of a system's box. Terms whose coefficient is 0 in
 * all of its polynomials are omitted; bit k of TERMS is set if term k is
 * stored. */
static uint32_t append_system_box(struct glint_draft *d,
                                  const struct glint_quantised_system *q,
                                  uint8_t *terms)
{
    int32_t packed[GLINT_LENS_SIDES * GLINT_BOX_TERMS];
    size_t n = 0;

    *terms = 0;
    for (int k = 0; k < q->n_box; k++)
        if (q->box[k])
            *terms |= (uint8_t)(1 << k % GLINT_BOX_TERMS);
    for (int k = 0; k < q->n_box; k++)
        if (*terms >> k % GLINT_BOX_TERMS & 1)
            packed[n++] = q->box[k];
    return glint_draft_append(d, packed, n * sizeof *packed);
}

static void write_model_system(struct glint_draft *d, uint32_t where,
                               const struct glint_fitted_system *f,
                               const struct glint_quantised_system *q)
{
    /* The order of these calls determines the layout of the file. */
    const int32_t range_q30[2] = {round_to_q30(f->y_lo), round_to_q30(f->y_hi)};
    const uint32_t across_at =
        f->skew ? glint_draft_append(d, range_q30, sizeof range_q30)
                : (uint32_t)d->bytes;
    uint8_t box_terms;
    const uint32_t box_at = append_system_box(d, q, &box_terms);
    const uint32_t output_at = append_system_outputs(d, f, q);
    const struct glint_model_system system = {
        .sine_lo_q30 = round_to_q30(f->sine_lo),
        .sine_hi_q30 = round_to_q30(f->sine_hi),
        .wave_lo_q24 = (int32_t)lrint(f->wave_lo * 0x1p24),
        .wave_hi_q24 = (int32_t)lrint(f->wave_hi * 0x1p24),
        .across_at = across_at,
        .box_at = box_at,
        .box_exponent = q->box_exponent,
        .output_at = output_at,
        .n_outputs = (uint8_t)f->n_outputs,
        .box_terms = box_terms,
        .annulus = (uint8_t)f->annulus};

    glint_draft_overwrite(d, where, &system, sizeof system);
}

enum glint_status
glint_draft_write_model(struct glint_draft *draft,
                        const struct glint_setup *setup,
                        const struct glint_model_header *header,
                        const struct glint_fitted_ghost *fitted,
                        struct glint_quantised_system *const *quantised)
{
    struct glint_model_header h = *header;
    uint32_t n = 0;

    *draft = (struct glint_draft){0};
    glint_draft_append(draft, NULL, sizeof h);
    h.n_ghosts = (uint32_t)setup->n_ghosts;
    h.n_parts = (uint32_t)setup->n_parts;
    h.ghost_at = (uint32_t)draft->bytes;
    for (int k = 0; k < setup->n_ghosts; k++) {
        const struct glint_model_ghost ghost = {(uint32_t)setup->ghost[k].i,
                                                (uint32_t)setup->ghost[k].j, n,
                                                (uint32_t)fitted[k].n_systems};

        glint_draft_append(draft, &ghost, sizeof ghost);
        n += ghost.n_systems;
    }
    h.n_systems = n;
    h.system_at =
        glint_draft_append(draft, NULL, n * sizeof(struct glint_model_system));
    n = 0;
    for (int k = 0; k < setup->n_ghosts; k++)
        for (int m = 0; m < fitted[k].n_systems; m++, n++)
            write_model_system(
                draft,
                h.system_at + n * (uint32_t)sizeof(struct glint_model_system),
                &fitted[k].system[m], &quantised[k][m]);
    glint_draft_overwrite(draft, 0, &h, sizeof h);
    return draft->out_of_memory ? GLINT_E_MEMORY : GLINT_OK;
}

struct glint_lens glint_draft_get_lens(const struct glint_draft *draft)
{
    const struct glint_model_header *h = (const void *)draft->data;

    return (struct glint_lens){h, (const void *)(draft->data + h->ghost_at),
                               (const void *)(draft->data + h->system_at),
                               NULL};
}

/* Encodes error X, rounded up, as glint_model_error_q20() decodes it. */
static uint16_t encode_rounded_error(double x)
{
    double mantissa = ceil(x * 0x1p20);
    int shift = 0;

    while (mantissa > 2047 && shift < 31)
        mantissa = ceil(x * ldexp(0x1p20, -++shift));
    return (uint16_t)(shift << 11 | (int)fmin(mantissa, 2047));
}

void glint_draft_write_errors(struct glint_draft *draft, int system,
                              const struct glint_measured *measured)
{
    const struct glint_lens lens = glint_draft_get_lens(draft);
    const struct glint_model_system *s = &lens.system[system];
    struct glint_model_output *o = (void *)(draft->data + s->output_at);

    for (uint32_t k = 0; k < s->n_outputs; k++, o++) {
        const struct glint_errors *e = &measured->of[o->kind];

        o->rms = encode_rounded_error(e->rms);
        o->p50 = encode_rounded_error(e->p50);
        o->p99 = encode_rounded_error(e->p99);
        o->max = encode_rounded_error(e->max);
    }
}

enum glint_status glint_bake_add_note(const struct glint_model_note *note,
                                      unsigned char **model, size_t *bytes)
{
    const size_t n = *bytes + sizeof *note;
    unsigned char *const file = realloc(*model, n);

    if (!file)
        return GLINT_E_MEMORY;
    memcpy(file + *bytes, note, sizeof *note);
    glint_blob_set_size_and_checksum(file, n);
    *model = file;
    *bytes = n;
    return GLINT_OK;
}
