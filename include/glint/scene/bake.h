/* SPDX-License-Identifier: MIT
 *
 * glint/scene/bake.h - bakes the description of a scene to a file of
 * glint/scene/model.h.
 *
 *     glint_description_parse(&scene, ...);
 *     glint_scene_bake(&scene, "shop", key, &data, &bytes, &report, &error);
 *     glint_scene_open(&model, data, bytes, &reason);
 *
 * Positions become integers, in steps; a unit of the scene is 2^unit_log2
 * steps. All objects then lie within a quarter of GLINT_SCENE_SPAN (a 64th, if
 * there is a plane). The rest of the range is for changes of poses and for
 * planes. The same description gives the same bytes. */
#ifndef GLINT_SCENE_BAKE_H
#define GLINT_SCENE_BAKE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/scene/description.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Results of baking. */
struct glint_scene_bake_report {
    double step; /* size of a step, in units of the scene; coordinates are
                    rounded to it */
    /* Upper bound of the coordinates of objects, lamps and camera, units of the
     * scene. */
    double reach;
    int vertices, triangles, cells, refs; /* numbers of vertices, triangles,
                                             grid cells and their entries, in
                                             all meshes */
    int flat; /* number of triangles left out: their area in steps is 0 */
};

/* Bakes SCENE. The file stores KEY and the first 63 characters of NAME that are
 * a-z, A-Z, 0-9, '-' or '_'. *DATA is malloc'ed. On GLINT_E_LENS, ERROR names
 * the object that cannot be baked, e.g. as it is too small relative to the
 * scene. May return GLINT_E_MEMORY. */
enum glint_status glint_scene_bake(const struct glint_description *scene,
                                   const char *name, uint64_t key,
                                   unsigned char **data, size_t *bytes,
                                   struct glint_scene_bake_report *report,
                                   struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
