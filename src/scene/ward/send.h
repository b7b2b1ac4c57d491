/* SPDX-License-Identifier: MIT */
#ifndef GLINT_SCENE_WARD_SEND_H
#define GLINT_SCENE_WARD_SEND_H

#include "glint/scene/ward.h"

/* Sets RGB_Q15 to the light that a metal reflects at PLACE, like
 * glint_ward_light(). Also sets the member root of PLACE, an intermediate
 * value. */
void glint_ward_compute_light(const struct glint_ward_lobe *lobe,
                              const struct glint_environment *environment,
                              struct glint_ward_place *place,
                              int32_t rgb_q15[3]);

#endif
