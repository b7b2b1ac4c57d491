/* SPDX-License-Identifier: MIT
 *
 * Parses the triangles of an OBJ file: lines v, vt, vn, f and usemtl.
 *
 *   in   the text, which may contain any bytes
 *   out  triangles, and the names of their materials
 *
 * A face with more than three corners is split into a fan of triangles around
 * its first corner. Indices count from 1, or, if negative, backwards from the
 * last item. Lines with other first words, such as groups, smoothing and
 * material libraries, are skipped. A backslash at the end of a line continues
 * the line. Limits: those of glint/scene/description.h, and 256 material
 * names.
 */
#ifndef GLINT_BAKE_SCENE_MESH_H
#define GLINT_BAKE_SCENE_MESH_H

#include "glint/scene/description.h"

enum { GLINT_MESH_MAX_NAMES = 256 };

struct glint_mesh {
    int n_triangles, n_names;
    /* The triangles, owned. Their material is an index into name, or -1; their
     * object is 0. */
    struct glint_described_triangle *triangle;
    char name[GLINT_MESH_MAX_NAMES][GLINT_DESCRIPTION_NAME_BYTES];
};

/* Parses TEXT[BYTES]. The caller frees mesh->triangle. On GLINT_E_LENS, ERROR
 * states file, line, column and cause. May return GLINT_E_MEMORY. */
enum glint_status glint_mesh_read(struct glint_mesh *mesh, const char *text,
                                  size_t bytes, const char *file_name,
                                  struct glint_error *error);

#endif
