/* SPDX-License-Identifier: MIT
 *
 * Prints the result of glint overlay in one line: lamps found, settings, and
 * brightness of the flare. If the flare is invisible, a second line names an
 * option that helps.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H

#include "overlay/overlay.h"

/* Light of the drawn flare: of the ghosts, or of the starburst or veil if
 * --only selects one of these. Linear, 1 = white, of the brightest colour
 * channel. */
struct overlay_light {
    /* whether the members below are known; false for the starburst or veil of
     * several frames */
    bool is_known;
    /* Peak light. For a single picture 1 / 10000 of the pixels exceed it. For
     * several frames: mean of the brightest 1 / 1000 of the pixels of the
     * brightest frame. */
    double peak;
    /* mean light over all pixels of all frames */
    double mean;
};

/* Returns the light of the drawn flare. For a single picture it draws the
 * ghosts again at a small size, unless the exposure has measured them already.
 * For several frames it estimates the light by the lens's response. */
struct overlay_light overlay_measure_light(struct overlay *o);

/* Returns the number of frames that were drawn. */
int overlay_count_frames(const struct overlay *o);

/* Prints the result line, and a second one if the flare is invisible. */
void overlay_print_summary(const struct overlay *o,
                           const struct overlay_light *light, FILE *to);

/* Prints that no lamp was found or given. If IS_COPIED, prints that the file
 * was copied. For a single picture, also prints the brightest regions that
 * could be lamps. */
void overlay_print_no_lamp_found(const struct drawing *drawing, bool is_copied,
                                 FILE *to);

/* Writes the result as members of a JSON object. */
void overlay_write_json(struct json_writer *json, const struct overlay *o,
                        const struct overlay_light *light);

#endif
