/* SPDX-License-Identifier: MIT
 *
 * glint/trace.h - traces exact rays through a lens.
 *
 *     glint_path_init(&path, &lens, &ghosts[k], 532.0);  one ghost, one colour
 *     glint_trace(&path, px, py, direction, &ray, NULL);
 *
 * Functions that find pupils, bake or draw exact pictures need a stack of
 * GLINT_BAKE_STACK_BYTES in the calling thread and in each worker, which
 * exceeds the default of threads of musl (128 KiB) and macOS (512 KiB). */
#ifndef GLINT_TRACE_H
#define GLINT_TRACE_H

#include <stdbool.h>

#include "glint/prescription.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Max events of a path: the light of a ghost crosses each surface at most three
 * times. */
#define GLINT_MAX_EVENTS (3 * GLINT_MAX_SURFACES)

#define GLINT_BAKE_STACK_BYTES (1 << 20)

enum glint_event_kind { GLINT_REFRACT, GLINT_REFLECT, GLINT_STOP };

/* An event: a ray meets a surface or the stop. Its members are precomputed
 * constants of the path. */
struct glint_event {
    enum glint_event_kind kind;
    int surface;       /* index of the surface; -1 for the stop */
    double curvature;  /* 1 / radius, 0 for a plane and the stop */
    double advance_mm; /* distance along z from the vertex of the previous event
                          (or from the start plane) to the vertex of this event;
                          negative where light runs backwards */
    double semi_mm;    /* semi-diameter */
    /* Index of refraction before and after the surface, in the direction of the
     * ray. */
    double n_from, n_to;
    int n_films; /* layers of the surface's coating; 0: bare */
    bool shaped; /* true: the surface is not a centred sphere; path->form
                    describes it */
};

/* A layer of a coating at the wavelength of a path. */
struct glint_film_at {
    double n;     /* index of refraction */
    double phase; /* 4 pi n d / wavelength, radians */
};

/* The path of one ghost at one wavelength: forward to surface J, back to I,
 * forward to the sensor. It never changes after initialisation, so any number
 * of threads may trace it. */
struct glint_path {
    int n_events;
    struct glint_event event[GLINT_MAX_EVENTS + 1];
    /* Layers of the coating of each surface, at the wavelength of the path. */
    struct glint_film_at film[GLINT_MAX_SURFACES][GLINT_MAX_FILMS];
    /* Forms of the surfaces; defined only for surfaces that are not centred
     * spheres. */
    struct glint_form form[GLINT_MAX_SURFACES];
    bool round; /* true: the lens is symmetric about its axis, so rays of a
                   light in the x-z plane are symmetric in y */
    /* Matrix from sensor to picture coordinates, in the frame of the light. The
     * picture of an anamorphic lens is widened when it is projected. Used only
     * if ROUND is false. */
    double widen[2][2];
    double to_sensor_mm; /* z from the last vertex to the sensor */
    /* true: energies are not computed but set to 1, which saves a third of the
     * time. */
    bool places_only;
};

/* Sets PATH to the path of GHOST through LENS; if GHOST is NULL, to the direct
 * path. */
void glint_path_init(struct glint_path *path,
                     const struct glint_prescription *lens,
                     const struct glint_ghost *ghost, double wavelength_nm);

/* Like glint_path_init(), for light in the plane at PHI_DEG about the axis.
 * The lens is rotated so that this plane is the x-z plane of rays, hits and
 * pupils. */
void glint_path_init_at(struct glint_path *path,
                        const struct glint_prescription *lens,
                        const struct glint_ghost *ghost, double wavelength_nm,
                        double phi_deg);

enum glint_ray_status {
    GLINT_RAY_OK = 0,
    /* The ray misses a surface, hits a surface's sphere only on its far half,
     * or cannot continue. */
    GLINT_RAY_MISSED = 1,
    GLINT_RAY_TOTAL_REFLECTION =
        2 /* total reflection at a surface where the path refracts */
};

struct glint_ray {
    /* Point at which the ray crosses the stop's plane. */
    double stop_x_mm, stop_y_mm;
    /* Point at which the ray hits the sensor; for an anamorphic lens, x is in
     * the widened picture. */
    double sensor_x_mm, sensor_y_mm;
    double energy;     /* product of all transmittances and reflectances, 0 ..
                          1 */
    double rel_radius; /* max over all surfaces of (distance from the axis /
                          semi-diameter) */
};

/* Traces the ray that starts at (PX, PY) on the vertex plane of the first
 * surface and runs along DIRECTION, of unit length. Barrels and the stop do not
 * block the ray. RAY is written only if GLINT_RAY_OK is returned. HITS, unless
 * NULL, receives x and y of each event in mm, [n_events][2]; at a surface that
 * is not a centred sphere they are in the frame of the surface. The energy is
 * computed for unpolarised light. [Hullin11] section 4 */
enum glint_ray_status glint_trace(const struct glint_path *path, double px_mm,
                                  double py_mm, const double direction[3],
                                  struct glint_ray *ray, double (*hits)[2]);

/* The start of a ray on the vertex plane of the first surface, and its
 * direction of unit length. */
struct glint_launch {
    double x_mm, y_mm, direction[3];
};

/* Traces N rays with results bit-identical to glint_trace(), in a fraction
 * of the time. RAY and STATUS have N entries, HITS has [n][n_events][2]. */
void glint_trace_many(const struct glint_path *path, int n,
                      const struct glint_launch *from, struct glint_ray *ray,
                      enum glint_ray_status *status, double (*hits)[2]);

/* N parallel rays whose start points form a row along x. */
struct glint_row {
    int n;
    double x0_mm, step_mm, y_mm, direction[3];
};

/* Traces the rays of ROW like glint_trace_many(); ray I starts at x = x0_mm + I
 * step_mm. */
void glint_trace_row(const struct glint_path *path, const struct glint_row *row,
                     struct glint_ray *ray, enum glint_ray_status *status,
                     double (*hits)[2]);

/* Traces ROWS rows of a grid: row J like ROW, but at the height Y_MM[J]. RAY
 * and STATUS have [rows][n] entries. Takes less time than single rows, as rays
 * of the end of a row are traced together with those of the next. */
void glint_trace_grid(const struct glint_path *path,
                      const struct glint_row *row, int rows, const double *y_mm,
                      struct glint_ray *ray, enum glint_ray_status *status,
                      double (*hits)[2]);

/* Returns the index of refraction of a glass at WAVELENGTH_NM, by the two-term
 * Cauchy formula from ND and VD. VD <= 0 means no dispersion. */
double glint_index(double nd, double vd, double wavelength_nm);

/* Returns the reflectance of a boundary for unpolarised light with the cosine
 * of incidence COS_FROM; 1 at total reflection. Light that is not reflected is
 * transmitted. The boundary is bare if N_FILMS is 0. Otherwise it is coated
 * with FILM[N_FILMS], at most GLINT_MAX_FILMS films; the film next to the
 * medium of lower index (air) is first. The order is the same for both
 * directions of light, because films do not absorb. */
double glint_reflectance(double n_from, double n_to, double cos_from,
                         const struct glint_film_at *film, int n_films);

/* Sets *S and *P to the reflectance of light polarised perpendicular and
 * parallel to the plane of incidence. */
void glint_reflectance_sp(double n_from, double n_to, double cos_from,
                          const struct glint_film_at *film, int n_films,
                          double *s, double *p);

/* Sets FILM to the layers of COATING at WAVELENGTH_NM; returns their number. */
int glint_coating_at(const struct glint_coating *coating, double wavelength_nm,
                     struct glint_film_at film[GLINT_MAX_FILMS]);

/* A rectangle of the vertex plane of the first surface that contains all rays
 * of a path that pass the stop and the barrels. The light is in the x-z plane.
 * For a round lens the rays are symmetric in y: y0 is then 0, and MIRRORED
 * states that the mirror image of the rectangle belongs to it. */
struct glint_pupil {
    double x0_mm, x1_mm, y0_mm, y1_mm;
    bool mirrored;
    double energy;       /* largest energy of the rays that were probed */
    double sensor_mm[4]; /* bounds of the light on the sensor, mm: x0, x1, y0,
                            y1 */
};

/* Returns the height of P, mm, including its mirror image. */
static inline double glint_pupil_height(const struct glint_pupil *p)
{
    return p->mirrored ? 2 * p->y1_mm : p->y1_mm - p->y0_mm;
}

/* Finds the pupil of PATH for light at THETA_DEG. Returns false if no light
 * passes. NEAR is NULL, or the pupil at another wavelength. Only NEAR and its
 * surroundings are then searched, at a third of the cost. */
bool glint_pupil_find(struct glint_pupil *pupil, const struct glint_path *path,
                      double theta_deg, double stop_radius_mm,
                      const struct glint_pupil *near);

/* Like glint_pupil_find(), but only for rays that hit the sensor within
 * FIELD_MM of its centre. */
bool glint_pupil_find_within(struct glint_pupil *pupil,
                             const struct glint_path *path, double theta_deg,
                             double stop_radius_mm, double field_mm,
                             const struct glint_pupil *near);

/* Like glint_pupil_find_within(), for light along DIRECTION, of unit length,
 * which must be in the x-z plane if the lens is round. */
bool glint_pupil_find_towards(struct glint_pupil *pupil,
                              const struct glint_path *path,
                              const double direction[3], double stop_radius_mm,
                              double field_mm, const struct glint_pupil *near);

/* Like glint_pupil_find_towards(), in a fifth of the time, for drafts: light
 * that enters through less than 1/16 of the front element can be missed. The
 * energy of PUPIL is 0. */
bool glint_pupil_find_roughly(struct glint_pupil *pupil,
                              const struct glint_path *path,
                              const double direction[3], double stop_radius_mm);

/* Extends PUPIL by the pupil of PATH for light along DIRECTION. PUPIL must be
 * the pupil for a similar wavelength and direction. This costs a tenth of
 * glint_pupil_find(). Returns false if no light passes. */
bool glint_pupil_extend(struct glint_pupil *pupil,
                        const struct glint_path *path,
                        const double direction[3], double stop_radius_mm);

#ifdef __cplusplus
}
#endif

#endif
