/* SPDX-License-Identifier: MIT
 *
 * Change of a stop's diffraction pattern by dust, scratches, smudges and masks,
 * in doubles.
 *
 * With T the light that lies through the stop, the amplitude is its root g, and
 * that of the clear stop 1, o. The pattern is |G|^2 / integral of T. Most of it
 * is that of the clear stop, |O|^2 / area, times the fraction C of the
 * outline's own light that remains. The rest is smooth, over angles of
 * wavelength over speck, and may be negative near the light:
 *
 *     D = |G|^2 / integral of T - C |O|^2 / area,  integral of D = 1 - C
 *
 * Both transforms are one, of g + i o, on a grid of 1024 x 1024 over 4 stop
 * radii: D is known up to 128 cycles per radius, beyond which it falls with the
 * third power, as the light of smooth rims does at least. [Cooley65] */
#ifndef GLINT_ENGINE_STAR_SMEAR_H
#define GLINT_ENGINE_STAR_SMEAR_H

#include <stddef.h>

#include "glint/setup.h"
#include "glint/status.h"

enum {
    GLINT_SMEAR_SIDE = 1024,
    GLINT_SMEAR_SPAN = 4 /* stop radii */
};

struct glint_smear {
    double clear; /* C */
    /* [SIDE + 1][SIDE + 1]: integral of D over cycles per radius from
     * -SIDE / (2 SPAN) on; row 0 at the lowest y. */
    double *sum;
    double edge; /* D at EDGE_Q, beyond which it is taken to fall */
};

/* Makes the smear of what lies in the stop of SETUP; it has a table.
 * GLINT_E_MEMORY. */
enum glint_status glint_smear_init(struct glint_smear *smear,
                                   const struct glint_setup *setup);
void glint_smear_finish(struct glint_smear *smear);

/* Returns the bytes that SMEAR takes, 0 if it is finished. */
static inline size_t glint_smear_bytes(const struct glint_smear *smear)
{
    return smear->sum ? (size_t)(GLINT_SMEAR_SIDE + 1) *
                            (GLINT_SMEAR_SIDE + 1) * sizeof *smear->sum
                      : 0;
}

/* Returns the mean of D over a square of half width HALF about (QX, QY), cycles
 * per stop radius, x right, y up. */
double glint_smear_compute_mean(const struct glint_smear *smear, double qx,
                                double qy, double half);

/* Returns the integral of D within Q cycles per stop radius, 0 .. 1. */
double glint_smear_integrate_within(const struct glint_smear *smear, double q);

/* Transforms N x N complex numbers in place, N a power of two, without a
 * factor; rows from USED on are 0. GLINT_E_MEMORY. */
enum glint_status glint_fourier_transform_2d(double (*at)[2], int n, int used);

#endif
