/* SPDX-License-Identifier: MIT
 *
 * Computes the index of refraction of a glass at any wavelength: by
 * Sellmeier's formula for catalogue glasses, else from nd and Vd.
 *
 * For nd and Vd the two-term Cauchy formula n = A + B / wavelength^2 passes
 * through the index at the d line and the dispersion n_F - n_C = (nd - 1) /
 * Vd. It is exact for these values; a real glass refracts violet light
 * slightly more.
 */
#include "bake/table/catalogue.h"
#include "glint/trace.h"

/* Uses the exact wavelengths of the Fraunhofer lines: the rounded ones, 587.56,
 * 486.13 and 656.27 nm, would displace rays by about 1e-5 mm. */

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

double glint_surface_index(const struct glint_surface *s, double wavelength_nm)
{
    return s->sellmeier[0] > 0.0
               ? glint_sellmeier_index(s->sellmeier, wavelength_nm)
               : glint_index(s->nd, s->vd, wavelength_nm);
}
