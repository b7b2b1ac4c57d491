/* SPDX-License-Identifier: MIT */
#include "posix/ending.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

bool glint_has_extension(const char *name, const char *ending)
{
    const size_t n = strlen(name), m = strlen(ending);

    return n > m && strcasecmp(name + n - m, ending) == 0;
}

const char *glint_get_extension(const char *name)
{
    const char *const slash = strrchr(name, '/');
    const char *const last = slash ? slash + 1 : name;
    const char *const dot = strrchr(last, '.');

    return dot && dot > last && !isdigit((unsigned char)dot[1]) ? dot : "";
}
