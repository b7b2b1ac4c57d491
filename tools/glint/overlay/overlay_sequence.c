/* SPDX-License-Identifier: MIT
 *
 * Draws numbered pictures as the frames of a video. Missing numbers are printed
 * and count as frame times in which nothing is drawn.
 */
#include "options/numbered.h"
#include "options/timed_text.h"
#include "overlay/overlay.h"

#include <ctype.h>
#include <dirent.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NAME_BYTES = NUMBERED_BYTES, FRAME_US = 1000000 / 25, RUNS_SAID = 8 };

/* numbers of all pictures, ascending */
struct numbers {
    int *at;
    int n;
};

/* ----------------------------------------------------------------- numbers */

static bool add_frame_number(struct numbers *l, int number)
{
    int *const more = text_grow_array(l->at, l->n, sizeof *more);

    if (!more)
        return false;
    l->at = more;
    more[l->n++] = number;
    return true;
}

/* Returns the number for which PATTERN gives the file name FILE, or -1 if there
 * is none. NAME is scratch memory. */
static int parse_number_of_file(const char *file, const char *pattern,
                                char *name)
{
    const char *percent = strchr(pattern, '%');
    const char *slash = strrchr(pattern, '/');
    const size_t folder = slash ? (size_t)(slash + 1 - pattern) : 0;
    const size_t before = (size_t)(percent - pattern) - folder;
    char *end;
    long number;

    if (strncmp(file, pattern + folder, before) != 0 ||
        !isdigit((unsigned char)file[before]))
        return -1;
    number = strtol(file + before, &end, 10);
    if (number > 1000000000 || !numbered_make_name(name, pattern, (int)number))
        return -1;
    return strcmp(name + folder, file) == 0 ? (int)number : -1;
}

static int compare_frame_numbers(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;

    return (x > y) - (x < y);
}

/* Lists in L, ascending, the numbers >= FIRST for which a file of PATTERN
 * exists. Returns false without memory. */
static bool list_file_numbers(struct numbers *l, const char *pattern, int first)
{
    const char *slash = strrchr(pattern, '/');
    char folder[NAME_BYTES] = ".", name[NAME_BYTES];
    const struct dirent *entry;
    bool ok = true;
    DIR *dir;

    if (slash)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash + 1 - pattern),
                 pattern);
    dir = opendir(folder);
    while (ok && dir && (entry = readdir(dir))) {
        const int number = parse_number_of_file(entry->d_name, pattern, name);

        if (number >= 0 && number >= first)
            ok = add_frame_number(l, number);
    }
    if (dir)
        closedir(dir);
    if (ok && l->n > 0)
        qsort(l->at, (size_t)l->n, sizeof *l->at, compare_frame_numbers);
    return ok;
}

/* Lists in L the numbers from FIRST (-1: 0 or 1) up to the first missing file.
 * Used for a PATTERN with the number in the name of the folder. Returns false
 * without memory. */
static bool list_consecutive_numbers(struct numbers *l, const char *pattern,
                                     int first)
{
    char name[NAME_BYTES];
    bool ok = true;
    int number = first;

    if (number < 0) {
        numbered_make_name(name, pattern, 0);
        number = access(name, F_OK) == 0 ? 0 : 1;
    }
    for (; ok && numbered_make_name(name, pattern, number) &&
           access(name, F_OK) == 0;
         number++)
        ok = add_frame_number(l, number);
    return ok;
}

static void print_missing_pictures(const struct tool *tool,
                                   const struct overlay *o,
                                   const struct numbers *l)
{
    int runs = 0;

    for (int i = 1; i < l->n && !tool->quiet; i++) {
        const int first = l->at[i - 1] + 1, last = l->at[i] - 1;

        if (first > last)
            continue;
        if (runs == 0)
            fprintf(stderr, "glint overlay: %s: skips the missing numbers ",
                    o->input);
        if (runs < RUNS_SAID)
            fprintf(stderr, "%s%d", runs ? ", " : "", first);
        if (runs < RUNS_SAID && last > first)
            fprintf(stderr, " to %d", last);
        if (runs++ == RUNS_SAID)
            fputs(" ...", stderr);
    }
    if (runs > 0)
        fputc('\n', stderr);
}

/* ------------------------------------------------------------------ frames */

/* Draws picture number l->at[i]. The difference to the previous number
 * determines the elapsed time. Returns an exit code. */
static int draw_numbered_picture(struct tool *tool, struct overlay *o,
                                 const struct numbers *l, int i)
{
    const int64_t gap = i > 0 ? (int64_t)l->at[i] - l->at[i - 1] : 1;
    char from[NAME_BYTES], to[NAME_BYTES];
    int code;

    numbered_make_name(from, o->input, l->at[i]);
    if (numbered_is_pattern(o->output))
        numbered_make_name(to, o->output, l->at[i]);
    else
        snprintf(to, sizeof to, "%s", o->output);
    o->elapsed_us = l->n == 1                     ? 0
                    : gap > 1000000000 / FRAME_US ? 1000000000
                                                  : (int32_t)(gap * FRAME_US);
    o->drawing.run.n_frames +=
        (int)(gap - 1); /* Lamp lists also number the missing pictures. */
    code = overlay_check_outputs(tool, o, from, to);
    if (code == EXIT_OK)
        code = overlay_draw_picture_file(tool, o, from, to);
    if (code == EXIT_OK && l->n > 1)
        overlay_print_progress(tool, o);
    return code;
}

static int draw_all_numbered_pictures(struct tool *tool, struct overlay *o,
                                      const struct numbers *l)
{
    char pattern[NAME_BYTES];
    int code = EXIT_OK;

    if (l->n == 0) {
        fprintf(stderr, "glint overlay: %s: no picture has such a name\n",
                o->input);
        return EXIT_INPUT;
    }
    if (l->n > 1 && !numbered_is_pattern(o->output)) {
        const bool hashes = numbered_convert_hashes(pattern, o->output);

        return tool_usage(
            tool,
            "%s: %d pictures need a %%04d in the name of the output, too%s%s",
            o->input, l->n, hashes ? ": -o " : "", hashes ? pattern : "");
    }
    print_missing_pictures(tool, o, l);
    for (int i = 0; i < l->n && code == EXIT_OK; i++)
        code = draw_numbered_picture(tool, o, l, i);
    if (code == EXIT_OK)
        /* Only pictures that exist are reported as frames. */
        o->drawing.run.n_frames = l->n;
    return code;
}

bool overlay_is_sequence(const struct overlay *o)
{
    return strchr(o->input, '%') && access(o->input, F_OK) != 0;
}

int overlay_draw_sequence(struct tool *tool, struct overlay *o)
{
    const char *percent = strchr(o->input, '%');
    struct numbers l = {NULL, 0};
    char name[NAME_BYTES];
    int code;

    if (!percent || !numbered_is_pattern(o->input))
        return tool_usage(tool, "%s: a sequence needs one %%04d", o->input);
    if (!numbered_make_name(name, o->input, INT_MAX) ||
        (numbered_is_pattern(o->output) &&
         !numbered_make_name(name, o->output, INT_MAX)))
        return tool_usage(tool, "names of pictures have at most %d bytes",
                          NAME_BYTES - 1);
    if (strchr(percent, '/')
            ? list_consecutive_numbers(&l, o->input, o->start_number)
            : list_file_numbers(&l, o->input, o->start_number))
        code = draw_all_numbered_pictures(tool, o, &l);
    else
        code = tool_fail(tool, GLINT_E_MEMORY, NULL);
    free(l.at);
    return code;
}
