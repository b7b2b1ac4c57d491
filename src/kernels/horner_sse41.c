/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <smmintrin.h>

#define W            __m128i
#define W_N          4
#define KERNEL(name) name##_sse41
#define w_add        _mm_add_epi32
#define w_set(x)     _mm_set1_epi32(x)

static inline W w_load(const int32_t *p)
{
    return _mm_loadu_si128((const W *)(const void *)p);
}

static inline void w_store(int32_t *p, W x)
{
    _mm_storeu_si128((W *)(void *)p, x);
}

/* A shift to the right by so many bits of the lower lane of each pair's
 * product, and to the left into the upper lane of the other. */
struct shift {
    W half;
    __m128i right, left;
};

static inline struct shift shift_by(int fraction)
{
    return (struct shift){_mm_set1_epi64x(1LL << (fraction - 1)),
                          _mm_cvtsi32_si128(fraction),
                          _mm_cvtsi32_si128(32 - fraction)};
}

struct factor {
    W even, odd;
};

static inline struct factor factor_of(W x)
{
    return (struct factor){x, _mm_srli_epi64(x, 32)};
}

/* The lower 32 bits of each product, rounded and shifted. */
static inline W w_times(W a, struct factor x, struct shift s)
{
    const W even = _mm_mul_epi32(a, x.even);
    const W odd = _mm_mul_epi32(_mm_srli_epi64(a, 32), x.odd);

    return _mm_blend_epi16(_mm_srl_epi64(_mm_add_epi64(even, s.half), s.right),
                           _mm_sll_epi64(_mm_add_epi64(odd, s.half), s.left),
                           0xcc);
}

#include "kernels/horner_v.h"
