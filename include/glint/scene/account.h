/* SPDX-License-Identifier: MIT
 *
 * glint/scene/account.h - statistics of a frame of a scene: why each object is
 * visible or not, and the work that it causes.
 *
 *     glint_scene_begin(scene, &stats);
 *     glint_scene_account(scene, objects, &all, seen);
 *
 * The functions compute visibility and surfaces of the frame again, at about
 * half the cost of a frame, and draw nothing. Only programs that call them link
 * them. */
#ifndef GLINT_SCENE_ACCOUNT_H
#define GLINT_SCENE_ACCOUNT_H

#include "glint/scene/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_scene_fate {
    GLINT_SCENE_DRAWN,
    GLINT_SCENE_OFF,    /* the object is not shown */
    GLINT_SCENE_BEHIND, /* the object is behind the camera */
    /* The object is off-screen; for a shadow catcher: no shadow falls on it. */
    GLINT_SCENE_OUTSIDE,
    GLINT_SCENE_COVERED, /* the object is hidden by other objects */
    GLINT_SCENE_SMALL,   /* the object is too small: it covers the middle of no
                            pixel */
    GLINT_SCENE_FATES
};

/* Types of work that are counted for each object of a frame. */
enum glint_scene_item {
    /* Entries of the object's triangles in the lists of all tiles. */
    GLINT_SCENE_TRIANGLES,
    /* Samples of pixels in which the object is visible. */
    GLINT_SCENE_SAMPLED,
    /* Pixels in which the object is visible. */
    GLINT_SCENE_COVERING,
    GLINT_SCENE_SHADED,  /* points of the object that are shaded */
    GLINT_SCENE_SHADOWS, /* sample points of lights to which shadow rays are
                            traced */
    GLINT_SCENE_TEXELS,  /* texels read for the object's textures and light
                            maps */
    GLINT_SCENE_LOOKUPS, /* lookups in an environment, for brushed metal */
    GLINT_SCENE_BOUNCED, /* reflected and transmitted rays that start on the
                            object */
    GLINT_SCENE_ITEMS
};

struct glint_scene_part {
    enum glint_scene_fate fate;
    /* For COVERED: index of the object that hides most of this object; else
     * -1. */
    int by;
    int64_t count[GLINT_SCENE_ITEMS];
};

/* Sets OBJECTS[n_objects] to the statistics of each object in the frame that
 * was begun last. Sets ALL to their sums; in ALL, BY is -1, and
 * GLINT_SCENE_COVERING counts pixels in which any object is visible. Sets SEEN,
 * [height][width] or NULL, to the index of the object that the first sample of
 * each pixel sees, or -1. Refracted rays are traced without refraction. */
void glint_scene_account(struct glint_scene *scene,
                         struct glint_scene_part *objects,
                         struct glint_scene_part *all, int16_t *seen);

/* Returns the approximate number of ray tests in the frame that was begun last.
 * Reflected, transmitted and shadow rays are tested against objects, cells of a
 * mesh's grid and triangles. The tests of about 2000 pixels are counted and
 * scaled to all pixels. The light of one source at a point counts as 4 tests, a
 * pixel of the box around a ball as 3. Ends early if there are more than MOST
 * tests, and returns a number above MOST. The result does not depend on the
 * processor or the number of threads. */
int64_t glint_scene_count_tests(struct glint_scene *scene, int64_t most);

/* Statistics of one type of overlay of a recorded motion: number of shells,
 * lines or box edges in the picture, and number of pixels that they may
 * cover. */
struct glint_scene_layered {
    int n;
    int64_t pixels;
};

/* Sets OF to the statistics of the overlays of the frame that was begun last,
 * one entry per enum glint_scene_kind. All are 0 without a recorded motion, and
 * for types that are drawn as objects, not as overlays. */
void glint_scene_account_layers(struct glint_scene *scene,
                                struct glint_scene_layered of[GLINT_KINDS]);

/* Returns the index of the object that hides most of light LIGHT from the
 * camera, or -1. */
int glint_scene_hider(const struct glint_scene *scene, int light);

#ifdef __cplusplus
}
#endif

#endif
