/* SPDX-License-Identifier: MIT
 *
 * Meshes of a baked scene: vertices in steps, each kept once, and a grid over
 * the triangles that says which of them a ray can meet. */
#ifndef GLINT_BAKE_SCENE_GRID_H
#define GLINT_BAKE_SCENE_GRID_H

#include "bake/scene/steps.h"
#include "bake/table/draft.h"
#include "glint/scene/bake.h"
#include "glint/scene/model.h"

/* Writes the tables of the triangles of OBJECT behind what is in DRAFT and sets
 * MESH to where they are. Adds to REPORT. Returns false without memory. */
bool glint_grid_write(struct glint_draft *draft,
                      const struct glint_description *scene,
                      const struct glint_described_object *object,
                      const struct glint_steps *steps,
                      struct glint_scene_mesh *mesh,
                      struct glint_scene_bake_report *report);

#endif
