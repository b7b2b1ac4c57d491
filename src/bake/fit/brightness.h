/* SPDX-License-Identifier: MIT
 *
 * Finds how bright a ghost must be to count.
 *
 *   in   a lens, the field, the band
 *   out  for a few angles: the irradiance that 1/1000 of the picture reaches or
 *        exceeds, at the azimuth at which it is least: the level that an
 *        exposure goes by
 *
 * A ghost far below that level may be off by more before anybody sees it.
 * Ghosts count one by one, not summed where they overlap, which is near enough.
 */
#ifndef GLINT_BAKE_FIT_BRIGHTNESS_H
#define GLINT_BAKE_FIT_BRIGHTNESS_H

#include "glint/setup.h"
#include "glint/workers.h"

enum { GLINT_BRIGHTNESS_ANGLES = 11 };

struct glint_brightness {
    double sine[GLINT_BRIGHTNESS_ANGLES];
    /* Energy times pupil area over sensor area; without light 0, or HUGE_VAL of
     * lenses that are not round. */
    double level[GLINT_BRIGHTNESS_ANGLES];
};

/* Sets the angles; returns how many of them angles up to MAX_DEG need. */
int glint_brightness_angles(struct glint_brightness *brightness,
                            double max_deg);

/* Sets HALF_MM to half the width and height of the picture that a field of
 * FIELD_MM holds. */
void glint_brightness_picture(const struct glint_prescription *lens,
                              double field_mm, double half_mm[2]);

/* Finds the levels that angles up to MAX_DEG need; they do not depend on
 * WORKERS. GLINT_E_MEMORY. */
enum glint_status glint_brightness_find(struct glint_brightness *brightness,
                                        const struct glint_setup *setup,
                                        double field_mm, double max_deg,
                                        const double band_nm[2],
                                        struct glint_workers *workers);

/* Returns the lower level of the two angles around SINE. */
double glint_brightness_at(const struct glint_brightness *brightness,
                           double sine);

#endif
