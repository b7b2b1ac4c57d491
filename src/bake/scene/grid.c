/* SPDX-License-Identifier: MIT */
#include "bake/scene/write_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Limits of a mesh's grid. CELLS_EACH: max number of cells per triangle.
 * REFS_EACH: max mean number of cells that list a triangle. A small mesh may
 * have more list entries: FEW_REFS / (number of objects) in total. Cells are
 * enlarged until both limits hold. So N triangles cost O(N), even if they
 * coincide. */
#define CELLS_EACH 2
#define REFS_EACH  64
#define FEW_REFS   (1 << 22)
/* Max mean number of triangles per cell; ordinary meshes have a few. A mesh
 * with more is rejected, as rays would be slow: a ray tests all triangles of a
 * cell. */
#define MOST_IN_CELL 4096

/* A vertex as stored in the file. Members that the mesh does not use are 0. */
struct corner {
    int32_t place[3], uv_q16[2], normal_q30[3];
};

/* state of converting the triangles of an object to a mesh */
struct mesher {
    const struct glint_description *scene;
    const struct glint_described_object *object;
    const struct glint_steps *steps;
    bool has_uv, has_normals;
    struct corner *corner;
    struct glint_scene_triangle *triangle;
    /* [n_slots]: hash table of vertices by content; entries are vertex indices
     * + 1, or 0 if free */
    uint32_t *slot;
    uint32_t n_slots, n_corners, n_triangles;
};

/* ----------------------------------------------------------------- corners */

static uint32_t compute_vertex_hash(const struct corner *c)
{
    const unsigned char *byte = (const unsigned char *)c;
    uint32_t h = 2166136261u;

    for (size_t i = 0; i < sizeof *c; i++)
        h = (h ^ byte[i]) * 16777619u;
    return h ^ h >> 15;
}

/* Returns the index of the vertex that equals C. Appends C if there is none. */
static uint32_t find_or_add_vertex(struct mesher *m, const struct corner *c)
{
    uint32_t at = compute_vertex_hash(c) & (m->n_slots - 1);

    while (m->slot[at]) {
        if (memcmp(&m->corner[m->slot[at] - 1], c, sizeof *c) == 0)
            return m->slot[at] - 1;
        at = (at + 1) & (m->n_slots - 1);
    }
    m->corner[m->n_corners] = *c;
    m->slot[at] = ++m->n_corners;
    return m->n_corners - 1;
}

/* Sets N to the unit normal of triangle T. Leaves N unchanged if T has no area,
 * which rounding can cause. */
static void compute_face_normal(const struct glint_described_triangle *t,
                                double n[3])
{
    double a[3], b[3], across[3], length;

    for (int i = 0; i < 3; i++) {
        a[i] = t->place[1][i] - t->place[0][i];
        b[i] = t->place[2][i] - t->place[0][i];
    }
    for (int i = 0; i < 3; i++)
        across[i] =
            a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    length = sqrt(across[0] * across[0] + across[1] * across[1] +
                  across[2] * across[2]);
    for (int i = 0; i < 3 && length > 1e-100; i++)
        n[i] = across[i] / length;
}

static bool has_triangle_area(const struct corner c[3])
{
    int64_t a[3], b[3];

    for (int i = 0; i < 3; i++) {
        a[i] = (int64_t)c[1].place[i] - c[0].place[i];
        b[i] = (int64_t)c[2].place[i] - c[0].place[i];
    }
    return a[1] * b[2] != a[2] * b[1] || a[2] * b[0] != a[0] * b[2] ||
           a[0] * b[1] != a[1] * b[0];
}

/* Converts the corners of triangle T to vertices C; in the file, v points down.
 * Subtracts an integer from large texture coordinates, which changes nothing,
 * as textures repeat. */
static void convert_triangle_corners(const struct mesher *m,
                                     const struct glint_described_triangle *t,
                                     struct corner c[3])
{
    double face[3] = {0, 1, 0};

    compute_face_normal(t, face);
    memset(c, 0, 3 * sizeof *c);
    for (int k = 0; k < 3; k++) {
        glint_steps_convert_position(m->steps, t->place[k], c[k].place);
        if (m->has_normals)
            glint_steps_convert_unit_vector(
                m->steps, t->has_normals ? t->normal[k] : face,
                c[k].normal_q30);
        for (int i = 0; m->has_uv && t->has_uv && i < 2; i++) {
            const double off =
                floor(fmin(t->uv[0][i], fmin(t->uv[1][i], t->uv[2][i])));
            const double x = t->uv[k][i] - (fabs(off) > 2 ? off : 0);

            c[k].uv_q16[i] = (int32_t)lrint(0x1p16 * (i ? 1 - x : x));
        }
    }
}

static void
convert_triangle_to_vertices(struct mesher *m,
                             const struct glint_described_triangle *t,
                             struct glint_scene_bake_report *report)
{
    struct glint_scene_triangle *to = &m->triangle[m->n_triangles];
    struct corner c[3];
    /* Vertices are clockwise as seen from outside; mirroring an axis reverses
     * their order. */
    const int second = m->steps->hand > 0 ? 1 : 2;

    convert_triangle_corners(m, t, c);
    if (!has_triangle_area(c)) {
        report->flat++;
        return;
    }
    to->vertex[0] = find_or_add_vertex(m, &c[0]);
    to->vertex[1] = find_or_add_vertex(m, &c[second]);
    to->vertex[2] = find_or_add_vertex(m, &c[3 - second]);
    to->material = t->material == m->object->material ? GLINT_SCENE_NONE
                                                      : (uint32_t)t->material;
    m->n_triangles++;
}

/* Converts all triangles of the object to vertices and indices. Returns false
 * if there is no memory. */
static bool convert_all_triangles(struct mesher *m,
                                  struct glint_scene_bake_report *report)
{
    const struct glint_described_triangle *t =
        m->scene->triangle + m->object->first_triangle;
    const uint32_t n = (uint32_t)m->object->n_triangles;

    for (uint32_t i = 0; i < n; i++) {
        m->has_normals |= t[i].has_normals;
        const struct glint_described_material *of =
            &m->scene->material[t[i].material];

        m->has_uv |= of->texture >= 0 || of->is_stone;
    }
    for (m->n_slots = 8; m->n_slots < 6 * n;)
        m->n_slots *= 2;
    m->corner = malloc((3 * (size_t)n + 1) * sizeof *m->corner);
    m->triangle = malloc(((size_t)n + 1) * sizeof *m->triangle);
    m->slot = calloc(m->n_slots, sizeof *m->slot);
    if (!m->corner || !m->triangle || !m->slot)
        return false;
    for (uint32_t i = 0; i < n; i++)
        convert_triangle_to_vertices(m, &t[i], report);
    return true;
}

/* -------------------------------------------------------------------- ball */

/* Sets LOW and HIGH to the bounding box of all vertices, and centre and radius
 * of MESH to their bounding sphere. */
static void compute_mesh_bounds(const struct mesher *m,
                                struct glint_scene_mesh *mesh, int32_t low[3],
                                int32_t high[3])
{
    double radius = 0;

    for (int i = 0; i < 3; i++) {
        low[i] = high[i] = m->n_corners ? m->corner[0].place[i] : 0;
        for (uint32_t k = 1; k < m->n_corners; k++) {
            const int32_t x = m->corner[k].place[i];

            low[i] = x < low[i] ? x : low[i];
            high[i] = x > high[i] ? x : high[i];
        }
        mesh->centre[i] = low[i] / 2 + high[i] / 2;
    }
    for (uint32_t k = 0; k < m->n_corners; k++) {
        double square = 0;

        for (int i = 0; i < 3; i++) {
            const double off = (double)m->corner[k].place[i] - mesh->centre[i];

            square += off * off;
        }
        radius = fmax(radius, square);
    }
    mesh->radius = (int32_t)ceil(sqrt(radius));
}

/* -------------------------------------------------------------------- grid */

/* Sets FROM and TO to the first and last cell, along each axis, of the box
 * around triangle T. The box is enlarged by GLINT_SCENE_MARGIN. */
static void find_cells_touched_by_triangle(const struct mesher *m,
                                           const struct glint_scene_mesh *mesh,
                                           const struct glint_scene_triangle *t,
                                           int32_t from[3], int32_t to[3])
{
    for (int i = 0; i < 3; i++) {
        const int32_t last = (int32_t)mesh->cells[i] - 1;
        int64_t low = INT64_MAX, high = INT64_MIN;

        for (int k = 0; k < 3; k++) {
            const int64_t x =
                (int64_t)m->corner[t->vertex[k]].place[i] - mesh->origin[i];

            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        low = low - GLINT_SCENE_MARGIN < 0 ? 0 : low - GLINT_SCENE_MARGIN;
        from[i] = (int32_t)(low >> mesh->cell_log2);
        to[i] = (int32_t)((high + GLINT_SCENE_MARGIN) >> mesh->cell_log2);
        from[i] = from[i] > last ? last : from[i];
        to[i] = to[i] > last ? last : to[i];
    }
}

/* Divides the box LOW .. HIGH into cells of 2^cell_log2 steps. Returns their
 * number; 0 if there are too many along an axis. */
static uint64_t divide_box_into_cells(struct glint_scene_mesh *mesh,
                                      const int32_t low[3],
                                      const int32_t high[3])
{
    uint64_t n = 1;

    for (int i = 0; i < 3; i++) {
        mesh->origin[i] = low[i];
        mesh->cells[i] =
            (uint32_t)(((int64_t)high[i] - low[i]) >> mesh->cell_log2) + 1;
        n *= mesh->cells[i] <= GLINT_SCENE_MAX_CELLS ? mesh->cells[i] : 0;
    }
    return n;
}

static uint64_t count_cell_list_entries(const struct mesher *m,
                                        const struct glint_scene_mesh *mesh)
{
    uint64_t sum = 0;

    for (uint32_t k = 0; k < m->n_triangles; k++) {
        int32_t from[3], to[3];
        uint64_t n = 1;

        find_cells_touched_by_triangle(m, mesh, &m->triangle[k], from, to);
        for (int i = 0; i < 3; i++)
            n *= (uint64_t)(to[i] - from[i] + 1);
        sum += n;
    }
    return sum;
}

/* Divides the box LOW .. HIGH into the smallest cells within the limits of
 * CELLS_EACH and REFS_EACH. Returns their number and sets REFS to the number of
 * list entries. */
static uint64_t choose_cell_size(const struct mesher *m,
                                 struct glint_scene_mesh *mesh,
                                 const int32_t low[3], const int32_t high[3],
                                 uint64_t *refs)
{
    const uint64_t most = CELLS_EACH * (uint64_t)mesh->n_triangles + 1;
    const uint64_t few = FEW_REFS / (uint64_t)m->scene->n_objects;
    uint64_t most_refs = REFS_EACH * (uint64_t)mesh->n_triangles;

    most_refs = most_refs < few ? few : most_refs;
    for (mesh->cell_log2 = 4;; mesh->cell_log2++) {
        const uint64_t n = divide_box_into_cells(mesh, low, high);

        *refs =
            n > 0 && n <= most ? count_cell_list_entries(m, mesh) : UINT64_MAX;
        if (*refs <= most_refs || mesh->cell_log2 == 28)
            return n;
    }
}

/* Lists the triangles of each cell. If REF is NULL, adds their number to
 * START[cell + 1]. Otherwise writes their indices to REF from START[cell] on,
 * and advances START[cell]. */
static void list_cell_triangles(const struct mesher *m,
                                const struct glint_scene_mesh *mesh,
                                uint32_t *start, uint32_t *ref)
{
    for (uint32_t i = 0; i < m->n_triangles; i++) {
        int32_t from[3], to[3];

        find_cells_touched_by_triangle(m, mesh, &m->triangle[i], from, to);
        for (int32_t z = from[2]; z <= to[2]; z++)
            for (int32_t y = from[1]; y <= to[1]; y++)
                for (int32_t x = from[0]; x <= to[0]; x++) {
                    const uint32_t cell =
                        ((uint32_t)z * mesh->cells[1] + (uint32_t)y) *
                            mesh->cells[0] +
                        (uint32_t)x;

                    if (ref)
                        ref[start[cell]++] = i;
                    else
                        start[cell + 1]++;
                }
    }
}

static bool write_triangle_grid(struct glint_draft *draft,
                                const struct mesher *m,
                                struct glint_scene_mesh *mesh,
                                const int32_t low[3], const int32_t high[3],
                                struct glint_scene_bake_report *report,
                                struct glint_error *error)
{
    uint64_t sum;
    const uint64_t n = choose_cell_size(m, mesh, low, high, &sum);
    uint32_t *start, *ref;

    if (sum > MOST_IN_CELL * n) {
        snprintf(error->text, sizeof error->text,
                 "mesh %s: too many of its %lu triangles lie in one place; "
                 "remove faces that coincide, cut polygons of many corners",
                 m->object->name, (unsigned long)mesh->n_triangles);
        return false;
    }
    start = calloc((size_t)n + 1, sizeof *start);
    ref = malloc(((size_t)sum + 1) * sizeof *ref);
    if (start && ref) {
        list_cell_triangles(m, mesh, start, NULL);
        for (uint64_t i = 1; i <= n; i++)
            start[i] += start[i - 1];
        mesh->start_at = glint_draft_append(draft, start, ((size_t)n + 1) * 4);
        list_cell_triangles(m, mesh, start, ref);
        mesh->ref_at = glint_draft_append(draft, ref, (size_t)sum * 4);
        report->cells += (int)n;
        report->refs += (int)sum;
    }
    free(start);
    free(ref);
    return start && ref;
}

/* ------------------------------------------------------------------ tables */

/* Appends a member of struct corner for all vertices: N numbers at OFFSET.
 * Returns the offset of the first number in the file. */
static uint32_t append_vertex_numbers(struct glint_draft *draft,
                                      const struct mesher *m, size_t offset,
                                      size_t n)
{
    const uint32_t at = (uint32_t)draft->bytes;

    for (uint32_t i = 0; i < m->n_corners; i++)
        glint_draft_append(draft, (const unsigned char *)&m->corner[i] + offset,
                           n * sizeof(int32_t));
    return at;
}

bool glint_grid_write_mesh(struct glint_draft *draft,
                           const struct glint_description *scene,
                           const struct glint_described_object *object,
                           const struct glint_steps *steps,
                           struct glint_scene_mesh *mesh,
                           struct glint_scene_bake_report *report,
                           struct glint_error *error)
{
    struct mesher m = {.scene = scene, .object = object, .steps = steps};
    int32_t low[3], high[3];
    bool good = convert_all_triangles(&m, report);

    *mesh = (struct glint_scene_mesh){0};
    if (good) {
        mesh->n_vertices = m.n_corners;
        mesh->n_triangles = m.n_triangles;
        compute_mesh_bounds(&m, mesh, low, high);
        mesh->vertex_at =
            append_vertex_numbers(draft, &m, offsetof(struct corner, place), 3);
        if (m.has_uv)
            mesh->uv_at = append_vertex_numbers(
                draft, &m, offsetof(struct corner, uv_q16), 2);
        if (m.has_normals)
            mesh->normal_at = append_vertex_numbers(
                draft, &m, offsetof(struct corner, normal_q30), 3);
        mesh->triangle_at = glint_draft_append(
            draft, m.triangle, m.n_triangles * sizeof *m.triangle);
        good = write_triangle_grid(draft, &m, mesh, low, high, report, error);
        report->vertices += (int)m.n_corners;
        report->triangles += (int)m.n_triangles;
    }
    free(m.corner);
    free(m.triangle);
    free(m.slot);
    return good;
}
