/* SPDX-License-Identifier: MIT
 *
 * glint/area.h - divides lamps of visible extent into points, spread evenly
 * over an ellipse.
 *
 * The ghosts of an area lamp are the sum of its points' ghosts, whose shifts
 * soften the outlines. The number of points follows from the lamp's area in
 * pixels and is a real number: the last point has only a fraction of the power,
 * and all points move smoothly as the lamp grows, so nothing steps in a video.
 * */
#ifndef GLINT_AREA_H
#define GLINT_AREA_H

#include "glint/view.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_AREA_SAMPLES = 16, /* default max points of the brightest lamp */
    /* Factor on (number of points of a lamp - 1) for a still picture, relative
     * to a frame of a video. */
    GLINT_AREA_STILL = 8,
    /* Max number of points of all wide lamps of a still picture together, as a
     * multiple of max_lights (glint/dials.h). */
    GLINT_AREA_STILL_ROOM = 4,
    /* Each point represents a square of the lamp with this side, pixels. */
    GLINT_AREA_SPACING_PX = 4,
    GLINT_AREA_MOST_SAMPLES = 4096
};

/* The points into which one lamp is divided. */
struct glint_area {
    struct glint_lamp lamp;
    double points; /* number of points, 1 or more; the last may be fractional */
    /* Weighted mean of the points in the unit circle. It is subtracted from all
     * points, so that their mean lies at the lamp's position. */
    double centre[2];
    /* Factor on the distances of the points from their mean, which gives the
     * points the lamp's RMS extent. */
    double spread;
    double u, v; /* position of the lamp, tangents */
    /* xx, xy, yy of the symmetric matrix that maps the unit circle to the
     * lamp's ellipse, tangents. The sign of the axes does not matter, so points
     * stay in place when the orientation jumps from 90 degrees to -90, or when
     * the axes of a nearly round lamp rotate. */
    double stretch[3];
};

/* Rule for the number of points of each lamp. The number is proportional to the
 * square root of the lamp's power, because steps between points are less
 * visible in a faint lamp. */
struct glint_area_rule {
    double pixels_per_tangent;
    double most;      /* max points of the brightest lamp */
    double brightest; /* power of the brightest lamp */
    /* Factor, 0 .. 1, on (number of points - 1) of each lamp; 0: one point per
     * lamp. */
    double thinning;
};

/* Returns the rule by which LAMPS[N] get at most ROOM points in total. If N
 * exceeds ROOM, each lamp gets one point. MOST is the max number of points of
 * one lamp. Sets *TOTAL to an upper bound of the number of all points. */
struct glint_area_rule glint_area_rule_of(const struct glint_lamp *lamps, int n,
                                          double pixels_per_tangent,
                                          double most, int room, int *total);

/* Sets AREA to the points into which RULE divides LAMP; returns their
 * number. */
int glint_area_plan(struct glint_area *area, const struct glint_lamp *lamp,
                    const struct glint_area_rule *rule);

/* Returns the distance between neighbouring points of AREA, as the tangent of
 * an angle; 0 if there is only one point. */
double glint_area_apart(const struct glint_area *area);

/* Returns point I of AREA as a lamp without extent, with its fraction of the
 * whole lamp's power. */
struct glint_lamp glint_area_point(const struct glint_area *area, int i);

/* Makes LAMP a disc with an RMS radius of TANGENT. */
void glint_area_set_round(struct glint_lamp *lamp, double tangent);

#ifdef __cplusplus
}
#endif

#endif
