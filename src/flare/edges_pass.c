/* SPDX-License-Identifier: MIT
 *
 * Draws the flare as a pass over tiles (tile/pass.h): accumulates the edges of
 * a tile into sums, and converts the sums to light, row by row. */
#include <stddef.h>

#include "flare/by_edges.h"
#include "flare/edges/ghost_shade.h"

/* Number of ghost outlines above which sums have 20 fraction bits instead of
 * 16. With 16 bits, rounding has an error of up to half a unit per outline.
 * Such an error is 1/40 of a code near black. */
enum { FINE_OUTLINES = 1024 };

/* Returns whether F has so many outlines that its sums need 20 fraction bits.
 * With a soft edge each ray bundle may have GLINT_SOFT_RINGS outlines. */
static int are_fine_sums_needed(const struct glint_flare *f)
{
    const struct glint_shade *shade = f->cfg.stop.shade;
    const int rings = shade && shade->soft_q16 ? GLINT_SOFT_RINGS : 1;

    return f->n_bundles > FINE_OUTLINES / rings;
}

/* Returns whether any row carries light over to the tile on its right. */
static int has_light_carry(const struct glint_edge_sums *s)
{
    int64_t any = 0;

    for (int i = 0; i < 3 << s->tile_log2; i++)
        any |= s->carry[i];
    return any != 0;
}

static void *begin_tile_row(const void *self, struct glint_box row, int worker)
{
    const struct glint_flare *f = self;
    const int log2 = f->cfg.tile_log2;
    struct glint_edges_worker *w = glint_flare_get_edges_worker(f, worker);
    struct glint_edge_sums *s = &w->sums;

    w->flare = f;
    w->at_tile = ((row.y0 - f->bins.region.y0) >> log2) * f->bins.tiles_x;
    s->shade = f->cfg.stop.shade;
    s->patch = s->shade ? s->shade->method->draw : NULL;
    s->scratch = w->rows; /* The memory of rows is unused once all edges are
                             made. */
    s->linear = glint_flare_get_edges(f)->linear;
    s->fine = are_fine_sums_needed(f);
    s->lit = 0;
    s->tile_log2 = log2;
    s->stride = GLINT_EDGE_STRIDE(log2);
    for (int i = 0; i < 3 << log2; i++)
        s->carry[i] = 0;
    return w;
}

static int accumulate_tile_edges(void *state, struct glint_box tile)
{
    struct glint_edges_worker *w = state;
    const struct glint_flare *f = w->flare;
    const int32_t *start = f->bins.start + w->at_tile++;
    const int n = start[1] - start[0];
    struct glint_edge_sums *s = &w->sums;

    /* Carries change only in tiles that are drawn, so that has_light_carry()
     * need not be called again after a dark tile. */
    s->lit = n > 0 || (s->lit && has_light_carry(s));
    if (!s->lit)
        return 0;
    s->tile = tile;
    glint_edges_add_to_sums(s, glint_flare_get_edges(f)->edge, f->bundle,
                            f->bins.ref + start[0], n);
    return 1;
}

static enum glint_given write_linear_row(const struct glint_edge_sums *s,
                                         const struct glint_pass_rows *rows)
{
    for (int c = 0; c < 3; c++)
        glint_sums_read_linear_row(s, c, rows->y - s->tile.y0,
                                   rows->light_q20[c]);
    return GLINT_GIVES_LIGHT;
}

static enum glint_given write_pixel_rows(void *state,
                                         const struct glint_pass_rows *rows)
{
    const struct glint_edges_worker *w = state;
    const struct glint_edge_sums *s = &w->sums;
    const struct glint_kernels *kernels = w->flare->resolve->kernels;
    const int first = rows->y - s->tile.y0;
    int lit = 0;

    if (s->linear)
        return write_linear_row(s, rows);
    if (glint_sums_is_row_dark(s, first) &&
        glint_sums_is_row_dark(s, first + rows->n - 1))
        return GLINT_GIVES_NOTHING;
    for (int c = 0; c < 3; c++)
        for (int row = 0; row < rows->n; row++)
            lit |= glint_sums_read_code_row(s, c, first + row, kernels,
                                            rows->light->rgb_q16[c][row]);
    return lit ? GLINT_GIVES_LIGHT : GLINT_GIVES_NOTHING;
}

struct glint_pass glint_edges_make_pass(const struct glint_flare *flare)
{
    return (struct glint_pass){.self = flare,
                               .begin = begin_tile_row,
                               .tile = accumulate_tile_edges,
                               .rows = write_pixel_rows};
}
