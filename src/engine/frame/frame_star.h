/* SPDX-License-Identifier: MIT
 *
 * Draws the starbursts of a frame, which are the diffraction of lamps by the
 * stop. A frame has tables for its stop, and a list of lamps in picture
 * coordinates. */
#ifndef GLINT_ENGINE_FRAME_FRAME_STAR_H
#define GLINT_ENGINE_FRAME_FRAME_STAR_H

#include <stdbool.h>

#include "engine/star/star_tables.h"
#include "glint/view.h"

struct glint_frame;

struct glint_frame_star {
    /* factor on the brightness of starbursts, in addition to the frame's scale;
     * 0: no starburst */
    double share;
    /* is_bare applies to lamps that are not in frame->known. Lamps in
     * frame->known have seen_px instead: above 0, the lamp's power is an
     * estimate that may be raised for the starburst; below 0, the lamp's core
     * is drawn. */
    bool is_bare;  /* true: the picture does not show the lamps, so the bright
                      cores of their starbursts are drawn, too */
    bool is_alone; /* true: the starburst is drawn without ghosts */

    /* Private. */
    struct glint_star_optics optics; /* the optics for which TABLES were made */
    struct glint_star_tables *tables;
    /* smear: diffraction by dirt in the stop; smear_mark: digest of that dirt,
     * 0 without dirt */
    struct glint_smear smear;
    uint64_t smear_mark;
    struct glint_star *star; /* NULL until the first starburst is drawn */
    /* [max_lights]: lights whose starbursts are drawn, at most
     * GLINT_STAR_MAX_LIGHTS, the brightest */
    struct glint_star_light *light;
    void *mem;
    size_t bytes;             /* size of MEM, bytes */
    int max_lights, n_lights; /* capacity of LIGHT, and number of lights of this
                                 frame */
    double pixels;            /* estimated number of pixels that the starburst
                                 lights */
    bool is_set; /* true: the starburst has been set for this frame */
};

/* Sets the starbursts of LAMPS for pictures of the format of IMAGE. SCALE is a
 * factor on the powers of the lamps. Makes the tables if there are none for the
 * frame's stop. Does nothing if frame->star.share is 0. Returns GLINT_E_MEMORY
 * on failure. */
enum glint_status glint_frame_star_set_lamps(struct glint_frame *frame,
                                             const struct glint_lamp *lamps,
                                             int n, double scale,
                                             const struct glint_image *image);

/* Allocates memory for the starbursts of N lamps and makes the tables, so that
 * drawing frames allocates nothing. Does nothing if frame->star.share is 0.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_star_allocate(struct glint_frame *frame, int n);

/* Returns the bytes that are allocated for the starburst of FRAME and for its
 * veil. */
size_t glint_frame_star_count_bytes(const struct glint_frame *frame);

/* Draws the binned flare onto IMAGE. Also draws the starburst and the veil, if
 * they have been set for this frame. */
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
