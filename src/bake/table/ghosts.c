/* SPDX-License-Identifier: MIT
 *
 * Lists the ghosts of a lens: pairs of reflecting surfaces on the same side of
 * the stop. If the two surfaces were on different sides of the stop, light
 * would cross the stop three times, and hardly any would reach the sensor.
 */
#include "glint/prescription.h"

int glint_ghost_list(const struct glint_prescription *lens,
                     struct glint_ghost *ghosts, int max)
{
    const int side[3] = {0, lens->stop_after, lens->n_surfaces};
    int n = 0;

    for (int s = 0; s < 2; s++)
        for (int i = side[s]; i < side[s + 1]; i++)
            for (int j = i + 1; j < side[s + 1]; j++, n++)
                if (n < max)
                    ghosts[n] = (struct glint_ghost){i, j};
    return n;
}
