/* SPDX-License-Identifier: MIT
 *
 * Declarations shared by transfer.c, which substitutes angle and wavelength
 * into polynomials, and transfer_rays.c, which evaluates rays.
 */
#ifndef GLINT_LENS_TERMS_H
#define GLINT_LENS_TERMS_H

#include "base/q.h"
#include "glint/transfer.h"

enum { TRANSFER_MAX_EXPONENT = 15 }; /* max power of any variable */

#define TRANSFER_ONE_Q30 (INT32_C(1) << 30)

/* Sets POWER_Q30[N + 1] to the powers 0 .. N of X_Q30. */
static inline void compute_powers_q30(int32_t x_q30, int n, int32_t *power_q30)
{
    power_q30[0] = TRANSFER_ONE_Q30;
    for (int k = 1; k <= n; k++)
        power_q30[k] = q_mul(power_q30[k - 1], x_q30, 30);
}

/* Returns the system (polynomials) of GHOST for this angle and wavelength; NULL
 * if no light of the ghost passes the lens. */
const struct glint_model_system *
glint_transfer_find_system(const struct glint_lens *lens, int ghost,
                           int32_t sine_q30, int32_t wave_q24);

/* Mixes GHOST of LENS into TRANSFER, which must be set to the same ghost, angle
 * and wavelength at another zoom position. The weight of LENS is PART_Q30, that
 * of TRANSFER 1 - PART_Q30. Returns 1 on success. Returns 0 and does nothing if
 * GHOST has no system for this angle and wavelength in LENS, or the two
 * energies have different numbers of roots. Returns 0 and leaves TRANSFER
 * undefined if the boxes are too far apart to extrapolate. */
int glint_transfer_mix_position(struct glint_transfer *transfer,
                                const struct glint_lens *lens, int ghost,
                                int32_t sine_q30, int32_t wave_q24,
                                int32_t part_q30);

static inline int has_transfer_output(const struct glint_transfer *t, int kind)
{
    return (t->outputs >> kind & 1) != 0;
}

#endif
