/* SPDX-License-Identifier: MIT
 *
 * What setups of a model and of a lens table have in common.
 */
#ifndef GLINT_ENGINE_SETUP_SETUP_H
#define GLINT_ENGINE_SETUP_SETUP_H

#include "glint/setup.h"

/* GLINT_E_ARGUMENT: no such stop, or no such wavelengths. */
enum glint_status glint_setup_check(int n_blades, double rotation_deg,
                                    const double *wavelength_nm, int n,
                                    struct glint_error *error);

/* Takes stop and wavelengths, checked already. */
void glint_setup_common(struct glint_setup *setup, int n_blades,
                        double rotation_deg, const double *wavelength_nm,
                        int n);

/* Light is measured by the mean over the wavelengths of what direct_flux has.
 * GLINT_E_LENS: that of NAME is dark. */
enum glint_status glint_setup_units(struct glint_setup *setup, const char *name,
                                    struct glint_error *error);

#endif
