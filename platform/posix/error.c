/* SPDX-License-Identifier: MIT */
#include "posix/error.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Returns 0 if no printable character begins with FIRST. */
static size_t get_utf8_length_by_first_byte(unsigned char first)
{
    if (first < 0x80)
        return first >= ' ' && first != 0x7f;
    if (first < 0xc2)
        return 0;
    return first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
}

size_t glint_utf8_get_length(const char *text)
{
    static const uint32_t smallest[] = {0, 0, 0xa0, 0x800, 0x10000};
    const unsigned char *const byte = (const unsigned char *)text;
    const size_t length = get_utf8_length_by_first_byte(byte[0]);
    uint32_t code;

    if (length < 2)
        return length;
    code = byte[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        /* This also rejects the zero byte that ends TEXT. */
        if ((byte[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (byte[i] & 0x3fu);
    }
    return code < smallest[length] || code > 0x10ffff ||
                   (code >= 0xd800 && code < 0xe000)
               ? 0
               : length;
}

void glint_utf8_replace_unprintable(char *text)
{
    while (*text) {
        const size_t length = glint_utf8_get_length(text);

        if (!length)
            *text = '?';
        text += length ? length : 1;
    }
}

/* max characters of a file name in a message; the cause must fit behind it */
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
    glint_utf8_replace_unprintable(error->text);
    return status;
}

enum glint_status glint_error_report_errno(struct glint_error *error,
                                           enum glint_status status,
                                           const char *file, int number)
{
    const int is_short = number == EMFILE || number == ENFILE ||
                         number == EAGAIN || number == ENOMEM;

    return glint_error_report(error, is_short ? GLINT_E_MEMORY : status, file,
                              "%s", strerror(number));
}
