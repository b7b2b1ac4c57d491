/* SPDX-License-Identifier: MIT
 *
 * Lamps of visible extent: as many points, spread evenly over an ellipse.
 *
 * Ghosts of an area lamp are those of its points, each shifted by as much as
 * the ghost moves with the lamp, so that their outlines are softened. How many
 * points it takes follows from the lamp's area in pixels and is a real number:
 * the last of them has the rest of the power, and all move smoothly as the
 * lamp grows. Nothing steps in a video.
 */
#ifndef GLINT_ENGINE_FRAME_AREA_H
#define GLINT_ENGINE_FRAME_AREA_H

#include "glint/glint.h"

enum {
    GLINT_AREA_SAMPLES = 7,    /* points of the brightest lamp, unless asked */
    GLINT_AREA_STILL = 20,     /* times as many of those in a single picture */
    GLINT_AREA_STILL_ROOM = 4, /* times max_lights that those may come to */
    GLINT_AREA_SPACING_PX = 4, /* a point for so many pixels squared */
    GLINT_AREA_MOST_SAMPLES = 4096
};

/* Points of one lamp. */
struct glint_area {
    struct glint_lamp lamp;
    double points;    /* >= 1 */
    double centre[2]; /* middle of the points' pattern, which is put where the
                         lamp is */
    double spread;    /* factor that gives the pattern the lamp's RMS extent */
    double u, v;      /* the lamp, tangents */
    double major[2], minor[2]; /* semi-axes, tangents */
};

/* How many points lamps get. The steps between them show less of faint lamps,
 * so these get fewer, by the root of their power. */
struct glint_area_rule {
    double pixels_per_tangent;
    double most;      /* power of the brightest lamp */
    double brightest; /* power of it */
    double thinning;  /* 0: each is one point; to 1 */
};

/* The rule for LAMPS by which there are at most ROOM points, or one each where
 * there are more lamps. MOST: of one lamp. TOTAL: no more than so many. */
struct glint_area_rule glint_area_rule_of(const struct glint_lamp *lamps, int n,
                                          double pixels_per_tangent,
                                          double most, int room, int *total);

/* Plans the points of LAMP. Returns how many. */
int glint_area_plan(struct glint_area *area, const struct glint_lamp *lamp,
                    const struct glint_area_rule *rule);

/* Point I of them, with its share of the power; a lamp without extent. */
struct glint_lamp glint_area_point(const struct glint_area *area, int i);

/* Makes a round lamp of the RMS radius TANGENT. */
void glint_area_set_round(struct glint_lamp *lamp, double tangent);

#endif
