/* SPDX-License-Identifier: MIT
 *
 * The starburst of a frame: tables for its stop, and the lamps in picture
 * coordinates. */
#ifndef GLINT_ENGINE_FRAME_FRAME_STAR_H
#define GLINT_ENGINE_FRAME_FRAME_STAR_H

#include <stdbool.h>

#include "engine/star/star_tables.h"
#include "glint/view.h"

struct glint_frame;

struct glint_frame_star {
    /* factor on the starburst: the powers of lamps are multiplied by the
     * frame's scale and by this; 0: no starburst */
    double share;
    /* For lamps in frame->known, seen_px applies instead: above 0, the power is
     * an estimate that may be raised for the starburst; below 0, the lamp's
     * core is drawn. */
    bool is_bare;  /* true: the lamps are not visible in a picture, so the cores
                      of their starbursts are drawn, too */
    bool is_alone; /* true: the starburst is drawn without ghosts */

    /* Private. */
    struct glint_star_optics optics; /* the optics for which TABLES were made */
    struct glint_star_tables *tables;
    /* diffraction by dirt in the stop, if any, and the digest of that dirt */
    struct glint_smear smear;
    uint64_t smear_mark;
    struct glint_star *star; /* NULL until the first starburst is drawn */
    /* [max_lights]: lights to draw; of more than GLINT_STAR_MAX_LIGHTS lights,
     * only the brightest */
    struct glint_star_light *light;
    void *mem;
    size_t bytes;             /* size of MEM, bytes */
    int max_lights, n_lights; /* capacity of LIGHT, and number of lights of this
                                 frame */
    double pixels;            /* estimated number of pixels that the starburst
                                 lights */
    bool is_set; /* true: the starburst has been set for this frame */
};

/* Sets the starburst of LAMPS, with powers times SCALE, for pictures of the
 * format of IMAGE. Makes the tables if there are none for the frame's stop.
 * Does nothing if share is 0. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_star_set_lamps(struct glint_frame *frame,
                                             const struct glint_lamp *lamps,
                                             int n, double scale,
                                             const struct glint_image *image);

/* Allocates memory for the starbursts of N lamps and makes the tables, so that
 * frames allocate nothing. Does nothing if share is 0. Returns GLINT_E_MEMORY
 * on failure. */
enum glint_status glint_frame_star_allocate(struct glint_frame *frame, int n);

/* Returns the bytes that are allocated for the starburst of FRAME and for its
 * veil. */
size_t glint_frame_star_count_bytes(const struct glint_frame *frame);

/* Draws the binned flare onto IMAGE, and the starburst and the veil if they are
 * set. */
void glint_frame_draw_passes(struct glint_frame *frame,
                             const struct glint_image *image);

/* Adds the starburst of LAMPS, times GAIN, to RGB, [height][width][3], linear
 * light. LINEAR_Q20, of the same size, is scratch memory and is overwritten. */
enum glint_status glint_frame_star_draw_alone(struct glint_frame *frame,
                                              const struct glint_lamp *lamps,
                                              int n, double gain,
                                              int32_t *linear_q20, float *rgb);

void glint_frame_star_finish(struct glint_frame_star *star);

#endif
