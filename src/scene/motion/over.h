/* SPDX-License-Identifier: MIT
 *
 * Lays shells and lines over the pixels of a tile.
 *
 * A line is as wide as it is: what of a pixel it covers is the overlap of the
 * pixel with its width, at the distance of its middle, in q8. Widths below 3/4
 * of a pixel count as that. What shells cover is off by 2^-11 within them;
 * their rims are found by exact rays. The functions are those of struct
 * glint_scene_motions (visible.h). */
#ifndef GLINT_SCENE_MOTION_OVER_H
#define GLINT_SCENE_MOTION_OVER_H

#include "scene/motion/play.h"

enum { GLINT_LINE_MOST_HALF_Q8 = 1 << 16 /* half of the widest line */ };

struct glint_box glint_layers_touch(const struct glint_scene *s,
                                    struct glint_box tile);
void glint_layers_list(struct glint_scene_worker *w, int y);
int glint_layers_next(struct glint_scene_worker *w, int x);
void glint_layers_over(const struct glint_scene_worker *w, int x, int y,
                       struct glint_scene_sum *sum);

#endif
