/* SPDX-License-Identifier: MIT */
#include "glint/kernels.h"
#include "kernels/kernels.h"

#define HORNER(set)                                         \
    {                                                       \
        glint_horner_along_##set, glint_horner_across_##set \
    }

const struct glint_horner *glint_horner_of(unsigned sets)
{
    static const struct glint_horner plain = HORNER(c);
#if defined(__x86_64__)
    static const struct glint_horner sse41 = HORNER(sse41);
    static const struct glint_horner avx2 = HORNER(avx2);

    return sets & GLINT_SET_AVX2    ? &avx2
           : sets & GLINT_SET_SSE41 ? &sse41
                                    : &plain;
#elif defined(KERNELS_NEON)
    static const struct glint_horner neon = HORNER(neon);

    return sets & GLINT_SET_NEON ? &neon : &plain;
#else
    (void)sets;
    return &plain;
#endif
}
