/* SPDX-License-Identifier: MIT */
#include "tile/bins.h"

void glint_bins_init(struct glint_bins *bins, struct glint_box region,
                     int tile_log2, int32_t *start, int32_t *ref)
{
    const int side = 1 << tile_log2;

    bins->region = region;
    bins->tile_log2 = tile_log2;
    bins->tiles_x = (region.x1 - region.x0 + side - 1) >> tile_log2;
    bins->tiles_y = (region.y1 - region.y0 + side - 1) >> tile_log2;
    bins->start = start;
    bins->ref = ref;
}

/* Returns the columns and rows of the tiles that BOX overlaps, as a box in
 * units of tiles; the box is empty if BOX overlaps no tile. */
static struct glint_box find_tile_range(const struct glint_bins *bins,
                                        struct glint_box box)
{
    const struct glint_box in = glint_box_intersect(box, bins->region);
    const struct glint_box *r = &bins->region;
    const int log2 = bins->tile_log2;

    if (glint_box_is_empty(in))
        return (struct glint_box){0, 0, 0, 0};
    return (struct glint_box){(in.x0 - r->x0) >> log2, (in.y0 - r->y0) >> log2,
                              ((in.x1 - 1 - r->x0) >> log2) + 1,
                              ((in.y1 - 1 - r->y0) >> log2) + 1};
}

int glint_bins_count_overlapped_tiles(const struct glint_bins *bins,
                                      struct glint_box box)
{
    const struct glint_box t = find_tile_range(bins, box);

    return (t.x1 - t.x0) * (t.y1 - t.y0);
}

void glint_bins_clear_counts(struct glint_bins *bins)
{
    for (int i = 0; i <= bins->tiles_x * bins->tiles_y; i++)
        bins->start[i] = 0;
}

void glint_bins_count_box(struct glint_bins *bins, struct glint_box box)
{
    const struct glint_box t = find_tile_range(bins, box);

    for (int y = t.y0; y < t.y1; y++)
        for (int x = t.x0; x < t.x1; x++)
            bins->start[y * bins->tiles_x + x]++;
}

void glint_bins_convert_counts_to_starts(struct glint_bins *bins)
{
    int32_t sum = 0;

    for (int i = 0; i <= bins->tiles_x * bins->tiles_y; i++) {
        const int32_t n = bins->start[i];

        bins->start[i] = sum;
        sum += n;
    }
}

void glint_bins_put_item(struct glint_bins *bins, struct glint_box box,
                         int32_t item)
{
    const struct glint_box t = find_tile_range(bins, box);

    for (int y = t.y0; y < t.y1; y++)
        for (int x = t.x0; x < t.x1; x++)
            bins->ref[bins->start[y * bins->tiles_x + x]++] = item;
}

void glint_bins_reset_starts(struct glint_bins *bins)
{
    for (int i = bins->tiles_x * bins->tiles_y; i > 0; i--)
        bins->start[i] = bins->start[i - 1];
    bins->start[0] = 0;
}

struct glint_box glint_bins_compute_tile_box(const struct glint_bins *bins,
                                             int tile)
{
    const int side = 1 << bins->tile_log2;
    const int x = bins->region.x0 + (tile % bins->tiles_x) * side;
    const int y = bins->region.y0 + (tile / bins->tiles_x) * side;

    return glint_box_intersect((struct glint_box){x, y, x + side, y + side},
                               bins->region);
}
