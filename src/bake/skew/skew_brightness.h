/* SPDX-License-Identifier: MIT
 *
 * How bright a ghost of a lens that is not round has to be to count: what
 * fit/brightness.h is of round ones, whose picture only turns with the light.
 *
 * Here the light comes from several azimuths, and light that lies across less
 * than a pixel counts as spread over one: a streak is bright by that, not by
 * how thin it is. */
#ifndef GLINT_BAKE_SKEW_SKEW_BRIGHTNESS_H
#define GLINT_BAKE_SKEW_SKEW_BRIGHTNESS_H

#include "bake/fit/brightness.h"

/* Does for a lens that is not round what glint_brightness_find() does for
 * others, up to MAX_DEG. */
enum glint_status
glint_skew_brightness_find(struct glint_brightness *brightness,
                           const struct glint_setup *setup, double field_mm,
                           double max_deg, const double band_nm[2],
                           struct glint_workers *workers);

#endif
