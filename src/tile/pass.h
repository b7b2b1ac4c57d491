/* SPDX-License-Identifier: MIT
 *
 * Where all that draws onto a picture meets: rows of tiles, and the passes that
 * light them.
 *
 *   in   passes, the hindmost first; the picture as it is so far
 *   out  its pixels, changed in place
 *
 * The driver goes along a row of tiles from left to right, so that a pass may
 * carry state from tile to tile, and takes two rows of pixels at a time, which
 * share their chroma in 4:2:0; one of linear pictures and of those drawn at
 * half resolution. Rows of tiles share nothing: they may be drawn in any order,
 * or at once, each by another worker.
 *
 * Passes give light, which is added, and may give cover, the share of each
 * pixel in which they hide the picture and the light of the passes before
 * them: a pixel that is covered wholly is set. More than one pass, or one that
 * covers, takes glint_blend (blend.h), which a flare alone does not link.
 */
#ifndef GLINT_TILE_PASS_H
#define GLINT_TILE_PASS_H

#include "glint/image.h"
#include "image/cover.h"
#include "image/quads.h"
#include "image/resolve.h"
#include "tile/box.h"

enum { GLINT_MAX_PASSES = 4 };

/* The place that a pass writes rows Y .. Y + N - 1 of its tile to, from the
 * tile's left edge on: light_q20 of a linear picture, where N is 1, else light.
 */
struct glint_pass_rows {
    int y, n;
    struct glint_light_rows *light; /* _q16, padded to GLINT_LANES */
    int32_t *light_q20[3];          /* R, G, B: one value a pixel */
    struct glint_cover_rows *cover; /* NULL: passes are to give light alone */
};

/* The outcome of a pass for two rows. */
enum glint_given {
    GLINT_GIVES_NOTHING,
    GLINT_GIVES_LIGHT, /* light in all three channels */
    GLINT_GIVES_COVER  /* cover and light, even if that is 0 */
};

struct glint_pass {
    const void *self;
    /* Begins the row of tiles ROW on worker WORKER; what it returns is STATE
     * below. */
    void *(*begin)(const void *self, struct glint_box row, int worker);
    /* Goes on to the tile TILE; 0: it stays as it is, and rows is not called.
     */
    int (*tile)(void *state, struct glint_box tile);
    /* Draws rows of that tile, which come from top to bottom, each once, even
     * where there is no picture. */
    enum glint_given (*rows)(void *state, const struct glint_pass_rows *rows);
};

/* The picture that is drawn onto, in tiles. */
struct glint_tiles {
    struct glint_box region; /* the whole picture, in pixels that passes see */
    int tile_log2;           /* 3 .. 6 */
    int half;          /* 1: each of these pixels is 2 x 2 of the picture */
    int width, height; /* size of the picture */
    const struct glint_image *image; /* NULL: light is dropped */
    const struct glint_resolve *resolve;
    /* set at half resolution, unless the picture is linear */
    const struct glint_half *quads;
    const struct glint_blend *blend; /* NULL: one pass, which gives no cover */
};

/* The memory that a worker needs for tiles. */
struct glint_tile_scratch {
    struct glint_light_rows *light;
    int32_t *light_q20; /* [3][2 sides of a tile]; of linear pictures */
    struct glint_quads_rows *codes;
    int n_tiles; /* tiles in which something was drawn so far */
    int n_held;  /* samples of a linear picture at the end of their range */
    struct glint_blend_rows *blend; /* set if the tiles blend passes */
};

/* Scratch of a worker: what the next pass gives, and all cover so far. */
struct glint_blend_rows {
    struct glint_light_rows light;
    int32_t light_q20[3][GLINT_CODES_WIDTH];
    struct glint_cover_rows cover, next;
};

/* How several passes come together, and cover the picture: named, so that
 * drawing links it (blend.h) only where it is. */
struct glint_blend {
    /* Has PASS draw ROWS of N_X pixels in front of what was GIVEN; returns what
     * both give together. */
    enum glint_given (*add)(const struct glint_pass *pass, void *state,
                            const struct glint_pass_rows *rows,
                            enum glint_given given, int n_x,
                            struct glint_blend_rows *scratch);
    /* Does as glint_resolve_stretch(), under COVER. */
    void (*stretch)(const struct glint_resolve *resolve,
                    const struct glint_image *image, int x, int y, int n_x,
                    int n_y, const struct glint_cover_rows *cover,
                    struct glint_light_rows *light,
                    struct glint_resolve_rows *rows);
    /* Covers what the rows are of a picture that is linear, or drawn at half
     * resolution, before light is added. */
    void (*hide)(const struct glint_tiles *tiles, struct glint_box tile, int y,
                 struct glint_tile_scratch *scratch);
};

/* Draws the row of tiles of number ROW, counted from the region's upper edge,
 * as worker WORKER. */
void glint_tile_rows(const struct glint_tiles *tiles,
                     const struct glint_pass *pass, int n_passes, int row,
                     int worker, struct glint_tile_scratch *scratch);

/* How many rows of tiles there are. */
int glint_tiles_down(const struct glint_tiles *tiles);

#endif
