/* SPDX-License-Identifier: MIT */
#include "tile/pass.h"

#include "base/q.h"

/* The state of a worker that draws passes in one tile. */
struct visit {
    const struct glint_tiles *tiles;
    const struct glint_pass *pass;
    int n_passes;
    void *state[GLINT_MAX_PASSES];
    unsigned awake; /* bit i is set if pass i draws in this tile */
    struct glint_box tile;
    struct glint_tile_scratch *scratch;
};

/* Draws ROWS with all passes that are active in this tile, from back to front.
 * Returns whether their combined output has light or cover. */
static enum glint_given call_active_passes(const struct visit *v,
                                           struct glint_pass_rows *rows)
{
    struct glint_blend_rows *more = v->scratch->blend;
    enum glint_given given = GLINT_GIVES_NOTHING;

    rows->cover = more ? &more->cover : NULL;
    for (int i = 0; i < v->n_passes; i++)
        if (!(v->awake >> i & 1))
            continue;
        else if (given == GLINT_GIVES_NOTHING)
            given = v->pass[i].rows(v->state[i], rows);
        else
            given = v->tiles->blend->add(&v->pass[i], v->state[i], rows, given,
                                         v->tile.x1 - v->tile.x0, more);
    return given;
}

/* Hides the covered fraction of the pixels in row Y of the picture if the
 * passes gave cover. Used for linear pictures and at half resolution, where
 * cover and light are applied in separate steps. */
static void attenuate_picture_row(const struct visit *v, enum glint_given given,
                                  int y)
{
    if (given == GLINT_GIVES_COVER)
        v->tiles->blend->hide(v->tiles, v->tile, y, v->scratch);
}

/* --------------------------------------------------------- linear pictures */

/* Expands N values to 2 N in place by repeating each value. Iterates backwards,
 * so that no value is overwritten before it is read. */
static void repeat_each_row_value(int32_t *row, int n)
{
    for (int i = n - 1; i >= 0; i--)
        row[2 * i] = row[2 * i + 1] = row[i];
}

static void draw_linear_tile(const struct visit *v)
{
    const struct glint_tiles *t = v->tiles;
    const int n = v->tile.x1 - v->tile.x0, twice = 2 << t->tile_log2;
    const int x = v->tile.x0 << t->half;
    const int n_x = q_smaller(n << t->half, t->width - x);
    int32_t *first = v->scratch->light_q20;
    enum glint_given given;
    struct glint_pass_rows rows = {
        .n = 1, .light_q20 = {first, first + twice, first + 2 * twice}};

    for (rows.y = v->tile.y0; rows.y < v->tile.y1; rows.y++) {
        const int y = rows.y << t->half;
        const int end = q_smaller(y + 1 + t->half, t->height);

        given = call_active_passes(v, &rows);
        if (given == GLINT_GIVES_NOTHING)
            continue;
        attenuate_picture_row(v, given, rows.y);
        for (int c = 0; c < 3 && t->half; c++)
            repeat_each_row_value(rows.light_q20[c], n);
        for (int k = y; k < end; k++)
            v->scratch->n_held += glint_resolve_add_to_linear(
                t->image, x, k, n_x, (const int32_t *const *)rows.light_q20);
    }
}

/* ------------------------------------------------------------------- codes */

static void resolve_code_rows(const struct visit *v, enum glint_given given,
                              const struct glint_pass_rows *rows)
{
    const struct glint_tiles *t = v->tiles;
    const int x = v->tile.x0, n_x = v->tile.x1 - x;

    if (given == GLINT_GIVES_COVER)
        t->blend->stretch(t->resolve, t->image, x, rows->y, n_x, rows->n,
                          rows->cover, rows->light, &v->scratch->codes->rows);
    else
        glint_resolve_add_to_run(t->resolve, t->image, x, rows->y, n_x, rows->n,
                                 rows->light, &v->scratch->codes->rows);
}

/* Draws a tile of a picture in codes, two rows at a time, because two rows
 * share chroma in 4:2:0. */
static void draw_code_tile(const struct visit *v)
{
    struct glint_pass_rows rows = {.light = v->scratch->light};

    for (rows.y = v->tile.y0; rows.y < v->tile.y1; rows.y += 2) {
        enum glint_given given;

        rows.n = q_smaller(2, v->tile.y1 - rows.y);
        given = call_active_passes(v, &rows);
        if (given != GLINT_GIVES_NOTHING && v->tiles->image)
            resolve_code_rows(v, given, &rows);
    }
}

/* max number of 2 x 2 pixel blocks to which light is added at once */
enum { QUADS = GLINT_CODES_WIDTH / 2 };

/* Adds one row of light at half resolution to two rows of the picture. */
static void resolve_half_resolution_row(const struct visit *v,
                                        const struct glint_pass_rows *rows)
{
    const struct glint_tiles *t = v->tiles;
    const int n_y = q_smaller(2, t->height - 2 * rows->y);

    for (int at = v->tile.x0; at < v->tile.x1; at += QUADS) {
        const int first = at - v->tile.x0;
        const int part = q_smaller(QUADS, v->tile.x1 - at);
        const uint16_t *const light_q16[3] = {
            rows->light->rgb_q16[0][0] + first,
            rows->light->rgb_q16[1][0] + first,
            rows->light->rgb_q16[2][0] + first};

        t->quads->resolve(t->resolve, t->image, 2 * at, 2 * rows->y,
                          q_smaller(2 * part, t->width - 2 * at), n_y,
                          light_q16, v->scratch->codes);
    }
}

static void draw_half_resolution_tile(const struct visit *v)
{
    struct glint_pass_rows rows = {.n = 1, .light = v->scratch->light};

    for (rows.y = v->tile.y0; rows.y < v->tile.y1; rows.y++) {
        const enum glint_given given = call_active_passes(v, &rows);

        if (given == GLINT_GIVES_NOTHING || !v->tiles->image)
            continue;
        attenuate_picture_row(v, given, rows.y);
        resolve_half_resolution_row(v, &rows);
    }
}

/* ------------------------------------------------------------------- tiles */

static void draw_passes_in_tile(struct visit *v)
{
    const struct glint_image *image = v->tiles->image;

    v->awake = 0;
    for (int i = 0; i < v->n_passes; i++)
        v->awake |= (unsigned)(v->pass[i].tile(v->state[i], v->tile) != 0) << i;
    if (!v->awake)
        return;
    v->scratch->n_tiles++;
    if (image && image->format == GLINT_LINEAR_Q20)
        draw_linear_tile(v);
    else if (v->tiles->half)
        draw_half_resolution_tile(v);
    else
        draw_code_tile(v);
}

int glint_tiles_count_rows(const struct glint_tiles *tiles)
{
    const int side = 1 << tiles->tile_log2;

    return (tiles->region.y1 - tiles->region.y0 + side - 1) >> tiles->tile_log2;
}

void glint_tiles_draw_row(const struct glint_tiles *tiles,
                          const struct glint_pass *pass, int n_passes, int row,
                          int worker, struct glint_tile_scratch *scratch)
{
    const int side = 1 << tiles->tile_log2;
    struct glint_box b = tiles->region;
    struct visit v = {
        .tiles = tiles, .pass = pass, .n_passes = n_passes, .scratch = scratch};

    b.y0 += row * side;
    b.y1 = q_smaller(b.y1, b.y0 + side);
    for (int i = 0; i < n_passes; i++)
        v.state[i] = pass[i].begin(pass[i].self, b, worker);
    for (int x = b.x0; x < b.x1; x += side) {
        v.tile = b;
        v.tile.x0 = x;
        v.tile.x1 = q_smaller(b.x1, x + side);
        draw_passes_in_tile(&v);
    }
}
