/* SPDX-License-Identifier: MIT
 *
 * The starburst of a frame: tables of its stop, and its lamps as they lie in
 * the picture. */
#ifndef GLINT_ENGINE_FRAME_FRAME_STAR_H
#define GLINT_ENGINE_FRAME_FRAME_STAR_H

#include <stdbool.h>

#include "engine/star/star_tables.h"
#include "glint/view.h"

struct glint_frame;

struct glint_frame_star {
    /* Factor on the star: lamps' powers are multiplied by the frame's scale and
     * by this. 0: there is no star. */
    double share;
    /* By seen_px of a lamp in frame->known: above 0, the lamp's power is an
     * estimate that the star may raise; below 0, the lamp's core is drawn. */
    bool is_bare; /* true: no picture shows the lamps, so their cores are drawn,
                     too */
    bool is_alone; /* true: the star is drawn without ghosts */

    /* Private. */
    struct glint_star_optics optics; /* optics for which the tables were made */
    struct glint_star_tables *tables;
    /* Dirt in the stop, if any, and its version. */
    struct glint_smear smear;
    uint64_t smear_mark;
    struct glint_star *star; /* NULL: there is none yet */
    /* [max_lights]; if there are more than GLINT_STAR_MAX_LIGHTS, the brightest
     * are drawn */
    struct glint_star_light *light;
    void *mem;
    size_t bytes;             /* of MEM */
    int max_lights, n_lights; /* capacity for lights, and number of lights of
                                 this frame */
    double pixels;            /* pixels that its parts light */
    bool is_set;              /* true: the star is set for this frame */
};

/* Sets the star of LAMPS times SCALE for pictures like IMAGE, and makes tables
 * if there are none for the frame's stop. Does nothing if the fraction is 0.
 * GLINT_E_MEMORY. */
enum glint_status glint_frame_star_set_lamps(struct glint_frame *frame,
                                             const struct glint_lamp *lamps,
                                             int n, double scale,
                                             const struct glint_image *image);

/* Allocates the stars of N lamps and makes their tables, so that frames
 * allocate nothing. Does nothing if the fraction is 0. GLINT_E_MEMORY. */
enum glint_status glint_frame_star_allocate(struct glint_frame *frame, int n);

/* Returns the bytes that the star of FRAME holds, for its tables and its lamps,
 * and its veil. */
size_t glint_frame_star_count_bytes(const struct glint_frame *frame);

/* Draws the bins of the flare, and the star and the veil that are set, onto
 * IMAGE. */
void glint_frame_draw_passes(struct glint_frame *frame,
                             const struct glint_image *image);

/* Adds the star of LAMPS alone, times GAIN, to RGB, linear light into which
 * glint_frame_draw_flare_alone() has drawn the ghosts. */
enum glint_status glint_frame_star_draw_alone(struct glint_frame *frame,
                                              const struct glint_lamp *lamps,
                                              int n, double gain,
                                              int32_t *linear_q20, float *rgb);

void glint_frame_star_finish(struct glint_frame_star *star);

#endif
