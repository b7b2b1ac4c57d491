/* SPDX-License-Identifier: MIT
 *
 * What the writer of a baked scene calls: steps.c, grid.c, skin.c. */
#ifndef GLINT_BAKE_SCENE_WRITE_SCENE_H
#define GLINT_BAKE_SCENE_WRITE_SCENE_H

#include "bake/table/draft.h"
#include "glint/scene/bake.h"
#include "glint/scene/description.h"
#include "glint/scene/model.h"

/* Conversion from the description's axes and doubles to those of a baked scene:
 * left-handed steps and units in _q30. Right-handed scenes change the sign of
 * z. */
struct glint_steps {
    int unit_log2;
    double scale; /* 2^unit_log2 */
    double hand;  /* factor of z: 1, or -1 of right-handed scenes */
};

/* Chooses the steps of SCENE; sets REACH to how far anything there lies from
 * the origin. */
struct glint_steps glint_steps_of(const struct glint_description *scene,
                                  double *reach);

/* Sets TO to place AT in steps. */
void glint_steps_place(const struct glint_steps *steps, const double at[3],
                       int32_t to[3]);

/* Sets TO_Q30 to unit vector X. */
void glint_steps_unit(const struct glint_steps *steps, const double x[3],
                      int32_t to_q30[3]);

/* Sets TO_Q30 to unit quaternion TURN. */
void glint_steps_turn(const struct glint_steps *steps, const double turn[4],
                      int32_t to_q30[4]);

/* Sets TURN to quaternion A after B. */
void glint_turn_after(const double a[4], const double b[4], double turn[4]);

/* Meshes of a baked scene: vertices in steps, each kept once, and a grid over
 * the triangles that states which of them a ray can meet. Writes the tables of
 * the triangles of OBJECT behind what is in DRAFT and sets MESH to where they
 * are. Adds to REPORT. Takes O(N) time and memory for N triangles. Returns
 * false without memory, or with an ERROR: too many triangles lie in one place.
 */
bool glint_grid_write(struct glint_draft *draft,
                      const struct glint_description *scene,
                      const struct glint_described_object *object,
                      const struct glint_steps *steps,
                      struct glint_scene_mesh *mesh,
                      struct glint_scene_bake_report *report,
                      struct glint_error *error);

/* Returns the index of the translucent material of OBJECT, or -1. */
int glint_skin_material(const struct glint_description *scene,
                        const struct glint_described_object *object);

/* Writes the table of SKIN, which place of it each texel is, of OBJECT, whose
 * triangles are MESH in DRAFT (of a ball NULL) and whose material is MATERIAL.
 * Returns false without memory, or with an ERROR: two places of a mesh have one
 * texel, or none has any. */
bool glint_skin_write(struct glint_draft *draft,
                      const struct glint_description *scene,
                      const struct glint_described_object *object,
                      const struct glint_scene_mesh *mesh, int material,
                      struct glint_scene_skin *skin, struct glint_error *error);

#endif
