/* SPDX-License-Identifier: MIT
 *
 * posix/error.h - error messages of one line about a file.
 */
#ifndef GLINT_PLATFORM_POSIX_ERROR_H
#define GLINT_PLATFORM_POSIX_ERROR_H

#include <stddef.h>

#include "glint/status.h"

#if defined(__GNUC__)
#define GLINT_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define GLINT_PRINTF(text, first)
#endif

/* Returns the length in bytes, 1 .. 4, of the UTF-8 character at the start of
 * TEXT, or 0 for a control character (C1, too, as U+009B begins a terminal
 * command), malformed UTF-8 or the end of TEXT. */
size_t glint_utf8_get_length(const char *text);

/* Replaces every byte of TEXT that glint_utf8_get_length() does not accept by
 * '?'. */
void glint_utf8_replace_unprintable(char *text);

/* Sets ERROR to "FILE: cause" and returns STATUS, so that callers report and
 * return in one statement. The beginning of a long FILE is omitted so that the
 * cause fits. Control characters, which hostile files and names may contain,
 * become '?', so that the text is one line. */
enum glint_status glint_error_report(struct glint_error *error,
                                     enum glint_status status, const char *file,
                                     const char *format, ...)
    GLINT_PRINTF(4, 5);

/* Sets ERROR to "FILE: cause", the cause being errno value NUMBER. Returns
 * STATUS, or GLINT_E_MEMORY if the cause is that the system lacks descriptors,
 * processes or memory. */
enum glint_status glint_error_report_errno(struct glint_error *error,
                                           enum glint_status status,
                                           const char *file, int number);

#endif
