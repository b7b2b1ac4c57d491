/* SPDX-License-Identifier: MIT
 *
 * Measures the brightness of a lens's flare by the angle of the lamp.
 *
 *     glint_response_measure(&frame, bytes, &response);         once
 *     glint_response_at(&response, theta_deg, &light);          each lamp
 *
 * Small pictures of the flare of one white lamp, at angles from the axis to the
 * corner of the view, are drawn in linear light and measured. Between the
 * angles the logarithms are interpolated, so that the result is a smooth
 * function of the angle. Lamps of visible extent, whose ghosts are softer, are
 * drawn at one angle only, and assumed to lose as much at all angles. Doubles;
 * the integer engine draws, but does not use it.
 *
 * Unit: light of the picture, 1 = white, for a lamp whose power (white times
 * pixels) equals that of the whole picture in white. So it does not depend on
 * the size of the picture. */
#ifndef GLINT_ENGINE_RESPONSE_H
#define GLINT_ENGINE_RESPONSE_H

#include "engine/frame/frame.h"
#include "engine/seen.h"

enum {
    GLINT_RESPONSE_ANGLES = 12,
    GLINT_RESPONSE_EXTENTS = 5,
    /* Pixels of small pictures: enough to take 1/1000 of them, at little cost;
     * or 1/10000 of them, as ghosts of a point may be that small. */
    GLINT_RESPONSE_COARSE = 192 * 108,
    GLINT_RESPONSE_FINE = 640 * 360
};

struct glint_response {
    int n; /* number of angles, 1 .. GLINT_RESPONSE_ANGLES; 0: nothing was
              measured */
    double theta_deg[GLINT_RESPONSE_ANGLES]; /* rising, from 0 */
    /* log2 of the light at each angle; -100: there is none. */
    struct glint_response_light log2_of[GLINT_RESPONSE_ANGLES];
    /* Lamps of visible extent: their RMS radii, tangents, rising from 0, and
     * log2 of the brightest part of their flare / the brightest part of a
     * point's. */
    double extent[GLINT_RESPONSE_EXTENTS],
        softened_log2[GLINT_RESPONSE_EXTENTS];
    double ms; /* milliseconds that measuring took */
};

/* Sets LIGHT to that of N lamps behind the lens of LIKE, drawn in a small
 * picture of about PIXELS. Powers are those in the view of LIKE. The peak is
 * the value that 1/10000 of the pixels reach: smaller specks do not count. Sets
 * SEEN to its visibility on GROUND, unless both are NULL. GLINT_E_MEMORY.
 */
enum glint_status glint_response_draw(const struct glint_frame *like,
                                      const struct glint_lamp *lamps, int n,
                                      int pixels,
                                      const struct glint_ground *ground,
                                      struct glint_response_light *light,
                                      struct glint_seen *seen);

/* Measures RESPONSE for the lens and view of LIKE, with the options that LIKE
 * was asked to draw with. Takes at most BYTES for drawing, unless that is 0.
 * GLINT_E_MEMORY. */
enum glint_status glint_response_measure(const struct glint_frame *like,
                                         size_t bytes,
                                         struct glint_response *response);

/* glint_response_measure() with a cache: reads entries from CACHE and writes
 * new ones. CACHE may be NULL. Responses of lenses without a model are not
 * cached. */
enum glint_status glint_response_obtain(const struct glint_frame *like,
                                        size_t bytes,
                                        const struct glint_engine_cache *cache,
                                        struct glint_response *response);

/* Returns the brightest part of the flare of LAMP / the brightest part of a
 * point's flare: at most 1, as the lamp's ghosts are blurred. */
double glint_response_softening(const struct glint_response *response,
                                const struct glint_lamp *lamp);

/* Sets LIGHT to the light of a point THETA_DEG off the axis. Outside the view
 * it is the light at the corner: there the lens itself dims lamps. */
void glint_response_at(const struct glint_response *response, double theta_deg,
                       struct glint_response_light *light);

#endif
