/* SPDX-License-Identifier: MIT
 *
 * How bright a ghost must be to count.
 *
 *   in   a lens, the field, the band
 *   out  for a few angles the irradiance that a thousandth of the picture has
 * or exceeds, at the azimuth where it is least: what an exposure goes by
 *
 * A ghost far below it may be off by more before anybody sees it. Ghosts count
 * one by one, not summed where they overlap, which is near enough for that.
 */
#ifndef GLINT_BAKE_FIT_BRIGHTNESS_H
#define GLINT_BAKE_FIT_BRIGHTNESS_H

#include "glint/setup.h"
#include "glint/workers.h"

enum { GLINT_BRIGHTNESS_ANGLES = 11 };

struct glint_brightness {
    double sine[GLINT_BRIGHTNESS_ANGLES];
    double level[GLINT_BRIGHTNESS_ANGLES]; /* energy times pupil area over
                                              sensor area; 0: no light */
};

/* GLINT_E_MEMORY. Does not depend on WORKERS. */
enum glint_status glint_brightness_find(struct glint_brightness *brightness,
                                        const struct glint_setup *setup,
                                        double field_mm,
                                        const double band_nm[2],
                                        struct glint_workers *workers);

/* The lower level of the two angles around SINE. */
double glint_brightness_at(const struct glint_brightness *brightness,
                           double sine);

#endif
