/* SPDX-License-Identifier: MIT
 *
 * Numbered pictures that are the frames of a video.
 */
#include "overlay.h"

#include <ctype.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Exactly one printf conversion of an int, "%d" or "%0Nd". */
static bool is_pattern(const char *text)
{
    const char *at = strchr(text, '%');

    if (!at)
        return false;
    for (at++; isdigit((unsigned char)*at); at++)
        ;
    return *at == 'd' && !strchr(at, '%');
}

enum { NAME_BYTES = 4096 };

/* NAME of NAME_BYTES becomes that of picture NUMBER. False: it is too long. */
static bool name_of(char *name, const char *pattern, int number)
{
    const char *at = strchr(pattern, '%');
    const long stated = at[1] == 'd' ? 0 : strtol(at + 1, NULL, 10);
    const int digits = stated >= 0 && stated < 20 ? (int)stated : 20;
    const int n = snprintf(name, NAME_BYTES, "%.*s%0*d%s", (int)(at - pattern),
                           pattern, digits, number, strchr(at, 'd') + 1);

    return n >= 0 && n < NAME_BYTES;
}

int overlay_sequence(struct tool *tool, struct overlay *o)
{
    char from[NAME_BYTES], to[NAME_BYTES];
    int number = o->start_number;

    if (!is_pattern(o->input) || !is_pattern(o->output))
        return tool_usage(tool, "a sequence needs one %%04d in both names");
    if (!name_of(from, o->input, INT_MAX) || !name_of(to, o->output, INT_MAX))
        return tool_usage(tool, "names of pictures have at most %d bytes",
                          NAME_BYTES - 1);
    if (number < 0) {
        name_of(from, o->input, 0);
        number = access(from, F_OK) == 0 ? 0 : 1;
    }
    o->elapsed_us = 1000000 / 25;
    for (;; number++) {
        int code;

        name_of(from, o->input, number);
        if (access(from, F_OK) != 0)
            break;
        name_of(to, o->output, number);
        code = overlay_check_apart(tool, from, to);
        if (code == EXIT_OK)
            code = overlay_picture(tool, o, from, to);
        if (code != EXIT_OK)
            return code;
        overlay_progress(tool, o);
    }
    if (o->look.n_frames == 0) {
        fprintf(stderr, "glint overlay: %s: no such frame\n", from);
        return EXIT_INPUT;
    }
    return EXIT_OK;
}
