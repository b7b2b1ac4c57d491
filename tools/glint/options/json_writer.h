/* SPDX-License-Identifier: MIT
 *
 * json_writer.h - writes JSON by format strings that look like JSON.
 *
 *     struct json_writer json = {stdout};
 *     json_write(&json, "{name: %s, size: [%d, %d]", name, width, height);
 *     json_write(&json, "whole: %c}\n", is_whole);
 *
 * Format strings have keys and conversions without quotes; the writer adds
 * quotes, escapes and the commas between members and elements. */
#ifndef GLINT_TOOLS_OPTIONS_JSON_WRITER_H
#define GLINT_TOOLS_OPTIONS_JSON_WRITER_H

#include <stdbool.h>
#include <stdio.h>

#include "posix/error.h"

struct json_writer {
    FILE *to;
    /* private: whether the next member or element needs a comma before it */
    bool is_due;
};

/* Writes FORMAT, which consists of
 *   { } [ ]     printed as they are
 *   word:       a key; also "%s:" and "%s_word:", of a name in the arguments
 *   %s          a text in quotes, escaped; NULL: null
 *   %c          a bool: true or false
 *   %d %u %f..  numbers as of printf(), with l, ll or z; null if not finite
 *   null 0      words and numbers, printed as they are
 *   line feed   printed after the comma that is due, with blanks behind it
 * Other characters are ignored. */
void json_write(struct json_writer *json, const char *format, ...)
    GLINT_PRINTF(2, 3);

#endif
