/* SPDX-License-Identifier: MIT
 *
 * occlusion.h - dims lamps: by a mask, which is white where light passes, and
 * by the distance of off-screen lamps from the image.
 *
 *     occlusion_open(&o, &error);                          once
 *     occlusion_dim_lamps(&o, frame, &view, focal_mm, lamps, n);
 *     occlusion_close(&o);
 *
 * A mask is an image, a numbered sequence of images or a y4m video. It is
 * stretched to the size of the image. The fraction of light that passes grows
 * linearly from 0 at code 0 to 1 at white. Off-screen the mask hides nothing. A
 * lamp is scaled by the mean of the mask over its disc, whose radius is at
 * least 2 pixels.
 */
#ifndef GLINT_TOOLS_DESK_OCCLUSION_H
#define GLINT_TOOLS_DESK_OCCLUSION_H

#include "formats/picture.h"
#include "glint/engine.h"
#include "video/y4m.h"

struct occlusion {
    const char *file; /* --mask: name of the mask file, or NULL */
    /* distance from the image border at which the light of an off-screen lamp
     * reaches 0, pixels; 0: no fading */
    double fade_px;

    /* Private. */
    /* mask of the current frame; planes are NULL if there is no mask */
    struct glint_image image;
    double black, white; /* mask codes at which no light and all light passes */
    bool is_video, is_numbered, is_over;
    struct glint_y4m_reader video;
    long frame; /* frame number of IMAGE; -1: none loaded yet */
};

/* Opens the mask of O, whose file and fade_px must be set. Errors are as of
 * glint_picture_load() and glint_y4m_reader_open(). */
enum glint_status occlusion_open(struct occlusion *o,
                                 struct glint_error *error);

/* Scales power and level of each of N LAMPS by the lamp's visible fraction in
 * FRAME. FRAME must increase from call to call. After the end of the mask its
 * last frame is used. A read error is reported once. */
void occlusion_dim_lamps(struct occlusion *o, int frame,
                         const struct glint_view *view, double focal_mm,
                         struct glint_engine_lamp *lamps, int n);

void occlusion_close(struct occlusion *o);

#endif
