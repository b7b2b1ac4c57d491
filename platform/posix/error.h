/* SPDX-License-Identifier: MIT
 *
 * posix/error.h - error messages of one line about a file.
 */
#ifndef GLINT_PLATFORM_POSIX_ERROR_H
#define GLINT_PLATFORM_POSIX_ERROR_H

#include "glint/status.h"

#if defined(__GNUC__)
#define GLINT_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define GLINT_PRINTF(text, first)
#endif

/* Sets ERROR to "FILE: cause" and returns STATUS, so that a refusal is one
 * statement. A long FILE loses its beginning, to leave room for the cause.
 * Control characters, which hostile files and names may hold, become '?', so
 * that the text is one line. */
enum glint_status glint_error_report(struct glint_error *error,
                                     enum glint_status status, const char *file,
                                     const char *format, ...)
    GLINT_PRINTF(4, 5);

#endif
