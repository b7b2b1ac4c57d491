/* SPDX-License-Identifier: MIT
 *
 * numbered.h - names of numbered files, by a pattern such as "in/%04d.png".
 */
#ifndef GLINT_TOOLS_OPTIONS_NUMBERED_H
#define GLINT_TOOLS_OPTIONS_NUMBERED_H

#include <stdbool.h>

enum { NUMBERED_BYTES = 4096 };

/* Checks whether TEXT has exactly one conversion, "%d" or "%0Nd". */
bool numbered_is(const char *text);

/* Sets NAME, NUMBERED_BYTES long, to that of file NUMBER by PATTERN. Returns
 * false if it is too long or PATTERN is none. */
bool numbered_name(char *name, const char *pattern, int number);

/* Sets PATTERN, NUMBERED_BYTES long, to TEXT with "%0Nd" in place of its last
 * run of N '#', by which other programs name sequences. Returns false if TEXT
 * has no '#', or if PATTERN is too long or not a pattern. */
bool numbered_from_hashes(char *pattern, const char *text);

#endif
