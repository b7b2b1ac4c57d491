/* SPDX-License-Identifier: MIT */
#include "kernels/halo.h"

#include "glint/kernels.h"

static const struct glint_star_kernels of_c = {glint_halo_c,
                                               glint_move_light_c};
#if defined(__x86_64__)
static const struct glint_star_kernels of_avx2 = {glint_halo_avx2,
                                                  glint_move_light_avx2};
#endif

const struct glint_star_kernels *glint_choose_star_kernels(unsigned sets)
{
#if defined(__x86_64__)
    if (sets & GLINT_SET_AVX2)
        return &of_avx2;
#endif
    (void)sets;
    return &of_c;
}
