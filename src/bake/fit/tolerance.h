/* SPDX-License-Identifier: MIT
 *
 * The tolerances that polynomials of a lens are fitted to. */
#ifndef GLINT_BAKE_FIT_TOLERANCE_H
#define GLINT_BAKE_FIT_TOLERANCE_H

#include "bake/fit/brightness.h"

/* Most times that a zone's box may be halved: in general, of shaped lenses, and
 * at the axis for fine tolerances. */
enum { GLINT_PART_DEPTH = 4, GLINT_SHAPED_DEPTH = 6, GLINT_MAX_AXIS_DEPTH = 8 };

/* Root mean squares that are aimed at; single rays may be off by five times as
 * much. Positions in the stop and at barrels draw the outline: EDGE_MM is how
 * far they may shift it on the sensor. From that follow their own tolerances:
 * STOP_LEAST to STOP, in stop radii, and 0.06 BARREL to BARREL, in radii of the
 * barrel. The lower limits are needed as the outline of a ghost that is larger
 * than the picture may lie outside of it, but moves in when the stop closes.
 *
 * The values are for ghosts of the level of brightness.h. sRGB shows an error
 * in a ghost of v times that level by v^0.42 as much, so edges and energy
 * of fainter ghosts may be off by more, up to EASE times. */
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
