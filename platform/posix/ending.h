/* SPDX-License-Identifier: MIT
 *
 * posix/ending.h - compares file name extensions. */
#ifndef GLINT_PLATFORM_POSIX_ENDING_H
#define GLINT_PLATFORM_POSIX_ENDING_H

#include <stdbool.h>

/* Returns whether NAME has the extension ENDING, such as ".y4m", in upper or
 * lower case, and is longer than ENDING. */
bool glint_has_extension(const char *name, const char *ending);

/* Returns the extension of the path NAME, including its dot. Returns "" if
 * there is none, as in "-", "/dev/stdout" and ".hidden", or if a digit follows
 * the dot, as in "f1.4". */
const char *glint_get_extension(const char *name);

#endif
