/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE    /* syscall; NOLINT(bugprone-reserved-identifier): \
                              theirs */
#include "linux/instructions.h"

#include <linux/perf_event.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

int glint_instructions_open(void)
{
    struct perf_event_attr attr;

    memset(&attr, 0, sizeof attr);
    attr.size = sizeof attr;
    attr.type = PERF_TYPE_HARDWARE;
    attr.config = PERF_COUNT_HW_INSTRUCTIONS;
    attr.exclude_kernel = 1;
    attr.exclude_hv = 1;
    return (int)syscall(SYS_perf_event_open, &attr, 0, -1, -1, 0);
}

uint64_t glint_instructions_read(int counter)
{
    uint64_t n;

    return read(counter, &n, sizeof n) == (ssize_t)sizeof n ? n : 0;
}

void glint_instructions_close(int counter)
{
    if (counter >= 0)
        close(counter);
}
