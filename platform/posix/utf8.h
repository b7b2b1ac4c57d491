/* SPDX-License-Identifier: MIT
 *
 * posix/utf8.h - text of files and names, fit for a terminal.
 */
#ifndef GLINT_PLATFORM_POSIX_UTF8_H
#define GLINT_PLATFORM_POSIX_UTF8_H

#include <stddef.h>

/* Returns the bytes of the character that TEXT begins with, 1 .. 4, or 0 for a
 * control character (C1, too: U+009B begins a command to a terminal), malformed
 * UTF-8 or the end of TEXT. */
size_t glint_utf8_length(const char *text);

/* Replaces every byte of TEXT that glint_utf8_length() does not accept by
 * '?'. */
void glint_utf8_clean(char *text);

#endif
