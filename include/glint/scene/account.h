/* SPDX-License-Identifier: MIT
 *
 * glint/scene/account.h - statistics of a scene's frame: what became of each
 * object, and its work.
 *
 *     glint_scene_begin(scene, &stats);
 *     glint_scene_account(scene, objects, &all, seen);
 *
 * Computes visibility and surfaces again, at about half the cost of a frame;
 * nothing is drawn. Linked only by programs that name it. */
#ifndef GLINT_SCENE_ACCOUNT_H
#define GLINT_SCENE_ACCOUNT_H

#include "glint/scene/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_scene_fate {
    GLINT_SCENE_DRAWN,
    GLINT_SCENE_OFF,     /* is not shown */
    GLINT_SCENE_BEHIND,  /* of the camera */
    GLINT_SCENE_OUTSIDE, /* of the picture; of a catcher, no shadow is on it */
    GLINT_SCENE_COVERED, /* by other objects */
    GLINT_SCENE_SMALL,   /* there is no pixel whose middle meets it */
    GLINT_SCENE_FATES
};

/* Work of a frame. */
enum glint_scene_item {
    GLINT_SCENE_TRIANGLES, /* entries in the lists of tiles */
    GLINT_SCENE_SAMPLED,   /* samples of pixels that see it */
    GLINT_SCENE_COVERING,  /* pixels that see it */
    GLINT_SCENE_SHADED,    /* times that a place is shaded */
    GLINT_SCENE_SHADOWS,   /* points of lights whose shadows are looked up */
    GLINT_SCENE_TEXELS,    /* texels read */
    GLINT_SCENE_LOOKUPS,   /* of an environment, by brushed metal */
    GLINT_SCENE_BOUNCED,   /* rays that continue from places shaded */
    GLINT_SCENE_ITEMS
};

struct glint_scene_part {
    enum glint_scene_fate fate;
    int by; /* COVERED: the object that covers most of it; else -1 */
    int64_t count[GLINT_SCENE_ITEMS];
};

/* Sets OBJECTS, [n_objects], to the statistics of each object in the frame that
 * was begun last, ALL to their sums (by: -1; covering: pixels that see
 * anything), and SEEN, [height][width] or NULL, to the object that the first
 * sample of each pixel sees, or -1. Rays that are bent are followed straight
 * on. */
void glint_scene_account(struct glint_scene *scene,
                         struct glint_scene_part *objects,
                         struct glint_scene_part *all, int16_t *seen);

/* Overlays of a recorded motion: number of shells, lines or box edges in the
 * picture, and pixels that each of them may touch. */
struct glint_scene_layered {
    int n;
    int64_t pixels;
};

/* Sets OF to that of the frame that was begun last, all 0 without a motion.
 * Kinds that are objects have none. */
void glint_scene_account_layers(struct glint_scene *scene,
                                struct glint_scene_layered of[GLINT_KINDS]);

/* Returns the object that hides most of light LIGHT from the camera, or -1. */
int glint_scene_hider(const struct glint_scene *scene, int light);

#ifdef __cplusplus
}
#endif

#endif
