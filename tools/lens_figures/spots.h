/* SPDX-License-Identifier: MIT
 *
 * spots.h - where rays of one light meet the sensor, in three wavelengths.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_SPOTS_H
#define GLINT_TOOLS_LENS_FIGURES_SPOTS_H

#include "glint/prescription.h"

/* Rays start in rings about the pupil's middle, six more in each than in the
 * one within. */
enum {
    SPOT_COLOURS = 3,
    SPOT_RINGS = 16,
    SPOT_RAYS = 1 + 3 * SPOT_RINGS * (SPOT_RINGS + 1)
};

struct spots {
    int n;
    double at[SPOT_COLOURS * SPOT_RAYS][2]; /* mm */
    int colour[SPOT_COLOURS * SPOT_RAYS];
    double middle[2]; /* their mean, mm */
    double rms_mm;    /* root mean square distance from it */
    double radius_mm; /* largest */
};

/* Returns the wavelength of COLOUR. */
double spots_nm(int colour);

/* Fills SPOTS with the rays that light at THETA_DEG in the plane at PHI_DEG
 * sends through LENS, evenly over its pupil. */
void spots_gather(struct spots *spots, const struct glint_prescription *lens,
                  double phi_deg, double theta_deg);

#endif
