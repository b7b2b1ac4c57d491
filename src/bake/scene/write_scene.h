/* SPDX-License-Identifier: MIT
 *
 * Internal header of the writer of baked scenes: steps.c, grid.c, skin.c.
 */
#ifndef GLINT_BAKE_SCENE_WRITE_SCENE_H
#define GLINT_BAKE_SCENE_WRITE_SCENE_H

#include "bake/table/draft.h"
#include "glint/scene/bake.h"
#include "glint/scene/description.h"
#include "glint/scene/model.h"

/* Conversion from doubles in the description's axes to integers of a baked
 * scene, whose axes are left-handed: positions in steps, unit vectors in
 * _q30. Right-handed scenes change the sign of z. */
struct glint_steps {
    int unit_log2;
    double scale; /* 2^unit_log2 */
    double hand;  /* factor of z: 1; -1 in right-handed scenes */
};

/* Chooses the step size of SCENE. Sets REACH to the max distance of any
 * point from the origin, along an axis. */
struct glint_steps glint_steps_of(const struct glint_description *scene,
                                  double *reach);

/* Converts position AT to steps. */
void glint_steps_place(const struct glint_steps *steps, const double at[3],
                       int32_t to[3]);

/* Converts unit vector X to _q30. */
void glint_steps_unit(const struct glint_steps *steps, const double x[3],
                      int32_t to_q30[3]);

/* Converts unit quaternion TURN to _q30. */
void glint_steps_turn(const struct glint_steps *steps, const double turn[4],
                      int32_t to_q30[4]);

/* Sets TURN to the product of quaternions A B: rotation B, then A. */
void glint_turn_after(const double a[4], const double b[4], double turn[4]);

/* Converts the triangles of OBJECT to a mesh: vertices in steps, each stored
 * once, and a uniform grid whose cells list the triangles that touch them.
 * Appends the tables to DRAFT, sets MESH to their offsets and adds to
 * REPORT. Needs O(N) time and memory for N triangles. Returns false if there
 * is no memory, or, with ERROR set, if too many triangles coincide. */
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
 * material MATERIAL. MESH is its mesh in DRAFT, or NULL for a sphere.
 * Returns false if there is no memory, or, with ERROR set, if too many
 * points share a texel or no point has a texel. */
bool glint_skin_write(struct glint_draft *draft,
                      const struct glint_description *scene,
                      const struct glint_described_object *object,
                      const struct glint_scene_mesh *mesh, int material,
                      struct glint_scene_skin *skin, struct glint_error *error);

#endif
