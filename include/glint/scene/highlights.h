/* SPDX-License-Identifier: MIT
 *
 * glint/scene/highlights.h - highlights on the objects of a scene, as lamps for
 * the flare.
 *
 *     cfg.parts.highlights = &glint_scene_highlights;            once
 *     glint_scene_draw(scene, &image);                           each frame
 *     n = glint_scene_find_highlights(scene, found);
 *     n = glint_lamp_tracker_step(tracks, spots, n, us, ...);    so that none
 *                                                                jumps
 *
 * A pixel of an object counts with its linear light before saturation: fully
 * above a luminance of 2, in part above 1, so that highlights appear and vanish
 * gradually. Discs of lights (see glint_scene_lights()) and the background are
 * not highlights. Light is summed with its moments in squares of 8 x 8 pixels;
 * squares with light that touch are one highlight, and highlights whose middles
 * are within 12 pixels are. No result depends on the number of workers, the
 * order of jobs or the tile size. */
#ifndef GLINT_SCENE_HIGHLIGHTS_H
#define GLINT_SCENE_HIGHLIGHTS_H

#include "glint/lamps.h"
#include "glint/scene/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_SCENE_MAX_HIGHLIGHTS = 8,
    GLINT_SCENE_HIGHLIGHT_APART = 12 /* pixels */
};

struct glint_scene_highlight {
    /* Its power is its flux, up to 2^42 _q16; area is that of its squares; it
     * is as wide as its moments say, half a pixel at least. */
    struct glint_spot spot;
    int object; /* index of that whose pixel is the brightest */
};

/* Sets FOUND[GLINT_SCENE_MAX_HIGHLIGHTS] to the highlights of the picture drawn
 * last, the brightest first, as many as the configuration wants, and
 * returns their number. */
int glint_scene_find_highlights(const struct glint_scene *scene,
                                struct glint_scene_highlight *found);

#ifdef __cplusplus
}
#endif

#endif
