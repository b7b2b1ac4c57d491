/* SPDX-License-Identifier: MIT
 *
 * Finds at which angles of the light a ghost is visible, and through which
 * region of the pupil.
 *
 *   in   a ghost of a lens, the band of wavelengths, the field
 *   out  ranges of angles, and boxes on the pupil at many angles of a range
 *
 * A ghost may appear, vanish and appear again. The search misses
 *   - a range of angles narrower than the step of the scan, or without light
 *     in the middle of the band;
 *   - a visible region smaller than 1/30 of its box, unless the field is so
 *     small that the search is refined around the nearest ray;
 *   - a visible region that exists for less than four angles and is separate
 *     from the tracked one;
 *   - with neighbouring zoom positions, angles at which light passes only at
 *     wavelengths other than the middle and the ends of the band.
 */
#ifndef GLINT_BAKE_VISIBLE_VISIBLE_H
#define GLINT_BAKE_VISIBLE_VISIBLE_H

#include "glint/setup.h"
#include "glint/trace.h"

enum {
    GLINT_VISIBLE_WAVES = 11,
    GLINT_VISIBLE_COLOURS = 3,
    GLINT_MAX_RANGES = 8,
    /* number of angles per range at which boxes are found */
    GLINT_PROFILE = 49,
    GLINT_MAX_BESIDE = 2
};

/* indices of the wavelengths in the middle and at both ends of the band */
extern const int glint_visible_colour[GLINT_VISIBLE_COLOURS];

/* Lenses of a smaller f-number are fast. Their fits use additional sampling and
 * weights, as fits were tuned for slower lenses. */
#define GLINT_WIDE 10

/* Angle off the axis, degrees, from which lights need the fits of fast lenses:
 * their rays, too, pass near the equators of surfaces. */
#define GLINT_FAR 60

/* a ghost, and the data common to all its ranges of angles */
struct glint_visible {
    const struct glint_setup *setup;
    int ghost;
    double field_mm; /* radius of the field around the sensor's centre, mm */
    /* true: the lens is faster than GLINT_WIDE. Its rays pass near
     * singularities, and its model is also used with much smaller stops. */
    bool wide;
    /* true: the lens is round, and lights beyond GLINT_FAR are requested;
     * implies wide */
    bool far;
    /* true: the lens is round, faster than GLINT_WIDE, and has non-spherical
     * surfaces. Their high powers grow steeply, so some zones of angles cannot
     * be fitted. Such zones are not halved endlessly but accepted where their
     * errors are invisible. */
    bool shaped;
    double wave_lo, wave_hi; /* ends of the band, 1 / wavelength^2, um^-2 */
    /* paths at GLINT_VISIBLE_WAVES wavelengths from wave_lo to wave_hi */
    struct glint_path path[GLINT_VISIBLE_WAVES];
    /* the same paths, for tracing positions without energies */
    struct glint_path position_path[GLINT_VISIBLE_WAVES];
    /* number of neighbouring zoom positions. The rays visible or blocked at
     * these positions are used here, too, so that models of several positions
     * can be interpolated. */
    int n_beside;
    /* [n_beside]: the ghost at the neighbouring zoom positions; n_beside of
     * these is 0 */
    struct glint_visible *beside;
};

/* Returns VISIBLE for K = 0, else the same ghost at neighbouring zoom position
 * K - 1. */
static inline const struct glint_visible *
glint_visible_get_member(const struct glint_visible *visible, int k)
{
    return k == 0 ? visible : &visible->beside[k - 1];
}

void glint_visible_init(struct glint_visible *visible,
                        const struct glint_setup *setup, int ghost,
                        double field_mm, const double band_nm[2]);

/* Sets the max angle between lights and the lens axis, degrees. */
void glint_visible_set_max_angle(struct glint_visible *visible, double max_deg);

/* Sets VISIBLE to WHOLE with the band narrowed to W0 .. W1, in w, -1 .. 1.
 * VISIBLE->beside must have memory for WHOLE->n_beside entries. */
void glint_visible_narrow_band(struct glint_visible *visible,
                               const struct glint_visible *whole, double w0,
                               double w1);

/* Sets PATH to the ghost's path at the wavelength W, -1 .. 1 over the band. */
void glint_visible_init_path(const struct glint_visible *visible, double w,
                             struct glint_path *path);

/* Finds the ranges of angles, as sines, up to MAX_DEG at which light passes.
 * Returns their number. */
int glint_visible_find_ranges(const struct glint_visible *visible,
                              double max_deg, double (*range)[2]);

/* Inserts the range MORE into N disjoint ascending ranges and merges it with
 * ranges that overlap or touch it. Drops MORE if there would be more than
 * GLINT_MAX_RANGES ranges. Returns the new number of ranges. */
int glint_visible_add_range(double (*range)[2], int n, const double more[2]);

/* the box of visible light at one angle and wavelength */
struct glint_box_sample {
    double sine, w; /* sine of the angle; position w in the band, -1 .. 1 */
    struct glint_pupil box;
};

/* The boxes of visible light at ascending angles of a range: one per angle,
 * which contains the light of the complete band, and the boxes at single
 * wavelengths. */
struct glint_visible_profile {
    int n, n_samples;
    double sine[GLINT_PROFILE];
    struct glint_pupil box[GLINT_PROFILE];
    struct glint_box_sample sample[GLINT_PROFILE * GLINT_VISIBLE_WAVES];
};

void glint_visible_find_profile(const struct glint_visible *visible,
                                const double range[2],
                                struct glint_visible_profile *profile);

/* Returns whether RAY passes the stop and all barrels and hits the field. */
bool glint_visible_is_ray_visible(const struct glint_visible *visible,
                                  const struct glint_ray *ray);

/* Extends box A to contain box B. */
void glint_visible_join_boxes(struct glint_pupil *a,
                              const struct glint_pupil *b);

#endif
