/* SPDX-License-Identifier: MIT
 *
 * Index of refraction of a glass at any wavelength, from nd and Vd.
 *
 * Two-term Cauchy, n = A + B / wavelength^2, through the index at the d line
 * and the dispersion n_F - n_C = (nd - 1) / Vd. Exact at the d line and in that
 * difference; a real glass bends a little more towards the violet. */
#include "glint/trace.h"

/* Lines in air, as glass catalogues give them. Rounding them to 587.56, 486.13
 * and 656.27 nm moves rays by some 1e-5 mm. */
#define LINE_C_NM 656.2725
#define LINE_D_NM 587.5618
#define LINE_F_NM 486.1327

double glint_index(double nd, double vd, double wavelength_nm)
{
    const double span =
        1.0 / (LINE_F_NM * LINE_F_NM) - 1.0 / (LINE_C_NM * LINE_C_NM);
    double b;

    if (!(vd > 0.0))
        return nd;
    b = (nd - 1.0) / (vd * span);
    return nd + b * (1.0 / (wavelength_nm * wavelength_nm) -
                     1.0 / (LINE_D_NM * LINE_D_NM));
}
