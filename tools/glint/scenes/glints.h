/* SPDX-License-Identifier: MIT
 *
 * glints.h - tracks the highlights of a scene over time and returns them as
 * lamps of the flare.
 *
 *     glints_open(&glints, width, height);
 *     n = glints_track_frame(&glints, scene, elapsed_us);  each picture
 *     level = glints_get_lamp(&glints, i, &view, focal_mm, &lamp);
 *     glints_close(&glints);
 *
 * Highlights are tracked like lamps in a picture: they fade in and out and do
 * not jump.
 */
#ifndef GLINT_TOOLS_SCENES_GLINTS_H
#define GLINT_TOOLS_SCENES_GLINTS_H

#include "glint/lamp_tracker.h"
#include "glint/scene/highlights.h"
#include "glint/setup.h"
#include "glint/view.h"

/* Max number of tracks: twice the max number of highlights, because as many
 * others may be fading out. */
enum { GLINTS_MAX = 2 * GLINT_SCENE_MAX_HIGHLIGHTS };

struct glints {
    struct glint_scene_highlight found[GLINT_SCENE_MAX_HIGHLIGHTS];
    struct glint_lamp_track track[GLINTS_MAX];
    /* number of highlights in the last picture; number of tracks */
    int n_found, n;

    /* Private. */
    struct glint_lamp_tracker *tracks;
    void *mem;
};

/* Initialises GLINTS for pictures of WIDTH x HEIGHT. Returns GLINT_E_MEMORY on
 * failure. */
enum glint_status glints_open(struct glints *glints, int width, int height);
void glints_close(struct glints *glints);

/* Finds the highlights in the picture of SCENE drawn last, and updates the
 * tracks. ELAPSED_US is the time since the previous picture; 0 means that the
 * picture is independent. Returns the number of lamps. */
int glints_track_frame(struct glints *glints, const struct glint_scene *scene,
                       int32_t elapsed_us);

/* Sets LAMP to highlight I as a lens of FOCAL_MM sees it. Returns the level of
 * the lamp: a fraction of its power while the lamp fades in or out, else 1. */
double glints_get_lamp(const struct glints *glints, int i,
                       const struct glint_view *view, double focal_mm,
                       struct glint_lamp *lamp);

#endif
