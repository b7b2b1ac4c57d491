/* SPDX-License-Identifier: MIT */
#include "flare/draw_over.h"

#include "flare/by_edges.h"

struct draw {
    struct glint_flare *flare;
    const struct glint_tiles *tiles;
    const struct glint_flare_under *under;
};

static void draw_tile_row_job(void *ctx, int job, int worker)
{
    const struct draw *d = ctx;

    glint_tiles_draw_row(d->tiles, d->under->pass, d->under->n, job, worker,
                         &d->flare->worker[worker].tile);
}

void glint_flare_draw_over_passes(struct glint_flare *flare,
                                  const struct glint_image *image,
                                  const struct glint_flare_under *under)
{
    struct glint_tiles tiles = glint_flare_prepare_tiles(flare, image);
    struct draw alone = {flare, &tiles, under};
    struct glint_pass pass[GLINT_MAX_PASSES];

    if (flare->bins.region.y0 == 0)
        glint_flare_reset_tile_state(flare);
    tiles.blend = under->blend;
    for (int i = 0; i < glint_workers_count(flare->cfg.workers); i++)
        flare->worker[i].tile.blend = &under->rows[i];
    for (int i = 0; i < under->n; i++)
        pass[i] = under->pass[i];
    if (flare->stats.primitives > 0)
        glint_edges_draw(flare, &tiles, pass, under->n);
    else /* Without primitives the flare is not drawn, as its bins may contain
            the edges of an earlier frame. */
        glint_workers_run(flare->cfg.workers, glint_tiles_count_rows(&tiles),
                          draw_tile_row_job, &alone);
}
