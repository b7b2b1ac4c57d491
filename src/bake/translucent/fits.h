/* SPDX-License-Identifier: MIT
 *
 * The three fits that a run time can draw. All are least squares over the
 * entries inside of the square: what lies outside is lost anyway, and if it
 * counted, rows at the rim would be a kind of their own. */
#ifndef GLINT_BAKE_TRANSLUCENT_FITS_H
#define GLINT_BAKE_TRANSLUCENT_FITS_H

#include "bake/translucent/rows.h"

/* Each fills the parts of FIT, all 0, that are its model's, but for the energy;
 * albedo is set. Of ROWS, and of h that they set, texel x is where light
 * leaves, and offsets lead to where it came from. */
enum glint_status glint_scatter_clusters(const struct glint_scatter_rows *rows,
                                         const struct glint_watch *watch,
                                         struct glint_scatter_fit *fit);
enum glint_status glint_scatter_factors(const struct glint_scatter_rows *rows,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_fit *fit);

#endif
