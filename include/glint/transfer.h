/* SPDX-License-Identifier: MIT
 *
 * glint/transfer.h - traces rays through a baked lens, in integers.
 *
 *     glint_transfer_init(&transfer, &lens, ghost, sine_q30, wave_q24);
 *     glint_transfer_ray(&transfer, u_q30, v_q30, &out);        or
 *     glint_transfer_grid(&transfer, &place, n_cells, vertices);
 *
 * All rays of a bundle have the same angle and wavelength.
 * glint_transfer_init() substitutes these into the polynomials; the resulting
 * polynomials depend only on u and v. */
#ifndef GLINT_TRANSFER_H
#define GLINT_TRANSFER_H

#include <stdint.h>

#include "glint/bundle.h"
#include "glint/model.h"
#include "glint/real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A window of a pupil box (glint/model.h), _q30. u runs from u_middle - u_half
 * to u_middle + u_half, within -1 .. 1. |v| runs from v_from to v_to, where 0
 * is the middle of the box (the inner rim, if the box is annular) and 1 is its
 * end. */
struct glint_box_window {
    int32_t u_middle_q30, u_half_q30, v_from_q30, v_to_q30;
};

/* The polynomials of one bundle: one ghost, light and wavelength. */
struct glint_transfer {
    const struct glint_model_system *system;
    uint32_t outputs; /* bit KIND is set if the system has an output of that
                         kind */
    /* Exponents: value of an output = integer * 2^exponent. */
    int32_t exponent[GLINT_OUT_KINDS];
    /* head and roots of the energy's struct glint_model_output */
    uint8_t head, roots;
    /* Log2 of a factor on the energy of vertices, 0 .. 29.
     * glint_transfer_init() sets it to 0; the caller may raise it. */
    uint8_t energy_up;
    /* Middle, half width and half height of the box at this angle and
     * wavelength, and (lens basis) its middle along y. */
    int32_t box[4];
    int32_t box_exponent;
    uint8_t annulus;
    /* WHOLE is 1 in the lens basis: v then runs over the whole box, not only
     * over one half. The light is mirrored into the quadrant that the model
     * covers, and the outputs are mirrored back: x and y are multiplied by
     * SIGN, and y is negated again if SIDE is 1. In other bases WHOLE and SIDE
     * are 0, and SIGN is 1. */
    uint8_t whole, side;
    int8_t sign;
    /* Window of the box that rows and grids of rays cover.
     * glint_transfer_init() sets it to the whole box, the caller may narrow it.
     * Unless the box is annular or WHOLE is 1, v begins at 0. */
    struct glint_box_window window;
    /* coefficients of u^a v^b, at [b][a] */
    int32_t table[GLINT_OUT_KINDS][GLINT_MAX_POWER + 1][GLINT_TABLE_WIDTH];
    uint8_t degree_u[GLINT_OUT_KINDS], degree_v[GLINT_OUT_KINDS];
    /* Instruction sets for rows, GLINT_SET_ bits; 0 after init, the caller may
     * set it. The result is the same for all sets. */
    unsigned sets;
    /* Scratch: the polynomials in u of one row of rays, and the value of u of
     * each ray in a row. */
    int32_t of_u[GLINT_OUT_KINDS][GLINT_TABLE_WIDTH];
    int32_t n_nodes, node_q30[GLINT_MAX_CELLS + GLINT_RAYS];
};

/* Substitutes angle and wavelength into the polynomials of GHOST. SINE_Q30 is 0
 * .. 2^30; WAVE_Q24 is clamped to the band of the model. Returns 0 if no light
 * of the ghost gets through. */
int glint_transfer_init(struct glint_transfer *transfer,
                        const struct glint_lens *lens, int ghost,
                        int32_t sine_q30, int32_t wave_q24);

/* Cosine and sine of the azimuth of a light. */
struct glint_azimuth {
    int32_t cos_q30, sin_q30;
};

/* Like glint_transfer_init(), for a light at AZIMUTH. The azimuth matters only
 * for lenses that are not round; glint_transfer_init() uses the azimuth 0. */
int glint_transfer_init_at(struct glint_transfer *transfer,
                           const struct glint_lens *lens, int ghost,
                           int32_t sine_q30, struct glint_azimuth azimuth,
                           int32_t wave_q24);

/* Returns the window that covers the whole box of TRANSFER. */
static inline struct glint_box_window
glint_box_whole(const struct glint_transfer *transfer)
{
    const int32_t one_q30 = INT32_C(1) << 30;
    const struct glint_box_window whole = {
        0, one_q30, transfer->whole ? -one_q30 : 0, one_q30};

    return whole;
}

/* Sets OUT to the outputs of the ray at (U, V), one per kind. Outputs are
 * integers within +-2^30; their values are integer * 2^exponent. Outputs of
 * kinds that the system lacks are 0. */
struct glint_outputs {
    int32_t at[GLINT_OUT_KINDS];
};
void glint_transfer_ray(const struct glint_transfer *transfer, int32_t u_q30,
                        int32_t v_q30, struct glint_outputs *out);

/* Sets OUT to the outputs of the rays at (U[i], V), one per kind and ray.
 * Outputs of kinds that the system lacks are undefined. IS_NEW may be 0 if V
 * equals V of the previous call. */
void glint_transfer_rays(struct glint_transfer *transfer, int32_t v_q30,
                         const int32_t u_q30[GLINT_RAYS], int is_new,
                         int32_t out[GLINT_OUT_KINDS][GLINT_RAYS]);

/* How outputs in mm of the sensor map to pixels of the picture. */
struct glint_place {
    /* Cosine and sine of the angle by which outputs are rotated, which is the
     * azimuth of the light. In the lens basis they are SIGN of struct
     * glint_transfer and 0. */
    int32_t cos_q30, sin_q30;
    struct glint_real pixels_per_mm;
    int32_t middle_x_q8, middle_y_q8; /* position of the centre of the sensor,
                                         pixels */
    /* (Radius of the model's stop) / (radius of the frame's stop), 1 or more;
     * 0: the radii are equal. */
    struct glint_real stop_scale;
};

/* Return coordinates within the window of TRANSFER. glint_transfer_u() returns
 * u at X_Q30, where -1 .. 1 is the width of the window. glint_transfer_v()
 * returns v after J of N equal steps from the lower to the upper end of the
 * upper half of the window, or of the whole window if WHOLE is 1. */
int32_t glint_transfer_u(const struct glint_transfer *transfer, int32_t x_q30);
int32_t glint_transfer_v(const struct glint_transfer *transfer, int j, int n);

/* Sets VERTICES to a grid of N_CELLS cells per side over the window, row by
 * row, [n_cells + 1][n_cells + 1]. v rises from row to row, u rises within a
 * row. The energy of a vertex, _q16, is 2^(energy_up - 29) times the integer
 * output GLINT_OUT_ENERGY, clamped to 0 .. 1. A ray with a value that does not
 * fit a vertex becomes invalid. For an annular box N_CELLS must be even and at
 * least 4. The middle row of rays is then invalid and separates the two halves
 * of the ring: the rows before and after it lie on the inner rim, so n_cells -
 * 2 rows of cells cover the box. */
void glint_transfer_grid(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells,
                         struct glint_vertex *vertices);

/* Sets ROW to row J, 0 .. N_CELLS, of the grid of glint_transfer_grid(). */
void glint_transfer_row(struct glint_transfer *transfer,
                        const struct glint_place *place, int n_cells, int j,
                        struct glint_vertex *row);

/* Sets ROW to row J of the grid of glint_transfer_grid(), and MIRRORED to row
 * N_CELLS - J, the mirror image of row J. This costs little more than ROW
 * alone. */
void glint_transfer_rows(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells, int j,
                         struct glint_vertex *row,
                         struct glint_vertex *mirrored);

#ifdef __cplusplus
}
#endif

#endif
