/* SPDX-License-Identifier: MIT
 *
 * What follows from the values of several options. */
#ifndef GLINT_ENGINE_OPTIONS_VALUES_H
#define GLINT_ENGINE_OPTIONS_VALUES_H

#include "engine/frame/quality.h"
#include "glint/options.h"

/* Returns the quality of OPTIONS, with the parameters that were set by
 * themselves, but for max_lights and area_points. */
struct glint_quality glint_options_quality(const struct glint_options *options);

#endif
