/* SPDX-License-Identifier: MIT */
#include "posix/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "posix/utf8.h"

/* characters shown of a file name, to leave room for the cause */
#define FILE_CHARS 120

enum glint_status glint_error_report(struct glint_error *error,
                                     enum glint_status status, const char *file,
                                     const char *format, ...)
{
    const size_t len = strlen(file);
    const size_t cut = len > FILE_CHARS ? len - (FILE_CHARS - 3) : 0;
    const int used = snprintf(error->text, sizeof error->text,
                              "%s%s: ", cut ? "..." : "", file + cut);
    va_list args;

    va_start(args, format);
    vsnprintf(error->text + used, sizeof error->text - (size_t)used, format,
              args);
    va_end(args);
    glint_utf8_clean(error->text);
    return status;
}
