/* SPDX-License-Identifier: MIT
 *
 * Internal state of a starburst, and its lights in the form that the pass
 * draws.
 */
#ifndef GLINT_STAR_PARTS_H
#define GLINT_STAR_PARTS_H

#include "star/starburst.h"
#include "tile/blend.h"

enum {
    /* number of zones of distance from a light; each ends at four times the
     * distance of the previous zone */
    GLINT_STAR_ZONES = 8,
    GLINT_STAR_INVERSES = 128 /* steps of the table of 1 / x over x = 1 .. 2 */
};

/* A light, its power multiplied by the units of the tables. */
struct glint_star_lamp {
    int32_t x_q8, y_q8;
    uint64_t inner_q16; /* lower bound of r^2 in 1 / r^2, pixels^2 */
    int is_bare;        /* 1: draw the lamp's core as well */
    /* line: light of one step of a profile; core: power of the lamp; per
     * channel, 15 bits times 2^exponent. halo: log2 of the power per
     * channel. */
    int32_t line[3], line_exponent, core[3], core_exponent, halo_log2_q16[3];
    /* Scale of the profiles for this lamp's radius: steps per pixel, and
     * pixels per step. */
    int32_t per_pixel_q16, pixels_q16;
    /* [GLINT_STAR_HALO_ROWS] each: halos for the tabulated radii below and
     * above the lamp's radius, and the weight of the latter. Both pointers
     * are equal if there is a single halo. */
    const glint_star_halo_row *halo, *next_halo;
    int halo_part_q15;
    int reach, halo_reach; /* distances in pixels at which lines, and the halo,
                              become invisible */
    int smear_reach; /* distance in pixels at which diffraction by dirt in the
                        stop becomes invisible */
    int n_zones;
    /* Zone i reaches from start[i] to start[i + 1] pixels; the distance is
     * max(|dx|, |dy|). In zone i the steps of a profile below seen[i] are
     * visible. */
    int start[GLINT_STAR_ZONES + 1];
    int seen[GLINT_STAR_ZONES];
};

/* Light that is accumulated for a range of pixels of one row. */
struct glint_star_stretch {
    int y, x0, x1; /* row; pixels x0 .. x1 - 1 of the row */
    int lo, hi;    /* columns lo .. hi - 1 may have light; all others are 0 */
    int64_t (*light_q20)[GLINT_CODES_WIDTH]; /* [3][x1 - x0]: linear light,
                                                display white */
};

/* State of a worker that draws a row of tiles. */
struct glint_star_row {
    const struct glint_star *star;
    struct glint_box tile;
    int n_near, n_here; /* numbers of lights that reach this row of tiles, and
                           this tile */
    uint16_t *near, *here; /* [max_lights] each: indices of these lights */
    int64_t (*light_q20)[GLINT_CODES_WIDTH]; /* [3]: buffer for one row of
                                                pixels; 0 between rows */
};

struct glint_star {
    struct glint_star_config cfg;
    const struct glint_star_tables *tables;
    int n_lamps, is_linear;
    struct glint_star_lamp *lamp;  /* [max_lights] */
    struct glint_star_row *worker; /* [n_workers] */
    struct glint_blend_rows *rows; /* [n_workers] */
    uint32_t
        inverse_q31[GLINT_STAR_INVERSES + 2]; /* 2^31 / (2^15 (1 + i / n)) */
};

glint_star_part_fn glint_star_add_lines_row, glint_star_add_halo_row,
    glint_star_add_core_row;

/* Returns whether lines of LAMP may reach pixels of BOX; conservative. */
int glint_star_can_lines_reach_box(const struct glint_star *star,
                                   const struct glint_star_lamp *lamp,
                                   struct glint_box box);

/* Returns the distance in pixels from a light to the end of its core. */
static inline int glint_star_core_reach(const struct glint_star *star)
{
    const int steps = star->tables->core_per_pixel_q16 >> 16;

    return GLINT_STAR_CORE >> (steps == 4 ? 2 : steps == 2 ? 1 : 0);
}

/* Extends the range of lit columns of ROW by X0 .. X1 - 1. */
static inline void glint_star_note(struct glint_star_stretch *row, int x0,
                                   int x1)
{
    row->lo = x0 < row->lo ? x0 : row->lo;
    row->hi = x1 > row->hi ? x1 : row->hi;
}

#endif
