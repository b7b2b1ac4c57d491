/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "engine/setup/degrees.h"
#include "glint/setup.h"

void glint_setup_stop(const struct glint_setup *setup, struct glint_stop *stop)
{
    const int n = setup->n_blades;

    *stop = (struct glint_stop){.n_blades = n,
                                .apothem_q16 = 1 << 16,
                                .opening_q30 =
                                    (int32_t)lrint(setup->opening * 0x1p30)};
    if (n == 0)
        return;
    stop->apothem_q16 = (int32_t)lrint(65536 * cos(GLINT_PI / n));
    for (int i = 0; i < n; i++) {
        const double a = setup->blade_rotation_deg + (i + 0.5) * 360.0 / n;

        stop->normal_q30[i][0] = (int32_t)lrint(glint_cos_deg(a) * 0x1p30);
        stop->normal_q30[i][1] = (int32_t)lrint(glint_sin_deg(a) * 0x1p30);
    }
}

/* Returns the signed distance of a point to the outline of the stop. It is
 * exact inside and beside a side; beyond a corner it is too short, but only its
 * sign matters there. */
static double stop_distance(const struct glint_stop *stop, double x, double y)
{
    double d = stop->n_blades ? 4 : 1 - hypot(x, y);

    for (int i = 0; i < stop->n_blades; i++) {
        const double side = stop->apothem_q16 * 0x1p-16 -
                            x * stop->normal_q30[i][0] * 0x1p-30 -
                            y * stop->normal_q30[i][1] * 0x1p-30;

        d = fmin(d, side);
    }
    return d;
}

void glint_setup_mask(const struct glint_setup *setup, int16_t *mask_q13,
                      int nodes, double span)
{
    const double step = 2 * span / (nodes - 1);
    struct glint_stop stop;

    glint_setup_stop(setup, &stop);
    for (int j = 0; j < nodes; j++)
        for (int i = 0; i < nodes; i++) {
            const double d =
                stop_distance(&stop, i * step - span, j * step - span);

            mask_q13[j * nodes + i] =
                (int16_t)lrint(fmax(-3.9, fmin(d, 3.9)) * 8192);
        }
}
