/* SPDX-License-Identifier: MIT
 *
 * glint/area.h - divides lamps of visible extent into points, spread evenly
 * over an ellipse.
 *
 * Ghosts of an area lamp are those of its points, each shifted by as much as
 * the ghost moves with the lamp, so that their outlines are softened. The
 * number of points follows from the lamp's area in pixels and is a real number:
 * the last point has only a fraction of the power, and all move smoothly as the
 * lamp grows. Nothing steps in a video. */
#ifndef GLINT_AREA_H
#define GLINT_AREA_H

#include "glint/view.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_AREA_SAMPLES = 7, /* points of the brightest lamp, unless another
                               number is requested */
    /* Factor on the points beyond the first that a lamp gets in a single
     * picture. */
    GLINT_AREA_STILL = 20,
    GLINT_AREA_STILL_ROOM = 4, /* factor on max_lights for points of wide lamps
                                  in a single picture */
    /* Side of the square, in pixels, that a point stands for. */
    GLINT_AREA_SPACING_PX = 4,
    GLINT_AREA_MOST_SAMPLES = 4096
};

/* Points of one lamp. */
struct glint_area {
    struct glint_lamp lamp;
    double points; /* number of points, 1 or more; the last may count in part */
    double centre[2]; /* middle of the pattern of points, which is moved to the
                         lamp's place */
    double spread;    /* factor that gives the pattern the lamp's RMS extent */
    double u, v;      /* place of the lamp, tangents */
    /* xx, xy, yy of the symmetric matrix that takes a circle of radius 1 to the
     * ellipse, tangents. It knows no sign of the axes, so that the points of a
     * lamp stay where they are when its turn goes from 90 degrees to -90, and
     * those of a nearly round one when its axes swing about. */
    double stretch[3];
};

/* How many points lamps get. Steps between points are seen less in a faint
 * lamp, so it gets fewer, by the root of its power. */
struct glint_area_rule {
    double pixels_per_tangent;
    double most;      /* most points of the brightest lamp */
    double brightest; /* power of the brightest lamp */
    double thinning;  /* factor on points beyond the first, 0 .. 1; 0: each lamp
                         is one point */
};

/* Returns the rule for LAMPS that makes at most ROOM points of all, or one of
 * each if there are more lamps; MOST is the most points of one lamp. *TOTAL
 * receives a bound on the number of points. */
struct glint_area_rule glint_area_rule_of(const struct glint_lamp *lamps, int n,
                                          double pixels_per_tangent,
                                          double most, int room, int *total);

/* Plans the points of LAMP by RULE; returns how many there are. */
int glint_area_plan(struct glint_area *area, const struct glint_lamp *lamp,
                    const struct glint_area_rule *rule);

/* Returns how far the points of AREA are apart, as a tangent; 0 if there is
 * only one. */
double glint_area_apart(const struct glint_area *area);

/* Returns point I of AREA, with its fraction of the power, as a lamp without
 * extent. */
struct glint_lamp glint_area_point(const struct glint_area *area, int i);

/* Makes LAMP round, with an RMS radius of TANGENT. */
void glint_area_set_round(struct glint_lamp *lamp, double tangent);

#ifdef __cplusplus
}
#endif

#endif
