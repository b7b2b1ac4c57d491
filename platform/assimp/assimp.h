/* SPDX-License-Identifier: MIT
 *
 * assimp/assimp.h - PLY, STL, glTF and other meshes, through Open Asset Import.
 *
 *     if (!glint_assimp_read(&data, &bytes, "cup.ply", most, &error))
 *         ... the OBJ text data[bytes] ...; free(data);
 *
 * The library lives in a plug-in, glint-assimp.so, which is loaded when a mesh
 * first needs it. It reads some fifty formats and does not survive every file
 * that is damaged, so it runs in a child process, whose crash does no harm. The
 * child returns each mesh as an OBJ text, which glint's own reader of meshes
 * parses and checks.
 */
#ifndef GLINT_PLATFORM_ASSIMP_ASSIMP_H
#define GLINT_PLATFORM_ASSIMP_ASSIMP_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

/* Version of this interface. A plug-in of another version is refused. */
#define GLINT_ASSIMP_VERSION 1

struct glint_assimp {
    int version;

    /* Reads the mesh PATH and writes it to the descriptor FD, then closes FD:
     * the letter m and an OBJ text of v, vt, vn, usemtl and f lines; or, if
     * there is no mesh or it has more than MAX_TRIANGLES triangles, the letter
     * x and a line with the cause. Called in a child process. */
    void (*write)(int fd, const char *path, unsigned max_triangles);
};

/* Reads the mesh PATH as an OBJ text of at most MAX bytes into a malloc'ed
 * block, which the caller frees. Transforms of the file's nodes are applied,
 * polygons are cut into triangles, points and lines left out. Returns
 * GLINT_E_UNSUPPORTED if there is no plug-in or the mesh has more than MAX
 * bytes or MAX_TRIANGLES triangles, GLINT_E_FORMAT if PATH is not a mesh,
 * GLINT_E_IO or GLINT_E_MEMORY. */
enum glint_status glint_assimp_read(uint8_t **data, size_t *bytes,
                                    const char *path, size_t max,
                                    unsigned max_triangles,
                                    struct glint_error *error);

#endif
