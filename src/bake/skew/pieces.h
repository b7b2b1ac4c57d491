/* SPDX-License-Identifier: MIT
 *
 * A piece of the light of one ghost in a lens that is not round: a patch of
 * directions, a band of wavelengths, a part of the pupil box.
 *
 *   in   a piece, and the polynomials that were fitted to it
 *   out  the variable in which to halve the piece, and its halves
 *
 * Where rays fold, polynomials in u and v need many terms; half of a box needs
 * far fewer. Where boxes move, halving directions helps. The choice depends on
 * high powers: halving reduces the error most in the variable whose high
 * powers contribute most to the polynomial.
 */
#ifndef GLINT_BAKE_SKEW_PIECES_H
#define GLINT_BAKE_SKEW_PIECES_H

#include "bake/fit/fitted.h"
#include "bake/fit/zone.h"

struct glint_skew_piece {
    /* the piece's patch of directions; its box is set if known is true or if
     * parts > 0 */
    struct glint_zone zone;
    double w0, w1; /* the piece's band, in w, -1 .. 1 */
    /* error, in tolerances, of the piece that was halved into this one */
    double before;
    int depth;  /* number of halvings of any variable that led to this piece */
    int parts;  /* number of those halvings that divided the box */
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

/* Sets SHARE[variable] to the fraction of the high powers of SYSTEM's
 * polynomials that halving this variable would remove. If any polynomial misses
 * its tolerance, only polynomials that miss theirs count. */
void glint_piece_compute_shares(const struct glint_fitted_system *system,
                                double share[GLINT_VARIABLES]);

/* Returns the smallest part number that no system of GHOST uses for directions
 * and wavelengths that overlap those of SYSTEM. */
int glint_piece_choose_part_number(const struct glint_fitted_ghost *ghost,
                                   const struct glint_fitted_system *system);

#endif
