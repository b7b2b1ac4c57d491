/* SPDX-License-Identifier: MIT
 *
 * posix/clock.h - the clock that frames are stamped with.
 */
#ifndef GLINT_PLATFORM_POSIX_CLOCK_H
#define GLINT_PLATFORM_POSIX_CLOCK_H

#include <stdint.h>

/* Returns CLOCK_MONOTONIC in us. It does not jump, and drivers stamp frames
 * with it. */
int64_t glint_now_us(void);

#endif
