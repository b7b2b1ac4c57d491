/* SPDX-License-Identifier: MIT
 *
 * Finds how bright a ghost must be to count; the tolerances that follow.
 *
 *   in   a lens, the field, the band
 *   out  for a few angles: the irradiance that 1/1000 of the picture reaches or
 *        exceeds, at the azimuth where it is lowest: the level that determines
 *        the exposure
 *
 * A ghost far below that level may have larger errors before they are visible.
 * Overlapping ghosts are not summed, which is accurate enough.
 */
#ifndef GLINT_BAKE_FIT_BRIGHTNESS_H
#define GLINT_BAKE_FIT_BRIGHTNESS_H

#include "glint/setup.h"
#include "glint/workers.h"

enum { GLINT_BRIGHTNESS_ANGLES = 11 };

struct glint_brightness {
    double sine[GLINT_BRIGHTNESS_ANGLES];
    /* Energy times pupil area per sensor area. Without light: 0 for round
     * lenses, HUGE_VAL for others. */
    double level[GLINT_BRIGHTNESS_ANGLES];
};

/* Sets the angles; returns the number needed for lights up to MAX_DEG. */
int glint_brightness_angles(struct glint_brightness *brightness,
                            double max_deg);

/* Returns the planes of symmetry of a lens: GLINT_MIRRORS_X, GLINT_MIRRORS_Y.
 */
uint32_t glint_skew_mirrors(const struct glint_prescription *lens);

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

/* Max number of times that a zone's box may be halved: in general, in lenses
 * with shaped surfaces, and at the axis for fine tolerances. */
enum { GLINT_PART_DEPTH = 4, GLINT_SHAPED_DEPTH = 6, GLINT_MAX_AXIS_DEPTH = 8 };

/* Tolerances, root mean square; single rays may be off by five times as much.
 * Positions in the stop and at barrels draw the outline: EDGE_MM is how far
 * they may shift it on the sensor. From that follow their own tolerances:
 * STOP_LEAST to STOP, in stop radii, and 0.06 BARREL to BARREL, in radii of the
 * barrel. The lower limits are needed as the outline of a ghost that is larger
 * than the picture may lie outside it, but moves in when the stop closes.
 *
 * The values are for ghosts of the level above. In sRGB an error in a ghost of
 * v times that level is v^0.42 times as visible, so edges and energy of fainter
 * ghosts have larger tolerances, up to EASE times. */
struct glint_tolerance {
    double sensor_mm, edge_mm, stop, stop_least, barrel, energy;
    double faint_sensor_mm; /* mm; sensor_mm of fainter ghosts is eased up to
                               this, no further */
    double escape; /* relative radius that a ray may get past a barrel that is
                      left out */
    double ease;
    double pixel_mm; /* of a picture 1920 wide */
    /* Factor for zones at the axis, where light folds into rings: on how narrow
     * they may become, and on the tolerance of places. */
    double axis;
    int axis_depth; /* times that boxes of zones at the axis may be halved,
                       GLINT_PART_DEPTH to GLINT_MAX_AXIS_DEPTH */
    const struct glint_brightness *brightness;
};

#endif
