/* SPDX-License-Identifier: MIT
 *
 * Finds the highlights of a scene with exact rays in double precision; the
 * reference for glint/scene/highlights.h.
 */
#ifndef REFERENCE_SCENES_TWIN_HIGHLIGHTS_H
#define REFERENCE_SCENES_TWIN_HIGHLIGHTS_H

#include "reference/scenes/twin.h"

enum { TWIN_HIGHLIGHTS = 64 };

struct twin_highlight {
    double x, y;   /* position, pixels from the top left corner */
    double power;  /* luminance, in units of white times pixels */
    double rgb[3]; /* colour, scaled to luminance 1 */
    /* sum of the variances of the light along x and y, pixels^2 */
    double variance;
    int n; /* number of squares of 8 x 8 pixels in the highlight */
};

/* Sets FOUND[TWIN_HIGHLIGHTS] to the highlights in VIEW, sorted by descending
 * brightness. Returns their number, or -1 without memory. */
int reference_find_highlights(const struct twin *twin,
                              const struct twin_view *view,
                              struct twin_highlight *found);

#endif
