/* SPDX-License-Identifier: MIT */
#include "kernels/maps/maps.h"

#include <immintrin.h>

#define W            __m256i
#define W_N          8
#define KERNEL(name) name##_avx2
#define OP(name)     _mm256_##name
#define WHOLE(name)  _mm256_##name##_si256

#include "kernels/maps/convolve_x86.inc"
