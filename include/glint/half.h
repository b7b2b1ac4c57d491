/* SPDX-License-Identifier: MIT
 *
 * glint/half.h - flares at half resolution.
 *
 * Four pixels are lit as one: see struct glint_flare_frame of glint/flare.h.
 * Linked only by programs that name it.
 */
#ifndef GLINT_HALF_H
#define GLINT_HALF_H

#ifdef __cplusplus
extern "C" {
#endif

struct glint_half;
extern const struct glint_half glint_half;

#ifdef __cplusplus
}
#endif

#endif
