/* SPDX-License-Identifier: MIT
 *
 * The maps of translucent things: memory, what is to be done in a frame, and
 * what a place shows. */
#include "scene/translucent/scene_stone.h"

#include "base/compiler.h"
#include "scene/parts.h"

enum {
    CHANNELS = 3,
    BLOCK_TEXELS = GLINT_BLOCK_WIDTH * GLINT_BLOCK_HEIGHT,
    ONE_Q15 = GLINT_SCENE_ONE_Q15
};

/* ------------------------------------------------------------------ opening */

static const void *table_at(const struct glint_scene *s, uint32_t at)
{
    return (const unsigned char *)s->model.header + at;
}

/* The header of the stone of skin I, whose sides were checked with the scene.
 */
static const struct glint_translucent_header *
header_of(const struct glint_scene *s, uint32_t i)
{
    return table_at(s, s->model.stone[s->model.skin[i].stone].file_at);
}

static int is_ball(const struct glint_scene *s, uint32_t i)
{
    return s->model.object[s->model.skin[i].object].kind == GLINT_OBJECT_SPHERE;
}

static void carve_skin(const struct glint_scene *s, struct glint_arena *a,
                       uint32_t i, struct glint_stone_skin *skin)
{
    const int side = 1 << header_of(s, i)->side_log2;
    const size_t texels = (size_t)side * (size_t)side
                          << (is_ball(s, i) ? 1 : 0);
    const size_t blocks = texels / (GLINT_BLOCK_WIDTH * GLINT_BLOCK_HEIGHT);
    struct glint_stone_skin k = {.of = &s->model.skin[i]};

    k.spread.is_ball = is_ball(s, i);
    k.spread.height = side;
    k.spread.width = side << k.spread.is_ball;
    k.across = k.spread.width / GLINT_BLOCK_WIDTH;
    k.down = side / GLINT_BLOCK_HEIGHT;
    for (int c = 0; c < CHANNELS; c++) {
        k.spread.light[c] = glint_arena_take(a, texels, sizeof(int16_t));
        k.spread.map[c] = glint_arena_take(a, texels, sizeof(int16_t));
    }
    k.block = glint_arena_take(a, blocks, sizeof *k.block);
    k.list = glint_arena_take(a, blocks, sizeof *k.list);
    if (skin)
        *skin = k;
}

/* Takes scratch for the largest of all stones, whatever their models. */
static struct glint_spread_scratch carve_scratch(const struct glint_scene *s,
                                                 struct glint_arena *a)
{
    struct glint_translucent_header largest = {.rank = 1, .kernel = 1};
    const struct glint_translucent stone = {.header = &largest};
    int height = 0;

    for (uint32_t i = 0; i < s->model.header->n_skins; i++) {
        const struct glint_translucent_header *h = header_of(s, i);

        height = q_larger(height, 1 << h->side_log2);
        if (h->rank > largest.rank)
            largest.rank = h->rank;
        if (h->kernel > largest.kernel)
            largest.kernel = h->kernel;
    }
    /* What is damaged is found when it is opened. */
    if (largest.rank > GLINT_TRANSLUCENT_MOST_RANK)
        largest.rank = GLINT_TRANSLUCENT_MOST_RANK;
    if (largest.kernel > GLINT_TRANSLUCENT_MOST_KERNEL)
        largest.kernel = GLINT_TRANSLUCENT_MOST_KERNEL;
    return glint_spread_carve(a, &stone, height);
}

static struct glint_stone_state *carve(const struct glint_scene *scene,
                                       struct glint_arena *arena)
{
    const uint32_t n = scene->model.header->n_skins;
    const int workers = glint_workers_count(scene->cfg.workers);
    struct glint_stone_state *placed =
        glint_arena_take(arena, 1, sizeof *placed);
    struct glint_stone_state measured, *w = placed ? placed : &measured;

    w->skin = glint_arena_take(arena, n, sizeof *w->skin);
    w->scratch = glint_arena_take(arena, (size_t)workers, sizeof *w->scratch);
    for (uint32_t i = 0; i < n; i++)
        carve_skin(scene, arena, i, placed ? &w->skin[i] : NULL);
    for (int i = 0; i < workers; i++) {
        const struct glint_spread_scratch s = carve_scratch(scene, arena);

        if (placed)
            w->scratch[i] = s;
    }
    return placed;
}

static enum glint_status open_skin(const struct glint_scene *s,
                                   struct glint_stone_skin *skin)
{
    const struct glint_scene_stone *stone = &s->model.stone[skin->of->stone];
    const int n = skin->spread.width * skin->spread.height;
    const char *reason;

    if (glint_translucent_open(&skin->stone, table_at(s, stone->file_at),
                               stone->file_bytes, &reason) != GLINT_OK)
        return GLINT_E_FORMAT;
    skin->material = stone->material;
    skin->fresnel = (int)stone->fresnel;
    skin->spread.stone = &skin->stone;
    skin->spread.convolve = glint_convolve_of(s->cfg.sets);
    if (skin->spread.is_ball)
        skin->turn_q30 = (const int32_t(*)[2])table_at(s, skin->of->texel_at);
    else
        skin->triangle = table_at(s, skin->of->texel_at);
    for (int c = 0; c < CHANNELS; c++)
        for (int i = 0; i < n; i++)
            skin->spread.light[c][i] = skin->spread.map[c][i] = 0;
    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] = 0;
    return GLINT_OK;
}

static void relight(struct glint_scene *scene)
{
    scene->stones->around_q15 = glint_stone_around(scene);
}

static enum glint_status open_stones(struct glint_scene *scene)
{
    for (uint32_t i = 0; i < scene->model.header->n_skins; i++)
        if (open_skin(scene, &scene->stones->skin[i]) != GLINT_OK)
            return GLINT_E_FORMAT;
    relight(scene);
    return GLINT_OK;
}

/* ------------------------------------------------------------------ updating
 */

/* Begins anew where things have moved since the map was lit. */
static void forget(const struct glint_scene *s, struct glint_stone_skin *skin)
{
    if (skin->is_lit && skin->moved == s->moved)
        return;
    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] = 0;
    skin->is_lit = 1;
    skin->moved = s->moved;
    glint_stone_expose(s, skin);
}

/* Wants block (X, Y), which may lie outside of the map, lit. */
static void want_light(struct glint_stone_skin *skin, int x, int y)
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

/* Lists the blocks whose light is wanted: those to be spread, and what lies
 * within a kernel. Returns how many are to be spread. */
static int list_blocks(struct glint_stone_skin *skin)
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
                want_light(skin, x + dx, y + dy);
    }
    return n;
}

struct update {
    struct glint_scene *scene;
    struct glint_stone_skin *skin;
};

static void light_job(void *ctx, int job, int worker)
{
    const struct update *u = ctx;

    (void)worker;
    glint_stone_light_block(u->scene, u->skin, u->skin->list[job]);
}

/* Spreads one channel of a column of blocks, run by run. */
static void spread_job(void *ctx, int job, int worker)
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
            glint_spread_strip(
                &skin->spread, c, x * GLINT_STRIP, from * GLINT_BLOCK_HEIGHT,
                y * GLINT_BLOCK_HEIGHT, &u->scene->stones->scratch[worker]);
        from = y + 1;
    }
}

/* Marks what was lit and spread. */
static void note(struct glint_stone_skin *skin)
{
    for (int i = 0; i < skin->n_list; i++) {
        uint8_t *block = &skin->block[skin->list[i]];

        *block = (uint8_t)((*block & ~GLINT_BLOCK_WANTED) | GLINT_BLOCK_LIT);
    }
    for (int i = 0; i < skin->across * skin->down; i++)
        if (skin->block[i] & GLINT_BLOCK_SEEN)
            skin->block[i] |= GLINT_BLOCK_READY;
}

/* Returns how many times what it does straight ahead the coat of SKIN mirrors
 * where it mirrors all, q15; 0: it has none. */
static int32_t most_coat_q15(const struct glint_scene *scene,
                             const struct glint_stone_skin *skin)
{
    const uint32_t ward = scene->model.material[skin->material].ward;
    int32_t most_q15 = 1;

    if (ward == GLINT_SCENE_NONE)
        return 0;
    for (int k = 0; k < 3; k++)
        most_q15 = q_larger(most_q15, scene->model.ward[ward].specular_q15[k]);
    return glint_ratio(UINT64_C(1) << 30, (uint64_t)most_q15);
}

static int update(struct glint_scene *scene)
{
    int n = 0;

    for (uint32_t i = 0; i < scene->model.header->n_skins; i++) {
        struct update u = {scene, &scene->stones->skin[i]};
        const struct glint_placed *p = &scene->placed[u.skin->of->object];
        int blocks;

        u.skin->most_coat_q15 = most_coat_q15(scene, u.skin);
        if (!p->is_shown || (!p->is_seen && !scene->has_split))
            continue;
        forget(scene, u.skin);
        glint_stone_see(scene, u.skin);
        blocks = list_blocks(u.skin);
        if (blocks == 0)
            continue;
        glint_workers_run(scene->cfg.workers, u.skin->n_list, light_job, &u);
        glint_workers_run(scene->cfg.workers, CHANNELS * u.skin->across,
                          spread_job, &u);
        note(u.skin);
        n += blocks * BLOCK_TEXELS;
    }
    return n;
}

/* ------------------------------------------------------------------- showing
 */

/* A place between two texels of an axis. */
struct between {
    int first, second;
    int32_t part_q16; /* of the second */
};

static struct between find(int32_t uv_q16, int side_log2, int goes_round)
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

/* Returns the light of MAP between four texels, _q15 of the map's. */
static int32_t sample(const int16_t *map, int width, const struct between *x,
                      const struct between *y)
{
    const int16_t *upper = map + (ptrdiff_t)y->first * width;
    const int16_t *lower = map + (ptrdiff_t)y->second * width;
    /* 7 bits more: below 2^22, and 2^38 in products */
    const int64_t a =
        (upper[x->first] << 7) +
        ((int64_t)(upper[x->second] - upper[x->first]) * x->part_q16 >> 9);
    const int64_t b =
        (lower[x->first] << 7) +
        ((int64_t)(lower[x->second] - lower[x->first]) * x->part_q16 >> 9);

    return (int32_t)(a + ((b - a) * y->part_q16 >> 16));
}

/* Returns how many times what it does straight ahead a coat mirrors where
 * PASSES_Q15 gets through, q15: what does not get through is mirrored, and
 * never more than all. */
static int32_t coat_q15(const struct glint_stone_skin *skin, int32_t passes_q15)
{
    const uint16_t *at_q15 = skin->stone.transmit_q15;
    const int32_t ahead_q15 = ONE_Q15 - at_q15[GLINT_TRANSLUCENT_COSINES];

    if (!skin->fresnel || ahead_q15 <= 0 || !skin->most_coat_q15)
        return ONE_Q15;
    return q_smaller(glint_ratio((uint64_t)(ONE_Q15 - passes_q15) << 15,
                                 (uint64_t)ahead_q15),
                     skin->most_coat_q15);
}

static int32_t add(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface, int32_t weight_q15,
                   int32_t rgb_q15[3])
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
        glint_ball_uv(p, surface, uv_q16);
    x = find(uv_q16[0], log2 + skin->spread.is_ball, skin->spread.is_ball);
    y = find(uv_q16[1], log2, 0);
    passes_q15 = glint_stone_passes(
        skin, -v3_cosine_q30(ray->toward_q30, surface->normal_q30));
    coat = coat_q15(skin, passes_q15);
    passes_q15 = q_mul(passes_q15, weight_q15, 15);
    for (int c = 0; c < CHANNELS; c++) {
        const int32_t part_q15 =
            q_mul(surface->material->rgb_q15[c], passes_q15, 15);
        const int64_t light_q22 =
            (int64_t)sample(skin->spread.map[c], skin->spread.width, &x, &y)
            << skin->shift;

        rgb_q15[c] = q_clamp_sat(rgb_q15[c] + q_shift(light_q22 * part_q15, 22),
                                 0, GLINT_SCENE_MOST_LIGHT);
    }
    return coat;
}

const struct glint_scene_stones glint_scene_stones = {carve, open_stones,
                                                      relight, update, add};
