/* SPDX-License-Identifier: MIT
 *
 * Reads random bytes as an OBJ file. An accepted mesh must have triangles, all
 * numbers must be finite, and all materials must exist.
 *
 *     make fuzz FUZZ=mesh SECONDS=60
 */
#include <math.h>

#include "bake/scene/mesh.h"
#include "fuzz/fuzz.h"

static void check_triangle_indices(const struct glint_described_triangle *t,
                                   int n_names)
{
    require(t->material >= -1 && t->material < n_names);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            require(fabs(t->place[k][i]) <= 1e12);
            require(fabs(t->normal[k][i]) <= 1e12);
            require(fabs(t->uv[k][i % 2]) <= 1e12);
        }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct glint_mesh mesh;
    struct glint_error error = {""};

    if (glint_mesh_read(&mesh, (const char *)data, size, "fuzz.obj", &error) !=
        GLINT_OK) {
        require(strncmp(error.text, "fuzz.obj:", 9) == 0);
        return 0;
    }
    require(mesh.n_triangles > 0);
    for (int i = 0; i < mesh.n_triangles; i++)
        check_triangle_indices(&mesh.triangle[i], mesh.n_names);
    free(mesh.triangle);
    return 0;
}
