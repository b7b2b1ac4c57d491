/* SPDX-License-Identifier: MIT */
#include "glint/kernels.h"
#include "kernels/kernels.h"

#define QUADS(set)                                          \
    {                                                       \
        glint_add_quads_##set, glint_add_quads_packed_##set \
    }

const struct glint_quad_kernels *glint_quad_kernels_of(unsigned sets)
{
    static const struct glint_quad_kernels plain = QUADS(c);
#if defined(__x86_64__)
    static const struct glint_quad_kernels sse41 = QUADS(sse41);
    static const struct glint_quad_kernels avx2 = QUADS(avx2);

    return sets & GLINT_SET_AVX2    ? &avx2
           : sets & GLINT_SET_SSE41 ? &sse41
                                    : &plain;
#elif defined(KERNELS_NEON)
    static const struct glint_quad_kernels neon = QUADS(neon);

    return sets & GLINT_SET_NEON ? &neon : &plain;
#else
    (void)sets;
    return &plain;
#endif
}
