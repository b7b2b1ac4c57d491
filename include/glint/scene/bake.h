/* SPDX-License-Identifier: MIT
 *
 * glint/scene/bake.h - bakes the description of a scene.
 *
 *     glint_description_parse(&scene, ...);
 *     glint_scene_bake(&scene, "shop", key, &data, &bytes, &report, &error);
 *     glint_scene_open(&model, data, bytes, &reason);
 *
 * Positions become integers: a unit of the scene is 2^unit_log2 steps, chosen
 * so that everything lies within a quarter of the run time's range (with a
 * plane, a 64th); the rest is for poses and planes. The same description gives
 * the same bytes. */
#ifndef GLINT_SCENE_BAKE_H
#define GLINT_SCENE_BAKE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/scene/description.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What baking did. Bytes are those of all tables of a kind. */
struct glint_scene_bake_report {
    double step;  /* of places, in units of the scene: they are off by half of
                     it at most, each way */
    double reach; /* how far objects, lamps and camera reach from the origin */
    int vertices, triangles, cells, refs; /* of all meshes */
    int flat; /* triangles left out: they have no area in steps */
};

/* Bakes SCENE. NAME is kept in the file, its first 63 characters of a-z, A-Z,
 * 0-9, '-' and '_', as is KEY. *DATA is malloc'ed. GLINT_E_LENS: ERROR names an
 * object that is too small for how far the scene reaches. GLINT_E_MEMORY. */
enum glint_status glint_scene_bake(const struct glint_description *scene,
                                   const char *name, uint64_t key,
                                   unsigned char **data, size_t *bytes,
                                   struct glint_scene_bake_report *report,
                                   struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
