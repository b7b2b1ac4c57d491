/* SPDX-License-Identifier: MIT */
#include "overlay/apart.h"

#include <string.h>

#include "posix/output.h"

static void add_file_path(struct apart_file *files, int *n, const char *option,
                          const char *path)
{
    if (path && *n < APART_FILES)
        files[(*n)++] = (struct apart_file){option, path};
}

void file_conflicts_add_input(struct apart *files, const char *option,
                              const char *path)
{
    add_file_path(files->read, &files->n_read, option, path);
}

void file_conflicts_add_output(struct apart *files, const char *option,
                               const char *path)
{
    add_file_path(files->written, &files->n_written, option, path);
}

void file_conflicts_add_drawing_files(struct apart *files,
                                      const struct drawing_line *line)
{
    const struct glint_options *const o = &line->settings.options;

    file_conflicts_add_input(files, "--lens", o->lens);
    file_conflicts_add_input(files, "--lights", o->lights);
    file_conflicts_add_input(files, "--mask", o->mask);
    file_conflicts_add_input(files, "--keys", o->keys);
    file_conflicts_add_input(files, "--scene", o->scene);
    file_conflicts_add_input(files, "--pose", o->pose);
    file_conflicts_add_input(files, "--control", o->control);
    file_conflicts_add_input(files, "--ghosts", o->ghosts);
    file_conflicts_add_input(files, "--stop-mask", o->stop_mask);
    file_conflicts_add_output(files, "--save-lights", o->save_lights);
}

/* Returns whether writing OUTPUT would overwrite INPUT. A numbered pattern is
 * not the name of a file, so patterns are compared as text. */
static bool would_overwrite_input(const char *input, const char *output)
{
    return glint_target_is_input(input, output) ||
           (strchr(input, '%') && glint_target_is_same_file(input, output));
}

/* Returns whether A and B are the same output; "-" is standard output. */
static bool is_same_output(const char *a, const char *b)
{
    if (strcmp(a, "-") == 0)
        return strcmp(b, "-") == 0 || glint_target_is_input(b, a);
    return glint_target_is_input(a, b) || glint_target_is_same_file(a, b);
}

static int report_overwritten_input(const struct tool *tool,
                                    const struct apart_file *input,
                                    const struct apart_file *output)
{
    const char *const name =
        strcmp(output->path, "-") ? output->path : "standard output";

    if (!input->option)
        return tool_usage(tool,
                          "%s %s would overwrite the input; name another "
                          "file",
                          output->option, name);
    return tool_usage(tool,
                      "%s %s would overwrite the file of %s; name "
                      "another file",
                      output->option, name, input->option);
}

int file_conflicts_check_outputs(const struct tool *tool,
                                 const struct apart *files)
{
    for (int i = 0; i < files->n_written; i++) {
        const struct apart_file *const to = &files->written[i];

        for (int k = 0; k < files->n_read; k++)
            if (would_overwrite_input(files->read[k].path, to->path))
                return report_overwritten_input(tool, &files->read[k], to);
        for (int k = 0; k < i; k++)
            if (is_same_output(files->written[k].path, to->path))
                return tool_usage(
                    tool, "%s and %s both write %s; name two files",
                    files->written[k].option, to->option, to->path);
    }
    return EXIT_OK;
}
