/* SPDX-License-Identifier: MIT
 *
 * glint/bake.h - the offline half: lens tables, exact rays, exact pictures.
 *
 *     glint_prescription_parse(&lens, text, bytes, "x.lens", &error);
 *     glint_optics_of(&lens, &optics);                   focal length, ...
 *     n = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
 *     glint_path_init(&path, &lens, &ghosts[k], 532.0);  one ghost, one colour
 *     glint_trace(&path, px, py, direction, &ray, NULL);
 *
 * Everything here is double precision and may take its time. Lengths are in
 * millimetres, wavelengths in nanometres, angles in degrees. A thread that
 * calls what finds pupils, bakes or draws, and each of its workers, needs a
 * stack of GLINT_BAKE_STACK_BYTES, more than what musl (128 KiB) and macOS
 * (512 KiB) give to threads.
 *
 * Axes: z runs from the front vertex (0) to the sensor, x to the right and y
 * up as the picture is seen. A light at (THETA, PHI) sends parallel rays along
 * (sin T cos P, sin T sin P, cos T); its own image is at f tan T (cos P, sin P)
 * on the sensor.
 */
#ifndef GLINT_BAKE_H
#define GLINT_BAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/lens.h"
#include "glint/status.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_SURFACES 64 /* refracting surfaces of a lens */
#define GLINT_MAX_GHOSTS   (GLINT_MAX_SURFACES * (GLINT_MAX_SURFACES - 1) / 2)
#define GLINT_MAX_EVENTS   (3 * GLINT_MAX_SURFACES) /* of one path */
#define GLINT_NAME_BYTES   64

#define GLINT_BAKE_STACK_BYTES (1 << 20)

/* ------------------------------------------------------------ lens tables */

/* A refracting surface. The medium before surface 0 is air. */
struct glint_surface {
    double radius_mm;    /* > 0: centre towards the sensor; 0: plane */
    double thickness_mm; /* to the next surface, the stop, or the sensor */
    double semi_mm;      /* semi-diameter of the barrel here */
    double nd;           /* index at 587.56 nm of the medium after it */
    double vd;           /* Abbe number of that medium; 0 for air */
    double coating_nm;   /* design wavelength of its quarter-wave film; 0:
                            bare, as cemented surfaces always are */
    double coating_n;    /* index of the film */
};

/* A film on a surface, a quarter wave thick. */
struct glint_film {
    double nm;    /* design wavelength, 100 .. 5000; 0: no film */
    double index; /* 1.01 .. 4 */
};

#define GLINT_MAX_FILMS GLINT_MAX_SURFACES

/* A lens table, all of it checked. The stop lies between two surfaces: its gap
 * before is the thickness of the surface in front of it. */
struct glint_prescription {
    char name[GLINT_NAME_BYTES];
    char source[256]; /* patent or book, for people */
    double f_number;
    double film_width_mm, film_height_mm;
    int n_surfaces; /* without the stop, 1 .. GLINT_MAX_SURFACES */
    struct glint_surface surface[GLINT_MAX_SURFACES];
    int stop_after;           /* surfaces before the stop, 0 .. n_surfaces */
    double stop_thickness_mm; /* from the stop to the next surface (or the
                                 sensor); a front stop lies at z < 0 */
    double stop_semi_mm;      /* largest opening of the stop */
    double check_focal_mm;    /* stated values; 0: not stated */
    double check_back_mm;
    /* What the table would have on its surfaces to be looked at, rather than
     * measured; on them only after glint_prescription_coat(). */
    struct glint_film mixed[GLINT_MAX_FILMS];
    int n_mixed; /* 0: the table does not say */
};

/* Reads a lens table; lenses/README.md describes the format. TEXT need not be
 * terminated and may hold anything. FILE_NAME only names it in errors.
 * GLINT_E_LENS: ERROR says file, line, column and cause; LENS is unchanged. */
enum glint_status glint_prescription_parse(struct glint_prescription *lens,
                                           const char *text, size_t bytes,
                                           const char *file_name,
                                           struct glint_error *error);

/* Changes the f-number. GLINT_E_ARGUMENT: not finite, or the stop it asks for
 * is wider than stop_semi_mm. */
enum glint_status
glint_prescription_set_f_number(struct glint_prescription *lens,
                                double f_number, struct glint_error *error);

/* Takes what is on LENS's surfaces between air and glass off, and deals FILMS
 * out over them, the first one to the front and from the first again behind the
 * last; N 1 .. GLINT_MAX_FILMS. Cemented surfaces stay bare. */
void glint_prescription_coat(struct glint_prescription *lens,
                             const struct glint_film *films, int n);

/* The films that a table without any of its own is mixed of; returns how many
 * there are. */
int glint_films_mixed(struct glint_film films[GLINT_MAX_FILMS]);

/* Reads films as the tables have them, "none", "NM" or "NM/INDEX", but divided
 * by commas. GLINT_E_ARGUMENT: ERROR says what is wrong; nothing is written. */
enum glint_status glint_films_parse(struct glint_film films[GLINT_MAX_FILMS],
                                    int *n, const char *text,
                                    struct glint_error *error);

/* First-order quantities at the d line (587.56 nm). */
struct glint_optics {
    double focal_mm;           /* effective focal length */
    double back_focal_mm;      /* last surface to the paraxial focus */
    double entrance_radius_mm; /* of the entrance pupil: focal / (2 N) */
    double entrance_z_mm;      /* of the entrance pupil from the front vertex */
    double stop_radius_mm;     /* of the aperture stop at the f-number */
    double length_mm;          /* front vertex to sensor */
};

void glint_optics_of(const struct glint_prescription *lens,
                     struct glint_optics *optics);

/* ------------------------------------------------------------------ ghosts */

/* Light reflected at surface J and then, running backwards, at surface I.
 * I = J = -1 is the direct path without reflections. */
struct glint_ghost {
    int i, j; /* indices into glint_prescription.surface, i < j */
};

/* All pairs on the same side of the stop, those before it first, I outer, J
 * inner. Writes at most MAX; returns how many there are. [Hullin11] */
int glint_ghost_list(const struct glint_prescription *lens,
                     struct glint_ghost *ghosts, int max);

/* --------------------------------------------------------------- exact rays */

enum glint_event_kind { GLINT_REFRACT, GLINT_REFLECT, GLINT_STOP };

/* One thing that happens to a ray, all constants worked out. */
struct glint_event {
    enum glint_event_kind kind;
    int surface;         /* index; -1 for the stop */
    double curvature;    /* 1 / radius, 0 for a plane and the stop */
    double advance_mm;   /* z from the vertex before (or the start plane) to
                            this one; negative when running backwards */
    double semi_mm;      /* semi-diameter */
    double n_from, n_to; /* index on the side it comes from, and beyond */
    double film_n;       /* index of the coating; 0: bare */
    double film_phase;   /* 4 pi n d / wavelength, radians */
};

/* The path of one ghost at one wavelength: forward to J, back to I, forward to
 * the sensor. Immutable once made; any number of threads may trace it. */
struct glint_path {
    int n_events;
    struct glint_event event[GLINT_MAX_EVENTS + 1];
    double to_sensor_mm; /* last vertex to the sensor */
    bool places_only;    /* energies stay 1, in a third less time */
};

/* Fills PATH for GHOST of LENS (NULL: the direct path). */
void glint_path_init(struct glint_path *path,
                     const struct glint_prescription *lens,
                     const struct glint_ghost *ghost, double wavelength_nm);

enum glint_ray_status {
    GLINT_RAY_OK = 0,
    GLINT_RAY_MISSED = 1,          /* a surface, its equator, or the way */
    GLINT_RAY_TOTAL_REFLECTION = 2 /* at a refraction */
};

struct glint_ray {
    double stop_x_mm, stop_y_mm;     /* where it crosses the stop's plane */
    double sensor_x_mm, sensor_y_mm; /* where it hits the sensor */
    double energy;     /* transmittances times reflectances, 0 .. 1 */
    double rel_radius; /* largest |xy| / semi-diameter over all surfaces */
};

/* Traces the ray that starts at (PX, PY) on the vertex plane of the first
 * surface along DIRECTION (unit length). It goes on where a barrel or the stop
 * would have ended it. RAY is written only for GLINT_RAY_OK. HITS, unless NULL,
 * receives x and y of each event, [n_events][2], in mm.
 * [Hullin11] section 4; unpolarised energy. */
enum glint_ray_status glint_trace(const struct glint_path *path, double px_mm,
                                  double py_mm, const double direction[3],
                                  struct glint_ray *ray, double (*hits)[2]);

/* Where a ray starts on the vertex plane of the first surface, and its
 * direction of unit length. */
struct glint_launch {
    double x_mm, y_mm, direction[3];
};

/* Traces N rays, to the bit as glint_trace() does, in a fraction of the time.
 * RAY and STATUS have N entries, HITS [n][n_events][2]. */
void glint_trace_many(const struct glint_path *path, int n,
                      const struct glint_launch *from, struct glint_ray *ray,
                      enum glint_ray_status *status, double (*hits)[2]);

/* N parallel rays side by side. */
struct glint_row {
    int n;
    double x0_mm, step_mm, y_mm, direction[3];
};

/* glint_trace_many() of ROW, ray I at x0_mm + I step_mm. */
void glint_trace_row(const struct glint_path *path, const struct glint_row *row,
                     struct glint_ray *ray, enum glint_ray_status *status,
                     double (*hits)[2]);

/* Index of refraction at WAVELENGTH_NM of a glass (two-term Cauchy from nd and
 * Vd; vd <= 0 is a medium without dispersion). */
double glint_index(double nd, double vd, double wavelength_nm);

/* Reflectance of one boundary for unpolarised light that meets it at
 * COS_FROM; FILM_N = 0 is a bare boundary, else a film of that index with
 * FILM_PHASE = 4 pi n d / wavelength. 1 at total reflection. */
double glint_reflectance(double n_from, double n_to, double cos_from,
                         double film_n, double film_phase);

/* ------------------------------------------------- lens, stop and colours */

#define GLINT_MAX_WAVELENGTHS 32
#define GLINT_SET_WAVES       65 /* of all sets together, see below */

/* N wavelengths, 1 .. GLINT_MAX_WAVELENGTHS, that stand for light of all
 * wavelengths: WAVELENGTH_NM rises, and RGB[i] times what is at wavelength i,
 * summed, is nearly what all of 400 .. 700 nm give to linear BT.709 by the CIE
 * 1931 observer [Wyman13], exactly if that is a polynomial of a degree below
 * 4 and N. Each channel sums to 1, so that a flat spectrum is white; single
 * colours lie outside of BT.709 and are negative in part. SHARE[i] is that of
 * the mean over the wavelengths and sums to 1. Wavelengths lie where steps
 * between them, as a ghost's outline moves in proportion to 1 / wavelength^2,
 * are smallest in the mean of squares over the channels. */
void glint_spectrum(int n, double *wavelength_nm, double (*rgb)[3],
                    double *share);

/* One of a set. */
struct glint_set_wave {
    double nm, rgb[3];
    double direct_flux, unit_flux; /* as in struct glint_setup */
};

/* A lens made ready for drawing: everything that no light and no frame
 * changes. */
struct glint_setup {
    const struct glint_prescription *lens; /* kept; NULL: made from a model */
    struct glint_optics optics;
    int n_ghosts;
    int n_parts; /* of a model: the last so many ghosts are further parts of the
                    pupil of some of those before them */
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    int n_blades;              /* of the stop; 0: circle */
    double blade_rotation_deg; /* of the first corner, from x towards y */
    int n_wavelengths;
    double wavelength_nm[GLINT_MAX_WAVELENGTHS];
    double rgb[GLINT_MAX_WAVELENGTHS][3]; /* linear BT.709; each channel sums
                                             to 1 */
    double direct_flux[GLINT_MAX_WAVELENGTHS]; /* through the stop at angle 0
                                                  for irradiance 1, mm^2 */
    double unit_flux[GLINT_MAX_WAVELENGTHS]; /* what light is measured by, mm^2:
                                                the mean of direct_flux, or
                                                itself after _balance */
    /* After _spread: sets of wavelengths, one after the other, the smallest
     * first, of which each ghost takes its own. */
    int n_sets, set_size[GLINT_MAX_WAVE_SETS];
    struct glint_set_wave set_wave[GLINT_SET_WAVES];
};

/* Prepares LENS with a stop of N_BLADES (0 or 3 .. 64; corners on the circle of
 * the f-number) for N wavelengths (1 .. GLINT_MAX_WAVELENGTHS, 300 .. 1100 nm).
 * Three wavelengths become R, G and B as they stand; any other number is
 * weighted by the CIE 1931 observer [Wyman13]. GLINT_E_ARGUMENT: out of range.
 * GLINT_E_LENS: no light gets through. */
enum glint_status glint_setup_init(struct glint_setup *setup,
                                   const struct glint_prescription *lens,
                                   int n_blades, double blade_rotation_deg,
                                   const double *wavelength_nm, int n,
                                   struct glint_error *error);

/* The same from a model, without its lens table: everything but exact rays. A
 * wavelength outside of the model's band counts as the nearest one inside. */
struct glint_lens;
enum glint_status glint_setup_from_model(struct glint_setup *setup,
                                         const struct glint_lens *lens,
                                         int n_blades,
                                         double blade_rotation_deg,
                                         const double *wavelength_nm, int n,
                                         struct glint_error *error);

/* Of a setup for the N wavelengths of glint_spectrum(): takes its colours. */
void glint_setup_weigh(struct glint_setup *setup);

/* Gives SETUP, made from LENS, the sets for each ghost to choose from. */
void glint_setup_spread(struct glint_setup *setup,
                        const struct glint_lens *lens);

/* Measures each wavelength by its own direct image, as a camera does that is
 * balanced to white behind this lens. Otherwise the lens's own tint shows in
 * the ghosts as it shows in everything else. */
void glint_setup_balance(struct glint_setup *setup);

/* From and to the numbers of a model; what is not finite becomes 0. */
struct glint_real glint_real_of(double x);
double glint_real_value(struct glint_real x);

/* A light at infinity. */
struct glint_lamp {
    double theta_deg; /* off the axis, 0 .. 89.9 */
    double phi_deg;   /* about it: 0 = +x, 90 = up */
    double power;     /* its in-focus image, spread over one pixel, would have
                         this linear value; 1 = display white */
    double rgb[3];    /* colour, linear BT.709; white is 1 1 1 */
    double axis[2];   /* RMS semi-axes of its extent, the major one first, in
                         tangents of angles off the axis: image over focal
                         length; 0 0: a point. Here for who makes many points
                         of it; the picture and the feed take it for one. */
    double turn_deg;  /* of the major one, 0 = +x, 90 = up */
};

/* Where a picture lies on the sensor: centred, square pixels. */
struct glint_view {
    int width, height;      /* pixels */
    double sensor_width_mm; /* of the whole width */
};

/* The largest view of WIDTH x HEIGHT that fits FILM. */
struct glint_view glint_view_fit(int width, int height, double film_width_mm,
                                 double film_height_mm);

/* Where a light is whose image lies at pixel (X, Y) of VIEW behind a lens of
 * FOCAL_MM, and the reverse. Pixels from the top left corner, y down. */
void glint_view_to_angles(const struct glint_view *view, double focal_mm,
                          double x, double y, struct glint_lamp *lamp);
void glint_view_to_pixel(const struct glint_view *view, double focal_mm,
                         const struct glint_lamp *lamp, double *x, double *y);

/* ------------------------------------------------------- the exact picture */

/* Told now and then how much is done, 0 .. 1, by the calling thread or by
 * worker 0, one of them at a time. */
typedef void glint_progress_fn(void *ctx, double done);

struct glint_exact_config {
    const struct glint_setup *setup;
    struct glint_view view;
    const struct glint_lamp *lamps;
    int n_lamps;
    int grid;       /* cells a side over each ghost's pupil box, even */
    int only_ghost; /* -1: all */
    struct glint_workers *workers; /* never changes the picture */
    glint_progress_fn *progress;   /* NULL: silent */
    void *progress_ctx;
};

/* The reference picture: every ray in double, each cell clipped exactly by the
 * stop and by every barrel's own circle, coverage by area, energy conserving.
 * RGB is [height][width][3], row 0 on top; values are what the lamps' POWER
 * says. GLINT_E_MEMORY: it needs about 100 bytes per cell of one ghost and 24
 * per pixel, or lamps times ghosts times wavelengths are more than 2^24.
 * Deterministic. */
enum glint_status glint_exact_render(const struct glint_exact_config *cfg,
                                     double *rgb);

/* ------------------------------------------------------------------- bake */

struct glint_bake_options {
    int basis;         /* enum glint_basis */
    double band_nm[2]; /* shortest and longest wavelength, 300 .. 1100 */
    double max_deg;    /* largest angle of a light, above 0, up to 89 */
    double field_mm;   /* radius on the sensor within which light counts; 0: a
                          tenth more than the film's corners */
    double tolerance;  /* scale of all errors aimed at, 0.1 .. 100; at 1 the
                          root mean squares for ghosts that are as bright as
                          counts are 0.03 pixels of a film 1920 wide, as much
                          for the outline, and 0.06 % of energy; for faint
                          ones up to 0.056 and 0.3 pixels and 0.6 % */
    struct glint_workers *workers; /* never changes the model */
    glint_progress_fn *progress;   /* NULL: silent */
    void *progress_ctx;
};

void glint_bake_defaults(struct glint_bake_options *options);

/* What a model of LENS by OPTIONS is known by. */
uint64_t glint_bake_key(const struct glint_prescription *lens,
                        const struct glint_bake_options *options);

/* What cannot be read from a model. */
struct glint_bake_report {
    int rays;      /* measured */
    int intruders; /* of these, cut in truth, but passed by the model, by more
                      than 3 % of a radius */
    int unmet;     /* systems that the tolerance was too tight for */
};

/* Bakes LENS into *MODEL of *BYTES, to be freed by the caller: a file as in
 * glint/lens.h. The same lens and options give the same bytes.
 * GLINT_E_ARGUMENT, GLINT_E_LENS (no light gets through, or the proof that no
 * integer overflows fails) with ERROR, GLINT_E_MEMORY. */
enum glint_status glint_bake(const struct glint_prescription *lens,
                             const struct glint_bake_options *options,
                             unsigned char **model, size_t *bytes,
                             struct glint_bake_report *report,
                             struct glint_error *error);

/* ------------------------------------------------ feeding the run-time half */

struct glint_stop;
struct glint_bundle;
struct glint_lens;
struct glint_vertex;

/* The stop of SETUP as the run-time half takes it. */
void glint_setup_stop(const struct glint_setup *setup, struct glint_stop *stop);

/* Signed distances of that stop at the nodes of a square mask of NODES^2 over
 * +-SPAN stop radii, q13, row 0 at the lowest y. */
void glint_setup_mask(const struct glint_setup *setup, int16_t *mask_q13,
                      int nodes, double span);

/* Part of the vertex plane of the first surface, symmetric in y, that holds
 * every ray of a path that the stop and the barrels let through; the light is
 * in the x-z plane. */
struct glint_pupil {
    double x0_mm, x1_mm, y1_mm;
    double energy;       /* largest one seen inside */
    double sensor_mm[4]; /* x0, x1, y0, y1 of its light on the sensor */
};

/* NEAR: unless NULL, what was found for another wavelength; the search then
 * looks only at it and its surroundings, for a third of the work. False:
 * nothing gets through. */
bool glint_pupil_find(struct glint_pupil *pupil, const struct glint_path *path,
                      double theta_deg, double stop_radius_mm,
                      const struct glint_pupil *near);

/* The same for what also lands within FIELD_MM of the sensor's centre. */
bool glint_pupil_find_within(struct glint_pupil *pupil,
                             const struct glint_path *path, double theta_deg,
                             double stop_radius_mm, double field_mm,
                             const struct glint_pupil *near);

struct glint_feed_config {
    const struct glint_setup *setup;
    struct glint_view view;
    double scale;  /* of all light: gain times 2^EV */
    int max_cells; /* fineness of the grids, 1 .. 1024: see glint_feed_plan */
    bool uniform;  /* all ghosts get max_cells a side */
};

enum { GLINT_FEED_CUTS = 8 };

/* One ghost, light and wavelength, the grid chosen for it and the barrels that
 * cut. A vertex holds the first barrel's value and the largest of the others'.
 */
struct glint_feed {
    const struct glint_lamp *lamp;
    int ghost, wavelength;
    struct glint_pupil pupil;
    bool found;  /* something gets through: PUPIL means something */
    int n_cells; /* 0: nothing of it is in the picture */
    int n_cuts;  /* barrels that may cut inside the stop */
    int cut_event[GLINT_FEED_CUTS]; /* the one that cuts most comes first */
    double energy_unit;             /* energy 65536 of a vertex */
};

/* Finds the pupil and the barrels, and chooses the grid by how much the ghost's
 * light bends in pixels: off by 0.01 px (RMS), outlines by 0.1, with 64 for
 * max_cells, and by the square of it less with more; a multiple of 4 from 8 to
 * 2 max_cells, 4 max_cells where light folds, over the pupil and a pixel more
 * on each side. Lamp, ghost and wavelength are set already. */
void glint_feed_plan(const struct glint_feed_config *cfg,
                     struct glint_feed *feed, const struct glint_feed *near);

/* The bundle of FEED, n_cells > 0, and its (n_cells + 1)^2 vertices. */
void glint_feed_bundle(const struct glint_feed_config *cfg,
                       const struct glint_feed *feed,
                       struct glint_bundle *bundle);
void glint_feed_trace(const struct glint_feed_config *cfg,
                      const struct glint_feed *feed,
                      struct glint_vertex *vertex);

#ifdef __cplusplus
}
#endif

#endif
