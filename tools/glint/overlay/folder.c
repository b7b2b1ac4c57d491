/* SPDX-License-Identifier: MIT */
#include "overlay/folder.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "posix/error.h"

bool folder_is_path_a_folder(const char *path)
{
    const size_t n = strlen(path);
    struct stat file;

    return (n > 0 && path[n - 1] == '/') ||
           (stat(path, &file) == 0 && S_ISDIR(file.st_mode));
}

static const char *find_file_name(const char *path)
{
    const char *const slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

bool folder_make_output_path(char path[FOLDER_PATH], const char *folder,
                             const char *input)
{
    const size_t n = strlen(folder);
    const int used = snprintf(path, FOLDER_PATH, "%s%s%s", folder,
                              n > 0 && folder[n - 1] == '/' ? "" : "/",
                              find_file_name(input));

    return used > 0 && used < FOLDER_PATH;
}

/* Rejects options that read a stream, which is consumed by the first of several
 * inputs. */
static int check_stream_options(const struct tool *tool,
                                const struct glint_options *o)
{
    const char *const file[] = {o->control, o->lights, o->keys, o->pose};
    static const char *const name[] = {"control", "lights", "keys", "pose"};
    struct stat is;

    for (int i = 0; i < 4; i++)
        if (file[i] && (strcmp(file[i], "-") == 0 ||
                        (stat(file[i], &is) == 0 && !S_ISREG(is.st_mode))))
            return tool_usage(
                tool,
                "--%s %s is a stream, which only the first input could read",
                name[i], file[i]);
    return EXIT_OK;
}

/* Rejects standard input, folders, a sequence among several inputs, and inputs
 * with equal file names. */
static int check_folder_inputs(const struct tool *tool, char **input, int n)
{
    struct stat file;

    for (int i = 0; i < n; i++) {
        if (strcmp(input[i], "-") == 0)
            return tool_usage(tool, "standard input has no file name for the "
                                    "output folder; name a file by -o");
        if (stat(input[i], &file) == 0 && S_ISDIR(file.st_mode))
            return tool_usage(tool, "%s is a folder; name the files in it",
                              input[i]);
        if (n > 1 && strchr(input[i], '%') && access(input[i], F_OK) != 0)
            return tool_usage(tool,
                              "%s is a sequence, which must be the only input",
                              input[i]);
        for (int k = 0; k < i; k++)
            if (strcmp(find_file_name(input[k]), find_file_name(input[i])) == 0)
                return tool_usage(tool,
                                  "%s and %s would be written to one file",
                                  input[k], input[i]);
    }
    return EXIT_OK;
}

/* Rejects an output in FOLDER that would overwrite another of the N inputs.
 * FILE is scratch memory for N files. */
static int check_output_overwrites_no_input(const struct tool *tool,
                                            const char *folder, char **input,
                                            struct stat *file, int n)
{
    char path[FOLDER_PATH];
    struct stat out;

    for (int i = 0; i < n; i++)
        if (stat(input[i], &file[i]) != 0)
            file[i].st_ino = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; folder_make_output_path(path, folder, input[i]) &&
                        stat(path, &out) == 0 && k < n;
             k++)
            if (k != i && file[k].st_ino == out.st_ino &&
                file[k].st_dev == out.st_dev)
                return tool_usage(tool, "%s, for %s, is the input %s", path,
                                  input[i], input[k]);
    return EXIT_OK;
}

int folder_create(const struct tool *tool, const char *folder, char **input,
                  int n, const struct glint_options *options, bool *is_new)
{
    struct stat *const file = malloc((size_t)n * sizeof *file);
    struct glint_error error = {""};
    int code;

    if (!file)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    code = check_folder_inputs(tool, input, n);
    if (code == EXIT_OK && n > 1)
        code = check_stream_options(tool, options);
    if (code == EXIT_OK)
        code = check_output_overwrites_no_input(tool, folder, input, file, n);
    free(file);
    if (code != EXIT_OK)
        return code;
    *is_new = mkdir(folder, 0777) == 0;
    if (*is_new || (errno == EEXIST && stat(folder, &(struct stat){0}) == 0))
        return EXIT_OK;
    glint_error_report(&error, GLINT_E_OUTPUT, folder, "%s", strerror(errno));
    return tool_fail(tool, GLINT_E_OUTPUT, error.text);
}
