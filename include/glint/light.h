/* SPDX-License-Identifier: MIT
 *
 * glint/light.h - inputs of a frame: stop, lights, wavelengths, and tints of
 * individual ghosts. */
#ifndef GLINT_LIGHT_H
#define GLINT_LIGHT_H

#include <stdint.h>

#include "glint/real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_BLADES 64
#define GLINT_MAX_WAVE_SETS \
    5 /* max waves, see struct glint_wave_sets, flare.h */

/* Transmission inside the outline of a stop: its soft edge, and tables of dust
 * and of a mask. */
enum { GLINT_SHADE_LEAST_LOG2 = 3, GLINT_SHADE_MOST_LOG2 = 10 };
struct glint_shade_method;
extern const struct glint_shade_method glint_shade_method;
struct glint_shade {
    /* &glint_shade_method. It is a pointer so that only programs that use it
     * link it. */
    const struct glint_shade_method *method;
    /* Width of the soft edge, stop radii, 0 .. 2^16. Across it the transmission
     * rises from 0 at the outline as 3 x^2 - 2 x^3, where x = (distance from
     * the outline) / width. */
    int32_t soft_q16;
    /* Log2 of the number of cells per side of the finest table; 0: there are no
     * tables, and everything inside the soft edge is clear. */
    int log2;
    /* Tables of transmission, [log2]. Table k has 2^(log2 - k) + 1 nodes per
     * side over +-1 stop radius; row 0 has the lowest y. Points outside have
     * the value of the nearest node. Both arrays must outlive the stop. LEVEL:
     * transmission at each node, 0 .. 2^15. ROUGH: max difference between this
     * value and the transmission in finer tables, within one and a half nodes,
     * in 256ths. */
    const uint16_t *level_q15[GLINT_SHADE_MOST_LOG2];
    const uint8_t *rough_q8[GLINT_SHADE_MOST_LOG2];
};

/* The opening of the aperture stop, in axes fixed to the camera: x right, y up.
 * Its unit is the stop radius: 1 is the circle of the frame's f-number. */
struct glint_stop {
    int n_blades; /* number of blades: 3 .. GLINT_MAX_BLADES; 0: the stop is a
                     circle */
    /* Unit normal of each side, outwards. */
    int32_t normal_q30[GLINT_MAX_BLADES][2];
    int32_t apothem_q16; /* distance from the centre to each side */
    int32_t inset_q16; /* for a circle: (1 - r^2) / 2, where r is the radius of
                          the outline in stop radii; 0 .. 2^15 */
    /* Curvature of the sides, which are arcs of a circle from corner to corner.
     * round_q30: curvature of the arcs, 1 / stop radii, 0 .. 2^30 - 1. off_q30:
     * this curvature times the distance from the centre of the stop to the
     * centre of an arc, 1 .. 2^30. Both 0: the sides are straight. */
    int32_t round_q30, off_q30;
    /* Soft edge, dust and mask of the stop; must outlive the stop. NULL: all of
     * the opening is clear. */
    const struct glint_shade *shade;
    /* For bundles of a model only: (radius of the stop) / (radius of the stop
     * with which the model was baked), 2^20 .. 2^30; 0: the radii are equal. */
    int32_t opening_q30;
};

/* A light at infinity: parallel rays. */
struct glint_light {
    /* Sine and cosine of the angle off the axis, 0 .. 2^30. */
    int32_t sine_q30, cosine_q30;
    /* Cosine and sine of the azimuth: 0 = right, 90 degrees = up. */
    int32_t cos_q30, sin_q30;
    /* Brightness of the light: the value that the pixels of its in-focus image
     * would have if the image covered one pixel; 1 = display white. */
    struct glint_real power;
    int32_t rgb_q14[3]; /* colour, linear BT.709, largest channel 1 */
    /* Distance to the neighbouring points, as the tangent of an angle, if the
     * light is one of the many points of a lamp; 0: a single light. Ghosts of
     * the light are enlarged if they are too small to touch the ghosts of those
     * points. */
    int32_t apart_q30;
};

/* Factors on the light of one ghost, -4 .. 4 per channel, and a gain on all
 * channels. A ghost with gain {0, 0} is muted: it is not planned. */
struct glint_tint {
    int32_t rgb_q14[3];
    struct glint_real gain; /* factor on all channels, 0 or more */
};

/* Returns the factor of TINT on channel C, as a double. */
double glint_tint_factor(const struct glint_tint *tint, int c);

/* A wavelength at which ghosts are drawn. */
struct glint_wave {
    int32_t wave_q24;   /* 1 / wavelength^2, um^-2 */
    int32_t rgb_q14[3]; /* colour, linear BT.709, largest channel 1 */
    /* Factor on rgb_q14, 1 / mm^2: A / B. A is the largest channel of the
     * colour before the colour was normalised to 1. B is the flux in mm^2 of
     * the direct image at angle 0, which is the unit of light (unit_flux of
     * struct glint_setup). */
    struct glint_real weight;
};

#ifdef __cplusplus
}
#endif

#endif
