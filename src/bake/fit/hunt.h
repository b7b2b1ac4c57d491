/* SPDX-License-Identifier: MIT
 *
 * Where a ghost is to be found: at which angles of the light, and through which
 * part of the pupil.
 *
 *   in   a ghost of a lens, the band of wavelengths, the field that counts
 *   out  ranges of angles, and boxes on the pupil at many angles of a range
 *
 * A ghost may appear, vanish and come back. Limits: ranges narrower than the
 * step of the scan, or without the middle of the band, can be missed, and so
 * can a visible part that is smaller than a thirtieth of its own box (unless
 * the field is so small that it is closed in upon), or that is there for less
 * than four angles apart from the one that is followed.
 */
#ifndef GLINT_BAKE_FIT_HUNT_H
#define GLINT_BAKE_FIT_HUNT_H

#include "glint/setup.h"
#include "glint/trace.h"

enum {
    GLINT_HUNT_WAVES = 11,
    GLINT_MAX_RANGES = 8,
    GLINT_PROFILE = 49 /* boxes over a range */
};

/* One ghost and what all its ranges share. */
struct glint_hunt {
    const struct glint_setup *setup;
    int ghost;
    double field_mm; /* light beyond this radius on the sensor is no loss */
    double wave_lo, wave_hi;                   /* 1 / wavelength^2, um^-2 */
    struct glint_path path[GLINT_HUNT_WAVES];  /* from wave_lo to wave_hi */
    struct glint_path scout[GLINT_HUNT_WAVES]; /* the same for places only */
};

void glint_hunt_init(struct glint_hunt *hunt, const struct glint_setup *setup,
                     int ghost, double field_mm, const double band_nm[2]);

/* HUNT for the part W0 .. W1, -1 .. 1, of the band of WHOLE. */
void glint_hunt_narrow(struct glint_hunt *hunt, const struct glint_hunt *whole,
                       double w0, double w1);

/* The path at W, -1 .. 1 over the band. */
void glint_hunt_path(const struct glint_hunt *hunt, double w,
                     struct glint_path *path);

/* Sines of the angles between which something gets through, up to MAX_DEG.
 * Returns how many ranges. */
int glint_hunt_ranges(const struct glint_hunt *hunt, double max_deg,
                      double (*range)[2]);

/* What gets through at one angle and wavelength. */
struct glint_glimpse {
    double sine, w; /* w: -1 .. 1 over the band */
    struct glint_pupil box;
};

/* Boxes over a range: at each angle, the one that holds what gets through
 * anywhere in the band, and those of single wavelengths, by rising angle. */
struct glint_visible_profile {
    int n, n_glimpses;
    double sine[GLINT_PROFILE];
    struct glint_pupil box[GLINT_PROFILE];
    struct glint_glimpse glimpse[GLINT_PROFILE * GLINT_HUNT_WAVES];
};

void glint_hunt_profile(const struct glint_hunt *hunt, const double range[2],
                        struct glint_visible_profile *profile);

/* Whether the stop, the barrels and the field let RAY through. */
bool glint_hunt_visible(const struct glint_hunt *hunt,
                        const struct glint_ray *ray);

#endif
