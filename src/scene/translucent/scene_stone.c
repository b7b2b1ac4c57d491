/* SPDX-License-Identifier: MIT
 *
 * Light maps of translucent objects: allocates them, recomputes them for each
 * frame, and looks up their light. */
#include "base/compiler.h"
#include "base/divide.h"
#include "scene/mesh.h"
#include "scene/parts.h"
#include "scene/state.h"
#include "scene/translucent/spread.h"

enum {
    GLINT_BLOCK_WIDTH = GLINT_STRIP,
    GLINT_BLOCK_HEIGHT = 16,
    /* Bits of the state of a block of texels in a map. */
    GLINT_BLOCK_SEEN = 1,  /* the block may be visible in this frame */
    GLINT_BLOCK_LIT = 2,   /* the light that enters the block's texels is
                              computed */
    GLINT_BLOCK_READY = 4, /* the block's map values are computed */
    GLINT_BLOCK_WANTED =
        8 /* the block's entering light is to be computed in this update */
};

/* The light map of a translucent object. */
struct glint_stone_skin {
    const struct glint_scene_skin *of;
    uint32_t material;
    int fresnel;
    int32_t max_coat_q15; /* max reflectance of the coat / its reflectance at
                             normal incidence; 0: there is no coat */
    struct glint_translucent stone;
    struct glint_spread spread;
    const uint32_t *triangle;     /* mesh: [height][width], index of each
                                     texel's triangle */
    const int32_t (*turn_q30)[2]; /* ball: cosines and sines of the angles of
                                     columns, then of rows */
    int across, down;             /* number of blocks, horizontally and
                                     vertically */
    uint8_t *block;               /* [down][across]: states */
    uint16_t *list;               /* [down][across]: indices of the blocks whose
                                     light has to be computed */
    int n_list;
    int shift;      /* the light of a texel, q15, is its map value times
                       2^shift */
    int is_lit;     /* 1: the map was computed at least once */
    uint32_t moved; /* value of the scene's counter MOVED when the map was
                       computed */
};

struct glint_stone_state {
    struct glint_stone_skin *skin;        /* [n_skins] */
    struct glint_spread_scratch *scratch; /* [workers] */
    int32_t around_q15; /* upper bound of the environment's irradiance */
};

/* Returns the fraction of light, q15, that the surface transmits if COSINE_Q30
 * is the cosine between ray and normal; 1 without Fresnel reflection. */
static inline int32_t
compute_transmittance_q15(const struct glint_stone_skin *skin,
                          int32_t cosine_q30)
{
    enum { LOW = 23 }; /* log2 of 2^30 / GLINT_TRANSLUCENT_COSINES */
    const int32_t c_q30 = q_smaller(cosine_q30, 1 << 30);
    const uint16_t *at_q15;
    int i;

    if (!skin->fresnel)
        return 1 << 15;
    if (c_q30 <= 0)
        return 0;
    i = q_smaller(c_q30 >> LOW, GLINT_TRANSLUCENT_COSINES - 1);
    at_q15 = skin->stone.transmit_q15 + i;
    return at_q15[0] + q_mul(at_q15[1] - at_q15[0], c_q30 - (i << LOW), LOW);
}

enum {
    CHANNELS = 3,
    ONE_Q30 = 1 << 30,
    MOST_VALUE = 32767,
    BLOCK_TEXELS = GLINT_BLOCK_WIDTH * GLINT_BLOCK_HEIGHT,
    ONE_Q15 = GLINT_SCENE_ONE_Q15
};

/* ----------------------------------------------------------- visible blocks */

static void mark_all_blocks_visible(struct glint_stone_skin *skin)
{
    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] |= GLINT_BLOCK_SEEN;
}

/* ------------------------------------------------------------------- balls */

/* Max angle between a point of a block and the nearest of four tested texels,
 * which lie in the middles of the block's quarters. It is 12.6 degrees if a
 * ball's map is 256 texels wide, 25.2 degrees if it is 128 wide, plus a
 * texel. */
struct reach {
    int32_t cosine_q30, sine_q30;
};

static struct reach
compute_max_angle_in_block_quarter(const struct glint_stone_skin *skin)
{
    const struct reach wide = {Q_CONST(.88, 30), Q_CONST(.475, 30)};
    const struct reach less = {Q_CONST(.97, 30), Q_CONST(.244, 30)};

    return skin->spread.width < 256 ? wide : less;
}

/* Returns whether, at texel (X, Y) of ball P, the cosine between the normal and
 * the direction to the camera is above LIMIT. */
static int does_texel_face_camera(const struct glint_placed *p,
                                  const struct glint_stone_skin *skin, int x,
                                  int y, const int32_t toward_q30[3],
                                  int32_t limit_q30)
{
    const int32_t *round_q30 = skin->turn_q30[x];
    const int32_t *down_q30 = skin->turn_q30[skin->spread.width + y];
    const int32_t n_q30[3] = {q_mul(round_q30[1], down_q30[1], 30), down_q30[0],
                              -q_mul(round_q30[0], down_q30[1], 30)};
    int32_t turned_q30[3];

    v3_rotate(&p->turn, n_q30, turned_q30);
    return v3_cosine_q30(turned_q30, toward_q30) > limit_q30;
}

/* Marks the blocks with points that face the camera. A point faces the camera
 * if n.d > R / D. n is its normal, R the ball's radius, d the unit vector from
 * the ball's centre to the camera and D the distance between them. Marks all
 * blocks if the camera is inside the ball, or the map is less than 128 texels
 * wide. */
static void mark_visible_ball_blocks(const struct glint_scene *s,
                                     const struct glint_placed *p,
                                     struct glint_stone_skin *skin)
{
    const struct reach reach = compute_max_angle_in_block_quarter(skin);
    int32_t off[3], toward_q30[3], limit_q30;
    int64_t wide[3];
    uint32_t away;

    v3_subtract(s->view.at, p->at, off);
    away = glint_compute_square_root((uint64_t)v3_dot(off, off));
    for (int k = 0; k < 3; k++)
        wide[k] = off[k];
    if (skin->spread.width < 128 || away <= (uint32_t)p->radius ||
        !glint_normalise_vector(wide, toward_q30)) {
        mark_all_blocks_visible(skin);
        return;
    }
    limit_q30 = q_mul(q_divide_to_fraction_q30((uint64_t)p->radius, away),
                      reach.cosine_q30, 30) -
                reach.sine_q30 - (1 << 20);
    for (int i = 0; i < skin->across * skin->down; i++)
        for (int k = 0; k < 4; k++)
            if (does_texel_face_camera(
                    p, skin,
                    i % skin->across * GLINT_BLOCK_WIDTH +
                        (k & 1 ? 3 : 1) * GLINT_BLOCK_WIDTH / 4,
                    i / skin->across * GLINT_BLOCK_HEIGHT +
                        (k & 2 ? 3 : 1) * GLINT_BLOCK_HEIGHT / 4,
                    toward_q30, limit_q30))
                skin->block[i] |= GLINT_BLOCK_SEEN;
}

/* ------------------------------------------------------------------ meshes */

/* Returns whether triangle T may be visible: it may overlap the picture and, if
 * the mesh is closed, does not face away from the camera. */
static int is_triangle_visible(const struct glint_scene *s,
                               const struct glint_placed *p,
                               const struct glint_stone_skin *skin,
                               const struct glint_scene_triangle *t)
{
    const struct glint_box all = {-128 * s->view.width, -128 * s->view.height,
                                  128 * s->view.width, 128 * s->view.height};
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};
    const struct glint_corner *c[3];
    int64_t area;

    for (int k = 0; k < 3; k++) {
        c[k] = &s->corner[p->first_vertex + t->vertex[k]];
        if (c[k]->w != 1)
            return 1;
        lo[0] = q_smaller(lo[0], c[k]->x);
        lo[1] = q_smaller(lo[1], c[k]->y);
        hi[0] = q_larger(hi[0], c[k]->x);
        hi[1] = q_larger(hi[1], c[k]->y);
    }
    area = ((int64_t)c[1]->x - c[0]->x) * ((int64_t)c[2]->y - c[0]->y) -
           ((int64_t)c[1]->y - c[0]->y) * ((int64_t)c[2]->x - c[0]->x);
    return (area >= 0 || !skin->of->closed) && hi[0] >= all.x0 - 512 &&
           lo[0] <= all.x1 + 512 && hi[1] >= all.y0 - 512 &&
           lo[1] <= all.y1 + 512;
}

/* Marks the blocks that a triangle with texture coordinates UV overlaps,
 * enlarged by a margin of one texel. */
static void mark_blocks_of_triangle(struct glint_stone_skin *skin,
                                    const int32_t *const uv_q16[3])
{
    const int size_log2[2] = {bit_length(GLINT_BLOCK_WIDTH) - 1,
                              bit_length(GLINT_BLOCK_HEIGHT) - 1};
    const int n[2] = {skin->across, skin->down};
    const int log2 = (int)skin->stone.header->side_log2;
    int lo[2], hi[2];

    for (int i = 0; i < 2; i++) {
        const int32_t a = uv_q16[0][i], b = uv_q16[1][i], c = uv_q16[2][i];
        const int64_t least = q_smaller(a, q_smaller(b, c));
        const int64_t most = q_larger(a, q_larger(b, c));

        lo[i] = q_clamp_sat(((least << log2 >> 16) - 1) >> size_log2[i], 0,
                            n[i] - 1);
        hi[i] = q_clamp_sat(((most << log2 >> 16) + 1) >> size_log2[i], 0,
                            n[i] - 1);
    }
    for (int y = lo[1]; y <= hi[1]; y++)
        for (int x = lo[0]; x <= hi[0]; x++)
            skin->block[y * skin->across + x] |= GLINT_BLOCK_SEEN;
}

static void mark_visible_mesh_blocks(const struct glint_scene *s,
                                     const struct glint_placed *p,
                                     struct glint_stone_skin *skin)
{
    const struct glint_scene_mesh *m = glint_mesh_of(s, skin->of->object);
    const int32_t *uv_q16 = glint_mesh_get_table(s, m->uv_at);

    for (uint32_t i = 0; i < m->n_triangles; i++) {
        const struct glint_scene_triangle *t = glint_mesh_triangle(s, m, i);
        const int32_t *corner_q16[3];

        if (!is_triangle_visible(s, p, skin, t))
            continue;
        for (int k = 0; k < 3; k++)
            corner_q16[k] = uv_q16 + 2 * (size_t)t->vertex[k];
        mark_blocks_of_triangle(skin, corner_q16);
    }
}

/* Marks the blocks of SKIN that may be visible. A marked block that is not
 * visible only costs time, but an unmarked block that is visible would be
 * black. */
static void mark_visible_blocks(const struct glint_scene *scene,
                                struct glint_stone_skin *skin)
{
    const struct glint_placed *p = &scene->placed[skin->of->object];

    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] &= (uint8_t)~GLINT_BLOCK_SEEN;
    if (scene->has_split) /* mirrors may show points that face away from the
                             camera */
        mark_all_blocks_visible(skin);
    else if (!p->is_seen)
        return;
    else if (skin->spread.is_ball)
        mark_visible_ball_blocks(scene, p, skin);
    else
        mark_visible_mesh_blocks(scene, p, skin);
}

/* -------------------------------------------------------------- environment */

/* Adds to RGB_Q15 the environment's irradiance of a white surface of normal
 * NORMAL_Q30, times WEIGHT_Q15. */
static void add_environment_light(const struct glint_scene *s,
                                  const int32_t normal_q30[3],
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

/* Returns an upper bound of the environment's irradiance. It is 9/8 of the max
 * over normals on the faces of a cube, as irradiance at other normals is at
 * most 1/8 larger. */
static int32_t compute_max_environment_light(const struct glint_scene *scene)
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
        glint_normalise_vector(to, n_q30);
        add_environment_light(scene, n_q30, 1 << 15, rgb_q15);
        for (int c = 0; c < CHANNELS; c++)
            most = q_larger(most, rgb_q15[c]);
    }
    return q_clamp_sat((int64_t)most + most / 8, 0, GLINT_SCENE_MOST_LIGHT);
}

/* ----------------------------------------------------------------- exposure */

/* Returns an upper bound of the light that source LIT casts on a white surface
 * of object P. For a lamp it is the light at the nearest point of P, or at 1/16
 * of P's radius if that is farther. */
static int32_t compute_max_light_of_source(const struct glint_scene *s,
                                           const struct glint_lit *lit,
                                           const struct glint_placed *p)
{
    int32_t toward_q30[3] = {0}, level_q15[3] = {0}, place[3], off[3];
    int64_t away;

    v3_subtract(lit->at, p->centre, off);
    away = (int64_t)glint_compute_square_root((uint64_t)v3_dot(off, off)) -
           p->reach;
    away = away > p->reach / 16 + 1 ? away : p->reach / 16 + 1;
    for (int k = 0; k < 3; k++)
        place[k] = lit->at[k];
    place[0] -= q_clamp_sat(away, 1, (1 << 29) - 1);
    glint_scene_compute_light_at(s, lit, place, toward_q30, level_q15);
    return q_larger(level_q15[0], q_larger(level_q15[1], level_q15[2]));
}

/* Sets the exponent shift of SKIN's map values from the max light that can fall
 * on the object. */
static void set_exponent_of_map_values(const struct glint_scene *scene,
                                       struct glint_stone_skin *skin)
{
    const struct glint_placed *p = &scene->placed[skin->of->object];
    int64_t most = scene->stones->around_q15;

    for (uint32_t i = 0; i < scene->n_lit; i++)
        most += compute_max_light_of_source(scene, &scene->lit[i], p);
    skin->shift = 0;
    while (most >> skin->shift > MOST_VALUE && skin->shift < 15)
        skin->shift++;
}

/* ---------------------------------------------------------------- surfaces */

static void set_ball_texel_surface(const struct glint_scene *s,
                                   const struct glint_stone_skin *skin, int x,
                                   int y, struct glint_met_surface *surface)
{
    const struct glint_placed *p = &s->placed[skin->of->object];
    const int32_t *round_q30 = skin->turn_q30[x];
    const int32_t *down_q30 = skin->turn_q30[skin->spread.width + y];
    const int32_t n_q30[3] = {q_mul(round_q30[1], down_q30[1], 30), down_q30[0],
                              -q_mul(round_q30[0], down_q30[1], 30)};

    v3_rotate(&p->turn, n_q30, surface->normal_q30);
    surface->triangle = 0;
    for (int k = 0; k < 3; k++) {
        surface->face_q30[k] = surface->normal_q30[k];
        surface->place[k] =
            p->at[k] + q_mul(surface->normal_q30[k], p->radius, 30);
    }
}

/* Sets the barycentric weights, at texture position (U, V), of the corners of a
 * triangle with texture coordinates UV, clamped to the triangle; returns 0 if
 * it has no area. Coordinates must be within +-2^24. */
static int compute_texel_weights(const int32_t *const uv_q16[3], int32_t u_q16,
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
    glint_compute_vertex_weights(edge, sum, part_q30);
    return 1;
}

/* Sets SURFACE to the point of a mesh at texel (X, Y) of its map; returns 0 if
 * no triangle covers the texel. */
static int set_mesh_texel_surface(const struct glint_scene *s,
                                  const struct glint_stone_skin *skin, int x,
                                  int y, struct glint_met_surface *surface)
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
    if (!compute_texel_weights(uv_q16, (2 * x + 1) << down, (2 * y + 1) << down,
                               met.spot.part_q30))
        return 0;
    return s->cfg.parts.meshes->surface(s, &met, surface);
}

/* -------------------------------------------------------------------- light */

/* Adds to RGB_Q15 the light of source LIT that enters the object at SURFACE. */
static void add_entering_light(const struct glint_scene *s,
                               const struct glint_stone_skin *skin,
                               const struct glint_met_surface *surface,
                               const struct glint_lit *lit, int32_t rgb_q15[3])
{
    int32_t toward_q30[3] = {0}, level_q15[3] = {0}, cosine_q30, share_q15;

    if (!glint_scene_compute_light_at(s, lit, surface->place, toward_q30,
                                      level_q15))
        return;
    cosine_q30 = v3_cosine_q30(toward_q30, surface->normal_q30);
    if (cosine_q30 <= 0)
        return;
    share_q15 = glint_scene_lit_fraction(s, surface, lit);
    if (share_q15 == 0)
        return;
    share_q15 =
        q_mul(share_q15, compute_transmittance_q15(skin, cosine_q30), 15);
    for (int c = 0; c < CHANNELS; c++) {
        const int64_t light_q15 =
            ((int64_t)level_q15[c] * cosine_q30 >> 30) * share_q15 >> 15;

        rgb_q15[c] =
            q_clamp_sat(rgb_q15[c] + light_q15, 0, GLINT_SCENE_MOST_LIGHT);
    }
}

/* Sets SURFACE to the object's point at texel (X, Y) of its map; returns 0 if
 * the texel is not on the object. */
static int set_texel_surface(const struct glint_scene *s,
                             const struct glint_stone_skin *skin, int x, int y,
                             struct glint_met_surface *surface)
{
    *surface = (struct glint_met_surface){
        .material = &s->model.material[skin->material],
        .object = skin->of->object};
    if (!skin->spread.is_ball)
        return set_mesh_texel_surface(s, skin, x, y, surface);
    set_ball_texel_surface(s, skin, x, y, surface);
    return 1;
}

static void compute_light_entering_texel(const struct glint_scene *s,
                                         const struct glint_stone_skin *skin,
                                         int x, int y, int32_t rgb_q15[3])
{
    struct glint_met_surface surface;

    if (!set_texel_surface(s, skin, x, y, &surface))
        return;
    for (uint32_t i = 0; i < s->n_lit; i++)
        add_entering_light(s, skin, &surface, &s->lit[i], rgb_q15);
    if (s->wards)
        add_environment_light(
            s, surface.normal_q30,
            skin->fresnel ? skin->stone.header->mean_transmit_q15 : 1 << 15,
            rgb_q15);
}

static void compute_light_entering_block(const struct glint_scene *scene,
                                         const struct glint_stone_skin *skin,
                                         int i)
{
    const int x0 = i % skin->across * GLINT_BLOCK_WIDTH;
    const int y0 = i / skin->across * GLINT_BLOCK_HEIGHT;

    for (int y = y0; y < y0 + GLINT_BLOCK_HEIGHT; y++)
        for (int x = x0; x < x0 + GLINT_BLOCK_WIDTH; x++) {
            int32_t rgb_q15[3] = {0, 0, 0};

            compute_light_entering_texel(scene, skin, x, y, rgb_q15);
            for (int c = 0; c < CHANNELS; c++)
                skin->spread.light[c][y * skin->spread.width + x] =
                    (int16_t)q_clamp_sat(q_shift(rgb_q15[c], skin->shift), 0,
                                         MOST_VALUE);
        }
}

/* ------------------------------------------------------------------ opening */

static const void *get_table_in_scene_file(const struct glint_scene *s,
                                           uint32_t at)
{
    return (const unsigned char *)s->model.header + at;
}

/* Returns the header of the translucent medium of light map (skin) I. The
 * scene's checks have verified that the medium has the size that the map
 * needs. */
static const struct glint_translucent_header *
get_medium_header(const struct glint_scene *s, uint32_t i)
{
    return get_table_in_scene_file(
        s, s->model.stone[s->model.skin[i].stone].file_at);
}

static int is_map_of_ball(const struct glint_scene *s, uint32_t i)
{
    return s->model.object[s->model.skin[i].object].kind == GLINT_OBJECT_SPHERE;
}

static void allocate_map(const struct glint_scene *s, struct glint_arena *a,
                         uint32_t i, struct glint_stone_skin *skin)
{
    const int side = 1 << get_medium_header(s, i)->side_log2;
    const size_t texels = (size_t)side * (size_t)side
                          << (is_map_of_ball(s, i) ? 1 : 0);
    const size_t blocks = texels / (GLINT_BLOCK_WIDTH * GLINT_BLOCK_HEIGHT);
    struct glint_stone_skin k = {.of = &s->model.skin[i]};

    k.spread.is_ball = is_map_of_ball(s, i);
    k.spread.height = side;
    k.spread.width = side << k.spread.is_ball;
    k.across = k.spread.width / GLINT_BLOCK_WIDTH;
    k.down = side / GLINT_BLOCK_HEIGHT;
    for (int c = 0; c < CHANNELS; c++) {
        k.spread.light[c] = glint_arena_allocate(a, texels, sizeof(int16_t));
        k.spread.map[c] = glint_arena_allocate(a, texels, sizeof(int16_t));
    }
    k.block = glint_arena_allocate(a, blocks, sizeof *k.block);
    k.list = glint_arena_allocate(a, blocks, sizeof *k.list);
    if (skin)
        *skin = k;
}

/* Allocates scratch memory of one worker, enough for the largest translucent
 * medium. */
static struct glint_spread_scratch
allocate_spread_scratch(const struct glint_scene *s, struct glint_arena *a)
{
    struct glint_translucent_header largest = {.rank = 1, .kernel = 1};
    const struct glint_translucent stone = {.header = &largest};
    int height = 0;

    for (uint32_t i = 0; i < s->model.header->n_skins; i++) {
        const struct glint_translucent_header *h = get_medium_header(s, i);

        height = q_larger(height, 1 << h->side_log2);
        if (h->rank > largest.rank)
            largest.rank = h->rank;
        if (h->kernel > largest.kernel)
            largest.kernel = h->kernel;
    }
    /* The rank is clamped, as a damaged file is detected only later, when its
     * medium is opened. */
    if (largest.rank > GLINT_TRANSLUCENT_MOST_RANK)
        largest.rank = GLINT_TRANSLUCENT_MOST_RANK;
    if (largest.kernel > GLINT_TRANSLUCENT_MOST_KERNEL)
        largest.kernel = GLINT_TRANSLUCENT_MOST_KERNEL;
    return glint_spread_carve(a, &stone, height);
}

static struct glint_stone_state *
allocate_translucency(const struct glint_scene *scene,
                      struct glint_arena *arena)
{
    const uint32_t n = scene->model.header->n_skins;
    const int workers = glint_workers_count(scene->cfg.workers);
    struct glint_stone_state *placed =
        glint_arena_allocate(arena, 1, sizeof *placed);
    struct glint_stone_state measured, *w = placed ? placed : &measured;

    w->skin = glint_arena_allocate(arena, n, sizeof *w->skin);
    w->scratch =
        glint_arena_allocate(arena, (size_t)workers, sizeof *w->scratch);
    for (uint32_t i = 0; i < n; i++)
        allocate_map(scene, arena, i, placed ? &w->skin[i] : NULL);
    for (int i = 0; i < workers; i++) {
        const struct glint_spread_scratch s =
            allocate_spread_scratch(scene, arena);

        if (placed)
            w->scratch[i] = s;
    }
    return placed;
}

static enum glint_status open_medium_of_map(const struct glint_scene *s,
                                            struct glint_stone_skin *skin)
{
    const struct glint_scene_stone *stone = &s->model.stone[skin->of->stone];
    const int n = skin->spread.width * skin->spread.height;
    const char *reason;

    if (glint_translucent_open(&skin->stone,
                               get_table_in_scene_file(s, stone->file_at),
                               stone->file_bytes, &reason) != GLINT_OK)
        return GLINT_E_FORMAT;
    skin->material = stone->material;
    skin->fresnel = (int)stone->fresnel;
    skin->spread.stone = &skin->stone;
    skin->spread.convolve = glint_choose_convolve_kernel(s->cfg.sets);
    if (skin->spread.is_ball)
        skin->turn_q30 =
            (const int32_t(*)[2])get_table_in_scene_file(s, skin->of->texel_at);
    else
        skin->triangle = get_table_in_scene_file(s, skin->of->texel_at);
    for (int c = 0; c < CHANNELS; c++)
        for (int i = 0; i < n; i++)
            skin->spread.light[c][i] = skin->spread.map[c][i] = 0;
    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] = 0;
    return GLINT_OK;
}

static void update_environment_bound(struct glint_scene *scene)
{
    scene->stones->around_q15 = compute_max_environment_light(scene);
}

static enum glint_status open_translucent_media(struct glint_scene *scene)
{
    for (uint32_t i = 0; i < scene->model.header->n_skins; i++)
        if (open_medium_of_map(scene, &scene->stones->skin[i]) != GLINT_OK)
            return GLINT_E_FORMAT;
    update_environment_bound(scene);
    return GLINT_OK;
}

/* ---------------------------------------------------------------- updating */

/* If objects or lights have changed since the map was computed, clears the
 * states of all blocks and sets the exponent of map values again. */
static void clear_stale_blocks(const struct glint_scene *s,
                               struct glint_stone_skin *skin)
{
    if (skin->is_lit && skin->moved == s->moved)
        return;
    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] = 0;
    skin->is_lit = 1;
    skin->moved = s->moved;
    set_exponent_of_map_values(s, skin);
}

/* Requests the computation of the light that enters at block (X, Y), unless
 * it is already requested or computed. On balls, blocks outside the map are
 * wrapped; on meshes, they are ignored. */
static void request_block_light(struct glint_stone_skin *skin, int x, int y)
{
    int i;

    if (skin->spread.is_ball) {
        if (y < 0 || y >= skin->down) {
            y = y < 0 ? -1 - y : 2 * skin->down - 1 - y;
            x += skin->across / 2;
        }
        x &= skin->across - 1;
    } else if (x < 0 || x >= skin->across || y < 0 || y >= skin->down) {
        return;
    }
    i = y * skin->across + x;
    if (skin->block[i] & (GLINT_BLOCK_LIT | GLINT_BLOCK_WANTED))
        return;
    skin->block[i] |= GLINT_BLOCK_WANTED;
    skin->list[skin->n_list++] = (uint16_t)i;
}

/* Lists the blocks for which the entering light must be computed: visible
 * blocks without map values, and blocks so near them that the kernel spreads
 * their light there. Returns the number of visible blocks without map
 * values. */
static int list_blocks_to_light(struct glint_stone_skin *skin)
{
    const int radius = (int)skin->stone.header->kernel / 2;
    const int off[2] = {(radius + GLINT_BLOCK_WIDTH - 1) / GLINT_BLOCK_WIDTH,
                        (radius + GLINT_BLOCK_HEIGHT - 1) / GLINT_BLOCK_HEIGHT};
    int n = 0;

    skin->n_list = 0;
    for (int i = 0; i < skin->across * skin->down; i++) {
        const int x = i % skin->across, y = i / skin->across;

        if ((skin->block[i] & (GLINT_BLOCK_SEEN | GLINT_BLOCK_READY)) !=
            GLINT_BLOCK_SEEN)
            continue;
        n++;
        for (int dy = -off[1]; dy <= off[1]; dy++)
            for (int dx = -off[0]; dx <= off[0]; dx++)
                request_block_light(skin, x + dx, y + dy);
    }
    return n;
}

struct update {
    struct glint_scene *scene;
    struct glint_stone_skin *skin;
};

static void compute_light_entering_block_job(void *ctx, int job, int worker)
{
    const struct update *u = ctx;

    (void)worker;
    compute_light_entering_block(u->scene, u->skin, u->skin->list[job]);
}

/* Computes the map values of one colour channel in one column of blocks.
 * Adjacent blocks are computed in one call. */
static void spread_light_in_block_column_job(void *ctx, int job, int worker)
{
    const struct update *u = ctx;
    const struct glint_stone_skin *skin = u->skin;
    const int c = job % CHANNELS, x = job / CHANNELS;
    int from = 0;

    for (int y = 0; y <= skin->down; y++) {
        const int is_wanted =
            y < skin->down &&
            (skin->block[y * skin->across + x] &
             (GLINT_BLOCK_SEEN | GLINT_BLOCK_READY)) == GLINT_BLOCK_SEEN;

        if (is_wanted)
            continue;
        if (y > from)
            glint_spread_light_in_strip(
                &skin->spread, c, x * GLINT_STRIP, from * GLINT_BLOCK_HEIGHT,
                y * GLINT_BLOCK_HEIGHT, &u->scene->stones->scratch[worker]);
        from = y + 1;
    }
}

static void mark_updated_blocks_ready(struct glint_stone_skin *skin)
{
    for (int i = 0; i < skin->n_list; i++) {
        uint8_t *block = &skin->block[skin->list[i]];

        *block = (uint8_t)((*block & ~GLINT_BLOCK_WANTED) | GLINT_BLOCK_LIT);
    }
    for (int i = 0; i < skin->across * skin->down; i++)
        if (skin->block[i] & GLINT_BLOCK_SEEN)
            skin->block[i] |= GLINT_BLOCK_READY;
}

/* Returns (max reflectance of SKIN's coat) / (its reflectance at normal
 * incidence), q15; 0 if there is no coat. */
static int32_t
compute_max_coat_reflectance_q15(const struct glint_scene *scene,
                                 const struct glint_stone_skin *skin)
{
    const uint32_t ward = scene->model.material[skin->material].ward;
    int32_t max_q15 = 1;

    if (ward == GLINT_SCENE_NONE)
        return 0;
    for (int k = 0; k < 3; k++)
        max_q15 = q_larger(max_q15, scene->model.ward[ward].specular_q15[k]);
    return glint_divide_rounded(UINT64_C(1) << 30, (uint64_t)max_q15);
}

static int update_translucency_maps(struct glint_scene *scene)
{
    int n = 0;

    for (uint32_t i = 0; i < scene->model.header->n_skins; i++) {
        struct update u = {scene, &scene->stones->skin[i]};
        const struct glint_placed *p = &scene->placed[u.skin->of->object];
        int blocks;

        u.skin->max_coat_q15 = compute_max_coat_reflectance_q15(scene, u.skin);
        if (!p->is_shown || (!p->is_seen && !scene->has_split))
            continue;
        clear_stale_blocks(scene, u.skin);
        mark_visible_blocks(scene, u.skin);
        blocks = list_blocks_to_light(u.skin);
        if (blocks == 0)
            continue;
        glint_workers_run(scene->cfg.workers, u.skin->n_list,
                          compute_light_entering_block_job, &u);
        glint_workers_run(scene->cfg.workers, CHANNELS * u.skin->across,
                          spread_light_in_block_column_job, &u);
        mark_updated_blocks_ready(u.skin);
        n += blocks * BLOCK_TEXELS;
    }
    return n;
}

/* ----------------------------------------------------------------- showing */

/* A position between the middles of two neighbouring texels on one axis. */
struct between {
    int first, second;
    int32_t part_q16; /* weight of the second texel */
};

static struct between find_texel_pair(int32_t uv_q16, int side_log2,
                                      int goes_round)
{
    const int side = 1 << side_log2;
    const int64_t at_q16 = ((int64_t)uv_q16 << side_log2) - (1 << 15);
    const int64_t i = at_q16 >> 16;

    if (goes_round)
        return (struct between){(int)(i & (side - 1)),
                                (int)((i + 1) & (side - 1)),
                                (int32_t)(at_q16 & 0xffff)};
    return (struct between){q_clamp_sat(i, 0, side - 1),
                            q_clamp_sat(i + 1, 0, side - 1),
                            (int32_t)(at_q16 & 0xffff)};
}

/* Returns the value of MAP interpolated bilinearly between four texels, in
 * 1/128 of the map's unit. */
static int32_t sample_light_map(const int16_t *map, int width,
                                const struct between *x,
                                const struct between *y)
{
    const int16_t *upper = map + (ptrdiff_t)y->first * width;
    const int16_t *lower = map + (ptrdiff_t)y->second * width;
    /* Values get 7 more fraction bits and are then below 2^22, products below
     * 2^38. */
    const int64_t a =
        (upper[x->first] << 7) +
        ((int64_t)(upper[x->second] - upper[x->first]) * x->part_q16 >> 9);
    const int64_t b =
        (lower[x->first] << 7) +
        ((int64_t)(lower[x->second] - lower[x->first]) * x->part_q16 >> 9);

    return (int32_t)(a + ((b - a) * y->part_q16 >> 16));
}

/* Returns the coat's reflectance, 1 - transmission PASSES_Q15, divided by its
 * reflectance at normal incidence, q15; 1 without coat or Fresnel
 * reflection. */
static int32_t compute_coat_reflectance_q15(const struct glint_stone_skin *skin,
                                            int32_t passes_q15)
{
    const uint16_t *at_q15 = skin->stone.transmit_q15;
    const int32_t ahead_q15 = ONE_Q15 - at_q15[GLINT_TRANSLUCENT_COSINES];

    if (!skin->fresnel || ahead_q15 <= 0 || !skin->max_coat_q15)
        return ONE_Q15;
    return q_smaller(
        glint_divide_rounded((uint64_t)(ONE_Q15 - passes_q15) << 15,
                             (uint64_t)ahead_q15),
        skin->max_coat_q15);
}

static int32_t add_scattered_light(const struct glint_scene *scene,
                                   const struct glint_scene_ray *ray,
                                   const struct glint_met_surface *surface,
                                   int32_t weight_q15, int32_t rgb_q15[3])
{
    const struct glint_placed *p = &scene->placed[surface->object];
    const struct glint_stone_skin *skin = &scene->stones->skin[p->skin];
    const int log2 = (int)skin->stone.header->side_log2;
    int32_t uv_q16[2] = {surface->uv_q16[0], surface->uv_q16[1]};
    int32_t passes_q15, coat;
    struct between x, y;

    if (surface->material != &scene->model.material[skin->material])
        return 0;
    if (skin->spread.is_ball)
        glint_compute_ball_uv(p, surface, uv_q16);
    x = find_texel_pair(uv_q16[0], log2 + skin->spread.is_ball,
                        skin->spread.is_ball);
    y = find_texel_pair(uv_q16[1], log2, 0);
    passes_q15 = compute_transmittance_q15(
        skin, -v3_cosine_q30(ray->toward_q30, surface->normal_q30));
    coat = compute_coat_reflectance_q15(skin, passes_q15);
    passes_q15 = q_mul(passes_q15, weight_q15, 15);
    for (int c = 0; c < CHANNELS; c++) {
        const int32_t part_q15 =
            q_mul(surface->material->rgb_q15[c], passes_q15, 15);
        const int64_t light_q22 =
            (int64_t)sample_light_map(skin->spread.map[c], skin->spread.width,
                                      &x, &y)
            << skin->shift;

        rgb_q15[c] = q_clamp_sat(rgb_q15[c] + q_shift(light_q22 * part_q15, 22),
                                 0, GLINT_SCENE_MOST_LIGHT);
    }
    return coat;
}

const struct glint_scene_stones glint_scene_stones = {
    allocate_translucency, open_translucent_media, update_environment_bound,
    update_translucency_maps, add_scattered_light};
