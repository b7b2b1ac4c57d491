/* SPDX-License-Identifier: MIT
 *
 * How bright the flare of a lens comes out, by the angle of the lamp.
 *
 *     glint_response_measure(&frame, bytes, &response);        once
 *     glint_response_at(&response, theta_deg, &light);                 each
 * lamp
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
#ifndef GLINT_ENGINE_RESPONSE_H
#define GLINT_ENGINE_RESPONSE_H

#include "engine/frame/frame.h"
#include "engine/seen.h"

enum {
    GLINT_RESPONSE_ANGLES = 12,
    GLINT_RESPONSE_EXTENTS = 5,
    /* Pixels of what is drawn: enough for a thousandth of them, and costing
     * little; and for a ten thousandth, as ghosts of a point may be as small.
     */
    GLINT_RESPONSE_COARSE = 192 * 108,
    GLINT_RESPONSE_FINE = 640 * 360
};

/* Light of a layer that is the flare alone, by linear R, G, B. */
struct glint_response_light {
    double peak[3]; /* mean of the brightest thousandth of the pixels */
    double mean[3]; /* mean of all pixels */
};

struct glint_response {
    int n; /* angles, 1 .. GLINT_RESPONSE_ANGLES; 0: nothing was measured */
    double theta_deg[GLINT_RESPONSE_ANGLES]; /* rising, from 0 */
    struct glint_response_light log2_of[GLINT_RESPONSE_ANGLES]; /* -100: none */
    /* Lamps of visible extent: their RMS radii, tangents, rising from 0, and
     * what the brightest of their flares is of that of a point. */
    double extent[GLINT_RESPONSE_EXTENTS],
        softened_log2[GLINT_RESPONSE_EXTENTS];
    double ms; /* ms that it took */
};

/* Looks at N pixels. */
void glint_response_around(const float *rgb, size_t n,
                           struct glint_response_light *light);

/* Of N lamps behind the lens of LIKE, drawn small, with about PIXELS. Powers
 * are those of its view. The peak is what a ten thousandth of the pixels reach:
 * smaller specks do not count. SEEN: what GROUND lets see of it; NULL, both.
 * GLINT_E_MEMORY. */
enum glint_status glint_response_draw(const struct glint_frame *like,
                                      const struct glint_lamp *lamps, int n,
                                      int pixels,
                                      const struct glint_ground *ground,
                                      struct glint_response_light *light,
                                      struct glint_seen *seen);

/* Measures frames as LIKE was asked to draw them. Takes no more than BYTES for
 * its own, unless that is 0. GLINT_E_MEMORY. */
enum glint_status glint_response_measure(const struct glint_frame *like,
                                         size_t bytes,
                                         struct glint_response *response);

/* Returns the brightest part of the flare of LAMP over that of a point, as its
 * ghosts overlap themselves: at most 1. */
double glint_response_softening(const struct glint_response *response,
                                const struct glint_lamp *lamp);

/* The light of a point THETA_DEG off the axis. Beyond the corner of the view it
 * is what it is at the corner: there lamps fade as the lens has it. */
void glint_response_at(const struct glint_response *response, double theta_deg,
                       struct glint_response_light *light);

#endif
