/* SPDX-License-Identifier: MIT
 *
 * Chooses among the variants of a kernel.
 *
 * KERNEL_SETS(X) expands to X(c), and to X(set) for each instruction set that
 * the build includes. BEST_OF(sets, NAME_) is the fastest of NAME_c, NAME_sse41
 * and so on that the GLINT_SET_ bits in SETS allow; NAME_c if no bit is set.
 * PIXEL_SETS and BEST_OF_PIXELS do the same for pixel kernels. These have no C
 * variant where every CPU of the target has NEON, to save memory. */
#ifndef GLINT_KERNELS_CHOOSE_H
#define GLINT_KERNELS_CHOOSE_H

#include "glint/kernels.h"

/* NEON kernels are built for every ARM CPU that may have NEON. At run time the
 * compiler's target or the operating system states whether the CPU has NEON. */
#if defined(__aarch64__) || defined(__ARM_NEON) ||               \
    (defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'A' && \
     __ARM_ARCH >= 7)
#define KERNELS_NEON 1
#endif

#if defined(__x86_64__)
#define KERNEL_SETS(X) X(c) X(sse41) X(avx2)
#define BEST_OF(sets, name)                 \
    ((sets)&GLINT_SET_AVX2    ? name##avx2  \
     : (sets)&GLINT_SET_SSE41 ? name##sse41 \
                              : name##c)
#elif defined(__wasm_simd128__) /* *_sse41.c with wasm/smmintrin.h */
#define KERNEL_SETS(X)      X(c) X(sse41)
#define BEST_OF(sets, name) ((sets)&GLINT_SET_SSE41 ? name##sse41 : name##c)
#elif defined(KERNELS_NEON)
#define KERNEL_SETS(X)      X(c) X(neon)
#define BEST_OF(sets, name) ((sets)&GLINT_SET_NEON ? name##neon : name##c)
#else
#define KERNEL_SETS(X)      X(c)
#define BEST_OF(sets, name) ((void)(sets), name##c)
#endif

#if defined(__ARM_NEON)
#define PIXEL_SETS(X)              X(neon)
#define BEST_OF_PIXELS(sets, name) ((void)(sets), name##neon)
#else
#define PIXEL_SETS     KERNEL_SETS
#define BEST_OF_PIXELS BEST_OF
#endif

#endif
