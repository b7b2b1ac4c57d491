/* SPDX-License-Identifier: MIT
 *
 * Builds a translucent medium whose fit is known in closed form, and bakes it.
 */
#ifndef GLINT_TESTS_STONE_BUILDER_H
#define GLINT_TESTS_STONE_BUILDER_H

#include "glint/scene/stone_bake.h"

struct built_stone {
    struct glint_scatter_fit fit;
    struct glint_stone_text text;
    unsigned char *data;
    size_t bytes;
    struct glint_stone_report report;
    struct glint_translucent stone;
};

/* Builds a translucent medium of SIDE x SIDE texels with a kernel of KERNEL x
 * KERNEL texels: falling as exp(-d) / d^2, wider in red than in blue. They
 * scatter the fraction ALBEDO of red light, and less of green and blue. Dark
 * fields of a chessboard of 8 x 8 fields scatter 0.6 of this. Factored models
 * get a second term, which is negative in places. */
void build_translucent_model(struct built_stone *b,
                             enum glint_scatter_model model, int side,
                             int kernel, double albedo);
void free_translucent_model(struct built_stone *b);

#endif
