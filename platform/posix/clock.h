/* SPDX-License-Identifier: MIT
 *
 * posix/clock.h - the clock of frames' time stamps.
 */
#ifndef GLINT_PLATFORM_POSIX_CLOCK_H
#define GLINT_PLATFORM_POSIX_CLOCK_H

#include <stdint.h>

/* Returns CLOCK_MONOTONIC in us. It does not jump, and drivers use it for
 * frames' time stamps. */
int64_t glint_now_us(void);

#endif
