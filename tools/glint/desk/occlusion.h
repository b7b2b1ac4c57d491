/* SPDX-License-Identifier: MIT
 *
 * occlusion.h - what hides lamps: a mask that lets light through where it is
 * white, and the distance from the picture.
 *
 *     occlusion_open(&o, &error);                          once
 *     occlusion_apply(&o, frame, &view, focal_mm, lamps, n);
 *     occlusion_close(&o);
 *
 * A mask is a picture, a pattern of numbered pictures or a video in y4m. It is
 * as large as the picture, whatever its own size. Grey lets a fraction of the
 * light through, evenly from code 0 to the white of the codes;
 * off-screen it hides nothing. What a lamp gives is scaled by the mean of the
 * mask over its disc, 2 pixels of radius at least.
 */
#ifndef GLINT_TOOLS_DESK_OCCLUSION_H
#define GLINT_TOOLS_DESK_OCCLUSION_H

#include "formats/picture.h"
#include "glint/engine.h"
#include "video/y4m.h"

struct occlusion {
    const char *file; /* of the mask; NULL: none */
    /* Pixels off-screen at which a lamp has faded; 0: lamps do not
     * fade.
     */
    double fade_px;

    /* Private. */
    struct glint_image image; /* mask of the frame; no plane: none */
    double black, white;      /* codes */
    bool is_video, is_numbered, is_over;
    struct glint_y4m_reader video;
    long frame; /* number of the mask's frame, or -1 */
};

/* Opens the mask of O, whose file and fade_px are set. Errors are those of
 * glint_picture_load() and glint_y4m_reader_open(). */
enum glint_status occlusion_open(struct occlusion *o,
                                 struct glint_error *error);

/* Scales powers and levels of N LAMPS by the fraction of each that is in view
 * in frame FRAME. Frames rise; a mask that ends earlier stays as it was last,
 * and one that cannot be read is reported once. */
void occlusion_apply(struct occlusion *o, int frame,
                     const struct glint_view *view, double focal_mm,
                     struct glint_engine_lamp *lamps, int n);

void occlusion_close(struct occlusion *o);

#endif
