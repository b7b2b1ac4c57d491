/* SPDX-License-Identifier: MIT
 *
 * Input for tests that draw a frame of the model of model_make_three_ghosts():
 * a red and a green wavelength, and a square stop of apothem 0.4, which clips
 * the ghost.
 */
#ifndef GLINT_TESTS_FRAME_PARTS_H
#define GLINT_TESTS_FRAME_PARTS_H

#include "glint/flare.h"

/* Sets WAVE to the two ends of the model's wavelength range: red, then
 * green. */
void set_frame_wavelengths(struct glint_wave wave[2]);

/* Returns a white light of power 1000 on the axis. */
struct glint_light make_axial_light(void);

/* Returns the rays of a frame: all ghosts of LENS in the colours of WAVE, at 64
 * pixels per mm. */
struct glint_flare_frame make_frame_rays(const struct glint_lens *lens,
                                         const struct glint_wave wave[2],
                                         int fineness);

/* Returns a flare configuration for images of WIDTH x HEIGHT. Its capacities
 * for ray bundles, primitives and cells are 0; the caller sets them. */
struct glint_flare_config make_frame_config(int width, int height,
                                            int tile_log2);

#endif
