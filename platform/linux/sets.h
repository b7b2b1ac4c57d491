/* SPDX-License-Identifier: MIT
 *
 * linux/sets.h - detects instruction sets that only the kernel can report: NEON
 * on 32-bit ARM.
 */
#ifndef GLINT_PLATFORM_LINUX_SETS_H
#define GLINT_PLATFORM_LINUX_SETS_H

/* Returns the instruction sets of glint_sets_here(), plus NEON if the kernel
 * reports that the CPU has it. */
unsigned glint_system_sets(void);

#endif
