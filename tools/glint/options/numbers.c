/* SPDX-License-Identifier: MIT
 *
 * Parses numbers and words; tool.h declares the functions. */
#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "glint/options.h"
#include "options/tool.h"

bool tool_parse_number(const char *text, double *value)
{
    return glint_option_numbers(text, value, 1) == 1;
}

int tool_parse_numbers(const char *text, double *values, int max)
{
    return glint_option_numbers(text, values, max);
}

bool tool_parse_integer(const char *text, int low, int high, int *value)
{
    char *end;
    long n;

    errno = 0;
    n = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno || n < low || n > high)
        return false;
    *value = (int)n;
    return true;
}

bool tool_parse_size(const char *text, int *width, int *height)
{
    char first[12];
    const char *x = strchr(text, 'x');

    if (!x || x - text >= (ptrdiff_t)sizeof first)
        return false;
    memcpy(first, text, (size_t)(x - text));
    first[x - text] = '\0';
    return tool_parse_integer(first, 1, GLINT_MAX_SIDE, width) &&
           tool_parse_integer(x + 1, 1, GLINT_MAX_SIDE, height);
}

int tool_find_word_index(const char *text, const char *const *words)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(text, words[i]) == 0)
            return i;
    return -1;
}
