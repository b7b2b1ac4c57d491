/* SPDX-License-Identifier: MIT */
#include "formats/half.h"

#include <string.h>

float glint_half_decode(uint16_t half)
{
    const uint32_t sign = (uint32_t)(half & 0x8000) << 16;
    const uint32_t rest = half & 0x7fff;
    const uint32_t exponent =
        rest >= 0x7c00 ? UINT32_C(224) << 23 : UINT32_C(112) << 23;
    const uint32_t bits = (sign | (rest << 13)) + exponent;
    float value;

    if (rest < 0x400) { /* 0 or subnormal: a multiple of 2^-24 */
        value = (float)rest * 0x1p-24F;
        return sign ? -value : value;
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Returns MANTISSA / 2^N, N >= 1, rounded to nearest, ties to even. */
static uint32_t drop(uint32_t mantissa, int n)
{
    const uint32_t half = UINT32_C(1) << (n - 1);
    const uint32_t kept = mantissa >> n, rest = mantissa & (2 * half - 1);

    return kept + (rest > half || (rest == half && (kept & 1)));
}

uint16_t glint_half_encode(float value)
{
    uint32_t bits, sign, size;
    int exponent;

    memcpy(&bits, &value, sizeof bits);
    sign = bits >> 16 & 0x8000;
    size = bits & 0x7fffffff;
    exponent = (int)(size >> 23) - 127;
    if (size > 0x7f800000) /* not-a-number stays one */
        return (uint16_t)(sign | 0x7e00 | (size >> 13 & 0x1ff));
    if (exponent > 15)
        return (uint16_t)(sign | 0x7c00);
    /* Rounding may carry into the exponent, as far as infinity. */
    if (exponent >= -14)
        return (uint16_t)(sign | (drop(size, 13) - (UINT32_C(112) << 10)));
    if (exponent < -25)
        return (uint16_t)sign;
    return (uint16_t)(sign | drop((size & 0x7fffff) | 0x800000, -1 - exponent));
}
