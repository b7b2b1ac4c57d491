/* SPDX-License-Identifier: MIT */
#include "posix/clock.h"

#include <time.h>

int64_t glint_get_time_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}
