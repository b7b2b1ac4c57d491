/* SPDX-License-Identifier: MIT
 *
 * Texels as codes: what is nearest in light. */
#include "bake/environment/sphere.h"

#include <math.h>

void glint_environment_put_9e5(const double (*light)[3], size_t n, double unit,
                               uint32_t *code)
{
    for (size_t i = 0; i < n; i++) {
        const double most =
            fmax(light[i][0], fmax(light[i][1], light[i][2])) / unit;
        int exponent = 0;
        uint32_t word;

        while (exponent < 31 && rint(ldexp(most, 12 - exponent)) > 511)
            exponent++;
        word = (uint32_t)exponent << 27;
        for (int c = 0; c < 3; c++)
            word |= (uint32_t)fmin(
                        rint(ldexp(light[i][c] / unit, 12 - exponent)), 511)
                    << (9 * c);
        code[i] = word;
    }
}
