/* SPDX-License-Identifier: MIT
 *
 * posix/ending.h - file name extensions.
 */
#ifndef GLINT_PLATFORM_POSIX_ENDING_H
#define GLINT_PLATFORM_POSIX_ENDING_H

#include <stdbool.h>

/* Returns whether NAME ends in ENDING, such as ".y4m", in upper or lower case,
 * and is longer than ENDING. */
bool glint_ends_in(const char *name, const char *ending);

/* Returns the extension of the path NAME, from its dot on, or "" if there is no
 * extension, as in "-", "/dev/stdout", ".hidden" or "f1.4", whose dot belongs
 * to a number. */
const char *glint_ending_of(const char *name);

#endif
