/* SPDX-License-Identifier: MIT
 *
 * glint/prescription.h - parses lens tables, and lists the ghosts of a lens.
 *
 *     glint_prescription_parse(&lens, text, bytes, "x.lens", &error);
 *     glint_optics_of(&lens, &optics); focal length, ...
 *     n = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
 *
 * The offline half computes in double precision. Lengths are in millimetres,
 * wavelengths in nanometres, angles in degrees.
 *
 * Axes: z runs from the front vertex (z = 0) to the sensor, x to the right and
 * y up as the picture is seen. A light at (THETA, PHI) sends parallel rays
 * along (sin T cos P, sin T sin P, cos T); its own image is at f tan T (cos P,
 * sin P) on the sensor. */
#ifndef GLINT_PRESCRIPTION_H
#define GLINT_PRESCRIPTION_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_SURFACES 64 /* max refracting surfaces of a lens */
#define GLINT_MAX_GHOSTS   (GLINT_MAX_SURFACES * (GLINT_MAX_SURFACES - 1) / 2)
#define GLINT_NAME_BYTES   64

#define GLINT_MAX_FILMS 8

/* A layer of a coating, without absorption. */
struct glint_film {
    /* Index of refraction, 1.01 .. 4, the same at all wavelengths. */
    double index;
    /* Index times thickness, in quarters of the design wavelength of the
     * coating, 0.01 .. 16. */
    double quarters;
};

/* The layers on a surface, the layer next to the air first. */
struct glint_coating {
    double nm;   /* design wavelength, 100 .. 5000; 0: no coating */
    int n_films; /* number of layers; 0: no coating */
    struct glint_film film[GLINT_MAX_FILMS];
};

#define GLINT_SHAPE_TERMS 9 /* aspheric coefficients A4, A6 .. A20 */

enum glint_bend {
    GLINT_BEND_ROUND, /* the profile is rotated about the axis */
    GLINT_BEND_X,     /* the profile lies in the x-z plane and is swept */
    GLINT_BEND_Y      /* the profile lies in the y-z plane, and is swept */
};

/* The form of a surface that is not a centred sphere; all 0 for a sphere. The
 * height of the profile's curve at distance h from the axis is c h^2 / (1 +
 * sqrt(1 - (1 + conic) c^2 h^2)) + A4 h^4 + A6 h^6 + ..., with c = 1 /
 * radius_mm. A cylinder or toric surface results from sweeping the profile
 * along circles of radius across_mm about a line parallel to its plane. */
struct glint_shape {
    double conic; /* conic constant; 0: sphere, -1: paraboloid */
    double term[GLINT_SHAPE_TERMS]; /* A4 in mm^-3, A6 in mm^-5, .. */
    int bend;                       /* enum glint_bend */
    /* Radius of the sweep with GLINT_BEND_X or Y, mm; 0: a cylinder. */
    double across_mm;
    /* The surface is shifted by decentre_mm (x, y), then rotated by tilt_deg,
     * first about x, then about y, right-handed. The centre of rotation is on
     * the axis, pivot_mm behind the vertex. */
    double decentre_mm[2], tilt_deg[2], pivot_mm;
};

/* A refracting surface. The medium before surface 0 is air. */
struct glint_surface {
    /* Radius of curvature, mm; above 0: its centre is towards the sensor; 0:
     * plane. */
    double radius_mm;
    /* Distance along the axis to the next surface, the stop, or the sensor,
     * mm. */
    double thickness_mm;
    double semi_mm; /* semi-diameter; the lens barrel blocks rays farther from
                       the axis */
    double nd;      /* index of refraction, at 587.56 nm, of the medium
                       behind the surface */
    double vd; /* Abbe number of the medium behind the surface; 0 for air */
    /* Coefficients of the dispersion of a catalogue glass, as in
     * glint_glass.sellmeier. All 0: the dispersion follows from nd and vd. */
    double sellmeier[6];
    struct glint_coating coating; /* coating of the surface; cemented surfaces
                                     have none */
    struct glint_shape shape;
};

/* A surface that is not a centred sphere, prepared for intersections. */
struct glint_form {
    double curvature, conic, term[GLINT_SHAPE_TERMS];
    int bend;      /* enum glint_bend */
    double across; /* 1 / across_mm; 0: a cylinder */
    double semi_mm;
    /* end2: square of the height up to which the profile follows the lens
     * table. end_at: value of the profile at end2, and its first and second
     * derivative with respect to the squared height. Above end2 these values
     * continue the profile with a curvature that fades out. */
    double end2, end_at[3];
    /* Rigid transform of a point p from the axes of the light at the vertex to
     * the axes of the surface: TURN p + SHIFT; rows of TURN are unit
     * vectors. */
    double turn[3][3], shift[3];
    /* level: the form is round or a cylinder, and on the axis, so that rays
     * stay in the frame of the light. along: direction of the profile in that
     * frame. round: 1 for a round form, which has the same profile in all
     * directions, else 0. */
    bool level;
    double along[2], round;
    int n_terms;      /* number of terms, up to the last term that is not 0 */
    double steepest2; /* square of the max slope of the profile within the
                         glass */
};

/* Returns true unless S is a sphere or plane centred on the axis. */
bool glint_surface_is_shaped(const struct glint_surface *s);

/* Sets AT to the point of S at (X, Y) mm in the frame of S, after the shift and
 * tilt of S. AT is relative to the vertex on the axis, in the frame of a light
 * whose plane is at PHI_DEG. Returns false if there is no such point. */
bool glint_surface_point(const struct glint_surface *s, double phi_deg,
                         double x, double y, double at[3]);

/* A glass of the catalogue of a manufacturer. */
struct glint_glass {
    const char *name, *maker;
    /* B1, B2, B3, C1, C2, C3 of n^2 = 1 + sum B L^2 / (L^2 - C), where L is the
     * wavelength in micrometres. */
    double sellmeier[6];
};

/* Returns the Kth glass, from 0, or NULL if there are no more. */
const struct glint_glass *glint_glass_at(int k);

/* Return the glass with the name NAME[BYTES], or the glass whose name is most
 * similar to NAME; NULL if no name is equal or similar. */
const struct glint_glass *glint_glass_find(const char *name, size_t bytes);
const struct glint_glass *glint_glass_near(const char *name, size_t bytes);

/* Returns the index of refraction of the medium behind S. */
double glint_surface_index(const struct glint_surface *s, double wavelength_nm);

#define GLINT_MAX_POSITIONS 8  /* max columns of the table of a zoom lens */
#define GLINT_MAX_MOVES     12 /* max number of gaps that zooming changes */

/* The values of a zoom lens at each of its positions (columns of the table),
 * sorted by ascending or descending focal length. Monotone cubics interpolate
 * the values over the zoom parameter. It is 0 at the first column, 1 at the
 * last, and a linear function of the logarithm of the focal length. */
struct glint_zoom {
    int n_positions; /* number of columns; 0: the lens does not zoom */
    int n_moves;     /* number of gaps that change */
    /* For each gap that changes: index of the element before the gap. Elements
     * are the surfaces and the stop, counted from the front. */
    int move[GLINT_MAX_MOVES];
    double gap_mm[GLINT_MAX_MOVES][GLINT_MAX_POSITIONS];
    double f_number[GLINT_MAX_POSITIONS];
    /* Values that the lens table states for each column, which the parser
     * compares with the computed values; 0: not stated. */
    double check_focal_mm[GLINT_MAX_POSITIONS];
    double check_back_mm[GLINT_MAX_POSITIONS];
    /* Values that are computed from the columns. */
    double focal_mm[GLINT_MAX_POSITIONS], back_mm[GLINT_MAX_POSITIONS];
    double last_gap_mm[GLINT_MAX_POSITIONS]; /* distance from the last element
                                                to the sensor, mm */
    /* Zoom parameter of each column, 0 .. 1. */
    double along[GLINT_MAX_POSITIONS];
};

struct glint_prescription;

/* Returns whether all surfaces of LENS are symmetric about its axis. */
bool glint_prescription_is_round(const struct glint_prescription *lens);

#define GLINT_MAX_COATINGS GLINT_MAX_SURFACES

/* A lens table whose values have all been checked. The stop lies between two
 * surfaces: the thickness of the surface before the stop is the distance from
 * that surface to the stop. */
struct glint_prescription {
    char name[GLINT_NAME_BYTES];
    char source[256];    /* source of the data, such as a patent, as text */
    char character[256]; /* description of the flare of the lens, as text */
    double f_number;
    double film_width_mm, film_height_mm;
    int n_surfaces; /* number of surfaces without the stop, 1 ..
                       GLINT_MAX_SURFACES */
    struct glint_surface surface[GLINT_MAX_SURFACES];
    int stop_after; /* number of surfaces before the stop, 0 .. n_surfaces */
    /* Distance from the stop to the next surface (or the sensor), mm. A stop in
     * front of the lens lies at z < 0, or behind the front vertex if the
     * distance is below 0. */
    double stop_thickness_mm;
    double stop_semi_mm; /* max radius of the stop */
    bool stop_is_circle; /* true: the stop is a circle at every opening;
                            false: it has blades */
    /* Focal length and other values that the lens table states, which the
     * parser compares with the computed values; 0: not stated. */
    double check_focal_mm;
    double check_back_mm;
    /* Alternative coatings from the table, which glint_prescription_coat()
     * applies. They were chosen for appearance, not measured. */
    struct glint_coating mixed[GLINT_MAX_COATINGS];
    int n_mixed; /* number of mixed coatings; 0: the table lists none */
    /* the positions of a zoom lens; after parsing, the lens is at the first
     * position */
    struct glint_zoom zoom;
    /* Index of the first surface, and number of surfaces, of the group that
     * moves along the axis to focus; 0 surfaces: the whole lens moves. */
    int focus_first, n_focus;
    /* Current zoom position, 0 .. 1, and distance from the sensor to the
     * focused object, m; 0: infinity. */
    double zoom_along, focus_m;
};

/* Parses a lens table; lenses/README.md describes the format. TEXT need not be
 * terminated and may contain any bytes. FILE_NAME is used only in error
 * messages. On GLINT_E_LENS, ERROR states file, line, column and cause; LENS is
 * unchanged. On GLINT_OK, ERROR is empty, or a warning: two surfaces overlap by
 * less than 0.02 mm. */
enum glint_status glint_prescription_parse(struct glint_prescription *lens,
                                           const char *text, size_t bytes,
                                           const char *file_name,
                                           struct glint_error *error);

/* Changes the f-number. Returns GLINT_E_ARGUMENT if F_NUMBER is not finite or
 * out of range, or needs a stop wider than stop_semi_mm. */
enum glint_status
glint_prescription_set_f_number(struct glint_prescription *lens,
                                double f_number, struct glint_error *error);

/* Returns the smallest f-number of three digits, for printing, that
 * glint_prescription_set_f_number() accepts. */
double glint_prescription_widest(const struct glint_prescription *lens);

/* Zooms LENS, which must not have been focused before, to ALONG, 0 .. 1.
 * Between columns the image stays in focus, because the difference between last
 * gap and back focal length is interpolated. Returns GLINT_E_ARGUMENT if LENS
 * does not zoom, or ALONG is out of range. Also returns it if elements would
 * collide, or the stop would be too small, at ALONG. */
enum glint_status glint_prescription_zoom(struct glint_prescription *lens,
                                          double along,
                                          struct glint_error *error);

/* Sets *ALONG to the zoom parameter at which LENS has the focal length
 * FOCAL_MM. Returns GLINT_E_ARGUMENT if LENS does not zoom, or FOCAL_MM is
 * outside its range. */
enum glint_status
glint_prescription_zoom_to(const struct glint_prescription *lens,
                           double focal_mm, double *along,
                           struct glint_error *error);

/* Focuses LENS, which must be focused at infinity, at a distance of METRES
 * from the sensor, by paraxial optics. Moves the focusing group, or the
 * whole lens if there is no such group. Returns GLINT_E_ARGUMENT if LENS
 * cannot focus so near. */
enum glint_status glint_prescription_focus(struct glint_prescription *lens,
                                           double metres,
                                           struct glint_error *error);

/* Replaces the coatings of LENS. Surfaces between air and glass get COATINGS[N]
 * in turn, from the front. After the last coating, the first one follows again.
 * N is 1 .. GLINT_MAX_COATINGS. Cemented surfaces get no coating. */
void glint_prescription_coat(struct glint_prescription *lens,
                             const struct glint_coating *coatings, int n);

/* Sets COATINGS to the default mixed coatings, for tables without mixed
 * coatings. Returns their number. */
int glint_coatings_mixed(struct glint_coating coatings[GLINT_MAX_COATINGS]);

/* Parses TEXT, a list of coatings separated by commas: "none", "NAME[/NM]" or
 * "NM[/INDEX[:QUARTERS]]..." as in lens tables. *N receives their number. On
 * GLINT_E_ARGUMENT, ERROR states what is wrong, and COATINGS is unchanged. */
enum glint_status
glint_coatings_parse(struct glint_coating coatings[GLINT_MAX_COATINGS], int *n,
                     const char *text, struct glint_error *error);

/* Sets COATING to coating K, from 0, of the coatings that have a name, at its
 * usual design wavelength. Returns the name, or NULL if there is no coating
 * K. */
const char *glint_coating_named(int k, struct glint_coating *coating);

/* First-order quantities at the d line (587.56 nm). */
struct glint_optics {
    double focal_mm;           /* effective focal length */
    double back_focal_mm;      /* distance from the last surface to the paraxial
                                  focus */
    double entrance_radius_mm; /* radius of the entrance pupil: focal_mm / (2
                                  f-number) */
    double entrance_z_mm;      /* distance of the entrance pupil from the front
                                  vertex */
    double stop_radius_mm;     /* radius of the aperture stop at the f-number */
    double length_mm; /* distance from the front vertex to the sensor, even if
                         the stop lies before the vertex */
    /* Squeeze of an anamorphic lens: (focal length in the y-z plane, which is
     * focal_mm) / (focal length in the x-z plane); 1 for round lenses. */
    double squeeze;
    /* Image scale: (distance of a light's image from the centre of the sensor)
     * / (tangent of the light's angle). It equals the focal length if the lens
     * is focused at infinity; its change with focus is called breathing. */
    double scale_mm;
};

void glint_optics_of(const struct glint_prescription *lens,
                     struct glint_optics *optics);

/* A ghost: light reflected at surface J and then, running backwards, at surface
 * I. I = J = -1 is the direct path without reflections. */
struct glint_ghost {
    int i, j; /* indices into glint_prescription.surface, i < j */
};

/* Lists all pairs of surfaces on the same side of the stop: first the pairs
 * before the stop, sorted by I, then J. Writes at most MAX pairs and returns
 * the number of all pairs. [Hullin11] */
int glint_ghost_list(const struct glint_prescription *lens,
                     struct glint_ghost *ghosts, int max);

#ifdef __cplusplus
}
#endif

#endif
