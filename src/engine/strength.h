/* SPDX-License-Identifier: MIT
 *
 * How much the light of lamps is multiplied by, so that a flare is seen and
 * believed: the automatic exposure behind --strength.
 *
 *     glint_strength_expose(&strength, &response, &lit, elapsed_us);  each
 * frame
 *
 * From scene to code. A lamp of power P (white times pixels: what the picture
 * shows of it, and what it would show beyond white) gives a flare of
 * P * response(angle) at --exposure 0; the response holds what the lens lets
 * through, its coatings, its stop and the size of the sensor. Times gain and
 * 2^EV that is display light, 1 = white, which is added to the picture's.
 * --exposure sets EV by hand; otherwise it is chosen here.
 *
 * Of lamps i with the light p_i at the brightest thousandth of the layer and
 * m_i in its mean (largest channels), the flare would have
 *     p = (sum p_i^4)^(1/4)    about the brightest: flares lie side by side
 *     m = sum m_i
 *     b = (p^4 + (m / 0.32)^4)^(1/4)
 * and the factor is
 *     strength^2 * ((p / t)^4 + (m / 0.32)^4)^(-1/4),
 *     t = 2^tanh(0.15 log2(b / b0)),    b0 = 1/32
 * so the brightest comes to strength^2, and the mean, where the lens veils the
 * picture or lamps are many, to a third of that at most; each doubling of the
 * strength is two stops, 0.5 a quarter of white. Lamps of ten stops more light
 * give one and a quarter more flare: a sun shows more than a candle, within a
 * stop either way. All lamps get the same factor, so the ratios between them
 * stay.
 *
 * The response knows one lamp at a time, along one line from the axis. For a
 * picture by itself there is time to draw the flare small and to take p and m
 * from that: p is then what a ten thousandth of the pixels reach. So the few
 * small ghosts of a point, the wide ones of a candle, and lamps that the lens
 * answers otherwise off that line come out as bright as others. Then what the
 * picture lets see of it (engine/seen.h) counts: where that is too little the
 * flare is lifted until a fiftieth of the picture shows it, at strength 0.5 up
 * to 0.7 at its brightest and 0.04 in the mean; where a quarter of the picture
 * is veiled it is lowered until that shows half as much as is seen, down to
 * 0.08 at its brightest.
 *
 * In a video the factor follows, by stops in proportion to the time: it falls
 * by up to 3 stops a second and rises by up to 2, no more than an eighth of
 * a stop a frame, so that it makes no step of 10 %. It starts anew after a cut
 * and where no lamp was before. Lamps rise and fade by their tracks (powers
 * without these levels decide on the factor), and a lamp that came and is too
 * bright for the factor until that has followed is held to 1.5 times what it
 * would be by itself.
 */
#ifndef GLINT_ENGINE_STRENGTH_H
#define GLINT_ENGINE_STRENGTH_H

#include "engine/response.h"

/* The lamps of a frame. */
struct glint_strength_lamps {
    struct glint_lamp *lamp; /* [n]; their powers are those to be drawn */
    const double *level;     /* [n], above 0, at most 1: how far each has risen;
                                a part of its power. NULL: all 1 */
    int n;
    double pixels; /* the picture's pixels, times the light of its white */
};

struct glint_strength {
    /* Options. */
    double asked;     /* 0 .. 100, 0.5 by default */
    bool is_physical; /* the factor is 2^EV alone */
    double exposure_ev, gain;

    /* The last frame's. */
    double
        scale; /* factor for the powers of lamps; 0: there is nothing to draw */
    struct glint_response_light light; /* the flare's, with that factor */
    bool is_drawn; /* the light is the flare's as it was drawn */

    /* Private: the factor without gain, followed. */
    double factor_log2;
    bool follows;
};

/* STRENGTH 0.5, gain 1. */
void glint_strength_defaults(struct glint_strength *strength);

/* What a starburst, STARBURST times as bright as its lamps and the stop have
 * it, is to be multiplied by beside the flare, which has the scale; it does not
 * follow what ghosts take to be seen. */
double glint_strength_star(const struct glint_strength *strength,
                           double starburst);

/* Sets the scale and the light for LAMPS. ELAPSED_US since the frame before; 0:
 * it has nothing to do with this one. Lowers the powers of lamps that are too
 * bright yet. */
void glint_strength_expose(struct glint_strength *strength,
                           const struct glint_response *response,
                           const struct glint_strength_lamps *lamps,
                           int32_t elapsed_us);

/* Of a picture by itself, after it was exposed: sets the scale and the light
 * anew by what its flare came to when it was drawn small, DRAWN, at scale 1,
 * rather than by the response, and by what is SEEN of it at that scale, unless
 * that is NULL. Nothing changes where the factor is set by hand
 * or there is no light. */
void glint_strength_correct(struct glint_strength *strength,
                            const struct glint_response_light *drawn,
                            const struct glint_seen *seen);

/* The light of the flare of N lamps behind RESPONSE, as its pixels' channels
 * come to, at scale 1. */
void glint_strength_light(const struct glint_response *response,
                          const struct glint_strength_lamps *lamps,
                          struct glint_response_light *light);

/* Returns the largest of three channels. */
double glint_strength_largest(const double rgb[3]);

#endif
