/* SPDX-License-Identifier: MIT
 *
 * glint/trace.h - exact rays through a lens.
 *
 *     glint_path_init(&path, &lens, &ghosts[k], 532.0);  one ghost, one colour
 *     glint_trace(&path, px, py, direction, &ray, NULL);
 *
 * Functions that find pupils, bake or draw exact pictures need a stack of
 * GLINT_BAKE_STACK_BYTES in the calling thread and in each worker, more than
 * musl (128 KiB) and macOS (512 KiB) give to threads. */
#ifndef GLINT_TRACE_H
#define GLINT_TRACE_H

#include <stdbool.h>

#include "glint/prescription.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Most surfaces that a path meets. */
#define GLINT_MAX_EVENTS (3 * GLINT_MAX_SURFACES)

#define GLINT_BAKE_STACK_BYTES (1 << 20)

enum glint_event_kind { GLINT_REFRACT, GLINT_REFLECT, GLINT_STOP };

/* One meeting of a ray with a surface or the stop, with its constants worked
 * out. */
struct glint_event {
    enum glint_event_kind kind;
    int surface;       /* index; -1 for the stop */
    double curvature;  /* 1 / radius, 0 for a plane and the stop */
    double advance_mm; /* z from the vertex of the last event (or the start
                          plane) to this one; negative when running backwards */
    double semi_mm;    /* semi-diameter */
    /* Index before the surface and after it, as the ray runs. */
    double n_from, n_to;
    int n_films; /* layers of the surface's coating; 0: bare */
    bool shaped; /* the surface is not a centred sphere: see path->form */
};

/* A layer of a coating at the wavelength of a path. */
struct glint_film_at {
    double n;     /* index */
    double phase; /* 4 pi n d / wavelength, radians */
};

/* The path of one ghost at one wavelength: forward to J, back to I, forward to
 * the sensor. Immutable once made; any number of threads may trace it. */
struct glint_path {
    int n_events;
    struct glint_event event[GLINT_MAX_EVENTS + 1];
    /* The coating of each surface that is met. */
    struct glint_film_at film[GLINT_MAX_SURFACES][GLINT_MAX_FILMS];
    struct glint_form form[GLINT_MAX_SURFACES]; /* of shaped surfaces only */
    bool round; /* true: all of the lens is symmetric about its axis, and y of a
                   light in the x-z plane may be mirrored */
    /* From the light's frame on the sensor to the same in the picture, which an
     * anamorphic lens's projector widens. Used unless ROUND. */
    double widen[2][2];
    double to_sensor_mm; /* from the last vertex to the sensor */
    bool places_only; /* true: energies stay 1, and tracing takes a third less
                         time */
};

/* Fills PATH for GHOST of LENS; NULL: for the direct path. */
void glint_path_init(struct glint_path *path,
                     const struct glint_prescription *lens,
                     const struct glint_ghost *ghost, double wavelength_nm);

/* Does the same for light in the plane at PHI_DEG about the axis, which stays
 * the x-z plane of rays, hits and pupils: the lens is turned instead. */
void glint_path_init_at(struct glint_path *path,
                        const struct glint_prescription *lens,
                        const struct glint_ghost *ghost, double wavelength_nm,
                        double phi_deg);

enum glint_ray_status {
    GLINT_RAY_OK = 0,
    GLINT_RAY_MISSED = 1, /* the ray misses a surface, meets it beyond its
                             equator, or cannot continue */
    GLINT_RAY_TOTAL_REFLECTION =
        2 /* the ray is reflected totally where it should be refracted */
};

struct glint_ray {
    /* Point at which the ray crosses the stop's plane. */
    double stop_x_mm, stop_y_mm;
    /* Point at which the ray hits the sensor; of an anamorphic lens its x in
     * the picture as it is shown. */
    double sensor_x_mm, sensor_y_mm;
    double energy;     /* transmittances times reflectances, 0 .. 1 */
    double rel_radius; /* largest |xy| / semi-diameter over all surfaces */
};

/* Traces the ray that starts at (PX, PY) on the vertex plane of the first
 * surface along DIRECTION, of unit length. The ray continues where a barrel or
 * the stop would have blocked it. RAY is written only if GLINT_RAY_OK is
 * returned. HITS, unless NULL, receives x and y of each event, [n_events][2],
 * in mm; those of a surface that is not a centred sphere are in its own frame.
 * Energy is that of unpolarised light. [Hullin11] section 4 */
enum glint_ray_status glint_trace(const struct glint_path *path, double px_mm,
                                  double py_mm, const double direction[3],
                                  struct glint_ray *ray, double (*hits)[2]);

/* The start of a ray on the vertex plane of the first surface, and its
 * direction of unit length. */
struct glint_launch {
    double x_mm, y_mm, direction[3];
};

/* Traces N rays, with the same bits as glint_trace() gives, in a fraction of
 * the time. RAY and STATUS have N entries, HITS has [n][n_events][2]. */
void glint_trace_many(const struct glint_path *path, int n,
                      const struct glint_launch *from, struct glint_ray *ray,
                      enum glint_ray_status *status, double (*hits)[2]);

/* N parallel rays in a row along x. */
struct glint_row {
    int n;
    double x0_mm, step_mm, y_mm, direction[3];
};

/* Does what glint_trace_many() does for the rays of ROW: ray I starts at x0_mm
 * + I step_mm. */
void glint_trace_row(const struct glint_path *path, const struct glint_row *row,
                     struct glint_ray *ray, enum glint_ray_status *status,
                     double (*hits)[2]);

/* Returns the index of refraction of a glass at WAVELENGTH_NM, by two-term
 * Cauchy from ND and VD; VD <= 0 is a medium without dispersion. */
double glint_index(double nd, double vd, double wavelength_nm);

/* Returns the reflectance of one boundary for unpolarised light that meets it
 * at COS_FROM, 1 at total reflection; what is not reflected passes. The
 * boundary is bare where N_FILMS is 0, else coated with FILM[N_FILMS], at most
 * GLINT_MAX_FILMS. They are those from the medium of the smaller index on, air,
 * whichever way the light runs, which does not matter as nothing absorbs. */
double glint_reflectance(double n_from, double n_to, double cos_from,
                         const struct glint_film_at *film, int n_films);

/* Does the same for light polarised perpendicular to the plane of incidence,
 * s, and parallel to it, p. */
void glint_reflectance_sp(double n_from, double n_to, double cos_from,
                          const struct glint_film_at *film, int n_films,
                          double *s, double *p);

/* Sets FILM to the layers of COATING at WAVELENGTH_NM; returns how many. */
int glint_coating_at(const struct glint_coating *coating, double wavelength_nm,
                     struct glint_film_at film[GLINT_MAX_FILMS]);

/* A part of the vertex plane of the first surface that holds every ray of a
 * path that the stop and the barrels let through. The light is in the x-z
 * plane. Of a round lens the part is symmetric in y: y0 is 0, and what lies
 * below is MIRRORED. */
struct glint_pupil {
    double x0_mm, x1_mm, y0_mm, y1_mm;
    bool mirrored;
    double energy;       /* largest energy of a ray seen inside */
    double sensor_mm[4]; /* range of its light on the sensor: x0, x1, y0, y1 */
};

/* Returns the height of P with its mirror image, mm. */
static inline double glint_pupil_height(const struct glint_pupil *p)
{
    return p->mirrored ? 2 * p->y1_mm : p->y1_mm - p->y0_mm;
}

/* Finds the pupil of PATH for light at THETA_DEG; returns false if nothing gets
 * through. NEAR: NULL, or the pupil at another wavelength; the search then
 * looks only at that and its surroundings, for a third of the work. */
bool glint_pupil_find(struct glint_pupil *pupil, const struct glint_path *path,
                      double theta_deg, double stop_radius_mm,
                      const struct glint_pupil *near);

/* Finds the pupil of those rays that also land within FIELD_MM of the sensor's
 * centre; otherwise as glint_pupil_find(). */
bool glint_pupil_find_within(struct glint_pupil *pupil,
                             const struct glint_path *path, double theta_deg,
                             double stop_radius_mm, double field_mm,
                             const struct glint_pupil *near);

/* Finds the pupil for light along DIRECTION, of unit length, in any plane if
 * the lens is not round, in the x-z plane if it is. */
bool glint_pupil_find_towards(struct glint_pupil *pupil,
                              const struct glint_path *path,
                              const double direction[3], double stop_radius_mm,
                              double field_mm, const struct glint_pupil *near);

#ifdef __cplusplus
}
#endif

#endif
