/* SPDX-License-Identifier: MIT
 *
 * What glint overlay says of its result: what was found, what was assumed, how
 * bright the flare came out, and what to do where that cannot be seen.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H

#include "overlay/overlay.h"

/* The light of the flare alone, 1 = white, largest channel. */
struct overlay_light {
    double peak; /* mean of the brightest thousandth of the pixels: of all
                    frames, the brightest */
    /* Mean over all pixels; of several frames, the mean of these. */
    double mean;
};

/* Returns the light of the flare. A single picture's is drawn once more, small,
 * and looked at; that of several is what the lens's response says. */
struct overlay_light overlay_light(const struct overlay *o);

/* One line, or two where nothing can be seen. */
void overlay_say(const struct overlay *o, const struct overlay_light *light,
                 FILE *to);

/* Members of a JSON object, without braces. */
void overlay_json(const struct overlay *o, const struct overlay_light *light,
                  FILE *to);

#endif
