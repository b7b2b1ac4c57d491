/* SPDX-License-Identifier: MIT
 *
 * A range of angles of one ghost, and the rays that are fitted over it.
 *
 *   in   a ghost's paths at a few wavelengths, a range of the light's angle
 *   out  a pupil box that follows the visible part through the range, and
 *        samples inside it in coordinates of -1 .. 1:
 *          u, v  place in the box, the light's plane along u
 *          s     the sine of the light's angle within the range
 *          w     1 / wavelength^2 within the band
 *
 * In these coordinates a ghost is tame, and symmetric in v, so v >= 0 is all
 * that is traced.
 */
#ifndef GLINT_BAKE_FIT_ZONE_H
#define GLINT_BAKE_FIT_ZONE_H

#include "bake/fit/hunt.h"
#include "bake/fit/regress.h"
#include "glint/model.h"
#include "glint/trace.h"

enum {
    GLINT_ZONE_SINES = 6,
    GLINT_ZONE_RAYS = 36 * 120,
    GLINT_MAX_BARRELS = 4
};

struct glint_zone {
    double lo, hi;                  /* sine of the angle */
    double middle[GLINT_BOX_TERMS]; /* mm; terms as in a model */
    double half_x[GLINT_BOX_TERMS], half_y[GLINT_BOX_TERMS];
    double fill; /* mean share of the box that the ghost needs */
    int hollow;  /* as of struct glint_model_system */
};

/* A part of a zone's box and band: U0 .. U1 of its u, up to TOP of its v, W0 ..
 * W1 of its w. */
struct glint_zone_part {
    double u0, u1, top, w0, w1;
    int hollow;
};

/* One of these at S and W. */
double glint_zone_at(const double side[GLINT_BOX_TERMS], double s, double w);

/* Sets the box for LO .. HI of PROFILE: one for all colours, or one that moves
 * with them and takes more terms. */
void glint_zone_init(struct glint_zone *zone,
                     const struct glint_visible_profile *profile, double lo,
                     double hi, bool by_colour);

/* Where a hollow box begins, a share of its half height. */
double glint_zone_rim(int hollow);

/* The halves of PART, along v (inner and outer) or along u. */
void glint_zone_part_halve(const struct glint_zone_part *part, bool along_v,
                           struct glint_zone_part *first,
                           struct glint_zone_part *second);

/* Reduces the box to PART of it. */
void glint_zone_cut(struct glint_zone *zone,
                    const struct glint_zone_part *part);

/* Reduces PART, to which ZONE has been cut and HUNT narrowed, to what can be
 * seen of it, and a margin. Returns by how much, 1: by nothing; 0: there is
 * nothing. */
double glint_zone_crop(const struct glint_zone *zone,
                       const struct glint_hunt *hunt,
                       struct glint_zone_part *part);

/* Node K of N over -1 .. 1, the ends among them. */
double glint_zone_node(int k, int n);

/* Channels of a sample. */
enum {
    RAY_SENSOR_X, /* mm */
    RAY_SENSOR_Y,
    RAY_STOP_X, /* stop radii */
    RAY_STOP_Y,
    RAY_ENERGY,
    RAY_EXCESS, /* the largest of all relative radii, the stop's too */
    RAY_FIELD,  /* distance from the sensor's centre, fields */
    RAY_CHANNELS
};

struct glint_zone_rays {
    int n;
    double x[GLINT_VARIABLES][GLINT_ZONE_RAYS];
    double at[RAY_CHANNELS][GLINT_ZONE_RAYS];
    /* relative radius at each barrel that limits the zone */
    int n_barrels;
    int barrel[GLINT_MAX_BARRELS]; /* events of the path */
    double radius[GLINT_MAX_BARRELS][GLINT_ZONE_RAYS];
    double missed_cut; /* how far past a barrel that is not among them a ray
                          gets at most, relative */
};

static inline bool glint_zone_rays_seen(const struct glint_zone_rays *r,
                                        int ray)
{
    return r->at[RAY_EXCESS][ray] <= 1 && r->at[RAY_FIELD][ray] <= 1;
}

/* The most energy over the least of what is seen at one angle and wavelength,
 * and what is much: films make all of it swing with the wavelength. */
double glint_zone_rays_spread(const struct glint_zone_rays *rays);
#define GLINT_STEEP 8

/* Room for the survey that chooses the barrels. */
enum { GLINT_SURVEY_RAYS = 6000 };
typedef double glint_zone_survey[GLINT_SURVEY_RAYS][GLINT_MAX_EVENTS + 1];

/* Chooses the barrels of RAYS: no ray gets farther past the others than SHOWS,
 * a relative radius. */
void glint_zone_survey_barrels(const struct glint_zone *zone,
                               const struct glint_hunt *hunt, double shows,
                               glint_zone_survey *survey,
                               struct glint_zone_rays *rays);

/* Traces the samples: RAYS for positions and barrels, ENERGIES at fewer places
 * but more wavelengths. */
void glint_zone_trace(const struct glint_zone *zone,
                      const struct glint_hunt *hunt,
                      struct glint_zone_rays *rays,
                      struct glint_zone_rays *energies);

/* Random rays of the zone, at angles and wavelengths between those of the
 * samples. Barrels are not looked at. Deterministic. */
void glint_zone_check(const struct glint_zone *zone,
                      const struct glint_hunt *hunt,
                      struct glint_zone_rays *rays);

#endif
