/* SPDX-License-Identifier: MIT
 *
 * Traces the rays to which the polynomials of a zone are fitted.
 *
 *   in   a zone, the paths of a ghost at a few wavelengths
 *   out  rays in zone coordinates: positions on the sensor and in the stop,
 *        energy, and relative radii at the barrels that block rays
 */
#ifndef GLINT_BAKE_FIT_ZONE_RAYS_H
#define GLINT_BAKE_FIT_ZONE_RAYS_H

#include "bake/fit/zone.h"

enum { GLINT_ZONE_RAYS = 36 * 120, GLINT_MAX_BARRELS = 4 };

/* channels of a ray */
enum {
    RAY_SENSOR_X, /* mm */
    RAY_SENSOR_Y,
    RAY_STOP_X, /* stop radii */
    RAY_STOP_Y,
    RAY_ENERGY,
    /* RAY_EXCESS: max relative radius over all surfaces and the stop.
     * RAY_FIELD: distance from the sensor's centre in field radii. With
     * neighbouring zoom positions: values of the position at which the larger
     * of both is smallest. */
    RAY_EXCESS,
    RAY_FIELD,
    /* skew zones only: area on the sensor / area in (u, v), mm^2; 0: unknown */
    RAY_SPREAD,
    RAY_CHANNELS
};

struct glint_zone_rays {
    int n;
    bool scattered; /* false: the rays form rows of constant v */
    double x[GLINT_VARIABLES][GLINT_ZONE_RAYS];
    double at[RAY_CHANNELS][GLINT_ZONE_RAYS];
    /* coordinates of the rays of the grid that do not reach the sensor */
    int n_invalid;
    double invalid[GLINT_VARIABLES][GLINT_ZONE_RAYS];
    /* barrels that block rays in this zone, and the relative radius of each ray
     * at each of them */
    int n_barrels;
    int barrel[GLINT_MAX_BARRELS]; /* indices among the path's events */
    double radius[GLINT_MAX_BARRELS][GLINT_ZONE_RAYS];
    /* max relative distance by which a ray that passes all listed barrels lies
     * outside a barrel that is not listed */
    double missed_cut;
};

static inline bool glint_zone_rays_is_visible(const struct glint_zone_rays *r,
                                              int ray)
{
    return r->at[RAY_EXCESS][ray] <= 1 && r->at[RAY_FIELD][ray] <= 1;
}

/* Sets X to the zone coordinates of ray I. */
static inline void
glint_zone_rays_get_coordinates(const struct glint_zone_rays *r, int i,
                                double x[GLINT_VARIABLES])
{
    for (int k = 0; k < GLINT_VARIABLES; k++)
        x[k] = r->x[k][i];
}

/* Sets X to the zone coordinates of the invalid ray I. */
static inline void glint_zone_rays_get_invalid(const struct glint_zone_rays *r,
                                               int i, double x[GLINT_VARIABLES])
{
    for (int k = 0; k < GLINT_VARIABLES; k++)
        x[k] = r->invalid[k][i];
}

/* Returns whether rays I and J have the same direction and wavelength. */
static inline bool
glint_zone_rays_have_same_light(const struct glint_zone_rays *r, int i, int j)
{
    return r->x[GLINT_S][i] == r->x[GLINT_S][j] &&
           r->x[GLINT_W][i] == r->x[GLINT_W][j] &&
           r->x[GLINT_P][i] == r->x[GLINT_P][j];
}

/* Returns whether no ray is visible. */
bool glint_zone_rays_are_all_blocked(const struct glint_zone_rays *rays);

/* Returns the ratio of max to min energy among the visible rays of one angle
 * and wavelength: the max over all angles and wavelengths. Films do not affect
 * it. Above GLINT_STEEP the energy varies strongly over the pupil. */
double glint_zone_rays_compute_energy_ratio(const struct glint_zone_rays *rays);
#define GLINT_STEEP 8

/* relative radii of sample rays at all events, used for choosing barrels */
enum { GLINT_SAMPLING_RAYS = 6000 };
typedef double glint_zone_sampling[GLINT_SAMPLING_RAYS][GLINT_MAX_EVENTS + 1];

/* Chooses the listed barrels of RAYS such that every ray that passes them lies
 * at most SHOWS (relative radius) outside any other barrel. */
void glint_zone_choose_barrels(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               double shows, glint_zone_sampling *sampling,
                               struct glint_zone_rays *rays);

/* Traces RAYS for positions and barrels; for skew zones, also for energies. */
void glint_zone_trace_rays(const struct glint_zone *zone,
                           const struct glint_visible *visible,
                           struct glint_zone_rays *rays);

/* Traces ENERGIES of a zone that is not skew, at fewer pupil points but more
 * wavelengths than RAYS. Energies hardly vary over the pupil, but oscillate
 * with the wavelength if coatings have several films. If those of RAYS also
 * vary over the pupil, as near total reflection, the grid is finer, with five
 * wavelengths per angle. */
void glint_zone_trace_energies(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               const struct glint_zone_rays *rays,
                               struct glint_zone_rays *energies);

/* Returns whether errors of rays in ZONE are weighted by the local brightness,
 * which is computed from neighbouring rays. */
static inline bool
glint_zone_is_weighted_by_brightness(const struct glint_zone *zone,
                                     const struct glint_visible *visible)
{
    return visible->shaped || zone->skew;
}

/* Sets RAYS to scattered rays of the zone, at angles and wavelengths between
 * the fitted ones, without barrels and neighbouring zoom positions. The result
 * is deterministic. If errors are weighted by brightness, rays come in groups
 * of three: a neighbour in v, the ray itself, and a neighbour in u; for skew
 * zones only the middle one is stored. */
void glint_zone_trace_check_rays(const struct glint_zone *zone,
                                 const struct glint_visible *visible,
                                 struct glint_zone_rays *rays);

#endif
