/* SPDX-License-Identifier: MIT
 *
 * glint/prescription.h - lens tables, and the ghosts of a lens.
 *
 *     glint_prescription_parse(&lens, text, bytes, "x.lens", &error);
 *     glint_optics_of(&lens, &optics);                   focal length, ...
 *     n = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
 *
 * The offline half computes in double precision. Lengths are in millimetres,
 * wavelengths in nanometres, angles in degrees.
 *
 * Axes: z runs from the front vertex (0) to the sensor, x to the right and y
 * up as the picture is seen. A light at (THETA, PHI) sends parallel rays along
 * (sin T cos P, sin T sin P, cos T); its own image is at f tan T (cos P, sin P)
 * on the sensor.
 */
#ifndef GLINT_PRESCRIPTION_H
#define GLINT_PRESCRIPTION_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_SURFACES 64 /* refracting surfaces of a lens */
#define GLINT_MAX_GHOSTS   (GLINT_MAX_SURFACES * (GLINT_MAX_SURFACES - 1) / 2)
#define GLINT_NAME_BYTES   64

#define GLINT_MAX_FILMS 8

/* A layer of a coating: a film that absorbs nothing. */
struct glint_film {
    double index;    /* 1.01 .. 4, the same at all wavelengths */
    double quarters; /* index times thickness, in quarters of the coating's
                        design wavelength, 0.01 .. 16 */
};

/* The layers on a surface, the one next to the air first. */
struct glint_coating {
    double nm;   /* design wavelength, 100 .. 5000; 0: bare */
    int n_films; /* 0: bare */
    struct glint_film film[GLINT_MAX_FILMS];
};

#define GLINT_SHAPE_TERMS 9 /* A4, A6 .. A20 */

enum glint_bend {
    GLINT_BEND_ROUND, /* the profile turns about the axis */
    GLINT_BEND_X,     /* the profile lies in the x-z plane, and is swept */
    GLINT_BEND_Y      /* in the y-z plane */
};

/* The form of a surface that is not a centred sphere; all 0 for a sphere. The
 * profile at the height h is c h^2 / (1 + sqrt(1 - (1 + conic) c^2 h^2)) + A4
 * h^4 + A6 h^6 + ..., c = 1 / radius_mm. A cylinder or toric sweeps it along
 * circles of the radius across_mm about a line parallel to its own plane. */
struct glint_shape {
    double conic;                   /* 0: sphere, -1: paraboloid */
    double term[GLINT_SHAPE_TERMS]; /* A4 in mm^-3, A6 in mm^-5, .. */
    int bend;                       /* enum glint_bend */
    double across_mm;               /* of a bend in X or Y; 0: a cylinder */
    /* The surface, shifted by decentre_mm (x, y), then turned by tilt_deg
     * about the point pivot_mm behind its vertex on the axis: first about x,
     * then about y, right-handed. */
    double decentre_mm[2], tilt_deg[2], pivot_mm;
};

/* A refracting surface. The medium before surface 0 is air. */
struct glint_surface {
    double radius_mm;    /* > 0: centre towards the sensor; 0: plane */
    double thickness_mm; /* mm to the next surface, the stop, or the sensor */
    double semi_mm;      /* semi-diameter of the barrel here */
    double nd;           /* index at 587.56 nm of the medium after it */
    double vd;           /* Abbe number of that medium; 0 for air */
    /* Dispersion of a glass of the catalogue, as glint_glass.sellmeier; all 0
     * where nd and vd say it. */
    double sellmeier[6];
    struct glint_coating coating; /* cemented surfaces are always bare */
    struct glint_shape shape;
};

/* A surface that is not a centred sphere, prepared for intersections. */
struct glint_form {
    double curvature, conic, term[GLINT_SHAPE_TERMS];
    int bend;      /* enum glint_bend */
    double across; /* 1 / across_mm; 0: a cylinder */
    double semi_mm;
    /* Beyond this height, squared, there is no glass; the profile continues
     * with the same value, slope and curvature there, and without its powers.
     */
    double end2, end_at[3];
    /* From the light's frame at the vertex to the surface's own: at = turn at +
     * shift; rows of TURN are unit vectors. */
    double turn[3][3], shift[3];
    /* Of a round form or a cylinder on the axis, LEVEL, rays stay in the
     * light's frame: the direction of its profile there, and 1 if that is any.
     */
    bool level;
    double along[2], round;
    int n_terms;      /* number of terms until the last that is not 0 */
    double steepest2; /* square of the steepest slope of the profile's glass */
};

/* Returns whether S is not a sphere on the axis. */
bool glint_surface_is_shaped(const struct glint_surface *s);

/* Sets AT to the point of S that lies at X, Y mm of its own frame, from the
 * vertex on the axis, where the shift and tilt of S put it; in the frame of a
 * light in the plane at PHI_DEG. Returns false where there is none. */
bool glint_surface_point(const struct glint_surface *s, double phi_deg,
                         double x, double y, double at[3]);

/* A glass of a maker's catalogue. */
struct glint_glass {
    const char *name, *maker;
    /* B1, B2, B3, C1, C2, C3 of n^2 = 1 + sum B L^2 / (L^2 - C), where L is the
     * wavelength in micrometres. */
    double sellmeier[6];
};

/* Returns the Kth glass, from 0, or NULL if there are no more. */
const struct glint_glass *glint_glass_at(int k);

/* Returns the glass NAME[BYTES], or NULL; or the one with the nearest name, of
 * those that are near. */
const struct glint_glass *glint_glass_find(const char *name, size_t bytes);
const struct glint_glass *glint_glass_near(const char *name, size_t bytes);

/* Returns the index of refraction of the medium behind S. */
double glint_surface_index(const struct glint_surface *s, double wavelength_nm);

#define GLINT_MAX_POSITIONS 8  /* columns of a zoom's table */
#define GLINT_MAX_MOVES     12 /* gaps of a zoom that change */

/* The values of a zoom lens at each of its positions, by rising or falling
 * focal length. Between positions monotone cubics interpolate them over the
 * zoom parameter: 0 at the first, 1 at the last column, in equal steps where
 * focal lengths rise by equal factors. */
struct glint_zoom {
    int n_positions;           /* columns; 0: the lens does not zoom */
    int n_moves;               /* gaps that change */
    int move[GLINT_MAX_MOVES]; /* the element before each of them: surfaces and
                                  the stop, counted from the front */
    double gap_mm[GLINT_MAX_MOVES][GLINT_MAX_POSITIONS];
    double f_number[GLINT_MAX_POSITIONS];
    /* Values that the table states of a column; 0: not stated. */
    double check_focal_mm[GLINT_MAX_POSITIONS];
    double check_back_mm[GLINT_MAX_POSITIONS];
    /* Derived from the columns. */
    double focal_mm[GLINT_MAX_POSITIONS], back_mm[GLINT_MAX_POSITIONS];
    double last_gap_mm[GLINT_MAX_POSITIONS]; /* to the sensor */
    double along[GLINT_MAX_POSITIONS];       /* 0 .. 1 */
};

struct glint_prescription;

/* Returns whether all of LENS is symmetric about its axis. */
bool glint_prescription_is_round(const struct glint_prescription *lens);

#define GLINT_MAX_COATINGS GLINT_MAX_SURFACES

/* A lens table, all of it checked. The stop lies between two surfaces: the
 * thickness of the surface before it is its distance from that surface. */
struct glint_prescription {
    char name[GLINT_NAME_BYTES];
    char source[256];    /* patent or book, for people */
    char character[256]; /* description of its flare, for people */
    double f_number;
    double film_width_mm, film_height_mm;
    int n_surfaces; /* without the stop, 1 .. GLINT_MAX_SURFACES */
    struct glint_surface surface[GLINT_MAX_SURFACES];
    int stop_after; /* number of surfaces before the stop, 0 .. n_surfaces */
    double stop_thickness_mm; /* mm from the stop to the next surface (or the
                                 sensor); a front stop lies at z < 0, or
                                 behind the vertex where this is below 0 */
    double stop_semi_mm;      /* largest opening of the stop */
    bool stop_is_circle;      /* at every opening; else it has blades */
    double check_focal_mm;    /* values that the table states; 0: not stated */
    double check_back_mm;
    /* The mixed coatings of the table, chosen for appearance, not measured.
     * Surfaces have them only after glint_prescription_coat(). */
    struct glint_coating mixed[GLINT_MAX_COATINGS];
    int n_mixed;            /* 0: the table lists none */
    struct glint_zoom zoom; /* the lens as read is at its first position */
    /* Surfaces that move together along the axis to focus; none: the whole lens
     * moves. */
    int focus_first, n_focus;
    /* Current zoom position, 0 .. 1, and distance of the focused object from
     * the sensor, m, 0 for infinity. */
    double zoom_along, focus_m;
};

/* Reads a lens table; lenses/README.md describes the format. TEXT need not be
 * terminated and may hold anything. FILE_NAME only names it in errors.
 * GLINT_E_LENS: ERROR states file, line, column and cause; LENS is unchanged.
 */
enum glint_status glint_prescription_parse(struct glint_prescription *lens,
                                           const char *text, size_t bytes,
                                           const char *file_name,
                                           struct glint_error *error);

/* Changes the f-number. GLINT_E_ARGUMENT: F_NUMBER is not finite or out of
 * range, or needs a stop wider than stop_semi_mm. */
enum glint_status
glint_prescription_set_f_number(struct glint_prescription *lens,
                                double f_number, struct glint_error *error);

/* Returns the smallest f-number of three digits that
 * glint_prescription_set_f_number() accepts, to print. */
double glint_prescription_widest(const struct glint_prescription *lens);

/* Zooms LENS, which has not been focused, to ALONG, 0 .. 1. Between columns the
 * last gap keeps the image in focus: its difference from the back focal length
 * is interpolated. GLINT_E_ARGUMENT: LENS does not zoom, ALONG is out of range,
 * or elements would collide or the stop be too small there. */
enum glint_status glint_prescription_zoom(struct glint_prescription *lens,
                                          double along,
                                          struct glint_error *error);

/* Sets *ALONG to where LENS has the focal length FOCAL_MM. GLINT_E_ARGUMENT:
 * LENS does not zoom, or not so far. */
enum glint_status
glint_prescription_zoom_to(const struct glint_prescription *lens,
                           double focal_mm, double *along,
                           struct glint_error *error);

/* Focuses LENS, which is at infinity, at METRES from the sensor: paraxial rays
 * from there meet where those from infinity did. The lens's focusing group
 * moves, or all of it. GLINT_E_ARGUMENT: it cannot focus so near. */
enum glint_status glint_prescription_focus(struct glint_prescription *lens,
                                           double metres,
                                           struct glint_error *error);

/* Replaces the coatings of LENS: surfaces between air and glass get COATINGS[N]
 * in turn from the front, again from the first when all are used; N is 1 ..
 * GLINT_MAX_COATINGS. Cemented surfaces are bare. */
void glint_prescription_coat(struct glint_prescription *lens,
                             const struct glint_coating *coatings, int n);

/* Sets COATINGS to the mix for tables that list none; returns how many it
 * has. */
int glint_coatings_mixed(struct glint_coating coatings[GLINT_MAX_COATINGS]);

/* Reads coatings from TEXT, words "none", "NAME[/NM]" or
 * "NM[/INDEX[:QUARTERS]]..." as in the tables, but separated by commas.
 * GLINT_E_ARGUMENT: ERROR states what is wrong, and COATINGS is unchanged. */
enum glint_status
glint_coatings_parse(struct glint_coating coatings[GLINT_MAX_COATINGS], int *n,
                     const char *text, struct glint_error *error);

/* Sets COATING to the Kth coating that has a name, from 0, at its usual
 * design wavelength. Returns its name, or NULL if there are no more. */
const char *glint_coating_named(int k, struct glint_coating *coating);

/* First-order quantities at the d line (587.56 nm). */
struct glint_optics {
    double focal_mm;           /* effective focal length */
    double back_focal_mm;      /* from the last surface to the paraxial focus */
    double entrance_radius_mm; /* radius of the entrance pupil: focal / (2 N) */
    double entrance_z_mm;      /* distance of the entrance pupil from the front
                                  vertex */
    double stop_radius_mm;     /* radius of the aperture stop at the f-number */
    double length_mm; /* from the front vertex to the sensor, even if the stop
                         lies before it */
    /* Squeeze of an anamorphic lens: focal length in the y-z plane (focal_mm) /
     * that in the x-z plane. 1 for round lenses. */
    double squeeze;
    /* Image scale: distance of a light's image from the middle of the sensor /
     * tangent of its angle. The focal length of a lens focused at infinity; its
     * change with focus is the lens's breathing. */
    double scale_mm;
};

void glint_optics_of(const struct glint_prescription *lens,
                     struct glint_optics *optics);

/* Light reflected at surface J and then, running backwards, at surface I.
 * I = J = -1 is the direct path without reflections. */
struct glint_ghost {
    int i, j; /* indices into glint_prescription.surface, i < j */
};

/* Lists all pairs of surfaces on the same side of the stop, those before it
 * first, by rising I and then J. Writes at most MAX; returns how many there
 * are. [Hullin11] */
int glint_ghost_list(const struct glint_prescription *lens,
                     struct glint_ghost *ghosts, int max);

#ifdef __cplusplus
}
#endif

#endif
