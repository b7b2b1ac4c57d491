/* SPDX-License-Identifier: MIT */
#include "glint/light.h"

#include <math.h>

struct glint_real glint_real_of(double x)
{
    int exponent;
    const double mantissa = frexp(x, &exponent);
    const double rounded = floor(fabs(mantissa) * 0x1p31);

    if (x == 0 || !isfinite(x))
        return (struct glint_real){0, 0};
    return (struct glint_real){(int32_t)copysign(rounded, x), exponent - 31};
}

double glint_real_value(struct glint_real x)
{
    return ldexp(x.mantissa, x.exponent);
}

double glint_tint_factor(const struct glint_tint *tint, int c)
{
    return glint_real_value(tint->gain) * tint->rgb_q14[c] / 16384;
}
