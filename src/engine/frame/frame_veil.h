/* SPDX-License-Identifier: MIT
 *
 * The veil of a frame: the fraction of all light that lens and dirt spread. */
#ifndef GLINT_ENGINE_FRAME_FRAME_VEIL_H
#define GLINT_ENGINE_FRAME_FRAME_VEIL_H

#include <stdbool.h>

#include "engine/frame/front.h"
#include "glint/bake.h"
#include "glint/dials.h"
#include "veil/glare.h"

struct glint_frame;

struct glint_frame_veil {
    /* Fractions of all light. GLARE: veiling glare of the lens (ISO 9358),
     * spread over the whole picture; HAZE: light that dirt on the front
     * element scatters by 1 to 10 degrees. 0: none. */
    double glare, haze;
    /* Dirt on the front element, which scatters light like haze, but in discs,
     * or NULL. The caller owns it. */
    const struct glint_front_dirt *front;
    /* Factor on the veil when it is drawn alone; 0: the factor on the flare. */
    double alone_gain;

    /* Private. */
    struct glint_veil *veil; /* NULL: there is none yet */
    void *mem;
    size_t bytes;   /* of MEM */
    bool has_front; /* true: VEIL has capacity for dirt on the front element */
    /* Table of FRONT, and the dirt from which it was made. */
    struct glint_front_table *table;
    const struct glint_front_dirt *table_of;
    struct glint_front_optics table_for;
    bool has_look; /* true: the picture has been read for this frame */
    bool is_set;   /* true: the veil is set for this frame */
};

/* Returns whether FRAME has a veil. */
bool glint_frame_has_veil(const struct glint_frame *frame);

/* Allocates the veil, and makes the table of dirt on the front element unless
 * there is a table for the frame's stop. Does nothing if there is no veil.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_veil_allocate(struct glint_frame *frame);

/* Reads the light of IMAGE, whose white is WHITE, for the next frame; needed
 * if that is drawn onto another picture, as otherwise drawing reads it. Does
 * nothing without a veil. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_veil_read_picture(struct glint_frame *frame,
                                                const struct glint_image *image,
                                                double white);

/* Sets the veil of LAMPS and of IMAGE, unless IMAGE was read before. Does
 * nothing without a veil. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_veil_set_light(struct glint_frame *frame,
                                             const struct glint_lamp *lamps,
                                             int n,
                                             const struct glint_image *image);

/* Adds the veil of this frame, times TIMES, to RGB, linear light.
 * LINEAR_Q20, of the same size, is scratch memory and is overwritten. Does
 * nothing without a veil. */
void glint_frame_veil_add_to_rgb(struct glint_frame *frame, double times,
                                 int32_t *linear_q20, float *rgb);

/* Adds the veil of LAMPS alone, times GAIN, to RGB, linear light. */
enum glint_status glint_frame_veil_draw_alone(struct glint_frame *frame,
                                              const struct glint_lamp *lamps,
                                              int n, double gain,
                                              int32_t *linear_q20, float *rgb);

void glint_frame_veil_finish(struct glint_frame_veil *veil);

/* Returns the cost of the veil of FRAME, as an equivalent number of pixels. */
double glint_frame_veil_cost_in_pixels(const struct glint_frame *frame);

#endif
