/* SPDX-License-Identifier: MIT
 *
 * figure.h - a drawing while it is made: its scale, and the parts of it.
 *
 * Millimetres of the lens: z runs along the axis from the front vertex, x up in
 * the plane of the section.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_FIGURE_H
#define GLINT_TOOLS_LENS_FIGURES_FIGURE_H

#include <stdbool.h>
#include <stdio.h>

#include "glint/trace.h"

enum { DRAWING_FIELDS = 3, DRAWING_MAX_RAYS = 41 };

struct lens_drawing {
    const struct glint_prescription *lens;
    int ghost;        /* number of the ghost whose path is drawn; -1: rays to
                         the sensor */
    double angle_deg; /* angle of a ghost's light; below 0: half the field */
    double plane_deg; /* of the section, about the axis from x to y; 0 or 90 */
    int rays;         /* rays of a fan, 1 .. DRAWING_MAX_RAYS */
    bool spots;       /* spot diagrams below the section */
    bool title;       /* words above it */
    double focus_m;   /* the lens is focused there, which the title says; 0:
                         infinity. Light is from afar in any case. */
    double width_px;
};

#define FIGURE_MARGIN_PX 24.0
#define FIGURE_NM        587.5618 /* of rays: the d line */

struct figure {
    const struct lens_drawing *drawing;
    FILE *file;
    double z0, z1, x1;   /* what the section shows: z0 .. z1, -x1 .. x1 */
    double scale;        /* pixels of a millimetre */
    double left, middle; /* pixels of z = 0 and x = 0 */
    double height_px;    /* of the section */
    double vertex[GLINT_MAX_SURFACES], stop_z, sensor_z;
    double film_mm; /* half of the picture as it is shown, in the plane */
    double widen;   /* how much wider that is than on the sensor */
    int shown;
};

extern const char *const figure_field_colour[DRAWING_FIELDS];

/* Sets places and scale of F, whose drawing and file are set. */
void figure_begin(struct figure *f);

double figure_px(const struct figure *f, double z);
double figure_py(const struct figure *f, double x);

/* Sets AT to z and x of the place that HIT, as of glint_trace(), is. */
void figure_meeting(const struct figure *f, const struct glint_event *event,
                    const double hit[2], double at[2]);

/* Writes the points of surface K from its lower to its upper rim; from the
 * upper one if SENSE is -1. */
void figure_profile(const struct figure *f, int k, int sense);

void figure_draw_axis_and_sensor(const struct figure *f);
void figure_draw_glasses(const struct figure *f);
void figure_draw_stop(const struct figure *f, double radius_mm);

/* Writes the number of surface K above its rim. */
void figure_draw_number(const struct figure *f, int k);

/* Returns the angle, in degrees, of the light that the lens images at HEIGHT_MM
 * from the picture's centre, by rays through the middle of the pupil; the
 * widest that still gets through the lens if none goes so far. */
double figure_angle_deg(const struct figure *f, double height_mm);

/* Returns that of FIELD, 0 .. DRAWING_FIELDS - 1. */
double figure_field_deg(const struct figure *f, int field);

/* Writes a spot diagram for each field below the section. */
void figure_draw_spots(const struct figure *f);

/* Pixels that they take. */
double figure_spots_px(const struct figure *f);

/* Returns 1, 2 or 5 times a power of ten, at least VALUE. */
double figure_round_up(double value);

#endif
