/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "engine/setup/dirt.h"

void glint_setup_stop(const struct glint_setup *setup, struct glint_stop *stop)
{
    const int n = setup->n_blades;
    struct glint_iris_sides sides;

    glint_iris_compute_sides(&sides, setup);
    *stop = (struct glint_stop){.n_blades = n,
                                .apothem_q16 = 1 << 16,
                                .opening_q30 =
                                    (int32_t)lrint(setup->opening * 0x1p30)};
    stop->shade = setup->dirt ? &setup->dirt->shade : NULL;
    if (n == 0)
        return;
    stop->apothem_q16 = (int32_t)lrint(65536 * sides.apothem);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 2; k++)
            stop->normal_q30[i][k] =
                (int32_t)lrint(sides.normal[i][k] * 0x1p30);
    if (!sides.arcs)
        return;
    stop->round_q30 = (int32_t)lrint(sides.round * 0x1p30);
    stop->off_q30 = (int32_t)lrint(sides.off * 0x1p30);
}

void glint_dirt_free(struct glint_dirt *dirt)
{
    if (!dirt)
        return;
    free(dirt->node_q15);
    free(dirt->rough_q8);
    free(dirt);
}
