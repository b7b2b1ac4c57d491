/* SPDX-License-Identifier: MIT
 *
 * The line that glint overlay prints on its result: lamps found, settings,
 * brightness of the flare, and options that help if it cannot be seen.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_LINE_H

#include "overlay/overlay.h"

/* The light of the ghosts alone, 1 = white, largest channel; with --only
 * starburst or veil, of that. */
struct overlay_light {
    bool is_known; /* not of the starburst or the veil over several frames */
    /* Of a single picture, the light that 1/10000 of the pixels reach; of
     * several frames, the mean of the brightest 1/1000 of the brightest frame's
     * pixels */
    double peak;
    /* Mean over all pixels; of several frames, the mean of these. */
    double mean;
};

/* Returns the light of what is drawn. That of a single picture is measured by
 * drawing it once more, ghosts small, unless their exposure has done so; that
 * of several follows from the lens's response. */
struct overlay_light overlay_light(struct overlay *o);

/* Returns the number of frames that are in the output, without those before
 * the first of --frames. */
int overlay_count_frames(const struct overlay *o);

/* Prints one line, or two if nothing can be seen. */
void overlay_say(const struct overlay *o, const struct overlay_light *light,
                 FILE *to);

/* Prints that no lamp was found, and if IS_COPIED that the file was copied; of
 * a still picture also the brightest candidate. */
void overlay_say_none(const struct drawing *drawing, bool is_copied, FILE *to);

/* Writes members of an object. */
void overlay_json(struct json_writer *json, const struct overlay *o,
                  const struct overlay_light *light);

#endif
