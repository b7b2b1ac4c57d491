/* SPDX-License-Identifier: MIT
 *
 * Kernel for the halos of starbursts. The rules of kernels.h apply.
 */
#ifndef GLINT_KERNELS_HALO_H
#define GLINT_KERNELS_HALO_H

#include <stdint.h>

enum {
    /* Number of rows of a halo table: two per octave of r^2, where r is the
     * distance from the lamp. The first row is for r^2 = 2^4 pixels^2. */
    GLINT_STAR_HALO_ROWS = 45,
    /* Number of columns of a halo table: four per octave of 1 + 4 v / reach,
     * where v is the distance from the nearest line. */
    GLINT_STAR_HALO_COLUMNS = 49,
    GLINT_HALO_SIDE = 8,   /* side of a square of pixels */
    GLINT_HALO_LINES = 64, /* max number of lines */
    /* number of values per channel and per row of light */
    GLINT_HALO_CHANNEL = 64,
    GLINT_HALO_STRIDE = 3 * GLINT_HALO_CHANNEL
};

/* One row of a halo table, [column][channel]: log2 (_q11) of light times r^2.
 */
typedef uint16_t glint_star_halo_row[GLINT_STAR_HALO_COLUMNS][3];

/* A square of GLINT_HALO_SIDE x GLINT_HALO_SIDE pixels in the halo of a lamp.
 */
struct glint_halo {
    int32_t dx_q8, dy_q8; /* pixels from the lamp to the middle of the first
                             pixel, at most 2^18 */
    /* Lines one of which is the nearest to each pixel. v: distance of the first
     * pixel; cos, sin: by how much it grows per pixel down and falls per pixel
     * to the right. */
    int n_lines;
    int64_t v_q38[GLINT_HALO_LINES];
    int32_t cos_q30[GLINT_HALO_LINES], sin_q30[GLINT_HALO_LINES];
    /* Rows whose pixels are all farther than this from a line have no light. */
    int32_t width_q8;
    uint64_t inner_q16; /* min r^2, pixels^2, 2^2 or more */
    int32_t reach_q8, reach_log2_q16;
    /* Tables, and the weight of the second, 0 .. 2^15; the table is not read if
     * it is 0. */
    const glint_star_halo_row *table, *next;
    int32_t next_q15;
    int32_t log2_q16[3]; /* added to the logarithms of the tables */
};

/* Adds the halo to the first N_X columns of the first N_Y rows of the square.
 * LIGHT: light of the first pixel, _q20,
 * [GLINT_HALO_SIDE][3][GLINT_HALO_CHANNEL]. The vector variants need N_X =
 * GLINT_HALO_SIDE. */
typedef void glint_halo_fn(const struct glint_halo *halo, int n_x, int n_y,
                           int64_t *light_q20);

/* Sets LOG2 to log2 of the light at V from the nearest line, where R2 is the
 * squared distance from the lamp, pixels^2; 1 = 1/16 of display white. */
void glint_halo_compute_log2(const struct glint_halo *halo, uint64_t r2_q16,
                             int32_t v_q8, int32_t log2_q16[3]);

/* Moves N values of light, a multiple of 8, to LIGHT_Q16, clamped to 0 ..
 * 65535, and sets them to 0. Returns 0 if all results are 0. */
typedef int glint_move_light_fn(int64_t *light_q20, int n, uint16_t *light_q16);

struct glint_star_kernels {
    glint_halo_fn *add_halo;
    glint_move_light_fn *move_light;
};

/* Returns the best kernels that the GLINT_SET_ bits SETS allow. */
const struct glint_star_kernels *glint_choose_star_kernels(unsigned sets);

glint_halo_fn glint_halo_c, glint_halo_avx2, glint_halo_neon;
glint_move_light_fn glint_move_light_c, glint_move_light_avx2,
    glint_move_light_neon;

#endif
