/* SPDX-License-Identifier: MIT
 *
 * The result line of glint overlay: lamps found, settings, brightness of the
 * flare, and options that help if the flare is invisible. */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H

#include "overlay/overlay.h"

/* The light of the ghosts alone, or of the starburst or veil with --only; 1 =
 * white, largest channel. */
struct overlay_light {
    bool is_known; /* false for the starburst or veil over several frames */
    /* Linear light, 1 = white. Single picture: exceeded by 1/10000 of the
     * pixels. Several frames: mean of the brightest 1/1000 pixels of the
     * brightest frame. */
    double peak;
    /* Mean linear light over all pixels of all frames */
    double mean;
};

/* Returns the light of the drawn flare. For a single picture it is measured by
 * drawing the ghosts again at small size, unless the exposure did so already;
 * for several frames it is estimated from the lens's response. */
struct overlay_light overlay_measure_light(struct overlay *o);

/* Returns the number of frames that were drawn. */
int overlay_count_frames(const struct overlay *o);

/* Prints the result line, and a second one if the flare is invisible. */
void overlay_print_summary(const struct overlay *o,
                           const struct overlay_light *light, FILE *to);

/* Prints that no lamp was found; if IS_COPIED, that the file was copied; for a
 * single picture also the brightest candidate. */
void overlay_print_no_lamp_found(const struct drawing *drawing, bool is_copied,
                                 FILE *to);

/* Writes the result as members of a JSON object. */
void overlay_write_json(struct json_writer *json, const struct overlay *o,
                        const struct overlay_light *light);

#endif
