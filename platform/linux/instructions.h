/* SPDX-License-Identifier: MIT
 *
 * linux/instructions.h - counts instructions of the calling thread, in user
 * space.
 *
 *     int counter = glint_instructions_open();       -1: not available
 *     before = glint_instructions_read(counter);
 */
#ifndef GLINT_PLATFORM_LINUX_INSTRUCTIONS_H
#define GLINT_PLATFORM_LINUX_INSTRUCTIONS_H

#include <stdint.h>

/* Starts counting instructions and returns the counter's descriptor, or -1 if
 * the processor has no such counter or the system does not allow it
 * (/proc/sys/kernel/perf_event_paranoid above 2). */
int glint_instructions_open(void);

/* Returns the number of instructions counted so far, or 0 if the counter cannot
 * be read. */
uint64_t glint_instructions_read(int counter);

void glint_instructions_close(int counter);

#endif
