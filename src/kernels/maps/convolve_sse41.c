/* SPDX-License-Identifier: MIT */
#include "kernels/maps/maps.h"

#include <smmintrin.h>

#define W            __m128i
#define W_N          4
#define KERNEL(name) name##_sse41
#define OP(name)     _mm_##name
#define WHOLE(name)  _mm_##name##_si128

#include "kernels/maps/convolve_x86.inc"
