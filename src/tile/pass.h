/* SPDX-License-Identifier: MIT
 *
 * Rows of tiles, and the passes that draw onto a picture in them.
 *
 *   in   passes, from the hindmost to the foremost; the picture as it is so far
 *   out  its pixels, changed in place
 *
 * The driver goes along a row of tiles from left to right, so that a pass may
 * carry state from tile to tile. It draws two rows of pixels at a time, as they
 * share chroma in 4:2:0; for linear pictures and at half resolution, one row.
 * Rows of tiles share no state: they may be drawn in any order, or
 * concurrently, each by another worker.
 *
 * Passes give light, which is added, and may give cover, the fraction of each
 * pixel in which they hide the picture and the light of the passes before them:
 * a fully covered pixel is overwritten. Several passes, or one pass that gives
 * cover, need glint_blend (blend.h); a program that draws only flares does not
 * link it. */
#ifndef GLINT_TILE_PASS_H
#define GLINT_TILE_PASS_H

#include "glint/image.h"
#include "image/cover.h"
#include "image/quads.h"
#include "image/resolve.h"
#include "tile/box.h"

enum { GLINT_MAX_PASSES = 4 };

/* Where a pass writes rows Y .. Y + N - 1 of its tile, from the tile's left
 * side on: to light_q20 for a linear picture, where N is 1, else to light. */
struct glint_pass_rows {
    int y, n;
    struct glint_light_rows *light; /* _q16, padded to GLINT_LANES */
    int32_t *light_q20[3];          /* R, G, B: one value per pixel */
    struct glint_cover_rows *cover; /* if NULL, passes must not give cover */
};

/* The output of a pass for its rows. */
enum glint_given {
    GLINT_GIVES_NOTHING,
    GLINT_GIVES_LIGHT, /* light in all three channels */
    GLINT_GIVES_COVER  /* cover and light, which may be 0 */
};

struct glint_pass {
    const void *self;
    /* Begins the row of tiles ROW on worker WORKER. Returns the STATE for the
     * calls below. */
    void *(*begin)(const void *self, struct glint_box row, int worker);
    /* Moves to tile TILE. Returns 0 if the pass draws nothing in it; rows is
     * then not called. */
    int (*tile)(void *state, struct glint_box tile);
    /* Draws rows of the current tile. It is called once for each row, from top
     * to bottom, even if there is no picture. */
    enum glint_given (*rows)(void *state, const struct glint_pass_rows *rows);
};

/* The picture that is drawn onto, in tiles. */
struct glint_tiles {
    /* The whole picture, in the pixels that passes see. */
    struct glint_box region;
    int tile_log2; /* 3 .. 6 */
    int half; /* 1: each pixel that passes see is 2 x 2 pixels of the picture */
    int width, height;               /* size of the picture */
    const struct glint_image *image; /* if NULL, light is discarded */
    const struct glint_resolve *resolve;
    /* set at half resolution, unless the picture is linear */
    const struct glint_half *quads;
    /* May be NULL if there is a single pass that gives no cover. */
    const struct glint_blend *blend;
};

/* The memory that a worker needs for tiles. */
struct glint_tile_scratch {
    struct glint_light_rows *light;
    int32_t *light_q20; /* [3][2 sides of a tile]; for linear pictures */
    struct glint_quads_rows *codes;
    int n_tiles; /* number of tiles drawn so far in which a pass was active */
    int n_held;  /* samples of a linear picture that were clamped to an end of
                    their range */
    struct glint_blend_rows *blend; /* set if the tiles blend passes */
};

/* Scratch of a worker: the output of the next pass, and the combined cover of
 * the passes so far. */
struct glint_blend_rows {
    struct glint_light_rows light;
    int32_t light_q20[3][GLINT_CODES_WIDTH];
    struct glint_cover_rows cover, next;
};

/* How several passes are blended and cover the picture. It is a table of
 * functions, so that only a program that names it (blend.h) links them. */
struct glint_blend {
    /* Draws ROWS of N_X pixels of PASS in front of GIVEN, the result of the
     * passes before. Returns the combined result. */
    enum glint_given (*add)(const struct glint_pass *pass, void *state,
                            const struct glint_pass_rows *rows,
                            enum glint_given given, int n_x,
                            struct glint_blend_rows *scratch);
    /* Hides COVER of the picture, then adds light as glint_resolve_stretch()
     * does. */
    void (*stretch)(const struct glint_resolve *resolve,
                    const struct glint_image *image, int x, int y, int n_x,
                    int n_y, const struct glint_cover_rows *cover,
                    struct glint_light_rows *light,
                    struct glint_resolve_rows *rows);
    /* Covers row Y of TILE in the picture, before light is added: for linear
     * pictures and at half resolution. */
    void (*hide)(const struct glint_tiles *tiles, struct glint_box tile, int y,
                 struct glint_tile_scratch *scratch);
};

/* Draws row ROW of tiles, counted from the region's upper side, as worker
 * WORKER. */
void glint_tile_rows(const struct glint_tiles *tiles,
                     const struct glint_pass *pass, int n_passes, int row,
                     int worker, struct glint_tile_scratch *scratch);

/* Returns the number of rows of tiles. */
int glint_tiles_down(const struct glint_tiles *tiles);

#endif
