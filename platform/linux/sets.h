/* SPDX-License-Identifier: MIT
 *
 * linux/sets.h - instruction sets of the machine that only the kernel can tell:
 * NEON on 32-bit ARM.
 */
#ifndef GLINT_PLATFORM_LINUX_SETS_H
#define GLINT_PLATFORM_LINUX_SETS_H

/* Returns glint_sets_here(), and NEON if the kernel states that the CPU has
 * it. */
unsigned glint_system_sets(void);

#endif
