/* SPDX-License-Identifier: MIT
 *
 * drawing.h - a lens drawn as SVG, as figures of papers on optics show it: a
 * section through the axis with its glasses, barrels, stop and sensor, rays to
 * the sensor or along a ghost, and spot diagrams below.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_DRAWING_H
#define GLINT_TOOLS_LENS_FIGURES_DRAWING_H

#include <stdio.h>

#include "glint/trace.h"

enum { DRAWING_MAX_RAYS = 41 };

struct lens_drawing {
    const struct glint_prescription *lens;
    int ghost;        /* number of the ghost whose path is drawn; -1: rays to
                         the sensor */
    double angle_deg; /* angle of a ghost's light; below 0: half the field */
    double plane_deg; /* of the section, about the axis from x to y; 0 or 90 */
    int rays;         /* rays of a fan, 1 .. DRAWING_MAX_RAYS */
    bool spots;       /* spot diagrams below the section */
    bool title;       /* words above it */
    double focus_m;   /* the lens is focused there, which the title says; 0:
                         infinity. Light is from afar in any case. */
    double width_px;
};

void lens_drawing_defaults(struct lens_drawing *drawing,
                           const struct glint_prescription *lens);

/* Writes the figure to FILE. Returns how many rays it shows. */
int lens_drawing_write(const struct lens_drawing *drawing, FILE *file);

#endif
