/* SPDX-License-Identifier: MIT */
#include "kernels/halo.h"

#include "kernels/choose.h"

static const struct glint_star_kernels of_c = {glint_halo_c,
                                               glint_move_light_c};
#if defined(__x86_64__)
static const struct glint_star_kernels of_avx2 = {glint_halo_avx2,
                                                  glint_move_light_avx2};
#elif defined(KERNELS_NEON)
static const struct glint_star_kernels of_neon = {glint_halo_neon,
                                                  glint_move_light_neon};
#endif

const struct glint_star_kernels *glint_choose_star_kernels(unsigned sets)
{
#if defined(__x86_64__)
    if (sets & GLINT_SET_AVX2)
        return &of_avx2;
#elif defined(KERNELS_NEON)
    if (sets & GLINT_SET_NEON)
        return &of_neon;
#endif
    (void)sets;
    return &of_c;
}
