/* SPDX-License-Identifier: MIT
 *
 * Parses the triangles of an OBJ file: v, vt, vn, f and usemtl.
 *
 *   in   the text, which may contain any bytes
 *   out  triangles, three corners each, and the names of their materials
 *
 * A face with more than three corners is split into a fan of triangles around
 * its first corner. Indices count from 1, or backwards from the last item if
 * negative. Other words, such as groups, smoothing and material libraries, are
 * skipped. A backslash at the end of a line joins the next line to it. Limits:
 * those of bake/scene/description.h, and 256 material names.
 */
#ifndef GLINT_BAKE_SCENE_MESH_H
#define GLINT_BAKE_SCENE_MESH_H

#include "glint/scene/description.h"

enum { GLINT_MESH_MAX_NAMES = 256 };

struct glint_mesh {
    int n_triangles, n_names;
    /* Owned. The MATERIAL of a triangle is an index of NAME, or -1; its
     * OBJECT is 0. */
    struct glint_described_triangle *triangle;
    char name[GLINT_MESH_MAX_NAMES][GLINT_DESCRIPTION_NAME_BYTES];
};

/* Parses TEXT[BYTES]; the caller frees mesh->triangle. On GLINT_E_LENS,
 * ERROR states file, line, column and cause. May return GLINT_E_MEMORY. */
enum glint_status glint_mesh_read(struct glint_mesh *mesh, const char *text,
                                  size_t bytes, const char *file_name,
                                  struct glint_error *error);

#endif
