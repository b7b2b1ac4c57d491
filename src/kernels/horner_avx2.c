/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <immintrin.h>

#define W            __m256i
#define W_N          8
#define KERNEL(name) name##_avx2
#define w_add        _mm256_add_epi32
#define w_set(x)     _mm256_set1_epi32(x)

static inline W w_load(const int32_t *p)
{
    return _mm256_loadu_si256((const W *)(const void *)p);
}

static inline void w_store(int32_t *p, W x)
{
    _mm256_storeu_si256((W *)(void *)p, x);
}

/* A shift to the right by so many bits of the lower lane of each pair's
 * product, and to the left into the upper lane of the other. */
struct shift {
    W half;
    __m128i right, left;
};

static inline struct shift shift_by(int fraction)
{
    return (struct shift){_mm256_set1_epi64x(1LL << (fraction - 1)),
                          _mm_cvtsi32_si128(fraction),
                          _mm_cvtsi32_si128(32 - fraction)};
}

struct factor {
    W even, odd;
};

static inline struct factor factor_of(W x)
{
    return (struct factor){x, _mm256_srli_epi64(x, 32)};
}

/* The lower 32 bits of each product, rounded and shifted. */
static inline W w_times(W a, struct factor x, struct shift s)
{
    const W even = _mm256_mul_epi32(a, x.even);
    const W odd = _mm256_mul_epi32(_mm256_srli_epi64(a, 32), x.odd);

    return _mm256_blend_epi32(
        _mm256_srl_epi64(_mm256_add_epi64(even, s.half), s.right),
        _mm256_sll_epi64(_mm256_add_epi64(odd, s.half), s.left), 0xaa);
}

#include "kernels/horner_v.h"
