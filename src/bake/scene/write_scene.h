/* SPDX-License-Identifier: MIT
 *
 * Internal header of the writer of baked scenes, shared by steps.c, grid.c and
 * skin.c.
 */
#ifndef GLINT_BAKE_SCENE_WRITE_SCENE_H
#define GLINT_BAKE_SCENE_WRITE_SCENE_H

#include "bake/table/draft.h"
#include "glint/scene/bake.h"
#include "glint/scene/description.h"
#include "glint/scene/model.h"

/* Conversion from the description's coordinates (doubles) to those of a baked
 * scene (integers, left-handed axes): positions in steps, unit vectors in _q30.
 * In right-handed scenes z changes its sign. */
struct glint_steps {
    int unit_log2;
    double scale; /* steps per unit of the description, 2^unit_log2 */
    double hand;  /* factor on z: 1, or -1 in right-handed scenes */
};

/* Chooses the step size for SCENE. Sets REACH to the max coordinate of any
 * point, in units of the description. */
struct glint_steps
glint_steps_choose_size(const struct glint_description *scene, double *reach);

/* Converts position AT from units of the description to steps TO. */
void glint_steps_convert_position(const struct glint_steps *steps,
                                  const double at[3], int32_t to[3]);

/* Converts unit vector X to the baked scene's axes, _q30. */
void glint_steps_convert_unit_vector(const struct glint_steps *steps,
                                     const double x[3], int32_t to_q30[3]);

/* Converts unit quaternion TURN to the baked scene's axes, _q30. */
void glint_steps_convert_rotation(const struct glint_steps *steps,
                                  const double turn[4], int32_t to_q30[4]);

/* Sets TURN to the quaternion product A B: rotation B followed by A. */
void glint_turn_multiply_quaternions(const double a[4], const double b[4],
                                     double turn[4]);

/* Converts the triangles of OBJECT to a mesh: vertices in steps, each stored
 * once, and a uniform grid whose cells list the triangles that touch them.
 * Appends the tables to DRAFT, sets MESH to their offsets and adds to REPORT.
 * Needs O(N) time and memory for N triangles. Returns false if there is no
 * memory, or, with ERROR set, if too many triangles coincide. */
bool glint_grid_write_mesh(struct glint_draft *draft,
                           const struct glint_description *scene,
                           const struct glint_described_object *object,
                           const struct glint_steps *steps,
                           struct glint_scene_mesh *mesh,
                           struct glint_scene_bake_report *report,
                           struct glint_error *error);

/* Returns the index of the translucent material of OBJECT; -1: none. */
int glint_skin_find_material(const struct glint_description *scene,
                             const struct glint_described_object *object);

/* Writes the map of a translucent object, which assigns a surface point to each
 * texel, to DRAFT. Sets SKIN to this map. MESH: the object's mesh in DRAFT;
 * NULL: a sphere. Returns false if there is no memory. Returns false and sets
 * ERROR if too many surface points share a texel, or no texel has one. */
bool glint_skin_write_map(struct glint_draft *draft,
                          const struct glint_description *scene,
                          const struct glint_described_object *object,
                          const struct glint_scene_mesh *mesh, int material,
                          struct glint_scene_skin *skin,
                          struct glint_error *error);

#endif
