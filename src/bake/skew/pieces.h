/* SPDX-License-Identifier: MIT
 *
 * A piece of the light of one ghost in a lens that is not round: a patch of
 * directions, a band of wavelengths, a part of the pupil box.
 *
 *   in   a piece, and the polynomials that were fitted to it
 *   out  the variable in which to halve the piece, and its halves
 *
 * Where rays form caustics, polynomials in the pupil coordinates u and v need
 * many terms, and half of a pupil box needs far fewer. Where the box moves
 * quickly with the direction, halving the patch of directions helps. A piece is
 * halved in the variable whose high powers contribute most to its polynomials,
 * because that reduces the error most.
 */
#ifndef GLINT_BAKE_SKEW_PIECES_H
#define GLINT_BAKE_SKEW_PIECES_H

#include "bake/fit/fitted.h"
#include "bake/fit/zone.h"

struct glint_skew_piece {
    /* the piece's patch of directions, and its pupil box. The box is set if
     * known is true or if parts > 0. */
    struct glint_zone zone;
    double w0, w1; /* the piece's band, in w, -1 .. 1 */
    /* error, in tolerances, of the larger piece that was halved into this
     * one */
    double before;
    int depth; /* number of halvings, in any variable, that led to this piece */
    int parts; /* number of halvings in u or v, which divide the pupil box */
    bool known; /* true: the box contains all light from the patch */
};

/* Halves P in VARIABLE (GLINT_U .. GLINT_P). */
void glint_piece_halve(const struct glint_skew_piece *p, int variable,
                       struct glint_skew_piece *first,
                       struct glint_skew_piece *second);

/* Crops the box of P to its visible region, with a margin. P must be a part of
 * a divided box. */
void glint_piece_crop_box(struct glint_skew_piece *p,
                          const struct glint_visible *visible);

/* Estimates how much halving in each variable helps. SHARE[variable] is the
 * fraction of the high powers of SYSTEM's polynomials that it would remove.
 * Polynomials within their tolerance are ignored unless all of them are. */
void glint_piece_compute_shares(const struct glint_fitted_system *system,
                                double share[GLINT_VARIABLES]);

/* Returns a part number for SYSTEM: the smallest one that is free. A number is
 * in use if another system of GHOST with that number overlaps SYSTEM in
 * directions and wavelengths. */
int glint_piece_choose_part_number(const struct glint_fitted_ghost *ghost,
                                   const struct glint_fitted_system *system);

#endif
