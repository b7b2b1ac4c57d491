/* SPDX-License-Identifier: MIT
 *
 * glint/light.h - the stop, the lights and the wavelengths of a frame. */
#ifndef GLINT_LIGHT_H
#define GLINT_LIGHT_H

#include <stdint.h>

#include "glint/real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_BLADES    64
#define GLINT_MAX_WAVE_SETS 5 /* see struct glint_wave_sets, flare.h */

/* The opening of the aperture stop, fixed to the camera: x right, y up. Its
 * unit is the stop radius: 1 is the circle that the f-number of the frame asks
 * for. */
struct glint_stop {
    int n_blades; /* 0: circle; else 3 .. GLINT_MAX_BLADES */
    /* Unit normal of each side, outwards. */
    int32_t normal_q30[GLINT_MAX_BLADES][2];
    int32_t apothem_q16; /* distance from the centre to each side */
    /* Only for bundles of a model: the stop's radius over that of the stop that
     * the model was baked for, 2^20 .. 2^30; 0: both are equal. */
    int32_t opening_q30;

    /* Unless NULL, this mask gives the opening instead of the sides: signed
     * distance to the outline, positive inside, at the nodes of a square of
     * mask_nodes^2 over +-mask_span_q16, row 0 at the lowest y. Kept. */
    const int16_t *mask_q13;
    int mask_nodes; /* 2 .. 4096 */
    int32_t mask_span_q16;
};

/* A light as the lens sees it: parallel rays. */
struct glint_light {
    /* Sine and cosine of the angle off the axis, 0 .. 2^30. */
    int32_t sine_q30, cosine_q30;
    int32_t cos_q30, sin_q30; /* cosine and sine of the azimuth: 0 = right, 90
                                 degrees = up */
    /* Value that the light's in-focus image would have if it were spread over
     * one pixel; 1 = display white. */
    struct glint_real power;
    int32_t rgb_q14[3]; /* colour, linear BT.709, largest channel 1 */
    /* Tangent of the angle to its neighbours if it is one of many points that
     * stand for a lamp: a ghost that is too small to meet those of the
     * neighbours is drawn larger. 0: the light stands by itself. */
    int32_t apart_q30;
};

/* A wavelength that is drawn. */
struct glint_wave {
    int32_t wave_q24;   /* 1 / wavelength^2, um^-2 */
    int32_t rgb_q14[3]; /* colour, linear BT.709, largest channel 1 */
    /* Factor on rgb_q14, 1 / mm^2: the largest channel that the colour really
     * has, over the flux, mm^2, of the direct image at angle 0 by which light
     * is measured. */
    struct glint_real weight;
};

#ifdef __cplusplus
}
#endif

#endif
