/* SPDX-License-Identifier: MIT
 *
 * Makes the core table of a starburst: the exact pattern, integrated over a
 * pixel, minus lines and halo. */
#ifndef GLINT_ENGINE_STAR_CORE_TABLE_H
#define GLINT_ENGINE_STAR_CORE_TABLE_H

#include "engine/star/psf.h"
#include "engine/star/smear.h"
#include "star/starburst.h"

/* Sets the core table of TABLES. All other members of TABLES must be set.
 * SMEAR: diffraction by dirt in the stop, or NULL; AIRY_PX: 550 nm times the
 * f-number, pixels. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_star_make_core_table(struct glint_star_tables *tables,
                                             const struct glint_psf *psf,
                                             const struct glint_smear *smear,
                                             double airy_px);

/* Sets RGB to the light of lines and halo at (X, Y), pixels from a light of
 * power 1, by TABLES. Only integer rounding distinguishes the drawn light from
 * it. */
void glint_star_evaluate_far_tables(const struct glint_star_tables *tables,
                                    double x, double y, double rgb[3]);

#endif
