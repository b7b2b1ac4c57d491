/* SPDX-License-Identifier: MIT
 *
 * Glasses of the manufacturers' catalogues, for lens tables. */
#ifndef GLINT_BAKE_TABLE_CATALOGUE_H
#define GLINT_BAKE_TABLE_CATALOGUE_H

#include "glint/prescription.h"

/* wavelengths of the Fraunhofer lines C, d and F in air, which glass catalogues
 * use */
#define LINE_C_NM 656.2725
#define LINE_D_NM 587.5618
#define LINE_F_NM 486.1327

/* Returns the index of refraction by Sellmeier's formula n^2 = 1 + sum B L^2 /
 * (L^2 - C), with L in micrometres. C = B1, B2, B3, C1, C2, C3. */
double glint_sellmeier_index(const double c[6], double wavelength_nm);

#endif
