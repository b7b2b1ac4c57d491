/* SPDX-License-Identifier: MIT
 *
 * Boxes on the pupil that hold the rays of one angle and wavelength which get
 * through. */
#ifndef GLINT_BAKE_VISIBLE_BOXES_H
#define GLINT_BAKE_VISIBLE_BOXES_H

#include "bake/visible/visible.h"

/* Shrinks BOX to those rays of a grid that get through, and a cell around them.
 * Returns whether there are any. */
bool glint_boxes_shrink(const struct glint_visible *h,
                        const struct glint_path *path, double sine, int across,
                        int down, struct glint_pupil *box);

/* Finds the box at SINE wherever it is; returns whether there is one. */
bool glint_boxes_find(const struct glint_visible *h,
                      const struct glint_path *path, double sine,
                      struct glint_pupil *box);

/* Returns NEAR and what lies around it. */
struct glint_pupil glint_boxes_grown(const struct glint_pupil *near);

/* Finds the box at SINE, looking around NEAR first. */
bool glint_boxes_follow(const struct glint_visible *h,
                        const struct glint_path *path, double sine,
                        const struct glint_pupil *near,
                        struct glint_pupil *box);

#endif
