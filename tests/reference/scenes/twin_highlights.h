/* SPDX-License-Identifier: MIT
 *
 * Highlights of a scene in double precision, by exact rays: what
 * glint/scene/highlights.h does in integers. */
#ifndef REFERENCE_SCENES_TWIN_HIGHLIGHTS_H
#define REFERENCE_SCENES_TWIN_HIGHLIGHTS_H

#include "reference/scenes/twin.h"

enum { TWIN_HIGHLIGHTS = 64 };

struct twin_highlight {
    double x, y;     /* pixels from the top left corner */
    double power;    /* luminance, white pixels */
    double rgb[3];   /* of luminance 1 */
    double variance; /* along both axes together, pixels^2 */
    int n;           /* squares of 8 x 8 pixels */
};

/* Sets FOUND[TWIN_HIGHLIGHTS] to the highlights that VIEW shows, the brightest
 * first. Returns how many there are; -1: there is no memory. */
int twin_highlights(const struct twin *twin, const struct twin_view *view,
                    struct twin_highlight *found);

#endif
