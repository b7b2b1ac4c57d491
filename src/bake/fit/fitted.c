/* SPDX-License-Identifier: MIT */
#include "bake/fit/fitted.h"

#include <stdlib.h>

enum glint_status glint_fitted_move_part(struct glint_fitted_ghost *ghost,
                                         int part,
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

enum glint_status
glint_fitted_append_system(struct glint_fitted_ghost *ghost,
                           const struct glint_fitted_system *system)
{
    const size_t n = (size_t)ghost->n_systems;
    struct glint_fitted_system *all =
        realloc(ghost->system, (n + 1) * sizeof *all);

    if (!all)
        return GLINT_E_MEMORY;
    all[ghost->n_systems++] = *system;
    ghost->system = all;
    return GLINT_OK;
}

void glint_fitted_free_system(struct glint_fitted_system *system)
{
    for (int k = 0; k < system->n_outputs; k++)
        free(system->output[k].coef);
    free(system->box);
}

void glint_fitted_free_ghost(struct glint_fitted_ghost *ghost)
{
    for (int k = 0; k < ghost->n_systems; k++)
        glint_fitted_free_system(&ghost->system[k]);
    free(ghost->system);
    *ghost = (struct glint_fitted_ghost){.n_systems = 0};
}
