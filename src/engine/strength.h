/* SPDX-License-Identifier: MIT
 *
 * Chooses the factor on the light of lamps, so that a flare is visible and
 * plausible: the automatic exposure behind --strength.
 *
 *     glint_strength_expose(&strength, &response, &lit, elapsed_us);
 *
 * From scene to code. A lamp of power P (white times pixels: as the picture
 * shows it, and as it would show it beyond white) gives a flare of P *
 * response(angle) at --exposure 0; the response contains what the lens lets
 * through, its coatings, its stop and the size of the sensor. Multiplied by
 * gain and 2^EV that is display light, 1 = white, which is added to the
 * picture's. --exposure sets EV by hand; otherwise it is chosen here.
 *
 * If lamp i has the light p_i at the brightest thousandth of the layer and m_i
 * in its mean (largest channels), the flare would have
 *     p = (sum p_i^4)^(1/4)    about the brightest: flares lie side by side
 *     m = sum m_i
 *     b = (p^4 + (m / 0.32)^4)^(1/4)
 * and the factor is
 *     strength^2 * ((p / t)^4 + (m / 0.32)^4)^(-1/4),
 *     t = 2^tanh(0.15 log2(b / b0)),    b0 = 1/32
 * so the brightest part is strength^2, and the mean, if the lens veils the
 * picture or lamps are many, at most a third of that; each doubling of the
 * strength is two stops, 0.5 a quarter of white. Lamps with ten stops more
 * light give 1.25 stops more flare: a sun shows more than a candle, within a
 * stop either way. All lamps get the same factor, so the ratios between them
 * stay.
 *
 * The response is that of one lamp along one line from the axis. A still
 * picture is drawn at reduced size first, and p and m are measured in that: p
 * is then the value that 1/10000 of the pixels reach. So the few small ghosts
 * of a point, the wide ones of a candle, and lamps at which the response off
 * that line differs become as bright as others. Then the exposure is corrected
 * by the visibility of the flare on the picture (engine/seen.h). An invisible
 * flare is brightened until it is visible in 1/50 of the picture: at strength
 * 0.5 up to 0.6 in its brightest part and 0.04 in the mean. A flare that veils
 * a quarter of the picture is lowered until the light there is half of the
 * least that can be seen, and one whose ghosts turn a bright sky white is
 * lowered until they take two fifths of the way there; neither below 0.1 in its
 * brightest part.
 *
 * In a video a strength that changes counts in its frame. The rest of the
 * factor follows, in stops in proportion to the time: it falls by up to 3 stops
 * a second and rises by up to 2, by no more than an eighth of a stop a frame,
 * so that no step exceeds 10 %. It starts again after a cut, and if there was
 * no lamp before. Lamps rise and fade with their tracks
 * (powers without these levels decide on the factor). A new lamp that is too
 * bright for the factor, until that has followed, is limited to 1.5 times the
 * exposure that it would get alone. */
#ifndef GLINT_ENGINE_STRENGTH_H
#define GLINT_ENGINE_STRENGTH_H

#include "engine/response.h"

/* The lamps of a frame. */
struct glint_strength_lamps {
    /* [n]; powers include levels but not scale; powers of new lamps that are
     * too bright are lowered in place */
    struct glint_engine_lamp *lamp;
    int n;
    double pixels; /* number of pixels of the picture, times the light of its
                      white */
};

struct glint_strength {
    /* Options. */
    double asked;     /* 0 .. 100, 0.5 by default */
    bool is_physical; /* true: the factor is 2^exposure_ev */
    double exposure_ev, gain;

    /* Results for the last frame. */
    double
        scale; /* factor on the powers of lamps; 0: there is nothing to draw */
    /* Light of the flare, with that factor. */
    struct glint_response_light light;
    bool is_drawn; /* true: the light was measured in a drawn flare */

    /* Private: log2 of the factor without strength and gain, as it follows. */
    double factor_log2;
    bool follows;
};

/* Sets strength 0.5 and gain 1. */
void glint_strength_defaults(struct glint_strength *strength);

/* Returns the factor on a starburst, in addition to the scale of the flare.
 * STARBURST is its brightness / the physical one; the result does not depend on
 * the exposure of ghosts. */
double glint_strength_star(const struct glint_strength *strength,
                           double starburst);

/* Sets the scale and the light for LAMPS, ELAPSED_US after the last frame, or 0
 * if this frame is unrelated to that one. Lowers the powers of lamps that are
 * still too bright. */
void glint_strength_expose(struct glint_strength *strength,
                           const struct glint_response *response,
                           const struct glint_strength_lamps *lamps,
                           int32_t elapsed_us);

/* Corrects the exposure of a still picture: sets the scale and the light from
 * DRAWN, the light of its flare drawn at reduced size and scale 1, instead of
 * the response; and from SEEN, the visibility of that flare on the picture,
 * unless SEEN is NULL. Changes nothing if the factor is set by hand or there is
 * no light. */
void glint_strength_correct(struct glint_strength *strength,
                            const struct glint_response_light *drawn,
                            const struct glint_seen *seen);

/* Corrects the exposure of a still: draws the flare of N LAMPS behind the lens
 * of FRAME at low resolution and scale 1, and measures it. WHITE: light of the
 * picture's white. GROUND: the picture below the flare, or NULL.
 * GLINT_E_MEMORY: nothing has changed. */
enum glint_status glint_strength_expose_still(struct glint_strength *strength,
                                              const struct glint_frame *frame,
                                              const struct glint_lamp *lamps,
                                              int n,
                                              const struct glint_ground *ground,
                                              double white);

/* Sets LIGHT to the light of the flare of LAMPS by RESPONSE, at scale 1. */
void glint_strength_light(const struct glint_response *response,
                          const struct glint_strength_lamps *lamps,
                          struct glint_response_light *light);

#endif
