/* SPDX-License-Identifier: MIT
 *
 * posix/utf8.h - text of files and names, fit for a terminal.
 */
#ifndef GLINT_PLATFORM_POSIX_UTF8_H
#define GLINT_PLATFORM_POSIX_UTF8_H

#include <stddef.h>

/* Bytes of the character that TEXT begins with, 1 .. 4; 0: a control character
 * (C1 too: U+009B begins a command to a terminal), no well-formed UTF-8, or the
 * end. */
size_t glint_utf8_length(const char *text);

/* Every byte that is no part of such a character becomes '?'. */
void glint_utf8_clean(char *text);

#endif
