/* SPDX-License-Identifier: MIT
 *
 * Draws passes (flare, scene, stars ...) onto a picture, tile by tile.
 *
 *   in   passes, from back to front; the picture behind them
 *   out  the pixels of the picture, changed in place
 *
 * The driver processes a row of tiles from left to right, so that a pass may
 * carry state from tile to tile. Within a tile it draws two pixel rows at a
 * time, because two rows share chroma in 4:2:0. For linear pictures and at half
 * resolution, it draws one row at a time. Rows of tiles share no state: they
 * may be drawn in any order, or concurrently, each by another worker.
 *
 * A pass returns light, which is added to the picture. It may also return
 * cover, the fraction of each pixel in which it hides the picture and the light
 * of the passes before it: a fully covered pixel is overwritten. Several
 * passes, or one pass that gives cover, need glint_blend (blend.h); a program
 * that draws only flares does not link it. */
#ifndef GLINT_TILE_PASS_H
#define GLINT_TILE_PASS_H

#include "glint/image.h"
#include "image/cover.h"
#include "image/quads.h"
#include "image/resolve.h"
#include "tile/box.h"

enum { GLINT_MAX_PASSES = 4 };

/* Where a pass writes its output: rows Y .. Y + N - 1 of the picture, from the
 * left side of the current tile on. For a linear picture a pass writes
 * light_q20, and N is 1; otherwise it writes LIGHT. */
struct glint_pass_rows {
    int y, n;
    /* Light, _q16; rows are padded to a multiple of GLINT_LANES values. */
    struct glint_light_rows *light;
    int32_t *light_q20[3];          /* R, G and B: one value per pixel of the
                                       row */
    struct glint_cover_rows *cover; /* if NULL, passes must not give cover */
};

/* Output of a pass for its rows. */
enum glint_given {
    GLINT_GIVES_NOTHING,
    GLINT_GIVES_LIGHT, /* light in all three channels */
    GLINT_GIVES_COVER  /* cover and light, which may be 0 */
};

struct glint_pass {
    const void *self;
    /* Begins row ROW of tiles on worker WORKER. Returns the STATE that is
     * passed to the functions below. */
    void *(*begin)(const void *self, struct glint_box row, int worker);
    /* Begins tile TILE. Returns 0 if the pass draws nothing in the tile; ROWS
     * is then not called. */
    int (*tile)(void *state, struct glint_box tile);
    /* Draws rows of the current tile. Called from the top to the bottom of the
     * tile, until all its rows are drawn, even if the light is discarded. */
    enum glint_given (*rows)(void *state, const struct glint_pass_rows *rows);
};

/* The picture that is drawn onto, in tiles. */
struct glint_tiles {
    /* the picture, in pixels of the drawing resolution */
    struct glint_box region;
    int tile_log2; /* log2 of the side of a tile, 3 .. 6 */
    int half; /* 1: half resolution: each pixel drawn is 2 x 2 pixels of the
                 picture */
    int width, height;               /* size of the picture */
    const struct glint_image *image; /* if NULL, light is discarded */
    const struct glint_resolve *resolve;
    /* functions for half resolution; set if HALF is 1 and the picture is not
     * linear */
    const struct glint_half *quads;
    /* functions that combine several passes; may be NULL for a single pass that
     * gives no cover */
    const struct glint_blend *blend;
};

/* Scratch memory of one worker for drawing tiles. */
struct glint_tile_scratch {
    struct glint_light_rows *light;
    int32_t
        *light_q20; /* [3][2 * width of a tile]: light for linear pictures */
    struct glint_quads_rows *codes;
    int n_tiles; /* number of tiles in which at least one pass drew */
    int n_held;  /* number of samples of a linear picture that were clamped */
    struct glint_blend_rows *blend; /* set if several passes are blended, else
                                       NULL */
};

/* Scratch memory of one worker for blending: the light and cover of the pass
 * that is being added (light, light_q20, next), and the combined cover of the
 * passes before it (cover). */
struct glint_blend_rows {
    struct glint_light_rows light;
    int32_t light_q20[3][GLINT_CODES_WIDTH];
    struct glint_cover_rows cover, next;
};

/* Functions that blend several passes and hide the picture behind them. They
 * are called through this table, so that only programs that name glint_blend
 * (blend.h) link them. */
struct glint_blend {
    /* Draws ROWS, N_X pixels wide, with PASS, and blends the result over the
     * output of the earlier passes, whose type is GIVEN. Returns the type of
     * the combined output. */
    enum glint_given (*add)(const struct glint_pass *pass, void *state,
                            const struct glint_pass_rows *rows,
                            enum glint_given given, int n_x,
                            struct glint_blend_rows *scratch);
    /* Hides the fraction COVER of the picture, then adds light, in the run of
     * pixels from (X, Y). */
    void (*stretch)(const struct glint_resolve *resolve,
                    const struct glint_image *image, int x, int y, int n_x,
                    int n_y, const struct glint_cover_rows *cover,
                    struct glint_light_rows *light,
                    struct glint_resolve_rows *rows);
    /* Hides the covered fraction of the picture's pixels in row Y of TILE,
     * before light is added. Used for linear pictures and at half resolution.
     */
    void (*hide)(const struct glint_tiles *tiles, struct glint_box tile, int y,
                 struct glint_tile_scratch *scratch);
};

/* Draws all passes in row ROW of tiles, counted from the top of the region.
 * WORKER is the index of the calling worker, SCRATCH its memory. */
void glint_tiles_draw_row(const struct glint_tiles *tiles,
                          const struct glint_pass *pass, int n_passes, int row,
                          int worker, struct glint_tile_scratch *scratch);

/* Returns the number of rows of tiles that cover the region. */
int glint_tiles_count_rows(const struct glint_tiles *tiles);

#endif
