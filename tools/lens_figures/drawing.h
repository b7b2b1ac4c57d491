/* SPDX-License-Identifier: MIT
 *
 * drawing.h - a lens drawn as SVG, as figures of papers on optics show it: a
 * section through the axis with its glasses, barrels, stop and sensor, rays to
 * the sensor or along a ghost, and spot diagrams below.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_DRAWING_H
#define GLINT_TOOLS_LENS_FIGURES_DRAWING_H

#include <stdio.h>

#include "lens_figures/figure.h"

void drawing_defaults(struct lens_drawing *drawing,
                      const struct glint_prescription *lens);

/* Writes the figure to FILE. Returns how many rays it shows. */
int drawing_write(const struct lens_drawing *drawing, FILE *file);

#endif
