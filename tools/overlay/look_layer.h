/* SPDX-License-Identifier: MIT
 *
 * The flare of a look as a layer of light, for pictures that are more than
 * codes of 8 bits.
 */
#ifndef GLINT_TOOLS_OVERLAY_LOOK_LAYER_H
#define GLINT_TOOLS_OVERLAY_LOOK_LAYER_H

#include "overlay/look.h"
#include "formats/samples.h"

/* Sets power, place and colour of the lamps that LOOK found in a proxy of
 * SAMPLES, WHITE being the light of its code 255: what the proxy clips is
 * measured. */
void look_measure(struct look *look, const struct glint_samples *samples,
                  double white);

/* Draws the flare of LOOK's lamps into RGB, upright [height][width][3], linear
 * light. IS_DEEP: to the last float; else planned as for codes of 8 bits, which
 * costs half. GLINT_E_MEMORY. */
enum glint_status look_draw_layer(struct look *look, bool is_deep, float *rgb);

#endif
