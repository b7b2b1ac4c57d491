/* SPDX-License-Identifier: MIT
 *
 * Stands in for loader.c in static programs, which cannot load a plug-in.
 */
#include "assimp/assimp.h"

#include "posix/error.h"

enum glint_status glint_assimp_read(uint8_t **data, size_t *bytes,
                                    const char *path, size_t max,
                                    unsigned max_triangles,
                                    struct glint_error *error)
{
    (void)max;
    (void)max_triangles;
    *data = NULL;
    *bytes = 0;
    return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                              "a static glint reads OBJ meshes alone");
}
