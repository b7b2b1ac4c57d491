/* SPDX-License-Identifier: MIT
 *
 * Builds small models in memory, whose polynomials can be evaluated by hand.
 *
 *     struct model_image m = model_make_three_ghosts();
 *     glint_lens_open(&lens, m.data, m.bytes, &reason);
 *
 * Tables are written one after the other, and none is shared. After a change,
 * model_seal_checksum() updates size and checksum.
 */
#ifndef GLINT_TESTS_MODEL_BUILDER_H
#define GLINT_TESTS_MODEL_BUILDER_H

#include <stdint.h>

#include "glint/model.h"

enum {
    MODEL_ROOM = 1 << 20,
    MODEL_TERMS = 4,
    /* bits for the terms s^0, s^1 and w of a pupil box */
    MODEL_BOX_TERMS = 1 | 2 | 1 << GLINT_BOX_POWERS
};

struct model_image {
    unsigned char *data; /* bytes of the model file; the caller frees them */
    uint32_t bytes;
};

#define MODEL_POWER(u, v, s, w) ((u) | (v) << 4 | (s) << 8 | (w) << 12)

#define MODEL_ERROR(mantissa, shift) ((uint16_t)((mantissa) | (shift) << 11))

struct model_polynomial {
    uint8_t kind, n_terms;
    int16_t exponent;
    uint16_t power[MODEL_TERMS];
    int32_t coef[MODEL_TERMS];
};

/* Appends ITEMS[BYTES], padded to 32-bit words. Returns their offset. */
uint32_t model_append_items(struct model_image *m, const void *items,
                            size_t bytes);

struct glint_model_header *model_header_of(const struct model_image *m);

void model_seal_checksum(struct model_image *m);

/* Opens the model in M and returns it; it points into m->data. Aborts if the
 * model is invalid. */
struct glint_lens model_open_image(const struct model_image *m);

struct glint_real model_real_from_double(double x);

/* Wavelengths of 800 and 400 nm, encoded as 1 / wavelength^2, um^-2, Q24; 1 in
 * Q30. */
enum {
    MODEL_WAVE_LO_Q24 = 26214400,
    MODEL_WAVE_HI_Q24 = 104857600,
    MODEL_ONE_Q30 = 1 << 30
};

void model_begin_header(struct model_image *m, enum glint_basis basis,
                        const char *name);

/* Writes the output polynomials P[N] to M and refers to them from S.
 * Coefficients are divided by 2^HALVED. */
void model_write_outputs(struct model_image *m, struct glint_model_system *s,
                         const struct model_polynomial *p, uint32_t n,
                         int halved);

/* Returns a polynomial system whose pupil box is centred at (1 + s / 2) mm and
 * has the half sides 4 - s and 3 mm. The variable s is the sine of the light's
 * angle, scaled to -1 .. 1 within the range of the system. */
struct glint_model_system
model_make_auto_system(struct model_image *m, int32_t sine_lo_q30,
                       int32_t sine_hi_q30, int32_t wave_lo_q24,
                       int32_t wave_hi_q24, int halved);

void model_append_ghosts(struct model_image *m,
                         const struct glint_model_ghost *ghosts,
                         uint32_t n_ghosts,
                         const struct glint_model_system *systems,
                         uint32_t n_systems);

/* Returns a model of three ghosts. Ghost 0 has two ranges of angles, sines 0 ..
 * 1/4 and 1/4 .. 1/2, the second with halved coefficients; ghost 1 is never
 * visible; ghost 2 has two bands of wavelengths. */
struct model_image model_make_three_ghosts(void);

#endif
