/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include "kernels/choose.h"

#define QUADS(set)                                      \
    static const struct glint_quad_kernels of_##set = { \
        glint_add_quads_##set, glint_add_quads_packed_##set};

PIXEL_SETS(QUADS)

const struct glint_quad_kernels *glint_choose_quad_kernels(unsigned sets)
{
    return BEST_OF_PIXELS(sets, &of_);
}
