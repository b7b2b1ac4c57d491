/* SPDX-License-Identifier: MIT
 *
 * Converts the smear (diffraction by dirt in the stop) to pixels of the
 * picture, and makes its table for drawing. */
#ifndef GLINT_ENGINE_STAR_SMEAR_TABLE_H
#define GLINT_ENGINE_STAR_SMEAR_TABLE_H

#include "engine/star/psf.h"
#include "engine/star/smear.h"
#include "star/smeared.h"

/* Sets RGB to the light per pixel^2 that dirt adds to the starburst. This is
 * the mean of SMEAR over a square of half width HALF around (X, Y), pixels from
 * the lamp, y down; it may be negative. PSF gives the spectrum, AIRY_PX 550 nm
 * times the f-number in pixels. */
void glint_smear_compute_light(const struct glint_smear *smear,
                               const struct glint_psf *psf, double airy_px,
                               double x, double y, double half, double rgb[3]);

/* Returns the fraction of the light of channel C that SMEAR scatters more than
 * R pixels from the lamp. */
double glint_smear_compute_light_beyond(const struct glint_smear *smear,
                                        const struct glint_psf *psf,
                                        double airy_px, double r, int c);

/* Computes the members of TABLE from SMEAR, except part, the drawing function.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_smear_make_table(struct glint_star_smear *table,
                                         const struct glint_smear *smear,
                                         const struct glint_psf *psf,
                                         double airy_px);

/* Sets RGB to the light of TABLE at (X, Y), pixels from the lamp, interpolated
 * as in drawing. */
void glint_smear_evaluate_table(const struct glint_star_smear *table, double x,
                                double y, double rgb[3]);

#endif
