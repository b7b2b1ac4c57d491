/* SPDX-License-Identifier: MIT
 *
 * Initialises a setup from a lens table, including the flux of its direct
 * light.
 */
#include "engine/setup/setup.h"

#include <stdio.h>

#include "bake/trace/cells.h"
#include "glint/trace.h"

/* Initialises SETUP as glint_setup_init() does. The flux of the direct light is
 * measured with CELLS x CELLS cells. */
static enum glint_status init_setup(struct glint_setup *setup,
                                    const struct glint_prescription *lens,
                                    int n_blades, double blade_rotation_deg,
                                    const double *wavelength_nm, int n,
                                    int cells, struct glint_error *error)
{
    const enum glint_status status = glint_setup_check_arguments(
        n_blades, blade_rotation_deg, wavelength_nm, n, error);

    if (status != GLINT_OK)
        return status;
    setup->lens = lens;
    glint_optics_of(lens, &setup->optics);
    /* the run time computes positions in the picture from focal_mm */
    setup->optics.focal_mm = setup->optics.scale_mm;
    setup->n_ghosts = glint_ghost_list(lens, setup->ghost, GLINT_MAX_GHOSTS);
    setup->n_parts = 0;
    glint_setup_init_common(setup, n_blades, blade_rotation_deg, wavelength_nm,
                            n);
    for (int i = 0; i < n; i++) {
        setup->direct_flux[i] =
            glint_direct_compute_flux(setup, wavelength_nm[i], cells);
        if (setup->direct_flux[i] < 0) {
            snprintf(error->text, sizeof error->text, "not enough memory");
            return GLINT_E_MEMORY;
        }
    }
    return glint_setup_set_unit_flux(setup, lens->name, error);
}

enum glint_status glint_setup_init(struct glint_setup *setup,
                                   const struct glint_prescription *lens,
                                   int n_blades, double blade_rotation_deg,
                                   const double *wavelength_nm, int n,
                                   struct glint_error *error)
{
    return init_setup(setup, lens, n_blades, blade_rotation_deg, wavelength_nm,
                      n, GLINT_FLUX_CELLS, error);
}

enum glint_status glint_setup_init_draft(struct glint_setup *setup,
                                         const struct glint_prescription *lens,
                                         int n_blades,
                                         double blade_rotation_deg,
                                         const double *wavelength_nm, int n,
                                         struct glint_error *error)
{
    return init_setup(setup, lens, n_blades, blade_rotation_deg, wavelength_nm,
                      n, GLINT_FLUX_DRAFT_CELLS, error);
}
