/* SPDX-License-Identifier: MIT
 *
 * posix/ending.h - the type of a file by the ending of its name.
 */
#ifndef GLINT_PLATFORM_POSIX_ENDING_H
#define GLINT_PLATFORM_POSIX_ENDING_H

#include <stdbool.h>

/* Returns whether NAME ends in ENDING, as ".y4m", in any case of letters, and
 * has something before it. */
bool glint_ends_in(const char *name, const char *ending);

/* Returns the ending of the last part of the path NAME, from its dot on, or ""
 * if it has none, as "-", "/dev/stdout", ".hidden" or "f1.4", whose dot belongs
 * to a number. */
const char *glint_ending_of(const char *name);

#endif
