/* SPDX-License-Identifier: MIT
 *
 * posix/clock.h - the clock that frames are stamped with.
 */
#ifndef GLINT_PLATFORM_POSIX_CLOCK_H
#define GLINT_PLATFORM_POSIX_CLOCK_H

#include <stdint.h>

/* CLOCK_MONOTONIC, microseconds. It does not jump, and drivers have it, too. */
int64_t glint_now_us(void);

#endif
