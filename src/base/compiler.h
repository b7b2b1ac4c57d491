/* SPDX-License-Identifier: MIT
 *
 * Compiler extensions that glint uses besides C99. */
#ifndef GLINT_BASE_COMPILER_H
#define GLINT_BASE_COMPILER_H

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "glint needs a little-endian CPU: it reads model files in place"
#endif

#include <stdint.h>

#define STATIC_ASSERT(condition) \
    __extension__ _Static_assert(condition, #condition)

/* The code requires arithmetic right shifts of negative numbers, which C99 does
 * not guarantee. */
STATIC_ASSERT((-3 >> 1) == -2);

/* Hides the value of P from the compiler. If P is a pointer, the compiler then
 * reloads what P points to instead of loading it early and spilling it to the
 * stack. */
#define FORGET(p) __asm__("" : "+r"(p))

/* Prefetches the memory at P into the cache. */
#if defined(__GNUC__)
#define PREFETCH(p) __builtin_prefetch(p)
#else
#define PREFETCH(p) ((void)(p))
#endif

/* Prevents inlining of a rarely called function, so that its arrays do not
 * enlarge the stack frames of its callers. */
#define OUT_OF_LINE __attribute__((noinline))

/* Aligns a variable or member to a multiple of BYTES bytes. */
#define ALIGNED(bytes) __attribute__((aligned(bytes)))

/* Returns the number of bits in the binary representation of X: 0 for 0, 64
 * for UINT64_MAX. */
static inline int bit_length(uint64_t x)
{
#if defined(__GNUC__)
    return x ? 64 - __builtin_clzll(x) : 0;
#else
    int n = 0;

    for (; x; x >>= 1)
        n++;
    return n;
#endif
}

static inline uint32_t count_set_bits(uint32_t x)
{
    uint32_t n = 0;

    for (; x; x &= x - 1)
        n++;
    return n;
}

/* The compiler builds a function marked WIDE_VECTORS twice: for every CPU of
 * the architecture, and for AVX2. The loader chooses one of the two at run
 * time; both give equal results. All functions called by such a function must
 * be marked WHOLLY_INLINE. Disabled with sanitizers, which do not support such
 * functions, and with clang, which would export the resolvers of static
 * functions. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && \
    !defined(GLINT_SANITIZED)
#define WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define WIDE_VECTORS
#endif
#define WHOLLY_INLINE inline __attribute__((always_inline))
#define NEVER_INLINE  __attribute__((noinline))

#endif
