/* SPDX-License-Identifier: MIT
 *
 * glint/half.h - flares at half resolution.
 *
 * Each pixel of the flare lights 2 x 2 pixels of the picture: see HALF of
 * struct glint_flare_frame in glint/flare.h. Only programs that use glint_half
 * link it. */
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
