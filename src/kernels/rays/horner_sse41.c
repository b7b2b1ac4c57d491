/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include <smmintrin.h>

#define W            __m128i
#define W_N          4
#define KERNEL(name) name##_sse41
#define OP(name)     _mm_##name
#define WHOLE(name)  _mm_##name##_si128

#include "kernels/rays/horner_x86.inc"
#include "kernels/rays/horner_v.inc"
