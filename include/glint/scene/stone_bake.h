/* SPDX-License-Identifier: MIT
 *
 * glint/scene/stone_bake.h - bakes a translucent medium from its text and a fit
 * of its scattering.
 *
 *     glint_stone_parse(&text, data, bytes, "marble.translucent", &error);
 *     glint_scatter_compute(&text.stone, &watch, &rows, &error);
 *     glint_scatter_fit(&rows, &text.fit, &watch, &fit);
 *     glint_stone_bake(&fit, &text, "marble", key, &data, &bytes, &report,
 *                      &error);
 *     glint_translucent_open(&stone, data, bytes, &reason);
 *
 * Kernels that are not sums of products of rows and columns are approximated by
 * such sums, optimal under slowly varying light. The same fit gives the same
 * bytes. */
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
    struct glint_stone stone; /* its mask is the caller's to set */
    struct glint_scatter_options fit;
    /* Names of the mask's picture and of measured rows; empty: there are none.
     */
    char mask[GLINT_STONE_FILE_BYTES], rows[GLINT_STONE_FILE_BYTES];
};

/* What baking did. */
struct glint_stone_report {
    double kernel_loss; /* of what kernels make of light together, the fraction
                           that their ranks leave out, root mean square;
                           factored: 0 */
    int tap_bits;       /* that the largest tap of a column has: sums of many
                           leave fewer than there are */
};

/* Sets TEXT to a slab of glint_stone_defaults(), clustered, of rank 3. */
void glint_stone_text_defaults(struct glint_stone_text *text);

/* Reads DATA[BYTES], a text as tools/examples/scenes/README.md has it.
 * GLINT_E_LENS: ERROR states file, line, column and cause. */
enum glint_status glint_stone_parse(struct glint_stone_text *text,
                                    const char *data, size_t bytes,
                                    const char *file_name,
                                    struct glint_error *error);

/* Bakes FIT, with texel, index and rank of TEXT. NAME is kept in the file, its
 * first 63 characters of a-z, A-Z, 0-9, '-' and '_', as is KEY. *DATA is
 * malloc'ed. GLINT_E_ARGUMENT: one of them is out of range.
 * GLINT_E_UNSUPPORTED: ERROR states what of FIT no baked translucent medium can
 * have. GLINT_E_MEMORY. */
enum glint_status glint_stone_bake(const struct glint_scatter_fit *fit,
                                   const struct glint_stone_text *text,
                                   const char *name, uint64_t key,
                                   unsigned char **data, size_t *bytes,
                                   struct glint_stone_report *report,
                                   struct glint_error *error);

/* Sets RADIOSITY[side * side][3] to what the integers of STONE
 * make of IRRADIANCE, of the same shape, whose largest they take for 32767.
 * GLINT_E_MEMORY. */
enum glint_status glint_stone_light(const struct glint_translucent *stone,
                                    const double *irradiance,
                                    double *radiosity);

#ifdef __cplusplus
}
#endif

#endif
