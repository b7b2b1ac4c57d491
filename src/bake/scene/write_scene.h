/* SPDX-License-Identifier: MIT
 *
 * What the writer of a baked scene calls: steps.c, grid.c, skin.c. */
#ifndef GLINT_BAKE_SCENE_WRITE_SCENE_H
#define GLINT_BAKE_SCENE_WRITE_SCENE_H

#include "bake/table/draft.h"
#include "glint/scene/bake.h"
#include "glint/scene/description.h"
#include "glint/scene/model.h"

/* Conversion from the description's axes and doubles to the left-handed steps
 * and _q30 units of a baked scene. Right-handed scenes change the sign of z. */
struct glint_steps {
    int unit_log2;
    double scale; /* 2^unit_log2 */
    double hand;  /* factor of z: 1, or -1 of right-handed scenes */
};

/* Chooses the steps of SCENE; sets REACH to how far anything there lies from
 * the origin. */
struct glint_steps glint_steps_of(const struct glint_description *scene,
                                  double *reach);

/* Sets TO to position AT in steps. */
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

/* Meshes of a baked scene: vertices in steps, each stored once, and a grid that
 * lists the triangles that a ray can meet in each cell. Appends the tables of
 * the triangles of OBJECT to DRAFT and sets MESH to their positions. Adds to
 * REPORT. Needs O(N) time and memory for N triangles. Returns false if there is
 * no memory, or with an ERROR if too many triangles coincide. */
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

/* Writes the table of SKIN, the surface point of each texel, for OBJECT with
 * material MATERIAL. MESH is its triangles in DRAFT, or NULL for a ball.
 * Returns false if there is no memory, or with an ERROR if two points of a mesh
 * have the same texel or no point has a texel. */
bool glint_skin_write(struct glint_draft *draft,
                      const struct glint_description *scene,
                      const struct glint_described_object *object,
                      const struct glint_scene_mesh *mesh, int material,
                      struct glint_scene_skin *skin, struct glint_error *error);

#endif
