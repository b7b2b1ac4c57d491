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
    /* Light of the star over that of the lens: lamps' powers are multiplied by
     * the frame's scale and this. 0: none. */
    double share;
    /* Pixels of each lamp that the picture clips, the root of the mean square
     * of their distances from its middle, with all that its light has spread
     * to: its power is an estimate. 0, and NULL for all: the lamp is what it
     * says.
     */
    const double *seen_px;
    const double *level; /* share of each of these in its power; NULL: 1 */
    bool is_bare;  /* true: no picture shows the lamps, so their cores are drawn
                    */
    bool is_alone; /* true: the star is drawn without ghosts */

    /* Private. */
    struct glint_star_optics optics; /* optics for which the tables were made */
    struct glint_star_tables *tables;
    struct glint_star *star; /* the star is drawn once set; NULL: none */
    /* [max_lights]; of more than GLINT_STAR_MAX_LIGHTS the brightest are drawn
     */
    struct glint_star_light *light;
    void *mem;
    int max_lights;
    bool is_set; /* true: the star is set for this frame */
};

/* Sets the star of LAMPS times SCALE for pictures like IMAGE, and makes tables
 * if there are none for the frame's stop. Does nothing if the share is 0.
 * GLINT_E_MEMORY. */
enum glint_status glint_frame_star_set(struct glint_frame *frame,
                                       const struct glint_lamp *lamps, int n,
                                       double scale,
                                       const struct glint_image *image);

/* Takes room for the stars of N lamps and makes their tables, so that frames
 * take no memory. Without a share nothing is done. GLINT_E_MEMORY. */
enum glint_status glint_frame_star_hold(struct glint_frame *frame, int n);

/* Draws what the flare has binned and the star that was set. */
void glint_frame_paint(struct glint_frame *frame,
                       const struct glint_image *image);

/* Adds the star of LAMPS alone, times GAIN, to RGB, linear light into which
 * glint_frame_draw_alone() has drawn the ghosts. */
enum glint_status glint_frame_star_alone(struct glint_frame *frame,
                                         const struct glint_lamp *lamps, int n,
                                         double gain, int32_t *linear_q20,
                                         float *rgb);

void glint_frame_star_finish(struct glint_frame_star *star);

#endif
