/* SPDX-License-Identifier: MIT
 *
 * Finds the irradiance of the brightest ghosts, which determines how visible
 * errors of fainter ghosts are. Also declares the tolerances of a fit.
 *
 *   in   a lens, the field, the band
 *   out  for some angles: the irradiance that 1/1000 of the picture's area
 *        exceeds, at the azimuth where it is lowest. This level determines the
 *        exposure of the flare.
 *
 * Errors of ghosts far below that level are less visible. The light of
 * overlapping ghosts is not summed, which is accurate enough.
 */
#ifndef GLINT_BAKE_FIT_BRIGHTNESS_H
#define GLINT_BAKE_FIT_BRIGHTNESS_H

#include "glint/setup.h"
#include "glint/workers.h"

enum { GLINT_BRIGHTNESS_ANGLES = 11 };

struct glint_brightness {
    double sine[GLINT_BRIGHTNESS_ANGLES];
    /* brightness level at each angle: energy times pupil area / sensor area.
     * Angles without light: 0 for round lenses, HUGE_VAL for others. */
    double level[GLINT_BRIGHTNESS_ANGLES];
};

/* Sets the angles of the table. Returns how many of them are needed for lights
 * up to MAX_DEG off the axis. */
int glint_brightness_set_angles(struct glint_brightness *brightness,
                                double max_deg);

/* Returns the planes of symmetry of a lens as bits GLINT_MIRRORS_X,
 * GLINT_MIRRORS_Y. */
uint32_t glint_skew_find_mirror_planes(const struct glint_prescription *lens);

/* Finds the brightness levels at all angles needed for lights up to MAX_DEG off
 * the axis. The result does not depend on WORKERS. May return
 * GLINT_E_MEMORY. */
enum glint_status
glint_brightness_find_levels(struct glint_brightness *brightness,
                             const struct glint_setup *setup, double field_mm,
                             double max_deg, const double band_nm[2],
                             struct glint_workers *workers);

/* Returns the brightness level for light at the angle with sine SINE: the
 * smaller one of the levels at the two tabulated angles around it. */
double glint_brightness_get_level(const struct glint_brightness *brightness,
                                  double sine);

/* Max number of times that a zone's box may be halved: spherical surfaces;
 * other surfaces; zones at the axis with a fine tolerance. */
enum { GLINT_PART_DEPTH = 4, GLINT_SHAPED_DEPTH = 6, GLINT_MAX_AXIS_DEPTH = 8 };

/* Tolerances of a fit (RMS; a single ray may be off by five times as much).
 *
 * edge_mm: tolerance of a ghost's outline on the sensor. Outlines are computed
 * from positions in the stop and at barrels, so the tolerances of those are
 * derived from edge_mm and clamped: for the stop to stop_least .. stop, in stop
 * radii; for barrels to 0.06 barrel .. barrel, in semi-diameters. The lower
 * limits are needed because the outline of a large ghost may lie outside the
 * picture, but moves in when the stop closes.
 *
 * All values hold for ghosts at the brightness level of this file. In sRGB the
 * visibility of an error in a ghost of v times that level is v^0.42, so edges
 * and energy of fainter ghosts have larger tolerances, up to ease times. */
struct glint_tolerance {
    double sensor_mm, edge_mm, stop, stop_least, barrel, energy;
    double faint_sensor_mm; /* upper limit of sensor_mm for faint ghosts, mm */
    /* max relative distance (radius / semi-diameter - 1) by which a ray may lie
     * outside a barrel that has no polynomial */
    double escape;
    double ease;
    double pixel_mm; /* width of a pixel in a picture of 1920 pixels, mm */
    /* factor on the min width and on the position tolerance of zones at the
     * axis, where light folds into rings */
    double axis;
    /* max number of halvings of boxes of zones at the axis,
     * GLINT_PART_DEPTH .. GLINT_MAX_AXIS_DEPTH */
    int axis_depth;
    const struct glint_brightness *brightness;
};

#endif
