/* SPDX-License-Identifier: MIT
 *
 * The integer rasteriser against that of [Bodonyi23], on grids made by hand.
 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "reference/cells/cells.h"
#include "support/ghosts.h"
#include "support/test.h"

/* Draws G by edges into pixels and by cells into want. Adds by how much they
 * are apart to OFF, and the light by cells to ALL. */
static void add_difference(const struct ghost *g, double *off, double *all)
{
    static const struct cells_options options = {.weights = CELLS_WACHSPRESS};
    struct glint_flare_config c = base_config();
    void *mem;
    struct glint_flare *const f = open_flare(&c, &mem);

    draw_list(c, g, 1, pixels);
    add_ghost(f, g);
    cells_draw(f, &options, want);
    free(mem);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        *off += abs(pixels[i] - want[i]);
        *all += want[i];
    }
}

/* By edges a cell has one irradiance, from the energy in its middle, so the
 * picture must be within 0.6 % of that by cells. */
TEST(edges_agree_with_cells)
{
    const struct ghost g = {32, 100, 75, 60, 100, 1, 300, 6, {16384, 0, 0}};
    double off = 0, all = 0;

    add_difference(&g, &off, &all);
    assert_true(off < 0.006 * all);
    assert_true(total(pixels, 0) > 0.999 * total(want, 0));
    assert_true(total(pixels, 0) < 1.001 * total(want, 0));
}

/* Cells of two pixels, folded and cut by stop and barrel, must give nearly the
 * light that the reference samples. */
TEST(small_cells_agree)
{
    double off = 0, all = 0;

    for (int k = 0; k < 16; k++) {
        const struct ghost g = {16, 100, 75, 9 + k % 4,    60 * k,
                                1,  300, -2, {16384, 0, 0}};

        add_difference(&g, &off, &all);
    }
    assert_true(off < 0.083 * all); /* 0.0896 by pixel centres alone */
}
