/* SPDX-License-Identifier: MIT */
#include "support/models/scene_builder.h"

#include "base/blob.h"
#include "support/test.h"

enum { ONE_Q30 = 1 << 30 };

enum glint_status scene_read_mesh_text(void *text, const char *name,
                                       uint8_t **data, size_t *bytes,
                                       struct glint_error *error)
{
    (void)name;
    (void)error;
    *data = (uint8_t *)strdup(*(const char *const *)text);
    assert_non_null(*data);
    *bytes = strlen((char *)*data);
    return GLINT_OK;
}

void scene_begin_header(struct scene_file *s)
{
    memset(s, 0, sizeof *s - sizeof s->data);
    s->header.magic = GLINT_SCENE_MAGIC;
    s->header.version = GLINT_SCENE_VERSION;
    strcpy(s->header.name, "test");
    s->header.unit_log2 = 16;
    for (int k = 0; k < 3; k++)
        s->header.camera.axis_q30[k][k] = ONE_Q30;
    s->header.camera.tan_x_q24 = 1 << 24;
    s->tables = sizeof s->header;
}

/* Appends FROM[BYTES] to the data section, which precedes the tables. Returns
 * its offset. */
static uint32_t append_scene_data(struct scene_file *s, const void *from,
                                  size_t bytes)
{
    const size_t at = s->tables;

    assert_true(at + bytes + 4 <= SCENE_BYTES / 2);
    memset((char *)s->data + at, 0, bytes + 4);
    memcpy((char *)s->data + at, from, bytes);
    s->tables = at + (bytes + 3) / 4 * 4;
    return (uint32_t)at;
}

uint32_t scene_add_material(struct scene_file *s, const char *name)
{
    struct glint_scene_material *m = &s->material[s->header.n_materials];

    *m = (struct glint_scene_material){.diffuse_q15 = 32768,
                                       .rgb_q15 = {32768, 32768, 32768},
                                       .power_q8 = 32 << 8,
                                       .index_q16 = 1 << 16,
                                       .texture = GLINT_SCENE_NONE,
                                       .ward = GLINT_SCENE_NONE};
    strcpy(m->name, name);
    return s->header.n_materials++;
}

static struct glint_scene_object *
append_object(struct scene_file *s, const char *name,
              enum glint_scene_object_kind kind, uint32_t material)
{
    struct glint_scene_object *o = &s->object[s->header.n_objects++];

    *o = (struct glint_scene_object){
        .kind = kind, .material = material, .turn_q30 = {ONE_Q30}};
    strcpy(o->name, name);
    return o;
}

uint32_t scene_add_sphere(struct scene_file *s, const char *name,
                          uint32_t material, int32_t x, int32_t y, int32_t z,
                          int32_t radius)
{
    struct glint_scene_object *o =
        append_object(s, name, GLINT_OBJECT_SPHERE, material);

    o->at[0] = x;
    o->at[1] = y;
    o->at[2] = z;
    o->radius = radius;
    return s->header.n_objects - 1;
}

uint32_t scene_add_plane(struct scene_file *s, const char *name,
                         uint32_t material, int32_t y)
{
    append_object(s, name, GLINT_OBJECT_PLANE, material)->at[1] = y;
    return s->header.n_objects - 1;
}

uint32_t scene_add_object(struct scene_file *s, const char *name,
                          uint32_t material, uint32_t mesh)
{
    append_object(s, name, GLINT_OBJECT_MESH, material)->mesh = mesh;
    return s->header.n_objects - 1;
}

static struct glint_scene_light *
add_light(struct scene_file *s, enum glint_scene_light_kind kind, double rgb)
{
    struct glint_scene_light *l = &s->light[s->header.n_lights++];

    *l = (struct glint_scene_light){.kind = kind};
    strcpy(l->name, "light");
    for (int k = 0; k < 3; k++)
        l->rgb[k] = glint_real_of(rgb);
    return l;
}

uint32_t scene_add_sun(struct scene_file *s, const int32_t toward_q30[3])
{
    memcpy(add_light(s, GLINT_LIGHT_SUN, 1)->toward_q30, toward_q30,
           3 * sizeof *toward_q30);
    return s->header.n_lights - 1;
}

uint32_t scene_add_lamp(struct scene_file *s, const int32_t at[3],
                        int32_t distance)
{
    const double units = ldexp(distance, -s->header.unit_log2);

    memcpy(add_light(s, GLINT_LIGHT_LAMP, units * units)->at, at,
           3 * sizeof *at);
    return s->header.n_lights - 1;
}

/* ------------------------------------------------------------------ meshes */

/* Sets LO and HI to the bounding box of triangle T, or of all N vertices if T
 * is NULL. */
static void compute_bounding_box(const int32_t (*at)[3], int n,
                                 const uint32_t *t, int32_t lo[3],
                                 int32_t hi[3])
{
    for (int k = 0; k < 3; k++) {
        lo[k] = hi[k] = at[t ? t[0] : 0][k];
        for (int i = 0; i < (t ? 3 : n); i++) {
            const int32_t x = at[t ? t[i] : (uint32_t)i][k];

            lo[k] = x < lo[k] ? x : lo[k];
            hi[k] = x > hi[k] ? x : hi[k];
        }
    }
}

static int is_triangle_in_cell(const struct glint_scene_mesh *m,
                               const int32_t (*at)[3], const uint32_t *t,
                               const int cell[3])
{
    int32_t lo[3], hi[3];
    int is = 1;

    compute_bounding_box(at, 3, t, lo, hi);
    for (int k = 0; k < 3; k++) {
        const int64_t from = m->origin[k] + ((int64_t)cell[k] << m->cell_log2);

        is &= from <= hi[k] + GLINT_SCENE_MARGIN &&
              from + (1 << m->cell_log2) >= lo[k] - GLINT_SCENE_MARGIN;
    }
    return is;
}

static void write_triangle_grid(struct scene_file *s,
                                struct glint_scene_mesh *m,
                                const int32_t (*at)[3],
                                const uint32_t (*triangle)[3])
{
    const uint32_t cells = m->cells[0] * m->cells[1] * m->cells[2];
    uint32_t *start = malloc((cells + 1) * sizeof *start), n = 0;
    uint32_t *ref = malloc(SCENE_BYTES);

    assert_true(start && ref);
    for (uint32_t c = 0; c < cells; c++) {
        const int cell[3] = {(int)(c % m->cells[0]),
                             (int)(c / m->cells[0] % m->cells[1]),
                             (int)(c / m->cells[0] / m->cells[1])};

        start[c] = n;
        for (uint32_t t = 0; t < m->n_triangles; t++)
            if (is_triangle_in_cell(m, at, triangle[t], cell))
                ref[n++] = t;
        assert_true(n < SCENE_BYTES / 4);
    }
    start[cells] = n;
    m->start_at = append_scene_data(s, start, (cells + 1) * sizeof *start);
    m->ref_at = append_scene_data(s, ref, n * sizeof *ref);
    free(start);
    free(ref);
}

/* Chooses a cell size that gives about one cell per triangle. */
static void choose_grid_cell_size(struct glint_scene_mesh *m,
                                  const int32_t lo[3], const int32_t hi[3])
{
    double volume = 1;

    for (int k = 0; k < 3; k++)
        volume *= fmax(16, (double)hi[k] - lo[k]);
    m->cell_log2 =
        (uint32_t)fmax(2, floor(log2(cbrt(volume / (1 + m->n_triangles)))));
    for (int k = 0; k < 3; k++) {
        m->origin[k] = lo[k];
        m->cells[k] = (uint32_t)((hi[k] - lo[k]) >> m->cell_log2) + 1;
        assert_true(m->cells[k] <= GLINT_SCENE_MAX_CELLS);
    }
}

uint32_t scene_add_mesh(struct scene_file *s, const int32_t (*at)[3],
                        const int32_t (*uv_q16)[2],
                        const int32_t (*normal_q30)[3], int n_vertices,
                        const uint32_t (*triangle)[3], int n_triangles)
{
    struct glint_scene_mesh *m = &s->mesh[s->header.n_meshes];
    struct glint_scene_triangle *t = malloc((size_t)n_triangles * sizeof *t);
    int32_t lo[3], hi[3];
    double radius = 0;

    assert_non_null(t);
    *m = (struct glint_scene_mesh){.n_vertices = (uint32_t)n_vertices,
                                   .n_triangles = (uint32_t)n_triangles};
    m->vertex_at = append_scene_data(s, at, (size_t)n_vertices * sizeof *at);
    if (uv_q16)
        m->uv_at =
            append_scene_data(s, uv_q16, (size_t)n_vertices * sizeof *uv_q16);
    if (normal_q30)
        m->normal_at = append_scene_data(
            s, normal_q30, (size_t)n_vertices * sizeof *normal_q30);
    for (int i = 0; i < n_triangles; i++) {
        memcpy(t[i].vertex, triangle[i], sizeof t[i].vertex);
        t[i].material = GLINT_SCENE_NONE;
    }
    m->triangle_at = append_scene_data(s, t, (size_t)n_triangles * sizeof *t);
    free(t);
    compute_bounding_box(at, n_vertices, NULL, lo, hi);
    for (int k = 0; k < 3; k++)
        m->centre[k] = (int32_t)(((int64_t)lo[k] + hi[k]) / 2);
    for (int i = 0; i < n_vertices; i++)
        radius =
            fmax(radius,
                 hypot(hypot(at[i][0] - m->centre[0], at[i][1] - m->centre[1]),
                       at[i][2] - m->centre[2]));
    m->radius = (int32_t)ceil(radius);
    choose_grid_cell_size(m, lo, hi);
    write_triangle_grid(s, m, at, triangle);
    return s->header.n_meshes++;
}

uint32_t scene_add_texture(struct scene_file *s, const uint8_t *rgb,
                           uint32_t w_log2, uint32_t h_log2)
{
    struct glint_scene_texture *t = &s->texture[s->header.n_textures];
    size_t w = (size_t)1 << w_log2, h = (size_t)1 << h_log2, at = 0, next;
    uint8_t *all = malloc(2 * 3 * w * h + 12);

    assert_non_null(all);
    memcpy(all, rgb, 3 * w * h);
    for (; w * h > 1; at = next) {
        const size_t w2 = w > 1 ? w / 2 : 1, h2 = h > 1 ? h / 2 : 1;
        const uint8_t *from = all + at;

        next = at + 3 * w * h;
        for (size_t i = 0; i < 3 * w2 * h2; i++) {
            const size_t c = i % 3, x = i / 3 % w2, y = i / 3 / w2;
            const size_t x0 = x * w / w2, y0 = y * h / h2;
            const size_t x1 = x0 + (w > 1), y1 = y0 + (h > 1);

            all[next + i] = (uint8_t)((from[3 * (y0 * w + x0) + c] +
                                       from[3 * (y0 * w + x1) + c] +
                                       from[3 * (y1 * w + x0) + c] +
                                       from[3 * (y1 * w + x1) + c] + 2) /
                                      4);
        }
        w = w2;
        h = h2;
    }
    *t = (struct glint_scene_texture){w_log2, h_log2,
                                      append_scene_data(s, all, at + 3)};
    free(all);
    return s->header.n_textures++;
}

/* ----------------------------------------------------------------- sealing */

static void append_table(struct scene_file *s, uint32_t *at, const void *table,
                         size_t bytes)
{
    *at = (uint32_t)s->bytes;
    memcpy((char *)s->data + s->bytes, table, bytes);
    s->bytes += bytes;
}

void scene_seal_checksum(struct scene_file *s)
{
    struct glint_scene_header *h = &s->header;

    s->bytes = s->tables;
    append_table(s, &h->light_at, s->light, h->n_lights * sizeof *s->light);
    append_table(s, &h->texture_at, s->texture,
                 h->n_textures * sizeof *s->texture);
    append_table(s, &h->material_at, s->material,
                 h->n_materials * sizeof *s->material);
    append_table(s, &h->mesh_at, s->mesh, h->n_meshes * sizeof *s->mesh);
    append_table(s, &h->object_at, s->object, h->n_objects * sizeof *s->object);
    append_table(s, &h->ward_at, s->ward, h->n_wards * sizeof *s->ward);
    append_table(s, &h->stone_at, s->stone, h->n_stones * sizeof *s->stone);
    append_table(s, &h->skin_at, s->skin, h->n_skins * sizeof *s->skin);
    /* The scene has no environment, so the environment begins at the end of the
     * file. */
    h->environment_at = (uint32_t)s->bytes;
    memcpy(s->data, h, sizeof *h);
    glint_blob_set_size_and_checksum(s->data, s->bytes);
}

struct glint_scene_model scene_open_model(struct scene_file *s)
{
    struct glint_scene_model model = {0};
    const char *reason = NULL;

    scene_seal_checksum(s);
    if (glint_scene_open(&model, s->data, s->bytes, &reason) != GLINT_OK)
        fail_msg("scene is rejected: %s", reason);
    return model;
}

int scene_make_ball(int rings, int sides, uint32_t (*corners)[3])
{
    const uint32_t first = (uint32_t)(rings * sides), last = first + 1;
    int n = 0;

    for (int j = 0; j <= rings; j++)
        for (int i = 0; i < sides; i++) {
            const uint32_t at = (uint32_t)(j * sides + i);
            const uint32_t next = (uint32_t)(j * sides + (i + 1) % sides);
            const uint32_t p = j ? at - (uint32_t)sides : first;
            const uint32_t q = j ? next - (uint32_t)sides : first;
            const uint32_t u = j < rings ? at : last;
            const uint32_t w = j < rings ? next : last;
            const uint32_t one[3] = {p, u, w}, two[3] = {p, w, q};

            if (j < rings)
                memcpy(corners[n++], one, sizeof one);
            if (j > 0)
                memcpy(corners[n++], two, sizeof two);
        }
    return n;
}

const struct glint_scene_parts scene_parts = {
    &glint_scene_meshes, &glint_scene_textures, &glint_scene_bounces,
    &glint_scene_wards,  &glint_scene_stones,   NULL,
    &glint_scene_motions};

struct glint_scene *scene_init_renderer(struct scene_file *file,
                                        const struct glint_scene_config *cfg,
                                        struct glint_scene_stats *stats)
{
    static void *mem;
    const struct glint_scene_model model = scene_open_model(file);
    const size_t bytes = glint_scene_bytes(cfg, &model);
    struct glint_scene_stats unread;
    struct glint_scene *s = NULL;

    assert_true(bytes > 0);
    free(mem);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_int_equal(glint_scene_init(&s, cfg, &model, mem, bytes - 1),
                     GLINT_E_MEMORY);
    assert_null(s);
    /* filled memory reveals members that remain unset */
    memset(mem, 0xa5, bytes);
    assert_ok(glint_scene_init(&s, cfg, &model, mem, bytes));
    glint_scene_begin(s, stats ? stats : &unread);
    return s;
}
