/* SPDX-License-Identifier: MIT
 *
 * Reads the triangles of an OBJ file: v, vt, vn, f and usemtl.
 *
 *   in   the text, which may hold anything
 *   out  triangles, three corners each, and the names of their materials
 *
 * Faces of more than three corners are cut into fans from the first. Corners
 * count from 1, or back from the last if negative. All other words are
 * skipped, as groups, smoothing and libraries of materials are; a backslash at
 * the end of a line joins the next to it. Limits: those of
 * bake/scene/description.h, and 256 names. */
#ifndef GLINT_BAKE_SCENE_MESH_H
#define GLINT_BAKE_SCENE_MESH_H

#include "glint/scene/description.h"

enum { GLINT_MESH_MAX_NAMES = 256 };

struct glint_mesh {
    int n_triangles, n_names;
    /* Malloc'ed. Of a triangle MATERIAL is an index of NAME, or -1; OBJECT is
     * 0. */
    struct glint_described_triangle *triangle;
    char name[GLINT_MESH_MAX_NAMES][GLINT_DESCRIPTION_NAME_BYTES];
};

/* Reads TEXT[BYTES]; the caller frees mesh->triangle. GLINT_E_LENS: ERROR
 * states file, line, column and cause. GLINT_E_MEMORY. */
enum glint_status glint_mesh_read(struct glint_mesh *mesh, const char *text,
                                  size_t bytes, const char *file_name,
                                  struct glint_error *error);

#endif
