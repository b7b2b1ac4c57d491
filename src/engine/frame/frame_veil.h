/* SPDX-License-Identifier: MIT
 *
 * Draws the veil of a frame, which is the light that the lens and the dirt on
 * it scatter over the picture. */
#ifndef GLINT_ENGINE_FRAME_FRAME_VEIL_H
#define GLINT_ENGINE_FRAME_FRAME_VEIL_H

#include <stdbool.h>

#include "engine/frame/front.h"
#include "glint/bake.h"
#include "glint/dials.h"
#include "veil/glare.h"

struct glint_frame;

struct glint_frame_veil {
    /* Scattered light as a fraction of all light; 0: none. glare: veiling glare
     * of the lens (ISO 9358), over the whole picture. haze: light that a
     * uniformly dirty front element scatters by 1 to 10 degrees. */
    double glare, haze;
    /* Dust, scratches or a mask on the front element, owned by the caller;
     * NULL: none. They scatter light as haze does, but only within the
     * out-of-focus discs of the dirt. */
    const struct glint_front_dirt *front;
    /* factor on the veil of a flare that is drawn without a picture; 0: use the
     * factor on the flare */
    double alone_gain;

    /* Private. */
    struct glint_veil *veil; /* NULL until the first veil is computed */
    void *mem;
    size_t bytes;   /* size of MEM, bytes */
    bool has_front; /* true: VEIL has memory for dirt on the front element */
    /* table: table of dirt on the front element; table_of, table_for: the dirt
     * and the optics for which it was computed */
    struct glint_front_table *table;
    const struct glint_front_dirt *table_of;
    struct glint_front_optics table_for;
    bool has_look; /* true: the light of the picture has been read for this
                      frame */
    bool is_set;   /* true: the veil has been computed for this frame */
};

/* Returns whether FRAME has glare, haze or dirt on the front element. */
bool glint_frame_has_veil(const struct glint_frame *frame);

/* Allocates the veil, and computes the table of dirt on the front element
 * unless there is one for the frame's optics. Does nothing if the frame has no
 * veil. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_veil_allocate(struct glint_frame *frame);

/* Reads the light of IMAGE, whose white has the linear light WHITE, for the
 * next frame. Only needed if that frame is drawn onto another picture;
 * otherwise drawing reads the picture itself. Does nothing without a veil.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_veil_read_picture(struct glint_frame *frame,
                                                const struct glint_image *image,
                                                double white);

/* Computes the veil from the light of LAMPS and of IMAGE. If a picture has been
 * read before, its light replaces that of IMAGE. Does nothing without a veil.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_veil_set_light(struct glint_frame *frame,
                                             const struct glint_lamp *lamps,
                                             int n,
                                             const struct glint_image *image);

/* Adds the veil of this frame times the factor TIMES to RGB,
 * [height][width][3], linear light. LINEAR_Q20, of the same size, is scratch
 * memory and is overwritten. Does nothing without a veil. */
void glint_frame_veil_add_to_rgb(struct glint_frame *frame, double times,
                                 int32_t *linear_q20, float *rgb);

/* Computes the veil of LAMPS in front of a black picture, and adds it, times
 * GAIN, to RGB, linear light. LINEAR_Q20 is scratch memory. */
enum glint_status glint_frame_veil_draw_alone(struct glint_frame *frame,
                                              const struct glint_lamp *lamps,
                                              int n, double gain,
                                              int32_t *linear_q20, float *rgb);

void glint_frame_veil_finish(struct glint_frame_veil *veil);

/* Returns the cost of drawing the veil of FRAME, in units of the cost of
 * drawing a pixel. */
double glint_frame_veil_estimate_cost_px(const struct glint_frame *frame);

#endif
