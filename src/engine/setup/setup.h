/* SPDX-License-Identifier: MIT
 *
 * Shared by setups of a model and of a lens table. */
#ifndef GLINT_ENGINE_SETUP_SETUP_H
#define GLINT_ENGINE_SETUP_SETUP_H

#include "glint/setup.h"

/* Checks stop and wavelengths. GLINT_E_ARGUMENT: one is out of range, and ERROR
 * states which. */
enum glint_status glint_setup_check(int n_blades, double rotation_deg,
                                    const double *wavelength_nm, int n,
                                    struct glint_error *error);

/* Sets stop, wavelengths and colours of SETUP; the arguments have been checked.
 */
void glint_setup_common(struct glint_setup *setup, int n_blades,
                        double rotation_deg, const double *wavelength_nm,
                        int n);

/* Sets unit_flux of all wavelengths to the mean of direct_flux. GLINT_E_LENS:
 * no light gets through lens NAME at some wavelength. */
enum glint_status glint_setup_units(struct glint_setup *setup, const char *name,
                                    struct glint_error *error);

/* Returns the fraction of the light through a circular stop that the stop of
 * SETUP lets through. Direct light is even over it to 1/10000. */
double glint_iris_share(const struct glint_setup *setup);

#endif
