/* SPDX-License-Identifier: MIT
 *
 * formats/half.h - floats of 16 bits, as EXR and TIFF have them.
 */
#ifndef GLINT_PLATFORM_FORMATS_HALF_H
#define GLINT_PLATFORM_FORMATS_HALF_H

#include <stdint.h>

/* Exact. */
float glint_half_decode(uint16_t half);

/* Encodes to the nearest value, ties to even; beyond 65504 it is infinite. */
uint16_t glint_half_encode(float value);

#endif
