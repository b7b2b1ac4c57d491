/* SPDX-License-Identifier: MIT
 *
 * Computes the constants of kernels/tone.h for the format and colours of a
 * picture.
 */
#ifndef GLINT_IMAGE_MIX_H
#define GLINT_IMAGE_MIX_H

#include "glint/image.h"
#include "kernels/tone.h"

const struct glint_tone16 *glint_get_tone_constants(enum glint_tone transfer);

/* Fills MIX for pictures with the format, range, matrix and transfer of
 * IMAGE. */
void glint_mix_set_factors(struct glint_mix *mix,
                           const struct glint_image *image);

#endif
