/* SPDX-License-Identifier: MIT
 *
 * Internal state of a starburst, shared by the files of this folder: lamps with
 * powers in units of the tables, rows being drawn, memory.
 */
#ifndef GLINT_STAR_PARTS_H
#define GLINT_STAR_PARTS_H

#include "star/starburst.h"
#include "tile/blend.h"

enum {
    /* Number of distance zones around a light. A zone is a range of distances;
     * it ends at four times the distance of the previous zone's end. */
    GLINT_STAR_ZONES = 8,
    /* Number of rows of a band. Bands begin at multiples of it. */
    GLINT_STAR_BAND = GLINT_HALO_SIDE,
    /* Number of steps of the table of 1 / x for x = 1 .. 2. */
    GLINT_STAR_INVERSES = 128
};

STATIC_ASSERT((int)GLINT_HALO_CHANNEL == GLINT_CODES_WIDTH &&
              (int)GLINT_HALO_LINES >= GLINT_MAX_BLADES);

/* A lamp whose starburst is drawn: its position, its power in units of the
 * tables, and the distances up to which the starburst is visible. */
struct glint_star_lamp {
    int32_t x_q8, y_q8;
    uint64_t inner_q16; /* light falls with 1 / r^2 only where r^2, the squared
                           distance from the lamp, exceeds this, pixels^2 */
    int is_bare;        /* 1: the picture does not show the lamp, so its core is
                           drawn, too */
    /* Power per channel in three forms. Light per unit of the line profiles, 1
     * pixel from the lamp, is line[c] 2^line_exponent. The power of the lamp is
     * core[c] 2^core_exponent. Both mantissas have 15 bits. halo: log2 of the
     * power. */
    int32_t line[3], line_exponent, core[3], core_exponent, halo_log2_q16[3];
    /* Scale of the profiles across lines, which the lamp's radius widens:
     * profile steps per pixel, and pixels per profile step. */
    int32_t per_pixel_q16, pixels_q16;
    /* Tables between which the halo is interpolated: for the nearest tabulated
     * radius below the lamp's radius (halo) and above it (next_halo).
     * halo_part_q15 is the weight of next_halo. If there is only one table,
     * both pointers are equal. */
    const glint_star_halo_row *halo, *next_halo;
    int halo_part_q15;
    /* Distances from the lamp, pixels, up to which lines (reach) and halo
     * (halo_reach) are visible. */
    int reach, halo_reach;
    /* Entry i: where r^2 is at least 2^(4 + i / 2) pixels^2, the halo is
     * invisible beyond this distance from the nearest line, pixels; at most
     * entry i - 1. */
    int32_t halo_width_q8[GLINT_STAR_HALO_ROWS];
    /* Distance from the lamp, pixels, up to which the light diffracted by dirt
     * in the stop (the smear) is visible. */
    int smear_reach;
    int n_zones;
    /* Zone i extends from distance start[i] to start[i + 1], where distance is
     * max(|dx|, |dy|) in pixels. In zone i the first seen[i] steps of the line
     * profiles are visible. */
    int start[GLINT_STAR_ZONES + 1];
    int seen[GLINT_STAR_ZONES];
};

/* One row of pixels of a tile, in which the light of all lamps is accumulated.
 */
struct glint_star_stretch {
    int y, x0, x1; /* row; pixels x0 .. x1 - 1 of the row */
    int lo, hi;    /* range of columns lo .. hi - 1 that may have light; all
                      other columns are 0 */
    /* Linear light per channel, [3][x1 - x0], 1 = display white. */
    int64_t (*light_q20)[GLINT_CODES_WIDTH];
};

/* The rows of a tile that are drawn together: rows y .. y + GLINT_STAR_BAND -
 * 1, but only up to y1 - 1, and pixels x0 .. x1 - 1. */
struct glint_star_band {
    int y, y1, x0, x1;
    int lo, hi; /* range of columns lo .. hi - 1 that may have light; all other
                   columns are 0 */
    struct glint_halo halo; /* scratch memory */
    /* light per row, channel and column, 1 = display white */
    int64_t (*light_q20)[3][GLINT_CODES_WIDTH];
};

/* State of a worker that draws a row of tiles. */
struct glint_star_row {
    const struct glint_star *star;
    struct glint_box tile;
    int n_near, n_here; /* number of lights that reach the row of tiles (near),
                           and the current tile (here) */
    /* Indices of the lights that n_near and n_here count, [max_lights] each. */
    uint16_t *near, *here;
    /* The current band, whose light_q20 has GLINT_STAR_BAND rows; all 0 between
     * bands. */
    struct glint_star_band band;
};

struct glint_star {
    struct glint_star_config cfg;
    const struct glint_star_tables *tables;
    int n_lamps, is_linear;
    int32_t faintest_log2_q16; /* log2 of light that is not visible, 1 = 1/16 of
                                  display white */
    const struct glint_star_kernels *kernels;
    struct glint_star_lamp *lamp;  /* [max_lights] */
    struct glint_star_row *worker; /* [n_workers] */
    struct glint_blend_rows *rows; /* [n_workers] */
    uint32_t
        /* Table of inverses: entry i is 2^31 / (2^15 (1 + i /
         * GLINT_STAR_INVERSES)). */
        inverse_q31[GLINT_STAR_INVERSES + 2];
};

glint_star_part_fn glint_star_add_lines_row, glint_star_add_core_row;

/* Adds the halo of LAMP to BAND. */
void glint_star_add_halo_band(const struct glint_star *star,
                              const struct glint_star_lamp *lamp,
                              struct glint_star_band *band);

/* Returns 0 if certainly no line of LAMP lights pixels of BOX, else 1. */
int glint_star_can_lines_reach_box(const struct glint_star *star,
                                   const struct glint_star_lamp *lamp,
                                   struct glint_box box);

/* Returns the distance from a lamp, pixels, to which the core table extends. */
static inline int glint_star_compute_core_reach(const struct glint_star *star)
{
    const int steps = star->tables->core_per_pixel_q16 >> 16;

    return GLINT_STAR_CORE >> (steps == 4 ? 2 : steps == 2 ? 1 : 0);
}

/* Records in ROW that the columns X0 .. X1 - 1 may have light. */
static inline void glint_star_mark_lit_columns(struct glint_star_stretch *row,
                                               int x0, int x1)
{
    row->lo = x0 < row->lo ? x0 : row->lo;
    row->hi = x1 > row->hi ? x1 : row->hi;
}

#endif
