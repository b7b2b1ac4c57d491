/* SPDX-License-Identifier: MIT */
#include "bake/fitted.h"

#include <stdlib.h>

void glint_fitted_finish(struct glint_fitted_ghost *ghost)
{
    for (int k = 0; k < ghost->n_systems; k++) {
        struct glint_fitted_system *s = &ghost->system[k];

        for (int i = 0; i < s->n_outputs; i++)
            free(s->output[i].coef);
        free(s->knot);
        free(s->box);
    }
    free(ghost->system);
    *ghost = (struct glint_fitted_ghost){.n_systems = 0};
}
