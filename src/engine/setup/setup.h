/* SPDX-License-Identifier: MIT
 *
 * Functions shared by setups that are made from a model and from a lens table.
 */
#ifndef GLINT_ENGINE_SETUP_SETUP_H
#define GLINT_ENGINE_SETUP_SETUP_H

#include "glint/setup.h"

/* Validates stop and wavelengths. Returns GLINT_E_ARGUMENT if a value is out of
 * range, and names it in ERROR. */
enum glint_status glint_setup_check_arguments(int n_blades, double rotation_deg,
                                              const double *wavelength_nm,
                                              int n, struct glint_error *error);

/* Sets stop, wavelengths and colours of SETUP from validated arguments. */
void glint_setup_init_common(struct glint_setup *setup, int n_blades,
                             double rotation_deg, const double *wavelength_nm,
                             int n);

/* Sets unit_flux of all wavelengths to the mean of direct_flux. Returns
 * GLINT_E_LENS if lens NAME passes no light at some wavelength. */
enum glint_status glint_setup_set_unit_flux(struct glint_setup *setup,
                                            const char *name,
                                            struct glint_error *error);

/* Models with a smaller f-number have the flux of the direct image through a
 * stop of GLINT_FLUX_BLADES straight sides, all others through a circle. */
#define GLINT_FLUX_F_NUMBER 10
enum { GLINT_FLUX_BLADES = 8 };

/* Returns the area of SETUP's stop divided by the area of its circle. */
double glint_iris_compute_area_fraction(const struct glint_setup *setup);

/* Returns glint_iris_compute_area_fraction(), corrected for direct light that
 * falls off towards the rim of the stop by FALLOFF, as in struct glint_setup:
 * the flux through the stop, in units of the area of its circle times the mean
 * light over a stop of GLINT_FLUX_BLADES. */
double glint_iris_compute_light_fraction(const struct glint_setup *setup,
                                         const double falloff[2]);

#endif
