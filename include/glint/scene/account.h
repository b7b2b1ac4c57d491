/* SPDX-License-Identifier: MIT
 *
 * glint/scene/account.h - what became of each object of a frame, and what
 * there was to do for it.
 *
 *     glint_scene_begin(scene, &stats);
 *     glint_scene_account(scene, objects, &all, seen);
 *
 * Finds again what the samples see, and the surfaces of that, which takes
 * about as long as half of a frame; nothing is drawn. A program that does not
 * name it does not link it. */
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

/* Items of a frame whose number decides its cost. */
enum glint_scene_item {
    GLINT_SCENE_TRIANGLES, /* entries in the lists of tiles */
    GLINT_SCENE_TOUCHED,   /* pixels of boxes of things, in each tile */
    GLINT_SCENE_LOOKED,    /* samples of the boxes of planes */
    GLINT_SCENE_ROWS,      /* of the boxes of balls, in each tile */
    GLINT_SCENE_SAMPLED,   /* of pixels, that see it */
    GLINT_SCENE_COVERING,  /* pixels that see it */
    GLINT_SCENE_SHADED,    /* times that a place is shaded */
    GLINT_SCENE_MESHED,    /* of these, on meshes */
    GLINT_SCENE_LIT,       /* places shaded, by each light in front of them */
    GLINT_SCENE_SHADOWS,   /* points asked of suns' lists of shadows */
    GLINT_SCENE_LISTED,    /* things that these list above the places */
    GLINT_SCENE_RAYS,      /* rays through the scene, to other lights and on */
    GLINT_SCENE_AIMED,     /* of these, to points of a lamp's disc */
    GLINT_SCENE_ASKED,     /* things that these ask */
    GLINT_SCENE_ENTERED,   /* meshes of these whose grids they enter */
    GLINT_SCENE_WALKED,    /* cells that they walk through there */
    GLINT_SCENE_TRIED,     /* triangles that these cells list */
    GLINT_SCENE_TEXELS,    /* texels read */
    GLINT_SCENE_SKIES,     /* places whose colour an environment lights */
    GLINT_SCENE_METALS,    /* places on brushed metal that it lights */
    GLINT_SCENE_FOURS,     /* fours of lookups of these, two levels each */
    GLINT_SCENE_NEAREST,   /* fours of lookups, one level each */
    GLINT_SCENE_LOBES,     /* places on brushed metal, by each light in front */
    GLINT_SCENE_BOUNCED,   /* rays that go on from places shaded */
    GLINT_SCENE_PASSED,    /* of these, through things */
    GLINT_SCENE_GATHERED,  /* texels of maps of stones that were lit, by each
                              light, and three times by what is around */
    GLINT_SCENE_SPREAD,    /* texels that light has spread to, by each texel of
                              a kernel's side, of all its ranks and planes */
    GLINT_SCENE_ITEMS
};

struct glint_scene_part {
    enum glint_scene_fate fate;
    int by; /* COVERED: the object that covers most of it; else -1 */
    int64_t count[GLINT_SCENE_ITEMS];
};

/* Sets OBJECTS, [n_objects], to what becomes of each of the frame that was
 * begun last, ALL to their sums (by: -1; covering: pixels that see anything),
 * and SEEN, [height][width] or NULL, to the object that the first sample of
 * each pixel sees, or -1. Rays that are bent are followed straight on. */
void glint_scene_account(struct glint_scene *scene,
                         struct glint_scene_part *objects,
                         struct glint_scene_part *all, int16_t *seen);

/* What is laid over the things of a recorded motion: how many shells, lines or
 * edges of the box are in the picture, and the pixels that these may touch, by
 * each of them. */
struct glint_scene_layered {
    int n;
    int64_t pixels;
};

/* Sets OF to that of the frame that was begun last, all 0 without a motion.
 * Kinds that are things have none. */
void glint_scene_account_layers(struct glint_scene *scene,
                                struct glint_scene_layered of[GLINT_KINDS]);

/* Returns the object that hides most of light LIGHT from the camera, or -1. */
int glint_scene_hider(const struct glint_scene *scene, int light);

#ifdef __cplusplus
}
#endif

#endif
