/* SPDX-License-Identifier: MIT
 *
 * Where the entrance pupil lies. */
#ifndef GLINT_ENGINE_SETUP_ENTRANCE_H
#define GLINT_ENGINE_SETUP_ENTRANCE_H

#include "glint/setup.h"

struct glint_entrance {
    double z_mm;     /* distance of the entrance pupil from the front vertex,
                        towards the sensor */
    double front_mm; /* semi-diameter of the first surface */
};

/* Returns where the entrance pupil of SETUP lies. A model has it in its
 * polynomials; LENS is the model, or NULL if the setup was made from a table.
 */
struct glint_entrance glint_entrance_of(const struct glint_setup *setup,
                                        const struct glint_lens *lens);

#endif
