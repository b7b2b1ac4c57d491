/* SPDX-License-Identifier: MIT
 *
 * Numbered pictures that are the frames of a video.
 */
#include "overlay.h"

#include <ctype.h>
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

static void name_of(char *name, size_t bytes, const char *pattern, int number)
{
    const char *at = strchr(pattern, '%');
    const int digits = at[1] == 'd' ? 0 : (int)strtol(at + 1, NULL, 10);

    snprintf(name, bytes, "%.*s%0*d%s", (int)(at - pattern), pattern,
             digits < 20 ? digits : 20, number, strchr(at, 'd') + 1);
}

int overlay_sequence(struct tool *tool, struct overlay *o)
{
    char from[1024], to[1024];
    int number = o->start_number;

    if (!is_pattern(o->input) || !is_pattern(o->output))
        return tool_usage(tool, "a sequence needs one %%04d in both names");
    if (number < 0) {
        name_of(from, sizeof from, o->input, 0);
        number = access(from, F_OK) == 0 ? 0 : 1;
    }
    o->elapsed_us = 1000000 / 25;
    for (;; number++) {
        int code;

        name_of(from, sizeof from, o->input, number);
        if (access(from, F_OK) != 0)
            break;
        name_of(to, sizeof to, o->output, number);
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
