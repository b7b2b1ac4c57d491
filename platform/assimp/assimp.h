/* SPDX-License-Identifier: MIT
 *
 * assimp/assimp.h - PLY, STL, glTF and other meshes, through Open Asset Import.
 *
 *     if (!glint_assimp_read(&data, &bytes, "cup.ply", most, &error))
 *         ... the OBJ text data[bytes] ...; free(data);
 *
 * The library lives in a plug-in, glint-assimp.so, which is loaded when a mesh
 * first needs it. It reads some fifty formats and does not survive every file
 * that is damaged, so it does that in a process of its own, which may fail. Its
 * meshes come as OBJ texts: so they pass the one reader of meshes that glint
 * has, with all of its checks.
 */
#ifndef GLINT_PLATFORM_ASSIMP_ASSIMP_H
#define GLINT_PLATFORM_ASSIMP_ASSIMP_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

/* Number of this interface. A plug-in with another number is refused. */
#define GLINT_ASSIMP_VERSION 1

struct glint_assimp {
    int version;

    /* Writes the triangles of the mesh PATH to the descriptor FD, which it
     * closes: a letter that is m and an OBJ text, v, vt, vn, usemtl and f; or x
     * and a line on why there is none. MAX_TRIANGLES at most. Called in a
     * process of its own. */
    void (*write)(int fd, const char *path, unsigned max_triangles);
};

/* Reads the mesh PATH as an OBJ text of at most MAX bytes into a malloc'ed
 * block, which the caller frees. Parts are where the file puts them together,
 * polygons are cut, points and lines left out. GLINT_E_UNSUPPORTED: there is no
 * plug-in, or what is more than MAX bytes or MAX_TRIANGLES; GLINT_E_FORMAT: it
 * is no mesh; GLINT_E_IO, GLINT_E_MEMORY. */
enum glint_status glint_assimp_read(uint8_t **data, size_t *bytes,
                                    const char *path, size_t max,
                                    unsigned max_triangles,
                                    struct glint_error *error);

#endif
