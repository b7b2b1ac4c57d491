/* SPDX-License-Identifier: MIT
 *
 * posix/clock.h - the clock that is used for time stamps of frames. */
#ifndef GLINT_PLATFORM_POSIX_CLOCK_H
#define GLINT_PLATFORM_POSIX_CLOCK_H

#include <stdint.h>

/* Returns the time of CLOCK_MONOTONIC, us; it never jumps. */
int64_t glint_get_time_us(void);

#endif
