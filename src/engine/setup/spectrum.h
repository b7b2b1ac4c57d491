/* SPDX-License-Identifier: MIT
 *
 * The colours of wavelengths.
 */
#ifndef GLINT_ENGINE_SETUP_SPECTRUM_H
#define GLINT_ENGINE_SETUP_SPECTRUM_H

/* Sets RGB to linear BT.709 of light of NM, by the CIE 1931 observer; negative
 * where the light is more saturated than any mixture of the primaries. */
void glint_observer_rgb(double nm, double rgb[3]);

#endif
