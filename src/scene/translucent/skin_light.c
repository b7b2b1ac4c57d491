/* SPDX-License-Identifier: MIT
 *
 * The light that gets in at each texel of a map: of lights that reach it, and
 * from all around. */
#include "scene/translucent/scene_stone.h"
#include "scene/parts.h"

enum { CHANNELS = 3, ONE_Q30 = 1 << 30, MOST_VALUE = 32767 };

/* ------------------------------------------------------------------- around */

/* Adds to RGB_Q15 what the environment shows a white surface of NORMAL_Q30. */
static void add_around(const struct glint_scene *s, const int32_t normal_q30[3],
                       int32_t weight_q15, int32_t rgb_q15[3])
{
    static const int32_t white_q15[3] = {1 << 15, 1 << 15, 1 << 15};
    static const struct glint_scene_material even = {.diffuse_q15 = 1 << 15};
    const struct glint_scene_ray ray = {.at = {0}};
    struct glint_met_surface surface = {.material = &even};

    for (int k = 0; k < 3; k++)
        surface.normal_q30[k] = normal_q30[k];
    s->cfg.parts.wards->reflect(s, &ray, &surface, NULL, white_q15, weight_q15,
                                rgb_q15);
}

/* Normals over the faces of a cube; between them irradiance is below an eighth
 * more. */
int32_t glint_stone_around(const struct glint_scene *scene)
{
    enum { STEPS = 8 };
    int32_t most = 0;

    if (!scene->wards)
        return 0;
    for (int i = 0; i < 6 * STEPS * STEPS; i++) {
        const int face = i / (STEPS * STEPS), axis = face / 2;
        int64_t to[3];
        int32_t n_q30[3], rgb_q15[3] = {0, 0, 0};

        to[axis] = face & 1 ? -STEPS : STEPS;
        to[(axis + 1) % 3] = 2 * (i % STEPS) + 1 - STEPS;
        to[(axis + 2) % 3] = 2 * (i / STEPS % STEPS) + 1 - STEPS;
        glint_unit(to, n_q30);
        add_around(scene, n_q30, 1 << 15, rgb_q15);
        for (int c = 0; c < CHANNELS; c++)
            most = q_larger(most, rgb_q15[c]);
    }
    return q_clamp_sat((int64_t)most + most / 8, 0, GLINT_SCENE_MOST_LIGHT);
}

/* ----------------------------------------------------------------- exposure */

/* Returns the most that LIT makes of a white surface on object P: of a lamp at
 * the nearest place, but a sixteenth of the object's size away at least. */
static int32_t most_of(const struct glint_scene *s, const struct glint_lit *lit,
                       const struct glint_placed *p)
{
    int32_t toward_q30[3] = {0}, level_q15[3] = {0}, place[3], off[3];
    int64_t away;

    v3_minus(lit->at, p->centre, off);
    away = (int64_t)glint_root((uint64_t)v3_dot(off, off)) - p->reach;
    away = away > p->reach / 16 + 1 ? away : p->reach / 16 + 1;
    for (int k = 0; k < 3; k++)
        place[k] = lit->at[k];
    place[0] -= q_clamp_sat(away, 1, (1 << 29) - 1);
    glint_scene_light_at(s, lit, place, toward_q30, level_q15);
    return q_larger(level_q15[0], q_larger(level_q15[1], level_q15[2]));
}

void glint_stone_expose(const struct glint_scene *scene,
                        struct glint_stone_skin *skin)
{
    const struct glint_placed *p = &scene->placed[skin->of->object];
    int64_t most = scene->stones->around_q15;

    for (uint32_t i = 0; i < scene->n_lit; i++)
        most += most_of(scene, &scene->lit[i], p);
    skin->shift = 0;
    while (most >> skin->shift > MOST_VALUE && skin->shift < 15)
        skin->shift++;
}

/* ------------------------------------------------------------------ surfaces
 */

/* Sets SURFACE to texel (X, Y) of a ball. */
static void ball_surface(const struct glint_scene *s,
                         const struct glint_stone_skin *skin, int x, int y,
                         struct glint_met_surface *surface)
{
    const struct glint_placed *p = &s->placed[skin->of->object];
    const int32_t *round_q30 = skin->turn_q30[x];
    const int32_t *down_q30 = skin->turn_q30[skin->spread.width + y];
    const int32_t n_q30[3] = {q_mul(round_q30[1], down_q30[1], 30), down_q30[0],
                              -q_mul(round_q30[0], down_q30[1], 30)};

    v3_turn(&p->turn, n_q30, surface->normal_q30);
    surface->triangle = 0;
    for (int k = 0; k < 3; k++) {
        surface->face_q30[k] = surface->normal_q30[k];
        surface->place[k] =
            p->at[k] + q_mul(surface->normal_q30[k], p->radius, 30);
    }
}

/* Sets weights of the corners of the triangle of UV at texel (X, Y), held
 * inside; returns 0 if it has no area. Elements of UV are within +-2^24. */
static int weigh_texel(const int32_t *const uv_q16[3], int32_t u_q16,
                       int32_t v_q16, int32_t part_q30[3])
{
    int64_t edge[3], sum = 0, all = 0;

    for (int k = 0; k < 3; k++) {
        const int32_t *a = uv_q16[(k + 1) % 3], *b = uv_q16[(k + 2) % 3];

        edge[k] = ((int64_t)a[0] - u_q16) * ((int64_t)b[1] - v_q16) -
                  ((int64_t)a[1] - v_q16) * ((int64_t)b[0] - u_q16);
        all += edge[k];
    }
    for (int k = 0; k < 3; k++) {
        edge[k] = all < 0 ? -edge[k] : edge[k];
        edge[k] = edge[k] > 0 ? edge[k] : 0;
        sum += edge[k];
    }
    if (all == 0 || sum == 0)
        return 0;
    glint_weigh(edge, sum, part_q30);
    return 1;
}

/* The same of a mesh; returns 0 if the texel is none of it. */
static int mesh_surface(const struct glint_scene *s,
                        const struct glint_stone_skin *skin, int x, int y,
                        struct glint_met_surface *surface)
{
    const struct glint_scene_object *o = s->placed[skin->of->object].object;
    const struct glint_scene_mesh *m = &s->model.mesh[o->mesh];
    const unsigned char *file = (const unsigned char *)s->model.header;
    const struct glint_scene_triangle *t;
    const int32_t *uv_q16[3];
    struct glint_met met = {.object = skin->of->object, .t = 1};
    const int down = 15 - (int)skin->stone.header->side_log2;

    met.triangle = skin->triangle[y * skin->spread.width + x];
    if (met.triangle == GLINT_SCENE_NONE)
        return 0;
    t = (const struct glint_scene_triangle *)(const void *)(file +
                                                            m->triangle_at) +
        met.triangle;
    for (int k = 0; k < 3; k++)
        uv_q16[k] = (const int32_t *)(const void *)(file + m->uv_at) +
                    2 * (size_t)t->vertex[k];
    if (!weigh_texel(uv_q16, (2 * x + 1) << down, (2 * y + 1) << down,
                     met.spot.part_q30))
        return 0;
    return s->cfg.parts.meshes->surface(s, &met, surface);
}

/* -------------------------------------------------------------------- light */

/* Adds to RGB_Q15 what of LIT gets in at SURFACE. */
static void add_light(const struct glint_scene *s,
                      const struct glint_stone_skin *skin,
                      const struct glint_met_surface *surface,
                      const struct glint_lit *lit, int32_t rgb_q15[3])
{
    int32_t toward_q30[3] = {0}, level_q15[3] = {0}, cosine_q30, share_q15;

    if (!glint_scene_light_at(s, lit, surface->place, toward_q30, level_q15))
        return;
    cosine_q30 = v3_cosine_q30(toward_q30, surface->normal_q30);
    if (cosine_q30 <= 0)
        return;
    share_q15 = glint_scene_reaches(s, surface, lit);
    if (share_q15 == 0)
        return;
    share_q15 = q_mul(share_q15, glint_stone_passes(skin, cosine_q30), 15);
    for (int c = 0; c < CHANNELS; c++) {
        const int64_t light_q15 =
            ((int64_t)level_q15[c] * cosine_q30 >> 30) * share_q15 >> 15;

        rgb_q15[c] =
            q_clamp_sat(rgb_q15[c] + light_q15, 0, GLINT_SCENE_MOST_LIGHT);
    }
}

/* Sets SURFACE to texel (X, Y); returns 0 if it is none of the thing. */
static int find_surface(const struct glint_scene *s,
                        const struct glint_stone_skin *skin, int x, int y,
                        struct glint_met_surface *surface)
{
    *surface = (struct glint_met_surface){
        .material = &s->model.material[skin->material],
        .object = skin->of->object};
    if (!skin->spread.is_ball)
        return mesh_surface(s, skin, x, y, surface);
    ball_surface(s, skin, x, y, surface);
    return 1;
}

static void light_texel(const struct glint_scene *s,
                        const struct glint_stone_skin *skin, int x, int y,
                        int32_t rgb_q15[3])
{
    struct glint_met_surface surface;

    if (!find_surface(s, skin, x, y, &surface))
        return;
    for (uint32_t i = 0; i < s->n_lit; i++)
        add_light(s, skin, &surface, &s->lit[i], rgb_q15);
    if (s->wards)
        add_around(s, surface.normal_q30,
                   skin->fresnel ? skin->stone.header->mean_transmit_q15
                                 : 1 << 15,
                   rgb_q15);
}

void glint_stone_light_block(const struct glint_scene *scene,
                             const struct glint_stone_skin *skin, int i)
{
    const int x0 = i % skin->across * GLINT_BLOCK_WIDTH;
    const int y0 = i / skin->across * GLINT_BLOCK_HEIGHT;

    for (int y = y0; y < y0 + GLINT_BLOCK_HEIGHT; y++)
        for (int x = x0; x < x0 + GLINT_BLOCK_WIDTH; x++) {
            int32_t rgb_q15[3] = {0, 0, 0};

            light_texel(scene, skin, x, y, rgb_q15);
            for (int c = 0; c < CHANNELS; c++)
                skin->spread.light[c][y * skin->spread.width + x] =
                    (int16_t)q_clamp_sat(q_shift(rgb_q15[c], skin->shift), 0,
                                         MOST_VALUE);
        }
}
