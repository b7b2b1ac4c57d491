/* SPDX-License-Identifier: MIT
 *
 * Computes the automatic exposure of option --strength. It is the factor on the
 * powers of lamps with which the flare is visible and plausible.
 *
 *     glint_strength_expose_frame(&strength, &response, &lit, elapsed_us);
 *
 * From scene to code: a lamp of power P (white times pixels: the light that the
 * picture shows, and the estimated light beyond white) has a flare of P *
 * response(angle) at --exposure 0. The response includes the transmittance and
 * the coatings of the lens, its stop and the sensor's size. Multiplied by gain
 * and 2^EV it is display light, 1 = white, which is added to the light of the
 * picture. --exposure sets EV directly; otherwise it is chosen here.
 *
 * If the flare of lamp i has the light p_i in the brightest thousandth of the
 * pixels and m_i in the mean (largest channels), the flare of all lamps has
 *     p = (sum p_i^4)^(1/4)    approximate peak, as flares rarely overlap
 *     m = sum m_i              mean
 *     b = (p^4 + (m / 0.32)^4)^(1/4)
 * and the factor on the power of all lamps is
 *     strength^2 * ((p / t)^4 + (m / 0.32)^4)^(-1/4),
 *     t = 2^tanh(0.15 log2(b / b0)),    b0 = 1/32
 * but at most 0.06 strength^2 / m, so that no lens fogs the picture: the mean
 * is at most 1.5 % of white at strength 0.5. So the peak is about strength^2,
 * and the mean, if the lens veils the picture or there are many lamps, at most
 * a third of that. Each doubling of the strength adds two stops; 0.5 is a
 * quarter of white. Lamps with ten stops more light have 1.25 stops more flare:
 * a sun shows more than a candle, within a stop either way. The ratios between
 * lamps are preserved.
 *
 * The response is measured with one lamp on one line from the axis. For a still
 * picture its own flare is drawn at reduced size first, which gives p and m
 * directly; p is then the value that 1/10000 of the pixels reach. So the few
 * small ghosts of a point, the large ghosts of a candle, and lamps off that
 * line are exposed equally. Then the exposure is corrected by the visibility of
 * the flare on the picture (engine/seen.h). An invisible flare is raised until
 * it is visible in 1/50 of the picture; at strength 0.5 the limits are 0.6 for
 * its peak and 0.04 for its mean. A flare that veils a quarter of the picture
 * is lowered until its light there is half of the min visible light. A flare
 * whose ghosts turn a bright sky white is lowered until they add two fifths of
 * the light that would do so. Neither is lowered below a peak of 0.1.
 *
 * In a video, a change of the strength takes effect at once. The rest of the
 * factor changes gradually, in stops: it falls by at most 3 stops per second,
 * rises by at most 2, and changes by at most an eighth of a stop per frame, so
 * that no step exceeds 10 %. It starts again after a cut, and when the first
 * lamp appears. Lamps fade in and out with their tracks; the factor is chosen
 * from their powers without these levels. The ghosts of a lamp that is too
 * bright for the current factor are limited to 1.5 times the exposure that they
 * would get alone, until the factor has adapted; its starburst is not. */
#ifndef GLINT_ENGINE_STRENGTH_H
#define GLINT_ENGINE_STRENGTH_H

#include "engine/response.h"

/* The lamps of a frame, as input of the exposure. */
struct glint_strength_lamps {
    /* [n]: lamps; powers include the fade levels, but not the scale */
    const struct glint_engine_lamp *lamp;
    /* [n]: factor on the ghosts of each lamp, set by
     * glint_strength_expose_frame(). It is below 1 for a lamp that would be too
     * bright until the exposure has adapted. It does not apply to
     * starbursts. */
    double *part;
    int n;
    double pixels; /* number of pixels of the picture times the linear light of
                      the picture's white */
};

struct glint_strength {
    /* Options: */
    double asked;     /* strength that the caller requested, 0 .. 100; 0.5 by
                         default */
    bool is_physical; /* true: the caller sets the exposure, and the factor is
                         2^exposure_ev */
    double exposure_ev, gain;

    /* Results for the last frame: */
    double scale; /* factor on the powers of lamps; 0: nothing to draw */
    /* light of the flare after multiplication by scale */
    struct glint_response_light light;
    bool is_drawn; /* true: LIGHT was measured by drawing the flare of this
                      picture; false: it was computed from the response */

    /* Private: log2 of the factor without strength and gain. It changes
     * gradually, while strength and gain take effect at once. */
    double factor_log2;
    bool follows;
};

/* Initialises STRENGTH with strength 0.5 and gain 1. */
void glint_strength_set_defaults(struct glint_strength *strength);

/* Returns the factor on the brightness of starbursts, in addition to scale.
 * STARBURST is the requested brightness / the physical brightness. The product
 * of this factor and scale does not depend on the exposure of ghosts. */
double glint_strength_compute_star_factor(const struct glint_strength *strength,
                                          double starburst);

/* Exposes a frame: sets scale and light of STRENGTH, and part of LAMPS.
 * ELAPSED_US is the time since the last frame; 0: the frame does not continue
 * the last one. */
void glint_strength_expose_frame(struct glint_strength *strength,
                                 const struct glint_response *response,
                                 const struct glint_strength_lamps *lamps,
                                 int32_t elapsed_us);

/* Replaces the exposure of a still picture, which was computed from the
 * response, by an exposure from a drawing of its flare. DRAWN is the light of
 * the flare, drawn at reduced size and scale 1. SEEN is the visibility of that
 * flare on the picture, or NULL. Does nothing if the caller has set the factor
 * or there is no light. */
void glint_strength_correct_exposure(struct glint_strength *strength,
                                     const struct glint_response_light *drawn,
                                     const struct glint_seen *seen);

/* Draws the flare of the N LAMPS of a still picture with the lens of FRAME, at
 * reduced size and scale 1, measures it, and calls
 * glint_strength_correct_exposure(). WHITE: linear light of the picture's
 * white. GROUND: the picture under the flare, or NULL. On GLINT_E_MEMORY
 * nothing has changed. */
enum glint_status glint_strength_expose_still_picture(
    struct glint_strength *strength, struct glint_frame *frame,
    const struct glint_lamp *lamps, int n, const struct glint_ground *ground,
    double white);

/* Sets LIGHT to the light of the flare of LAMPS at scale 1, computed from
 * RESPONSE. */
void glint_strength_compute_light(const struct glint_response *response,
                                  const struct glint_strength_lamps *lamps,
                                  struct glint_response_light *light);

#endif
