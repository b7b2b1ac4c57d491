/* SPDX-License-Identifier: MIT
 *
 * posix/ending.h - compares file name extensions. */
#ifndef GLINT_PLATFORM_POSIX_ENDING_H
#define GLINT_PLATFORM_POSIX_ENDING_H

#include <stdbool.h>

/* Returns whether NAME has the extension ENDING, such as ".y4m", in upper or
 * lower case, and is longer than ENDING. */
bool glint_ends_in(const char *name, const char *ending);

/* Returns the extension of the path NAME, including its dot, or "" if there is
 * none, as in "-", "/dev/stdout", ".hidden" or "f1.4", whose dot belongs to a
 * number. */
const char *glint_get_extension(const char *name);

#endif
