/* SPDX-License-Identifier: MIT */
#include "bake/fit/fitted.h"

#include <stdlib.h>

enum glint_status glint_fitted_part(struct glint_fitted_ghost *ghost, int part,
                                    struct glint_fitted_ghost *out)
{
    int kept = 0;

    *out = (struct glint_fitted_ghost){.n_systems = 0};
    out->system = malloc(((size_t)ghost->n_systems + 1) * sizeof *out->system);
    if (!out->system)
        return GLINT_E_MEMORY;
    for (int k = 0; k < ghost->n_systems; k++) {
        const struct glint_fitted_system *s = &ghost->system[k];

        if (s->part == part)
            out->system[out->n_systems++] = *s;
        else
            ghost->system[kept++] = *s;
    }
    ghost->n_systems = kept;
    return GLINT_OK;
}

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
