/* SPDX-License-Identifier: MIT */
#include "support/model_builder.h"

#include "support/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint32_t model_append_items(struct model_image *m, const void *items,
                            size_t bytes)
{
    const uint32_t at = m->bytes;

    if (at + bytes + 4 > MODEL_ROOM)
        abort();
    memcpy(m->data + at, items, bytes);
    m->bytes += (uint32_t)(bytes + 3) / 4 * 4;
    return at;
}

struct glint_model_header *model_header_of(const struct model_image *m)
{
    return (struct glint_model_header *)(void *)m->data;
}

void model_seal_checksum(struct model_image *m)
{
    struct glint_model_header *h = model_header_of(m);

    h->bytes = m->bytes;
    h->crc32 = glint_model_crc32(m->data + 16, m->bytes - 16);
}

struct glint_real model_real_from_double(double x)
{
    struct glint_real real = {0, 0};
    int exponent;
    const double mantissa = frexp(x, &exponent);

    if (x != 0) {
        real.mantissa = (int32_t)(mantissa * 0x1p31);
        real.exponent = exponent - 31;
    }
    return real;
}

void model_begin_header(struct model_image *m, enum glint_basis basis,
                        const char *name)
{
    struct glint_model_header h = {.magic = GLINT_MODEL_MAGIC,
                                   .version = GLINT_MODEL_VERSION,
                                   .basis = basis};

    h.key[0] = 7;
    strcpy(h.name, name);
    h.focal_mm = model_real_from_double(50);
    h.back_focal_mm = model_real_from_double(37.5);
    h.entrance_radius_mm = model_real_from_double(12.5);
    h.stop_radius_mm = model_real_from_double(8);
    h.f_number = model_real_from_double(2);
    h.film_width_mm = model_real_from_double(36);
    h.film_height_mm = model_real_from_double(24);
    h.field_mm = model_real_from_double(30);
    h.front_mm = model_real_from_double(15);
    h.wave_lo_q24 = MODEL_WAVE_LO_Q24;
    h.wave_hi_q24 = MODEL_WAVE_HI_Q24;
    h.sine_hi_q30 = MODEL_ONE_Q30 / 2;
    h.direct_flux[0] = model_real_from_double(400);
    h.direct_flux[1] = model_real_from_double(-3);
    h.n_surfaces = 4;
    m->data = test_free_later(calloc(1, MODEL_ROOM));
    m->bytes = 0;
    if (!m->data)
        abort();
    model_append_items(m, &h, sizeof h);
}

void model_write_outputs(struct model_image *m, struct glint_model_system *s,
                         const struct model_polynomial *p, uint32_t n,
                         int halved)
{
    struct glint_model_output o[GLINT_OUT_KINDS] = {{0}};

    for (uint32_t k = 0; k < n; k++) {
        int32_t coef[MODEL_TERMS];

        for (uint32_t t = 0; t < p[k].n_terms; t++)
            coef[t] = p[k].coef[t] / (1 << halved);
        o[k].kind = p[k].kind;
        o[k].n_terms = p[k].n_terms;
        o[k].exponent = p[k].exponent;
        o[k].term_at = model_append_items(m, p[k].power, 2 * p[k].n_terms);
        o[k].coef_at = model_append_items(m, coef, 4 * (size_t)p[k].n_terms);
        o[k].bound = 1 << 29;
        o[k].rounding_q8 = 384;
        /* an RMS error of 0.75, or of 0.375 if HALVED is 1 */
        o[k].rms = MODEL_ERROR(1536, 9 - halved);
        o[k].p50 = MODEL_ERROR(1024, 8);
        o[k].p99 = MODEL_ERROR(1024, 10 + halved);
        o[k].max = MODEL_ERROR(1024, 11 + halved);
    }
    s->n_outputs = (uint8_t)n;
    s->output_at = model_append_items(m, o, n * sizeof *o);
}

struct glint_model_system
model_make_auto_system(struct model_image *m, int32_t sine_lo_q30,
                       int32_t sine_hi_q30, int32_t wave_lo_q24,
                       int32_t wave_hi_q24, int halved)
{
    static const struct model_polynomial outputs[] = {
        /* sensor x = 0.25 + 0.5 u - 0.125 v^2 s, mm */
        {GLINT_OUT_SENSOR_X,
         3,
         -28,
         {MODEL_POWER(0, 0, 0, 0), MODEL_POWER(1, 0, 0, 0),
          MODEL_POWER(0, 2, 1, 0)},
         {1 << 26, 1 << 27, -(1 << 25)}},
        /* sensor y = 0.5 v + 0.25 u v, mm */
        {GLINT_OUT_SENSOR_Y,
         2,
         -28,
         {MODEL_POWER(0, 1, 0, 0), MODEL_POWER(1, 1, 0, 0)},
         {1 << 27, 1 << 26}},
        /* stop x = 0.5 u^3 */
        {GLINT_OUT_STOP_X, 1, -29, {MODEL_POWER(3, 0, 0, 0)}, {1 << 28}},
        /* stop y = 0.5 v - 0.125 v^3 */
        {GLINT_OUT_STOP_Y,
         2,
         -29,
         {MODEL_POWER(0, 1, 0, 0), MODEL_POWER(0, 3, 0, 0)},
         {1 << 28, -(1 << 26)}},
        /* energy = 2^-6 (0.5 + 0.25 w) */
        {GLINT_OUT_ENERGY,
         2,
         -35,
         {MODEL_POWER(0, 0, 0, 0), MODEL_POWER(0, 0, 0, 1)},
         {1 << 28, 1 << 27}},
        /* barrel 0 = 0.5 + u^2 / 2 */
        {GLINT_OUT_BARREL_0,
         2,
         -28,
         {MODEL_POWER(0, 0, 0, 0), MODEL_POWER(2, 0, 0, 0)},
         {1 << 27, 1 << 27}},
    };
    static const int32_t box[3][3] = {
        {1 << 20, 1 << 19, 0}, {1 << 22, -(1 << 20), 0}, {3 << 20, 0, 0}};
    struct glint_model_system s = {.sine_lo_q30 = sine_lo_q30,
                                   .sine_hi_q30 = sine_hi_q30,
                                   .wave_lo_q24 = wave_lo_q24,
                                   .wave_hi_q24 = wave_hi_q24,
                                   .box_exponent = -20,
                                   .box_terms = MODEL_BOX_TERMS};

    s.box_at = model_append_items(m, box, sizeof box);
    model_write_outputs(m, &s, outputs, sizeof outputs / sizeof *outputs,
                        halved);
    return s;
}

void model_append_ghosts(struct model_image *m,
                         const struct glint_model_ghost *ghosts,
                         uint32_t n_ghosts,
                         const struct glint_model_system *systems,
                         uint32_t n_systems)
{
    const uint32_t ghost_at =
        model_append_items(m, ghosts, n_ghosts * sizeof *ghosts);
    const uint32_t system_at =
        model_append_items(m, systems, n_systems * sizeof *systems);
    struct glint_model_header *h = model_header_of(m);

    h->n_ghosts = n_ghosts;
    h->ghost_at = ghost_at;
    h->n_systems = n_systems;
    h->system_at = system_at;
    model_seal_checksum(m);
}

struct model_image model_make_three_ghosts(void)
{
    static const struct glint_model_ghost ghosts[] = {
        {0, 1, 0, 2}, {0, 2, 0, 0}, {1, 3, 2, 2}};
    const int32_t lo = MODEL_WAVE_LO_Q24, hi = MODEL_WAVE_HI_Q24;
    const int32_t one = MODEL_ONE_Q30, middle = lo + (hi - lo) / 2;
    struct glint_model_system s[4];
    struct model_image m;

    model_begin_header(&m, GLINT_BASIS_AUTO, "auto");
    s[0] = model_make_auto_system(&m, 0, one / 4, lo, hi, 0);
    s[1] = model_make_auto_system(&m, one / 4, one / 2, lo, hi, 1);
    s[2] = model_make_auto_system(&m, one / 8, one / 2, lo, middle, 0);
    s[3] = model_make_auto_system(&m, one / 8, one / 2, middle, hi, 1);
    model_append_ghosts(&m, ghosts, 3, s, 4);
    return m;
}

struct glint_lens model_open_image(const struct model_image *m)
{
    struct glint_lens lens;
    const char *reason = "";

    if (glint_lens_open(&lens, m->data, m->bytes, &reason) != GLINT_OK) {
        fprintf(stderr, "model_open_image: %s\n", reason);
        abort();
    }
    return lens;
}
