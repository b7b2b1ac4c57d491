/* SPDX-License-Identifier: MIT */
#ifndef GLINT_ENGINE_H
#define GLINT_ENGINE_H

#ifdef __cplusplus
extern "C" {
#endif

/* Seconds since any moment, never falling. */
typedef double glint_clock_fn(void);

#ifdef __cplusplus
}
#endif

#endif
