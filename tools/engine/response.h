/* SPDX-License-Identifier: MIT
 *
 * How bright the flare of a lens comes out, by the angle of the lamp.
 *
 *     response_measure(&tool, &scene, view, bytes, &response);       once
 *     response_at(&response, theta_deg, &light);                 each lamp
 *
 * Small pictures of the flare of one white lamp, at angles from the axis to
 * the corner of the view, are drawn in linear light and looked at;
 * between the angles the logarithms are interpolated, so that it is a gentle
 * function of the angle. Lamps of visible extent, whose ghosts are softer, are
 * drawn at one angle and taken to lose as much at all. Doubles; the integer
 * engine draws, but is not part of it.
 *
 * Unit: light of the picture, 1 = white, of a lamp whose power (white times
 * pixels) is as much as the whole picture white. So it is the same for every
 * size of the picture.
 */
#ifndef GLINT_TOOLS_ENGINE_RESPONSE_H
#define GLINT_TOOLS_ENGINE_RESPONSE_H

#include "options/scene.h"

enum { RESPONSE_ANGLES = 12, RESPONSE_EXTENTS = 5 };

/* Light of a layer that is the flare alone, by linear R, G, B. */
struct response_light {
    double peak[3]; /* mean of the brightest thousandth of the pixels */
    double mean[3]; /* of all */
};

struct response {
    int n; /* angles, 1 .. RESPONSE_ANGLES; 0: nothing was measured */
    double theta_deg[RESPONSE_ANGLES];              /* rising, from 0 */
    struct response_light log2_of[RESPONSE_ANGLES]; /* -100: none */
    /* Lamps of visible extent: their RMS radii, tangents, rising from 0, and
     * what the brightest of their flares is of that of a point. */
    double extent[RESPONSE_EXTENTS], softened_log2[RESPONSE_EXTENTS];
    double ms; /* that it took */
};

/* Looks at N pixels. */
void response_look(const float *rgb, size_t n, struct response_light *light);

/* Of N lamps behind SCENE's lens, drawn small: the shape of VIEW, as many
 * pixels as suit. GLINT_E_MEMORY. Powers are those of VIEW. */
enum glint_status response_draw(const struct tool *tool,
                                const struct scene *scene,
                                struct glint_view view,
                                const struct glint_lamp *lamps, int n,
                                struct response_light *light);

/* Measures SCENE, which is open, for pictures that lie as VIEW does. Takes no
 * more than BYTES for the frames, unless that is 0. Returns an exit code. */
int response_measure(const struct tool *tool, const struct scene *scene,
                     struct glint_view view, size_t bytes,
                     struct response *response);

/* What the brightest part of the flare of LAMP is of that of a point, as its
 * ghosts overlap themselves: at most 1. */
double response_softening(const struct response *response,
                          const struct glint_lamp *lamp);

/* The light of a point THETA_DEG off the axis. Beyond the corner of the view it
 * is what it is at the corner: there lamps fade as the lens has it. */
void response_at(const struct response *response, double theta_deg,
                 struct response_light *light);

#endif
