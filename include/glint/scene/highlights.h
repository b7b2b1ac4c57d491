/* SPDX-License-Identifier: MIT
 *
 * glint/scene/highlights.h - finds highlights on the objects of a scene, as
 * lamps for the flare.
 *
 *     cfg.parts.highlights = &glint_scene_highlights;            once
 *     glint_scene_draw(scene, &image);                           each frame
 *     n = glint_scene_find_highlights(scene, found);
 *     n = glint_lamp_tracker_step(tracks, spots, n, us, ...);    so that none
 *                                                                jumps
 *
 * Pixels of objects are examined in linear light before saturation. Their light
 * counts completely above a luminance of 2, partly above 1, so that highlights
 * appear and vanish gradually. Discs of lights (see glint_scene_lights()) and
 * the background are not highlights. Light and its moments are summed in
 * squares of 8 x 8 pixels. Adjacent squares with light form a highlight;
 * highlights whose middles are within 12 pixels are merged. No result depends
 * on the number of workers, the order of jobs or the tile size. */
#ifndef GLINT_SCENE_HIGHLIGHTS_H
#define GLINT_SCENE_HIGHLIGHTS_H

#include "glint/lamps.h"
#include "glint/scene/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_SCENE_MAX_HIGHLIGHTS = 8,
    GLINT_SCENE_HIGHLIGHT_APART = 12 /* distance within which highlights are
                                        merged, pixels */
};

struct glint_scene_highlight {
    /* The highlight as a spot. power equals the flux, at most 2^42 _q16. area
     * is the area of the highlight's squares of pixels. Size and axes follow
     * from the moments of its light and are at least half a pixel. */
    struct glint_spot spot;
    int object; /* index of the object that the brightest pixel shows */
};

/* Sets FOUND[GLINT_SCENE_MAX_HIGHLIGHTS] to the highlights of the picture drawn
 * last, sorted by decreasing brightness. The configuration limits their number.
 * Returns the number of highlights. */
int glint_scene_find_highlights(const struct glint_scene *scene,
                                struct glint_scene_highlight *found);

#ifdef __cplusplus
}
#endif

#endif
