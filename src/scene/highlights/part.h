/* SPDX-License-Identifier: MIT
 *
 * What the part of a scene for highlights does while a picture is drawn. */
#ifndef GLINT_SCENE_HIGHLIGHTS_PART_H
#define GLINT_SCENE_HIGHLIGHTS_PART_H

#include "base/arena.h"
#include "glint/scene/scene.h"

struct glint_highlight_state;

struct glint_scene_highlights {
    /* Takes the memory of the part; NULL while it is measured. */
    struct glint_highlight_state *(*carve)(const struct glint_scene *scene,
                                           struct glint_arena *arena);
    /* Begins a picture. */
    void (*begin)(struct glint_highlight_state *bright);
    /* Adds light of object OBJECT in the pixel whose middle is (X, Y), pixels
     * q8 from the top left corner: SHARE_Q4 of RGB_Q15. */
    void (*note)(struct glint_highlight_state *bright, uint32_t object,
                 int32_t x_q8, int32_t y_q8, const int32_t rgb_q15[3],
                 int share_q4);
};

#endif
