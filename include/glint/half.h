/* SPDX-License-Identifier: MIT
 *
 * glint/half.h - pictures drawn with half as many pixels each way.
 *
 * Four pixels are lit as one: struct glint_flare_frame of glint/flare.h. A
 * program that does not name it does not link it.
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
