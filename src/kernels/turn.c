/* SPDX-License-Identifier: MIT */
#include "glint/kernels.h"
#include "kernels/kernels.h"

glint_turn_fn *glint_turn_of(unsigned sets)
{
#if defined(__x86_64__)
    return sets & GLINT_SET_AVX2    ? glint_turn_avx2
           : sets & GLINT_SET_SSE41 ? glint_turn_sse41
                                    : glint_turn_c;
#elif defined(KERNELS_NEON)
    return sets & GLINT_SET_NEON ? glint_turn_neon : glint_turn_c;
#else
    (void)sets;
    return glint_turn_c;
#endif
}
