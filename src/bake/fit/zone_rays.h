/* SPDX-License-Identifier: MIT
 *
 * Traces the rays that polynomials of a zone are fitted to.
 *
 *   in   a zone, a ghost's paths at a few wavelengths
 *   out  rays in the zone's coordinates: where they land, their energy, how
 *        near they come to the barrels that cut */
#ifndef GLINT_BAKE_FIT_ZONE_RAYS_H
#define GLINT_BAKE_FIT_ZONE_RAYS_H

#include "bake/fit/zone.h"

enum { GLINT_ZONE_RAYS = 36 * 120, GLINT_MAX_BARRELS = 4 };

/* Channels of a sample. */
enum {
    RAY_SENSOR_X, /* mm */
    RAY_SENSOR_Y,
    RAY_STOP_X, /* stop radii */
    RAY_STOP_Y,
    RAY_ENERGY,
    /* Largest relative radius at any surface and at the stop, and distance from
     * the sensor's centre, in radii of the field: of the ghost, or of the one
     * beside it at which the larger of both is least. */
    RAY_EXCESS,
    RAY_FIELD,
    RAY_SPREAD, /* area on the sensor per area of u and v, mm^2; skew zones
                   only; 0: unknown */
    RAY_CHANNELS
};

struct glint_zone_rays {
    int n;
    bool scattered; /* false: neighbours of the same v lie in rows */
    double x[GLINT_VARIABLES][GLINT_ZONE_RAYS];
    double at[RAY_CHANNELS][GLINT_ZONE_RAYS];
    /* relative radius at each barrel that cuts in the zone */
    int n_barrels;
    int barrel[GLINT_MAX_BARRELS]; /* events of the path */
    double radius[GLINT_MAX_BARRELS][GLINT_ZONE_RAYS];
    double missed_cut; /* largest relative distance by which a ray gets past a
                          barrel that is not listed */
};

static inline bool glint_zone_rays_seen(const struct glint_zone_rays *r,
                                        int ray)
{
    return r->at[RAY_EXCESS][ray] <= 1 && r->at[RAY_FIELD][ray] <= 1;
}

/* Sets X to the zone coordinates of ray I. */
static inline void glint_zone_rays_x(const struct glint_zone_rays *r, int i,
                                     double x[GLINT_VARIABLES])
{
    for (int k = 0; k < GLINT_VARIABLES; k++)
        x[k] = r->x[k][i];
}

/* Returns whether rays I and J have the same direction and wavelength. */
static inline bool glint_zone_rays_alike(const struct glint_zone_rays *r, int i,
                                         int j)
{
    return r->x[GLINT_S][i] == r->x[GLINT_S][j] &&
           r->x[GLINT_W][i] == r->x[GLINT_W][j] &&
           r->x[GLINT_P][i] == r->x[GLINT_P][j];
}

/* Returns true if none of the rays is visible. */
bool glint_zone_rays_dark(const struct glint_zone_rays *rays);

/* Returns the largest ratio of max to min energy of visible rays at one angle
 * and wavelength, which films do not affect; above GLINT_STEEP it is large. */
double glint_zone_rays_spread(const struct glint_zone_rays *rays);
#define GLINT_STEEP 8

/* Room for the sampling that chooses the barrels. */
enum { GLINT_SAMPLING_RAYS = 6000 };
typedef double glint_zone_sampling[GLINT_SAMPLING_RAYS][GLINT_MAX_EVENTS + 1];

/* Chooses the barrels of RAYS so that no ray gets farther than SHOWS, a
 * relative radius, past any other. */
void glint_zone_choose_barrels(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               double shows, glint_zone_sampling *sampling,
                               struct glint_zone_rays *rays);

/* Traces RAYS for positions and barrels, and ENERGIES at fewer points of the
 * pupil but more wavelengths. For a skew zone RAYS are also used for
 * energies. */
void glint_zone_trace(const struct glint_zone *zone,
                      const struct glint_visible *visible,
                      struct glint_zone_rays *rays,
                      struct glint_zone_rays *energies);

/* Returns whether errors of rays of ZONE are weighted by their local
 * brightness, which needs neighbouring rays. */
static inline bool glint_zone_by_light(const struct glint_zone *zone,
                                       const struct glint_visible *visible)
{
    return visible->shaped || zone->skew;
}

/* Sets RAYS to scattered rays of the zone, at angles and wavelengths between
 * those that were fitted, without barrels and what is seen beside alone.
 * Deterministic. If rays are weighted by light they come in threes: the middle
 * ray, a neighbour across and a neighbour along. In a skew zone only the middle
 * ray counts. */
void glint_zone_check(const struct glint_zone *zone,
                      const struct glint_visible *visible,
                      struct glint_zone_rays *rays);

#endif
