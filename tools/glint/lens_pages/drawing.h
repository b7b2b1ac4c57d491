/* SPDX-License-Identifier: MIT
 *
 * drawing.h - draws a lens as SVG, like a figure of an optics paper: a section
 * through the axis with glass elements, barrels, stop and sensor, rays to the
 * sensor or along a ghost, and spot diagrams below. */
#ifndef GLINT_TOOLS_LENS_FIGURES_DRAWING_H
#define GLINT_TOOLS_LENS_FIGURES_DRAWING_H

#include <stdio.h>

#include "glint/trace.h"

enum { DRAWING_MAX_RAYS = 41 };

struct lens_drawing {
    const struct glint_prescription *lens;
    /* number of the ghost whose path is drawn; -1: draws rays to the sensor */
    int ghost;
    /* angle of the light of a ghost, degrees; below 0: half the field */
    double angle_deg;
    double plane_deg; /* plane of the section: angle about the axis from x to y,
                         0 or 90 */
    int rays;         /* rays per fan, 1 .. DRAWING_MAX_RAYS */
    bool spots;       /* spot diagrams below the section */
    double focus_m;   /* focus distance, printed in the title; 0: infinity. Rays
                         are always from infinity. */
};

void lens_drawing_set_defaults(struct lens_drawing *drawing,
                               const struct glint_prescription *lens);

/* Writes the figure to FILE. Returns the number of rays in it. */
int lens_drawing_write(const struct lens_drawing *drawing, FILE *file);

#endif
