/* SPDX-License-Identifier: MIT */
#ifndef GLINT_SCENE_WARD_SEND_H
#define GLINT_SCENE_WARD_SEND_H

#include "glint/scene/ward.h"

/* Does as glint_ward_light() of PLACE, the root of which it sets. */
void glint_ward_send(const struct glint_ward_lobe *lobe,
                     const struct glint_environment *environment,
                     struct glint_ward_place *place, int32_t rgb_q15[3]);

#endif
