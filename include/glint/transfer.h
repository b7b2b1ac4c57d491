/* SPDX-License-Identifier: MIT
 *
 * glint/transfer.h - rays through a baked lens, in integers.
 *
 *     glint_transfer_init(&transfer, &lens, ghost, sine_q30, wave_q24);
 *     glint_transfer_ray(&transfer, u_q30, v_q30, &out);        or
 *     glint_transfer_grid(&transfer, &place, n_cells, vertices);
 *
 * Angle and wavelength are the same for a whole bundle: init puts them in and
 * leaves polynomials in u and v.
 */
#ifndef GLINT_TRANSFER_H
#define GLINT_TRANSFER_H

#include <stdint.h>

#include "glint/bundle.h"
#include "glint/model.h"
#include "glint/real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A part of a box, _q30: U from middle - half to middle + half, within -1 .. 1,
 * and |V| from one to the other, 0 .. 1: from the middle of the box, or from
 * the rim of an annular one, to its end. */
struct glint_box_window {
    int32_t u_middle_q30, u_half_q30, v_from_q30, v_to_q30;
};

/* The polynomials of one bundle: one ghost, light and wavelength. */
struct glint_transfer {
    const struct glint_model_system *system;
    uint32_t outputs; /* bit KIND is set where there is that output */
    int32_t exponent[GLINT_OUT_KINDS]; /* exponent of each output */
    uint8_t head, roots; /* the energy's members of these names in struct
                            glint_model_output */
    uint8_t energy_up; /* log2 of the factor on a vertex's energy, 0 .. 29; init
                          sets 0, the caller may raise it */
    int32_t box[3];    /* middle, half width, half height at this angle */
    int32_t box_exponent;
    uint8_t annulus;
    /* part of the box that rows and grids of rays cover: init sets all of it,
     * the caller may narrow it; v begins at 0 unless the box is annular */
    struct glint_box_window window;
    enum glint_basis basis;
    union {
        /* coefficients of u^a v^b: [b][a] */
        int32_t table[GLINT_OUT_KINDS][GLINT_MAX_POWER + 1][GLINT_TABLE_WIDTH];
        struct {
            int32_t n_terms;
            uint16_t power[GLINT_MAX_MODEL_TERMS];
            int32_t coef[GLINT_MAX_MODEL_TERMS];
        } sparse[GLINT_OUT_KINDS];
    } of;
    uint8_t degree_u[GLINT_OUT_KINDS], degree_v[GLINT_OUT_KINDS];
    unsigned sets; /* instruction sets for rows, GLINT_SET_: 0 after init, for
                      the caller to set; changes no result */
    /* Scratch: polynomials in u, of one row of rays; places along a row. */
    int32_t of_u[GLINT_OUT_KINDS][GLINT_TABLE_WIDTH];
    int32_t n_nodes, node_q30[GLINT_MAX_CELLS + GLINT_RAYS];
};

/* Puts angle and wavelength into the polynomials of GHOST. SINE_Q30 0 .. 2^30,
 * WAVE_Q24 within the band (else held to it). Returns 0 where nothing of the
 * ghost gets through. */
int glint_transfer_init(struct glint_transfer *transfer,
                        const struct glint_lens *lens, int ghost,
                        int32_t sine_q30, int32_t wave_q24);

/* The outputs of one ray at (U, V), each within +-2^30: integers by kind, to be
 * scaled by 2^exponent; 0 for outputs that are not there. */
struct glint_outputs {
    int32_t at[GLINT_OUT_KINDS];
};
void glint_transfer_ray(const struct glint_transfer *transfer, int32_t u_q30,
                        int32_t v_q30, struct glint_outputs *out);

/* Gives the outputs of the rays at (U[i], V) by kind; kinds that are not there
 * are left as they are. IS_NEW: V is another one than in the last call. */
void glint_transfer_rays(struct glint_transfer *transfer, int32_t v_q30,
                         const int32_t u_q30[GLINT_RAYS], int is_new,
                         int32_t out[GLINT_OUT_KINDS][GLINT_RAYS]);

/* The place of a bundle in the picture. */
struct glint_place {
    int32_t cos_q30, sin_q30; /* cosine and sine of the light's azimuth */
    struct glint_real pixels_per_mm;
    int32_t middle_x_q8, middle_y_q8; /* the sensor's centre, pixels */
    struct glint_real stop_scale; /* the model's stop radius over the frame's, 1
                                     or more; 0: they are the same */
};

/* U at part X_Q30 of the window, -1 .. 1, and V at J of N steps across its
 * upper half. */
int32_t glint_transfer_u(const struct glint_transfer *transfer, int32_t x_q30);
int32_t glint_transfer_v(const struct glint_transfer *transfer, int j, int n);

/* Fills the vertices of a grid of N_CELLS a side over the window, row by row,
 * [n_cells + 1][n_cells + 1], v rising, u fastest. The energy 65536 of a vertex
 * is 2^(exponent[ENERGY] + 29 - energy_up); more saturates. What does not fit a
 * vertex is lost. Of an annular box N_CELLS is even, at least 4; the row in the
 * middle is lost, and those beside it are its rim: n_cells - 2 rows of cells
 * cover what there is. */
void glint_transfer_grid(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells,
                         struct glint_vertex *vertices);

/* Row J of it alone, 0 .. N_CELLS. */
void glint_transfer_row(struct glint_transfer *transfer,
                        const struct glint_place *place, int n_cells, int j,
                        struct glint_vertex *row);

/* Row J and, for little more, row N_CELLS - J, its mirror image. */
void glint_transfer_rows(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells, int j,
                         struct glint_vertex *row,
                         struct glint_vertex *mirrored);

#ifdef __cplusplus
}
#endif

#endif
