/* SPDX-License-Identifier: MIT
 *
 * assimp/assimp.h - reads PLY, STL, glTF and other meshes through Open Asset
 * Import (Assimp).
 *
 *     if (!glint_assimp_read_mesh(&data, &bytes, "cup.ply", most, &error))
 *         ... the OBJ text data[bytes] ...; free(data);
 *
 * Assimp is linked only to a plug-in, glint-assimp.so, which is loaded when a
 * mesh first needs it. Assimp reads some fifty formats and crashes on some
 * damaged files, so it runs in a child process. The child returns each mesh as
 * an OBJ text, which glint's own reader of meshes parses and checks. */
#ifndef GLINT_PLATFORM_ASSIMP_ASSIMP_H
#define GLINT_PLATFORM_ASSIMP_ASSIMP_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

/* Version of this interface. glint rejects plug-ins of other versions. */
#define GLINT_ASSIMP_VERSION 1

struct glint_assimp {
    int version;

    /* Reads the mesh file PATH, writes it to the descriptor FD and closes FD.
     * The output is the letter m and an OBJ text of v, vt, vn, usemtl and f
     * lines. If the file has no mesh, or one of more than MAX_TRIANGLES
     * triangles, the output is the letter x and a line with the cause. Called
     * in a child process. */
    void (*write)(int fd, const char *path, unsigned max_triangles);
};

/* Reads the mesh PATH as an OBJ text of at most MAX bytes into a malloc'ed
 * block, which the caller frees. Transforms of the file's nodes are applied,
 * polygons are cut into triangles, points and lines left out. Returns
 * GLINT_E_UNSUPPORTED if there is no plug-in or the mesh has more than MAX
 * bytes or MAX_TRIANGLES triangles, GLINT_E_FORMAT if PATH is not a mesh,
 * GLINT_E_IO or GLINT_E_MEMORY. */
enum glint_status glint_assimp_read_mesh(uint8_t **data, size_t *bytes,
                                         const char *path, size_t max,
                                         unsigned max_triangles,
                                         struct glint_error *error);

#endif
