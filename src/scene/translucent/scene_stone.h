/* SPDX-License-Identifier: MIT
 *
 * The part of a scene for translucent things: a map for each, in blocks.
 *
 *   seen -> light E of these blocks and of all within a kernel -> spread
 *
 * A block keeps its light and what it made of it until something moves. */
#ifndef GLINT_SCENE_TRANSLUCENT_SCENE_STONE_H
#define GLINT_SCENE_TRANSLUCENT_SCENE_STONE_H

#include "scene/state.h"
#include "scene/translucent/spread.h"

enum {
    GLINT_BLOCK_WIDTH = GLINT_STRIP,
    GLINT_BLOCK_HEIGHT = 16,
    /* Blocks */
    GLINT_BLOCK_SEEN = 1,  /* may be seen in this frame */
    GLINT_BLOCK_LIT = 2,   /* has its light */
    GLINT_BLOCK_READY = 4, /* light has spread */
    GLINT_BLOCK_WANTED = 8 /* is to be lit, or spread, now */
};

/* The map of an object. */
struct glint_stone_skin {
    const struct glint_scene_skin *of;
    uint32_t material;
    int fresnel;
    int32_t most_coat_q15; /* of what its coat mirrors straight ahead, where it
                              mirrors all; 0: there is no coat */
    struct glint_translucent stone;
    struct glint_spread spread;
    const uint32_t *triangle;     /* mesh: [height][width] */
    const int32_t (*turn_q30)[2]; /* ball: of columns, then of rows */
    int across, down;             /* blocks */
    uint8_t *block;               /* [down][across] */
    uint16_t *list;               /* [down][across] blocks to be lit */
    int n_list;
    int shift;      /* light, q15, is that of the map times 2^shift */
    int is_lit;     /* has been once */
    uint32_t moved; /* what the scene had when it was */
};

struct glint_stone_state {
    struct glint_stone_skin *skin;        /* [n_skins] */
    struct glint_spread_scratch *scratch; /* [workers] */
    int32_t around_q15; /* no surface has more from the environment */
};

/* seen.c: marks the blocks of SKIN that may be seen. */
void glint_stone_see(const struct glint_scene *scene,
                     struct glint_stone_skin *skin);

/* skin_light.c: sets the shift of SKIN by the most light that may fall on it;
 * lights block I of it. */
void glint_stone_expose(const struct glint_scene *scene,
                        struct glint_stone_skin *skin);
void glint_stone_light_block(const struct glint_scene *scene,
                             const struct glint_stone_skin *skin, int i);

/* Returns the most light that a surface has from the environment. */
int32_t glint_stone_around(const struct glint_scene *scene);

/* Returns the share of light that passes the surface at a cosine, q15. */
static inline int32_t glint_stone_passes(const struct glint_stone_skin *skin,
                                         int32_t cosine_q30)
{
    enum { LOW = 23 }; /* 2^30 over GLINT_TRANSLUCENT_COSINES */
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

#endif
