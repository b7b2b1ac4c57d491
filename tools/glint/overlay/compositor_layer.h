/* SPDX-License-Identifier: MIT
 *
 * The flare as a layer of light, for pictures that are more than
 * codes of 8 bits.
 */
#ifndef GLINT_TOOLS_OVERLAY_COMPOSITOR_LAYER_H
#define GLINT_TOOLS_OVERLAY_COMPOSITOR_LAYER_H

#include "overlay/compositor.h"
#include "formats/samples.h"

/* Sets power, place and colour of the lamps that COMPOSITOR has found in a
 * proxy of SAMPLES, with the light that the proxy clips. WHITE is the light of
 * its code 255. */
void compositor_measure(struct compositor *compositor,
                        const struct glint_samples *samples, double white);

/* Draws the flare of COMPOSITOR's lamps into RGB, upright [height][width][3],
 * linear light. IS_DEEP: as accurate as floats; else planned as for codes of 8
 * bits, which costs half. GLINT_E_MEMORY. */
enum glint_status compositor_draw_layer(struct compositor *compositor,
                                        bool is_deep, float *rgb);

#endif
