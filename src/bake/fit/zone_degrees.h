/* SPDX-License-Identifier: MIT
 *
 * Which terms the polynomials of a zone may have, and how many. */
#ifndef GLINT_BAKE_FIT_ZONE_DEGREES_H
#define GLINT_BAKE_FIT_ZONE_DEGREES_H

#include "bake/fit/zone_fit.h"

/* Returns the terms of output KIND in TASK. STEEP: energies change a lot over
 * the pupil. */
struct glint_degrees glint_zone_degrees(const struct glint_zone_task *task,
                                        enum glint_channel kind, bool steep);

#endif
