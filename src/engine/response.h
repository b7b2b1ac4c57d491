/* SPDX-License-Identifier: MIT
 *
 * Measures the lens response, which is the brightness of the flare as a
 * function of the angle of the lamp.
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
 * depend on the size of the picture. */
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
    /* measured angles, rising from 0, degrees */
    double theta_deg[GLINT_RESPONSE_ANGLES];
    /* log2 of the light at each angle; -100: no light */
    struct glint_response_light log2_of[GLINT_RESPONSE_ANGLES];
    /* For lamps of visible extent. extent: tangents of RMS radii, rising from
     * 0, then 0 where nothing was measured. softened: log2 of (peak of the
     * flare of such a lamp / peak of a point light's flare). */
    double extent[GLINT_RESPONSE_EXTENTS],
        softened_log2[GLINT_RESPONSE_EXTENTS];
    double ms; /* duration of the measurement, ms */
};

/* Draws the flare of N lamps with the lens of FRAME in a small picture of about
 * PIXELS pixels, and sets LIGHT to its brightness. The powers of LAMPS are
 * those for the picture of FRAME. The peak is the light that 1/10000 of the
 * pixels reach. Sets SEEN to the visibility of the flare on the picture GROUND,
 * unless either is NULL. Exact rays are cached for the next picture of FRAME.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_response_draw_and_measure(
    struct glint_frame *frame, const struct glint_lamp *lamps, int n,
    int pixels, const struct glint_ground *ground,
    struct glint_response_light *light, struct glint_seen *seen);

/* Measures RESPONSE for the lens, view and requested options of frame LIKE.
 * Allocates at most BYTES for drawing; 0: no limit. Measures lamps of visible
 * extent up to EXTENT, a tangent of an RMS radius; they are slow by exact rays.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_response_measure(const struct glint_frame *like,
                                         size_t bytes, double extent,
                                         struct glint_response *response);

/* Returns whether RESPONSE was measured for lamps up to EXTENT, or for the
 * largest lamps that are measured. */
bool glint_response_has_extent(const struct glint_response *response,
                               double extent);

/* Like glint_response_measure(), but reads the result from CACHE if it is
 * stored there, and otherwise stores it. CACHE may be NULL. Responses of lenses
 * without a model are not cached. */
enum glint_status
glint_response_measure_cached(const struct glint_frame *like, size_t bytes,
                              const struct glint_engine_cache *cache,
                              struct glint_response *response);

/* Returns the peak of the flare of LAMP divided by the peak of the flare of a
 * point light. The result is at most 1, as the extent of a lamp blurs its
 * ghosts. */
double glint_response_compute_softening(const struct glint_response *response,
                                        const struct glint_lamp *lamp);

/* Sets LIGHT to the brightness of the flare of a point light THETA_DEG degrees
 * off the axis. For angles outside the view it is the brightness at the
 * corner. */
void glint_response_interpolate_light(const struct glint_response *response,
                                      double theta_deg,
                                      struct glint_response_light *light);

#endif
