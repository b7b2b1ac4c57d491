/* SPDX-License-Identifier: MIT
 *
 * What a frame of model_auto() is drawn with in tests: two wavelengths, one red
 * and one green, and a square stop of apothem 0.4, which cuts the ghost.
 */
#ifndef GLINT_TESTS_FRAME_PARTS_H
#define GLINT_TESTS_FRAME_PARTS_H

#include "glint/flare.h"

/* Fills WAVE with the ends of the model's range: red, then green. */
void frame_waves(struct glint_wave wave[2]);

/* Returns a white light of power 1000 on the axis. */
struct glint_light frame_light(void);

/* Returns rays of all ghosts of LENS in the colours of WAVE, at 64 pixels a
 * millimetre. */
struct glint_flare_frame frame_rays(const struct glint_lens *lens,
                                    const struct glint_wave wave[2],
                                    int fineness);

/* Returns the configuration of pictures of WIDTH x HEIGHT, without room for
 * bundles and what they are drawn as. */
struct glint_flare_config frame_config(int width, int height, int tile_log2);

#endif
