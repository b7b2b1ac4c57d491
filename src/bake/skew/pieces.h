/* SPDX-License-Identifier: MIT
 *
 * A piece of the light of a ghost of a lens that is not round: a patch of
 * directions, a band of wavelengths, a part of the box.
 *
 *   in   a piece, the polynomials that were fitted to it
 *   out  in which variable to halve it, and its halves
 *
 * Where rays fold, polynomials in u and v need many terms, and those of half a
 * box far fewer; elsewhere boxes move, and halving directions helps. High
 * powers decide: halving reduces the error most in the variable whose high
 * powers hold most of the polynomial. */
#ifndef GLINT_BAKE_SKEW_PIECES_H
#define GLINT_BAKE_SKEW_PIECES_H

#include "bake/fit/fitted.h"
#include "bake/fit/zone.h"

struct glint_skew_piece {
    struct glint_zone zone; /* its patch; its box if that is KNOWN or a part */
    double w0, w1;          /* its band, -1 .. 1 */
    double before;          /* error of the piece that was halved into it, in
                               tolerances */
    int depth;              /* number of halvings that led to it */
    int parts;              /* of these, of the box */
    bool known;             /* true: the box holds all light of the patch */
};

/* Halves P in VARIABLE. */
void glint_piece_halve(const struct glint_skew_piece *p, int variable,
                       struct glint_skew_piece *first,
                       struct glint_skew_piece *second);

/* Crops the box of P, a part, to its visible region, with a margin. */
void glint_piece_crop(struct glint_skew_piece *p,
                      const struct glint_visible *visible);

/* Sets SHARE to the fraction of the high powers of SYSTEM's polynomials that
 * halving each variable would remove. If some polynomials missed their
 * tolerance, only these count. */
void glint_piece_shares(const struct glint_fitted_system *system,
                        double share[GLINT_VARIABLES]);

/* Returns the smallest part number not used by a system of GHOST whose
 * directions and wavelengths overlap SYSTEM. */
int glint_piece_number(const struct glint_fitted_ghost *ghost,
                       const struct glint_fitted_system *system);

#endif
