/* SPDX-License-Identifier: MIT
 *
 * The smear of a stop in pixels, and its table. */
#ifndef GLINT_ENGINE_STAR_SMEAR_TABLE_H
#define GLINT_ENGINE_STAR_SMEAR_TABLE_H

#include "engine/star/psf.h"
#include "engine/star/smear.h"
#include "star/smeared.h"

/* Sets RGB to the light per pixel^2 of the smear of PSF, whose AIRY_PX is that
 * of the stop, over a square of half width HALF about (X, Y), pixels, y down;
 * it may be below 0. */
void glint_smear_compute_light(const struct glint_smear *smear,
                               const struct glint_psf *psf, double airy_px,
                               double x, double y, double half, double rgb[3]);

/* Returns the fraction of the light of channel C that the smear has within R
 * pixels, and beyond. */
double glint_smear_compute_light_beyond(const struct glint_smear *smear,
                                        const struct glint_psf *psf,
                                        double airy_px, double r, int c);

/* Sets TABLE, but for what draws it. GLINT_E_MEMORY. */
enum glint_status glint_smear_make_table(struct glint_star_smear *table,
                                         const struct glint_smear *smear,
                                         const struct glint_psf *psf,
                                         double airy_px);

/* Sets RGB to the light of TABLE at (X, Y), as it is drawn. */
void glint_smear_evaluate_table(const struct glint_star_smear *table, double x,
                                double y, double rgb[3]);

#endif
