/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include "kernels/choose.h"

#define KERNELS(set)                                                         \
    static const struct glint_kernels of_##set = {                           \
        glint_add_luma_##set, glint_add_pairs_##set, glint_add_packed_##set, \
        glint_add_code_##set, glint_run_sum_##set};

PIXEL_SETS(KERNELS)

const struct glint_kernels *glint_choose_pixel_kernels(unsigned sets)
{
    return BEST_OF_PIXELS(sets, &of_);
}
