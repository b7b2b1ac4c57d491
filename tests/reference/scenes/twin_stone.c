/* SPDX-License-Identifier: MIT */
#include "reference/scenes/twin_stone.h"

#include <stdlib.h>
#include <string.h>

#include "glint/scene/translucent.h"
#include "glint/view.h"
#include "reference/scenes/twin_around.h"

enum { CHANNELS = 3 };

struct twin_map {
    /* index of the translucent material; -1: the object is not translucent */
    int material;
    int of; /* index of the medium among the translucent media of the scene */
    bool is_ball;
    int width, height;
    struct glint_translucent stone;
    /* meshes: [height][width] scene triangle of each texel; -1: no triangle */
    int *triangle;
    /* [height][width][3]: incident light, later replaced by the light that
     * leaves */
    double *light;
    double *work; /* [3][height][width]: scratch */
};

/* --------------------------------------------------- opening of light maps */

static int find_medium_material(const struct glint_description *s,
                                const struct glint_described_object *o)
{
    if (o->n_triangles == 0)
        return o->material >= 0 && s->material[o->material].is_stone
                   ? o->material
                   : -1;
    for (int i = 0; i < o->n_triangles; i++)
        if (s->material[s->triangle[o->first_triangle + i].material].is_stone)
            return s->triangle[o->first_triangle + i].material;
    return -1;
}

/* Returns twice the signed area of the triangle of texture point (U, V) and the
 * corners I and J of T. */
static double compute_edge_area(const struct glint_described_triangle *t, int i,
                                int j, double u, double v)
{
    return (t->uv[i][0] - u) * (t->uv[j][1] - v) -
           (t->uv[i][1] - v) * (t->uv[j][0] - u);
}

/* Sets SHARE to the barycentric coordinates of the centre of texel (X, Y) in T.
 * Returns whether the centre is inside T. */
static bool compute_barycentric(const struct twin_map *m,
                                const struct glint_described_triangle *t, int x,
                                int y, double share[3])
{
    const double u = (x + .5) / m->width, v = 1 - (y + .5) / m->height;
    bool inside = true;
    double sum = 0;

    for (int k = 0; k < 3; k++) {
        share[k] = compute_edge_area(t, (k + 1) % 3, (k + 2) % 3, u, v);
        sum += share[k];
    }
    for (int k = 0; k < 3; k++) {
        share[k] /= sum;
        inside = inside && share[k] >= 0;
        share[k] = fmax(share[k], 0);
    }
    sum = share[0] + share[1] + share[2];
    for (int k = 0; k < 3; k++)
        share[k] /= sum;
    return inside;
}

/* Assigns each texel the triangle that covers its centre. A texel just outside
 * a chart gets the triangle of a neighbouring texel. */
static void assign_triangles_to_texels(const struct glint_description *s,
                                       const struct glint_described_object *o,
                                       struct twin_map *m)
{
    const int n = m->width * m->height,
              rings = (int)m->stone.header->kernel / 2 + 2;
    int *before = malloc((size_t)n * sizeof *before);
    double share[3];

    for (int x = 0; x < n; x++) {
        m->triangle[x] = -1;
        for (int i = o->first_triangle;
             i < o->first_triangle + o->n_triangles && m->triangle[x] < 0; i++)
            if (s->triangle[i].material == m->material &&
                compute_barycentric(m, &s->triangle[i], x % m->width,
                                    x / m->width, share))
                m->triangle[x] = i;
    }
    for (int r = 0; before && r < rings; r++) {
        memcpy(before, m->triangle, (size_t)n * sizeof *before);
        for (int x = 0; x < n; x++)
            for (int k = 0; k < 9 && m->triangle[x] < 0; k++) {
                const int i = x % m->width + k % 3 - 1;
                const int j = x / m->width + k / 3 - 1;

                if (i >= 0 && i < m->width && j >= 0 && j < m->height)
                    m->triangle[x] = before[j * m->width + i];
            }
    }
    free(before);
}

static bool allocate_medium_map(const struct glint_description *s,
                                const struct glint_described_object *o,
                                struct twin_map *m)
{
    const struct glint_described_stone *stone =
        &s->stone[s->material[m->material].stone];
    const char *reason;
    size_t texels;

    if (glint_translucent_open(&m->stone, stone->data, stone->bytes, &reason) !=
        GLINT_OK)
        return false;
    m->of = s->material[m->material].stone;
    m->is_ball = o->kind == GLINT_DESCRIBED_SPHERE;
    m->height = 1 << m->stone.header->side_log2;
    m->width = m->height << m->is_ball;
    texels = (size_t)m->width * (size_t)m->height;
    m->light = calloc(CHANNELS * texels, sizeof *m->light);
    m->work = calloc(3 * texels, sizeof *m->work);
    m->triangle = calloc(texels, sizeof *m->triangle);
    if (!m->light || !m->work || !m->triangle)
        return false;
    if (!m->is_ball)
        assign_triangles_to_texels(s, o, m);
    return true;
}

enum glint_status reference_allocate_media_maps(struct twin *twin)
{
    const struct glint_description *s = twin->scene;

    if (s->n_stones == 0)
        return GLINT_OK;
    twin->map = calloc((size_t)s->n_objects, sizeof *twin->map);
    if (!twin->map)
        return GLINT_E_MEMORY;
    for (int i = 0; i < s->n_objects; i++) {
        twin->map[i].material = find_medium_material(s, &s->object[i]);
        if (twin->map[i].material >= 0 &&
            !allocate_medium_map(s, &s->object[i], &twin->map[i]))
            return GLINT_E_MEMORY;
    }
    return GLINT_OK;
}

void reference_free_media_maps(struct twin *twin)
{
    for (int i = 0; twin->map && i < twin->scene->n_objects; i++) {
        free(twin->map[i].light);
        free(twin->map[i].work);
        free(twin->map[i].triangle);
    }
    free(twin->map);
    twin->map = NULL;
}

/* ---------------------------------------------------------- incident light */

/* Returns the fraction of light that the surface transmits at an angle of
 * incidence of COSINE (Fresnel); 1 if the material has no Fresnel
 * reflection. */
static double
compute_surface_transmittance(const struct glint_described_material *m,
                              const struct twin_map *map, double cosine)
{
    const double n = map->stone.header->index_q16 / 65536.;
    const double g = sqrt(n * n - 1 + cosine * cosine);
    const double across = (cosine - g) / (cosine + g);
    const double along = (n * n * cosine - g) / (n * n * cosine + g);

    if (!m->fresnel)
        return 1;
    return cosine > 0 ? 1 - (across * across + along * along) / 2 : 0;
}

/* Sets HIT to the surface point of texel (X, Y). Returns false if no surface
 * has this texel. */
static bool compute_texel_hit(const struct twin *twin, int object, int x, int y,
                              struct twin_hit *hit)
{
    const struct glint_description *s = twin->scene;
    const struct glint_described_object *o = &s->object[object];
    const struct twin_map *m = &twin->map[object];

    *hit = (struct twin_hit){
        .object = object, .triangle = -1, .material = m->material};
    if (m->is_ball) {
        const double round = 2 * GLINT_PI * ((x + .5) / m->width - .5);
        const double down = GLINT_PI * (y + .5) / m->height;
        const double n[3] = {sin(round) * sin(down), cos(down),
                             (s->left_handed ? -1 : 1) * cos(round) *
                                 sin(down)};

        vec_rotate(o->turn, 1, n, hit->normal);
        memcpy(hit->shading, hit->normal, sizeof hit->normal);
        vec_add_scaled(o->at, o->radius, hit->normal, hit->place);
    } else {
        const int i = m->triangle[y * m->width + x];
        double share[3], at[3] = {0, 0, 0};

        if (i < 0)
            return false;
        compute_barycentric(m, &s->triangle[i], x, y, share);
        for (int k = 0; k < 3; k++)
            vec_add_scaled(at, share[k], s->triangle[i].place[k], at);
        vec_rotate(o->turn, 1, at, hit->place);
        vec_add_scaled(hit->place, 1, o->at, hit->place);
        hit->triangle = i;
        hit->uv[0] = share[1];
        hit->uv[1] = share[2];
        reference_complete_triangle_hit(twin, o, hit);
        if (vec_dot(hit->shading, hit->normal) < 0)
            vec_add_scaled(hit->shading, -2, hit->shading, hit->shading);
    }
    return true;
}

/* Returns the mean transmittance of the surface over all directions, weighted
 * by the cosine. */
static double
compute_mean_transmittance(const struct glint_described_material *m,
                           const struct twin_map *map)
{
    enum { N = 1000 };
    double sum = 0;

    for (int i = 0; i < N; i++)
        sum += 2 * (i + .5) / N *
               compute_surface_transmittance(m, map, (i + .5) / N) / N;
    return sum;
}

static void compute_incident_light_map(const struct twin *twin, int object)
{
    const struct glint_description *s = twin->scene;
    struct twin_map *m = &twin->map[object];
    const struct glint_described_material *of = &s->material[m->material];
    const double mean = compute_mean_transmittance(of, m);

    for (int i = 0; i < m->width * m->height; i++) {
        double *rgb = m->light + CHANNELS * (ptrdiff_t)i;
        struct twin_hit hit;

        rgb[0] = rgb[1] = rgb[2] = 0;
        if (!compute_texel_hit(twin, object, i % m->width, i / m->width, &hit))
            continue;
        reference_add_irradiance(twin, hit.shading, rgb);
        for (int c = 0; c < CHANNELS; c++)
            rgb[c] *= mean;
        for (int k = 0; k < s->n_lights; k++) {
            double to[3], light[3], share;
            const double facing = reference_compute_light_at_hit(
                twin, &hit, &s->light[k], to, light, &share);

            for (int c = 0; c < CHANNELS && facing > 0; c++)
                rgb[c] += share * facing *
                          compute_surface_transmittance(of, m, facing) *
                          light[c];
        }
    }
}

/* -------------------------------------------------------------- scattering */

static double read_texel_weight(const struct twin_map *m, int table, int x)
{
    const struct glint_translucent_header *h = m->stone.header;
    const int side = 1 << h->side_log2;
    const size_t i = (size_t)table * (size_t)(side * side) +
                     (size_t)(x / m->width % side * side + x % m->width % side);
    const bool is_signed = h->variant == GLINT_TRANSLUCENT_FACTORED;
    const uint8_t code = m->stone.code[i];

    return is_signed ? (int8_t)code / 128. : code / 256.;
}

/* Returns the index of the texel ACROSS columns to the right of texel FROM and
 * DOWN rows below it, or -1 outside the map. */
static int find_neighbour_texel(const struct twin_map *m, int from, int across,
                                int down)
{
    int x = from % m->width + across, y = from / m->width + down;

    if (m->is_ball) {
        if (y < 0 || y >= m->height) {
            y = y < 0 ? -1 - y : 2 * m->height - 1 - y;
            x += m->width / 2;
        }
        x = (x + m->width) % m->width;
    }
    return x < 0 || x >= m->width || y < 0 || y >= m->height ? -1
                                                             : y * m->width + x;
}

/* Convolves FROM with the kernel TAP along rows or columns, and adds the result
 * times SCALE to TO. */
static void convolve_map_along_axis(const struct twin_map *m,
                                    const double *from, const int16_t *tap,
                                    bool down, double scale, double *to)
{
    const int kernel = (int)m->stone.header->kernel, r = kernel / 2;

    for (int i = 0; i < m->width * m->height; i++)
        for (int k = 0; k < kernel; k++) {
            const int at =
                find_neighbour_texel(m, i, down ? 0 : r - k, down ? r - k : 0);

            if (at >= 0)
                to[i] += scale * tap[k] * from[at];
        }
}

/* Scatters the light in WORK[0] by term P (a "plane" of the baked fit) and adds
 * the result to channel C of OUT. */
static void add_light_of_scattering_term(struct twin_map *m, int c, int p,
                                         double *out)
{
    const struct glint_translucent_header *h = m->stone.header;
    const int n = m->width * m->height, side = 1 << h->side_log2;
    const bool is_factored = h->variant == GLINT_TRANSLUCENT_FACTORED;
    double *row = m->work + n, *sum = m->work + 2 * (ptrdiff_t)n;

    memset(sum, 0, (size_t)n * sizeof *sum);
    for (uint32_t r = 0; r < h->rank; r++) {
        const uint32_t i =
            ((uint32_t)c * h->n_planes + (uint32_t)p) * h->rank + r;
        const int16_t *tap = m->stone.tap + 2 * (size_t)i * h->kernel;

        memset(row, 0, (size_t)n * sizeof *row);
        convolve_map_along_axis(m, m->work, tap, false,
                                ldexp(1, -(int)m->stone.shift[i]), row);
        convolve_map_along_axis(m, row, tap + h->kernel, true, 1, sum);
    }
    for (int x = 0; x < n; x++) {
        const int table = is_factored ? c * (int)h->n_planes + p : c;

        if (m->stone.cluster && m->stone.cluster[x / m->width % side * side +
                                                 x % m->width % side] != p)
            continue;
        out[CHANNELS * (ptrdiff_t)x] += read_texel_weight(m, table, x) * sum[x];
    }
}

static void scatter_light_by_baked_terms(struct twin_map *m)
{
    const struct glint_translucent_header *h = m->stone.header;
    const int n = m->width * m->height;

    for (int c = 0; c < CHANNELS; c++) {
        for (int x = 0; x < n; x++) {
            m->work[x] = m->light[CHANNELS * (ptrdiff_t)x + c];
            if (m->stone.cluster)
                m->work[x] *= read_texel_weight(m, CHANNELS + c, x);
            m->light[CHANNELS * (ptrdiff_t)x + c] = 0;
        }
        for (uint32_t p = 0; p < h->n_planes; p++)
            add_light_of_scattering_term(m, c, (int)p, m->light + c);
        for (int x = 0; x < n; x++) {
            double *to = &m->light[CHANNELS * (ptrdiff_t)x + c];

            *to = fmax(*to, 0) * glint_real_value(h->gain[c]);
        }
    }
}

static void scatter_light_by_exact_rows(const struct glint_scatter_rows *rows,
                                        struct twin_map *m)
{
    const size_t n = CHANNELS * (size_t)m->width * (size_t)m->height;

    memcpy(m->work, m->light, n * sizeof *m->light);
    glint_scatter_light_rows(rows, m->work, m->light);
}

void reference_compute_media_maps(const struct twin *twin)
{
    for (int i = 0; twin->map && i < twin->scene->n_objects; i++) {
        struct twin_map *m = &twin->map[i];

        if (m->material < 0)
            continue;
        compute_incident_light_map(twin, i);
        if (twin->rows && !m->is_ball)
            scatter_light_by_exact_rows(&twin->rows[m->of], m);
        else
            scatter_light_by_baked_terms(m);
    }
}

/* ------------------------------------------------------- light that leaves */

/* Returns the reflectance of the coat divided by its reflectance at normal
 * incidence. PASSED: transmittance of the coat; the coat reflects the rest. The
 * ratio is limited so that no channel reflects more than 1. */
static double compute_coat_reflectance(const struct glint_described_material *m,
                                       const struct twin_map *map,
                                       double passed)
{
    const double ahead = 1 - compute_surface_transmittance(m, map, 1);
    const double most = fmax(m->metal[0], fmax(m->metal[1], m->metal[2]));

    if (!m->is_metal || ahead <= 0)
        return 1;
    return fmin((1 - passed) / ahead, 1 / most);
}

void reference_add_medium_light(const struct twin *twin,
                                const struct twin_hit *hit,
                                const double toward[3], double rgb[3])
{
    const struct twin_map *m = &twin->map[hit->object];
    const struct glint_described_material *of =
        &twin->scene->material[hit->material];
    const double x = hit->uv[0] * m->width - .5;
    const double y = (1 - hit->uv[1]) * m->height - .5;
    const double out =
        compute_surface_transmittance(of, m, -vec_dot(toward, hit->shading));

    for (int c = 0; c < CHANNELS; c++)
        rgb[c] *= compute_coat_reflectance(of, m, out);
    for (int k = 0; k < 4; k++) {
        const double left = floor(x), top = floor(y);
        const double share =
            (k & 1 ? x - left : 1 - x + left) * (k & 2 ? y - top : 1 - y + top);
        int i = (int)left + (k & 1), j = (int)top + (k >> 1);

        j = j < 0 ? 0 : j >= m->height ? m->height - 1 : j;
        if (m->is_ball)
            i = (i + m->width) % m->width;
        i = i < 0 ? 0 : i >= m->width ? m->width - 1 : i;
        for (int c = 0; c < CHANNELS; c++)
            rgb[c] += share * out * of->colour[c] *
                      m->light[CHANNELS * (ptrdiff_t)(j * m->width + i) + c];
    }
}
