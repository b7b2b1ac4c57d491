/* SPDX-License-Identifier: MIT
 *
 * A fit of a translucent medium that is known in closed form, and the baked
 * translucent medium. */
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

/* Builds a translucent medium of SIDE texels and KERNEL: bells, wider in red
 * than in blue, that scatter ALBEDO of the light; fields of a chess board of 8
 * x 8 differ. Factored ones have a second term that is negative in places. */
void build_stone(struct built_stone *b, enum glint_scatter_model model,
                 int side, int kernel, double albedo);
void free_stone(struct built_stone *b);

#endif
