/* SPDX-License-Identifier: MIT
 *
 * formats/half.h - floats of 16 bits, as EXR and TIFF have them.
 */
#ifndef GLINT_PLATFORM_FORMATS_HALF_H
#define GLINT_PLATFORM_FORMATS_HALF_H

#include <stdint.h>

/* Decodes HALF without rounding. */
float glint_half_decode(uint16_t half);

/* Encodes VALUE to the nearest half, ties to even; from 65520 on to
 * infinity. */
uint16_t glint_half_encode(float value);

#endif
