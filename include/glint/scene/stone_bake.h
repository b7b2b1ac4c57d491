/* SPDX-License-Identifier: MIT
 *
 * glint/scene/stone_bake.h - bakes a translucent medium from its text and from
 * a fit of its scattering.
 *
 *     glint_stone_parse(&text, data, bytes, "marble.translucent", &error);
 *     glint_scatter_compute(&text.stone, &watch, &rows, &error);
 *     glint_scatter_fit(&rows, &text.fit, &watch, &fit);
 *     glint_stone_bake(&fit, &text, "marble", key, &data, &bytes, &report,
 *                      &error);
 *     glint_translucent_open(&stone, data, bytes, &reason);
 *
 * Each kernel is stored as a sum of products of a row and a column. A kernel
 * that is not such a sum is approximated by one, optimal for slowly varying
 * light. The same fit gives the same bytes. */
#ifndef GLINT_SCENE_STONE_BAKE_H
#define GLINT_SCENE_STONE_BAKE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/scene/translucent.h"
#include "glint/scene/translucent_bake.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_STONE_FILE_BYTES 201

struct glint_stone_text {
    struct glint_stone stone; /* the translucent slab; the caller sets its
                                 mask */
    struct glint_scatter_options fit;
    /* Names of the picture of the mask and of the file of measured rows; empty:
     * none. */
    char mask[GLINT_STONE_FILE_BYTES], rows[GLINT_STONE_FILE_BYTES];
};

/* Results of baking. */
struct glint_stone_report {
    /* Fraction of the response to light that is lost because the rank of
     * kernels is limited, RMS over all kernels; 0 for factored fits. */
    double kernel_loss;
    /* Number of bits of the largest tap of a column. With many taps it is below
     * GLINT_TRANSLUCENT_TAP_BITS, because the sum of taps is limited. */
    int tap_bits;
};

/* Sets TEXT to the slab of glint_stone_defaults(), with a clustered fit of rank
 * 3. */
void glint_stone_text_defaults(struct glint_stone_text *text);

/* Parses DATA[BYTES], a text as described in tools/examples/scenes/README.md.
 * On GLINT_E_LENS, ERROR states file, line, column and cause. */
enum glint_status glint_stone_parse(struct glint_stone_text *text,
                                    const char *data, size_t bytes,
                                    const char *file_name,
                                    struct glint_error *error);

/* Bakes FIT, with the texel size, index of refraction and rank of TEXT. The
 * file stores KEY and the first 63 characters of NAME that are a-z, A-Z, 0-9,
 * '-' or '_'. *DATA is malloc'ed. Returns GLINT_E_ARGUMENT if a parameter is
 * out of range. On GLINT_E_UNSUPPORTED, ERROR states which property of FIT
 * cannot be baked. May return GLINT_E_MEMORY. */
enum glint_status glint_stone_bake(const struct glint_scatter_fit *fit,
                                   const struct glint_stone_text *text,
                                   const char *name, uint64_t key,
                                   unsigned char **data, size_t *bytes,
                                   struct glint_stone_report *report,
                                   struct glint_error *error);

/* Sets RADIOSITY[side * side][3] to the light that leaves STONE when
 * IRRADIANCE[side * side][3] enters. The integer arithmetic of STONE is used;
 * the largest value of IRRADIANCE is mapped to 32767. May return
 * GLINT_E_MEMORY. */
enum glint_status glint_stone_light(const struct glint_translucent *stone,
                                    const double *irradiance,
                                    double *radiosity);

#ifdef __cplusplus
}
#endif

#endif
