/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include "glint/kernels.h"

#define KERNELS(set)                                                         \
    {                                                                        \
        glint_add_luma_##set, glint_add_pairs_##set, glint_add_packed_##set, \
            glint_add_code_##set, glint_run_sum_##set                        \
    }

const struct glint_kernels *glint_kernels_of(unsigned sets)
{
    static const struct glint_kernels plain = KERNELS(c);
#if defined(__x86_64__)
    static const struct glint_kernels sse41 = KERNELS(sse41);
    static const struct glint_kernels avx2 = KERNELS(avx2);

    return sets & GLINT_SET_AVX2    ? &avx2
           : sets & GLINT_SET_SSE41 ? &sse41
                                    : &plain;
#elif defined(KERNELS_NEON)
    static const struct glint_kernels neon = KERNELS(neon);

    return sets & GLINT_SET_NEON ? &neon : &plain;
#else
    (void)sets;
    return &plain;
#endif
}
