/* SPDX-License-Identifier: MIT
 *
 * Finds the position of the entrance pupil of a lens.
 */
#ifndef GLINT_ENGINE_SETUP_ENTRANCE_H
#define GLINT_ENGINE_SETUP_ENTRANCE_H

#include "glint/setup.h"

struct glint_entrance {
    double z_mm;     /* distance of the entrance pupil from the front vertex,
                        towards the sensor, mm */
    double front_mm; /* semi-diameter of the front surface, mm */
};

/* Returns the position of the entrance pupil of SETUP. LENS is the model from
 * which it is computed, or NULL if SETUP was made from a lens table. */
struct glint_entrance glint_entrance_find_pupil(const struct glint_setup *setup,
                                                const struct glint_lens *lens);

#endif
