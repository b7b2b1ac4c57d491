/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include "base/q.h"

void glint_turn_c(const struct glint_turn *t, const int32_t *x,
                  const int32_t *y, int32_t (*out)[GLINT_TURNED],
                  int32_t (*lost)[GLINT_TURNED])
{
    for (int i = 0; i < GLINT_TURNED; i++) {
        const int64_t xc = (int64_t)x[i] * t->cos, xs = (int64_t)x[i] * t->sin;
        const int64_t yc = (int64_t)y[i] * t->cos, ys = (int64_t)y[i] * t->sin;
        const int64_t sum[4] = {xc - ys, xs + yc, xc + ys, xs - yc};

        for (int k = 0; k < 4; k++)
            out[k][i] = q_scaled(sum[k], t->shift, t->limit, &lost[k / 2][i]);
    }
}
