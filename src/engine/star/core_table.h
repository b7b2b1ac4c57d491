/* SPDX-License-Identifier: MIT
 *
 * The core of a starburst: the exact pattern over each pixel, less what lines
 * and halo give there.
 */
#ifndef GLINT_ENGINE_STAR_CORE_TABLE_H
#define GLINT_ENGINE_STAR_CORE_TABLE_H

#include "engine/star/psf.h"
#include "star/starburst.h"

/* Sets the core of TABLES, all else of which is set. GLINT_E_MEMORY. */
enum glint_status glint_star_set_core(struct glint_star_tables *tables,
                                      const struct glint_psf *psf);

/* What lines and halo give at (X, Y) from a light of power 1, as drawn but for
 * the rounding of integers. */
void glint_star_tabled(const struct glint_star_tables *tables, double x,
                       double y, double rgb[3]);

#endif
