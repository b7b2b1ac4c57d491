/* SPDX-License-Identifier: MIT */
#include "glint/kernels.h"

#include "kernels/choose.h"

unsigned glint_sets_built(void)
{
#if defined(__x86_64__)
    return GLINT_SET_SSE41 | GLINT_SET_AVX2;
#elif defined(__wasm_simd128__)
    return GLINT_SET_SSE41;
#elif defined(KERNELS_NEON)
    return GLINT_SET_NEON;
#else
    return 0;
#endif
}

#if defined(__x86_64__)

#include <cpuid.h>

/* Returns whether the operating system saves the AVX registers of threads. */
static int does_system_save_avx(void)
{
    unsigned low, high;

    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    (void)high;
    return (low & 6) == 6;
}

unsigned glint_sets_here(void)
{
    unsigned a, b, c, d, sets;

    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_SSE4_1))
        return 0;
    sets = GLINT_SET_SSE41;
    if ((c & bit_OSXSAVE) && does_system_save_avx() &&
        __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & bit_AVX2))
        sets |= GLINT_SET_AVX2;
    return sets;
}

#else

/* The compiler's target is all that is known. */
unsigned glint_sets_here(void)
{
#if defined(__ARM_NEON) || defined(__wasm_simd128__)
    return glint_sets_built();
#else
    return 0;
#endif
}

#endif
