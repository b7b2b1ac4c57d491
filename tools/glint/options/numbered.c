/* SPDX-License-Identifier: MIT */
#include "options/numbered.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool numbered_is_pattern(const char *text)
{
    const char *at = strchr(text, '%');

    if (!at)
        return false;
    for (at++; isdigit((unsigned char)*at); at++)
        ;
    return *at == 'd' && !strchr(at, '%');
}

bool numbered_make_name(char *name, const char *pattern, int number)
{
    const char *at = strchr(pattern, '%');
    const char *end = at ? strchr(at, 'd') : NULL;
    long stated;
    int digits, n;

    if (!end)
        return false;
    stated = at[1] == 'd' ? 0 : strtol(at + 1, NULL, 10);
    digits = stated >= 0 && stated < 20 ? (int)stated : 20;
    n = snprintf(name, NUMBERED_BYTES, "%.*s%0*d%s", (int)(at - pattern),
                 pattern, digits, number, end + 1);
    return n >= 0 && n < NUMBERED_BYTES;
}

bool numbered_convert_hashes(char *pattern, const char *text)
{
    const char *const slash = strrchr(text, '/');
    const char *const name = slash ? slash + 1 : text;
    const char *const last = strrchr(name, '#');
    const char *first = last;
    char width[16] = "";
    int n;

    if (!last)
        return false;
    while (first > name && first[-1] == '#')
        first--;
    if (last > first)
        snprintf(width, sizeof width, "0%d", (int)(last - first + 1));
    n = snprintf(pattern, NUMBERED_BYTES, "%.*s%%%sd%s", (int)(first - text),
                 text, width, last + 1);
    return n >= 0 && n < NUMBERED_BYTES && numbered_is_pattern(pattern);
}
