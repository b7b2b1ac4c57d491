/* SPDX-License-Identifier: MIT
 *
 * posix/error.h - one line for a person about a file that was refused.
 */
#ifndef GLINT_PLATFORM_POSIX_ERROR_H
#define GLINT_PLATFORM_POSIX_ERROR_H

#include "glint/status.h"

#if defined(__GNUC__)
#define GLINT_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define GLINT_PRINTF(text, first)
#endif

/* Fills ERROR with "FILE: cause" and returns STATUS, so that a refusal is one
 * statement. A long FILE loses its beginning, never the cause its end; control
 * characters, which hostile files and names may hold, become '?', so the text
 * is one line whatever happens. */
enum glint_status glint_error_report(struct glint_error *error,
                                     enum glint_status status, const char *file,
                                     const char *format, ...)
    GLINT_PRINTF(4, 5);

#endif
