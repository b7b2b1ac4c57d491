/* SPDX-License-Identifier: MIT
 *
 * Interpolates the polynomials of a bundle between two zoom positions. */
#ifndef GLINT_LENS_BLEND_H
#define GLINT_LENS_BLEND_H

#include "glint/transfer.h"

enum {
    GLINT_BLEND_BARRELS = GLINT_OUT_KINDS - GLINT_OUT_BARREL_0,
    GLINT_BLEND_PLACES = 6
};

/* The polynomials TO of a bundle at one zoom position ("this"), into which
 * those at another position are mixed, output by output: (1 - part) times the
 * output of this position plus part times that of the other. part < 0, down to
 * -1, extrapolates away from the other position. */
struct glint_zoom_mix {
    struct glint_transfer *to;
    int32_t part_q30;
    /* Difference between the pupil boxes of both positions (other - this).
     * move[0] is in half widths and half heights of this position's box,
     * move[1] in those of the other position's box. along: displacement of the
     * middle along u; wider, higher: differences in size. All are 0 if one of
     * them exceeds 8 half widths. */
    struct glint_blend_move {
        int32_t along_q24, wider_q24, higher_q24;
    } move[2];
    /* 1: the boxes are too far apart to interpolate; all moves are 0 */
    int far;
    /* Where rays pass the stop, in stop radii, at this position ([0]) and at
     * the other position ([1]). middle: ray at the middle of the box; across,
     * up: change with u and with v. */
    struct glint_blend_stop {
        int32_t middle, across, up;
        int32_t x_exponent, y_exponent;
    } stop[2];
    /* Values of the polynomials of all barrels (rims of surfaces, which cut
     * rays), _q16. First index: 0 for this position, 1 for the other one. Third
     * index: 0 at sample points of the barrel's own box, 1 at points of the
     * pupil inside both boxes. n_others: number of barrels of the other
     * position. */
    int32_t barrel_q16[2][GLINT_BLEND_BARRELS][2][GLINT_BLEND_PLACES];
    int n_others, n_mixed;
    /* Bit masks. partners: for each barrel of the other position, the barrels
     * of this position with which it is mixed. taken: all barrels that were
     * mixed or added. */
    uint32_t partners[GLINT_BLEND_BARRELS];
    uint32_t taken;
};

/* An output (polynomial) of the other position after angle and wavelength were
 * substituted. */
struct glint_blend_output {
    uint8_t kind, head;
    int32_t exponent;
    int32_t (*row)[GLINT_TABLE_WIDTH];
    uint8_t degree_u, degree_v;
};

/* Mixes BOX, the box of this position in units of 2^EXPONENT, into the box of
 * the transfer, which must still be that of the other position. Returns 0 if
 * part is below 0 and the boxes are too far apart to extrapolate or the result
 * has no area. */
int glint_blend_mix_box(struct glint_zoom_mix *blend, const int32_t box[3],
                        int32_t exponent);

/* Returns output KIND of T as a struct that points into T. */
struct glint_blend_output glint_blend_get_output(struct glint_transfer *t,
                                                 int kind);

/* Returns the value, _q16, of the polynomial O of a barrel at point (U, V) of
 * its box. If the barrel is so far away that the value is clamped, it blocks
 * nothing or everything. Units coarser than 2^-16, which no barrel has, are not
 * distinguished. */
int32_t glint_blend_evaluate_q16(const struct glint_blend_output *o,
                                 int64_t u_q24, int64_t v_q24);

/* Stores the values of output O if it is a barrel. Call for all outputs of the
 * other position, by ascending kind. */
void glint_blend_register_barrel(struct glint_zoom_mix *blend,
                                 const struct glint_blend_output *o);

/* Finds the barrels of this position that correspond to each registered barrel
 * of the other position. */
void glint_blend_pair_barrels(struct glint_zoom_mix *blend);

/* Adds barrel O to T as an output whose kind is unused. Returns the barrel's
 * number, or -1 if all kinds are used. */
int glint_blend_add_barrel(struct glint_transfer *t,
                           const struct glint_blend_output *o);

/* Mixes output O into the transfer. Call for all outputs of the other position,
 * by ascending kind. */
void glint_blend_mix_output(struct glint_zoom_mix *blend,
                            const struct glint_blend_output *o);

/* Widens the barrels that the other position lacks, unless part is below 0.
 * Call it last. */
void glint_blend_widen_barrels(const struct glint_zoom_mix *blend);

/* Multiplies the energy of T by the fraction SHARE_Q30. */
void glint_blend_scale_energy(struct glint_transfer *t, int32_t share_q30);

#endif
