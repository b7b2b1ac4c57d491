/* SPDX-License-Identifier: MIT */
#ifndef GLINT_SCENE_WARD_SEND_H
#define GLINT_SCENE_WARD_SEND_H

#include "glint/scene/ward.h"

/* Like glint_ward_light() for PLACE; also sets the root of PLACE. */
void glint_ward_send(const struct glint_ward_lobe *lobe,
                     const struct glint_environment *environment,
                     struct glint_ward_place *place, int32_t rgb_q15[3]);

#endif
