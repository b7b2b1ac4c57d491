/* SPDX-License-Identifier: MIT
 *
 * Which instruction sets the machine has, where only its system knows: NEON on
 * 32-bit ARM.
 */
#ifndef GLINT_PLATFORM_LINUX_SETS_H
#define GLINT_PLATFORM_LINUX_SETS_H

/* glint_sets_here(), and what the kernel says of the CPU besides. */
unsigned glint_system_sets(void);

#endif
