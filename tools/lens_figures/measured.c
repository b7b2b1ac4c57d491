/* SPDX-License-Identifier: MIT */
#include "lens_figures/measured.h"

#include <stdio.h>
#include <string.h>

#include "model/lens_files.h"

enum { LINE_CHARS = 200, PATH_CHARS = 1024 };

/* Copies the cell at *AT, which is after a '|', to CELL without the blanks
 * about it, and moves *AT behind the next '|'. Returns false if there is none
 * or it is too long. */
static bool take_cell(const char **at, char *cell, size_t bytes)
{
    const char *from = *at + strspn(*at, " "), *end = strchr(*at, '|');
    size_t n;

    if (!end)
        return false;
    *at = end + 1;
    if (from > end)
        from = end;
    while (end > from && end[-1] == ' ')
        end--;
    n = (size_t)(end - from);
    if (n >= bytes)
        return false;
    memcpy(cell, from, n);
    cell[n] = '\0';
    return true;
}

static bool take_row(const char *line, const char *name,
                     struct measured *measured)
{
    char lens[64];

    return *line++ == '|' && take_cell(&line, lens, sizeof lens) &&
           strcmp(lens, name) == 0 &&
           take_cell(&line, measured->f_number, sizeof measured->f_number) &&
           take_cell(&line, measured->seconds, sizeof measured->seconds) &&
           take_cell(&line, measured->kb, sizeof measured->kb) &&
           take_cell(&line, measured->ms, sizeof measured->ms);
}

bool measured_find(const char *name, struct measured *measured)
{
    static const char file_name[] = "/figures.md";
    char path[PATH_CHARS], line[LINE_CHARS];
    bool found = false;

    for (int i = 0; !found && lens_folder(i, "lenses", path,
                                          sizeof path - sizeof file_name);
         i++) {
        FILE *file = *path ? fopen(strcat(path, file_name), "r") : NULL;

        while (file && !found && fgets(line, sizeof line, file))
            found = take_row(line, name, measured);
        if (file)
            fclose(file);
    }
    return found;
}
