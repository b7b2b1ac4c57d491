/* SPDX-License-Identifier: MIT
 *
 * Computes the smear, in doubles. It is the change of a stop's diffraction
 * pattern by dust, scratches, smudges and masks.
 *
 * If T is the transmission of the stop, the amplitude is g = sqrt(T); for the
 * clear stop it is o = 1. With the Fourier transforms G and O the pattern is
 * |G|^2 / integral of T. Most of it is the pattern of the clear stop, |O|^2 /
 * area, times the fraction C of the light at the outline that is transmitted.
 * The rest, D, is smooth, extends over angles of wavelength / size of a speck,
 * and may be negative near the lamp:
 *
 *     D = |G|^2 / integral of T - C |O|^2 / area,  integral of D = 1 - C
 *
 * One transform, of g + i o, on a grid of 1024 x 1024 cells over 4 stop radii,
 * yields both G and O [Cooley65]. D is known up to 128 cycles per radius;
 * beyond, it is assumed to fall with the third power of the frequency, as the
 * light of smooth rims does at least. */
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
    double clear; /* C, fraction of the light at the outline that dirt passes */
    /* [SIDE + 1][SIDE + 1]: running integral of D over both frequencies, which
     * are in cycles per radius and begin at -SIDE / (2 SPAN); row 0 has the
     * lowest y. NULL: dirt blocks all light. */
    double *sum;
    double edge; /* mean of D around 112 cycles per radius, from which D at
                    higher frequencies is extrapolated */
};

/* Computes the smear, the diffraction by dirt in the stop of SETUP. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_smear_init(struct glint_smear *smear,
                                   const struct glint_setup *setup);
void glint_smear_finish(struct glint_smear *smear);

/* Returns the bytes allocated for SMEAR; 0 after glint_smear_finish(). */
static inline size_t glint_smear_count_bytes(const struct glint_smear *smear)
{
    return smear->sum ? (size_t)(GLINT_SMEAR_SIDE + 1) *
                            (GLINT_SMEAR_SIDE + 1) * sizeof *smear->sum
                      : 0;
}

/* Returns the mean of D, the change of the pattern by dirt, over a square of
 * half width HALF around (QX, QY), in cycles per stop radius, x to the right, y
 * up. */
double glint_smear_compute_mean(const struct glint_smear *smear, double qx,
                                double qy, double half);

/* Returns the integral of D, the change of the pattern by dirt, over the
 * frequencies up to Q cycles per stop radius. */
double glint_smear_integrate_within(const struct glint_smear *smear, double q);

/* Fourier-transforms N x N complex numbers in place, without normalisation. N
 * must be a power of two; rows from USED on must be 0. Returns GLINT_E_MEMORY
 * on failure. */
enum glint_status glint_fourier_transform_2d(double (*at)[2], int n, int used);

#endif
