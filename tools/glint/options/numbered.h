/* SPDX-License-Identifier: MIT
 *
 * numbered.h - makes the names of numbered files by a pattern,
 * "in/%04d.png". */
#ifndef GLINT_TOOLS_OPTIONS_NUMBERED_H
#define GLINT_TOOLS_OPTIONS_NUMBERED_H

#include <stdbool.h>

enum { NUMBERED_BYTES = 4096 };

/* Returns whether TEXT is a pattern: it has exactly one conversion, %d or
 * %0Nd. */
bool numbered_is_pattern(const char *text);

/* Sets NAME, NUMBERED_BYTES long, to the name of file NUMBER by PATTERN.
 * Returns false if NAME is too long or PATTERN is not a pattern. */
bool numbered_make_name(char *name, const char *pattern, int number);

/* Sets PATTERN, NUMBERED_BYTES long, to TEXT with the last run of N '#' in its
 * file name replaced by "%0Nd". Other programs name sequences by '#'. Returns
 * false if the file name has no '#', or if PATTERN is too long or not a
 * pattern. */
bool numbered_convert_hashes(char *pattern, const char *text);

#endif
