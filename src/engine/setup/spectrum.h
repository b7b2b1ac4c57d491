/* SPDX-License-Identifier: MIT
 *
 * Computes the colours of single wavelengths. */
#ifndef GLINT_ENGINE_SETUP_SPECTRUM_H
#define GLINT_ENGINE_SETUP_SPECTRUM_H

/* Sets RGB to the linear BT.709 colour of light of wavelength NM, by the CIE
 * 1931 observer; channels are negative for colours outside the gamut. */
void glint_observer_compute_rgb(double nm, double rgb[3]);

#endif
