/* SPDX-License-Identifier: MIT
 *
 * Measures the brightness of a lens's flare as a function of the
 * angle of the lamp.
 *
 *     glint_response_measure(&frame, bytes, &response);         once
 *     glint_response_interpolate_light(&response, theta_deg, &light); each lamp
 *
 * Draws small linear-light pictures of the flare of one white lamp, at angles
 * from the axis to the corner of the view, and measures them. Logarithms are
 * interpolated between the angles, so that the result is a smooth function of
 * the angle. Lamps of visible extent have softer ghosts; they are drawn at one
 * angle only, and the same loss of brightness is assumed at all angles. Uses
 * doubles; the integer engine draws the pictures but does not use the result.
 *
 * Unit: light of the picture, 1 = white, for a lamp whose power (white times
 * pixels) equals that of the whole picture in white. So the unit does not
 * depend on the size of the picture.
 */
#ifndef GLINT_ENGINE_RESPONSE_H
#define GLINT_ENGINE_RESPONSE_H

#include "engine/frame/frame.h"
#include "engine/seen.h"

enum {
    GLINT_RESPONSE_ANGLES = 12,
    GLINT_RESPONSE_EXTENTS = 5,
    /* Number of pixels of the small pictures. COARSE is enough to find the
     * brightest 1/1000 at little cost; FINE the brightest 1/10000, as the
     * ghosts of a point may be that small. */
    GLINT_RESPONSE_COARSE = 192 * 108,
    GLINT_RESPONSE_FINE = 640 * 360
};

struct glint_response {
    int n; /* number of angles, 1 .. GLINT_RESPONSE_ANGLES; 0: nothing was
              measured */
    /* angles in rising order, from 0 */
    double theta_deg[GLINT_RESPONSE_ANGLES];
    /* log2 of the light at each angle; -100: no light */
    struct glint_response_light log2_of[GLINT_RESPONSE_ANGLES];
    /* Lamps of visible extent: tangents of their RMS radii, rising from 0,
     * and log2 of the ratio of the peak of their flare to the peak of a
     * point's flare. */
    double extent[GLINT_RESPONSE_EXTENTS],
        softened_log2[GLINT_RESPONSE_EXTENTS];
    double ms; /* time that the measurement took, ms */
};

/* Sets LIGHT to the light of the flare of N lamps, drawn with the lens of
 * FRAME in a small picture of about PIXELS pixels. The lamps' powers refer to
 * the view of FRAME, whose next picture of these lamps takes less time if it is
 * drawn by exact rays. The peak is the value that 1/10000 of the pixels reach;
 * smaller specks are ignored. Sets SEEN to the flare's visibility on GROUND,
 * unless both are NULL. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_response_draw_and_measure(
    struct glint_frame *frame, const struct glint_lamp *lamps, int n,
    int pixels, const struct glint_ground *ground,
    struct glint_response_light *light, struct glint_seen *seen);

/* Measures RESPONSE for the lens, view and requested options of LIKE.
 * Allocates at most BYTES for drawing; 0: no limit. Returns GLINT_E_MEMORY
 * on failure. */
enum glint_status glint_response_measure(const struct glint_frame *like,
                                         size_t bytes,
                                         struct glint_response *response);

/* Like glint_response_measure(), but reads results from CACHE if they are
 * stored there, and stores new ones. CACHE may be NULL. Responses of lenses
 * without a model are not cached. */
enum glint_status
glint_response_measure_cached(const struct glint_frame *like, size_t bytes,
                              const struct glint_engine_cache *cache,
                              struct glint_response *response);

/* Returns the ratio of the peak of the flare of LAMP to the peak of a
 * point's flare: at most 1, as the extent of the lamp blurs its ghosts. */
double glint_response_compute_softening(const struct glint_response *response,
                                        const struct glint_lamp *lamp);

/* Sets LIGHT to the light of the flare of a point THETA_DEG off the axis.
 * Outside the view it is the light at the corner. */
void glint_response_interpolate_light(const struct glint_response *response,
                                      double theta_deg,
                                      struct glint_response_light *light);

#endif
