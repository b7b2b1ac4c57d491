/* SPDX-License-Identifier: MIT */
#include "overlay/apart.h"

#include <string.h>

#include "posix/output.h"

static void add(struct apart_file *files, int *n, const char *option,
                const char *path)
{
    if (path && *n < APART_FILES)
        files[(*n)++] = (struct apart_file){option, path};
}

void apart_read(struct apart *files, const char *option, const char *path)
{
    add(files->read, &files->n_read, option, path);
}

void apart_write(struct apart *files, const char *option, const char *path)
{
    add(files->written, &files->n_written, option, path);
}

void apart_line(struct apart *files, const struct drawing_line *line)
{
    const struct glint_options *const o = &line->settings.options;

    apart_read(files, "--lens", o->lens);
    apart_read(files, "--lights", o->lights);
    apart_read(files, "--mask", o->mask);
    if (!line->keys_text)
        apart_read(files, "--keys", o->keys);
    apart_read(files, "--scene", o->scene);
    apart_read(files, "--pose", o->pose);
    apart_read(files, "--control", o->control);
    apart_read(files, "--ghosts", o->ghosts);
    apart_read(files, "--stop-mask", o->stop_mask);
    apart_write(files, "--save-lights", o->save_lights);
}

/* Returns whether writing OUTPUT would overwrite INPUT. Patterns are not files
 * and are compared as text. */
static bool is_lost(const char *input, const char *output)
{
    return glint_target_is_input(input, output) ||
           (strchr(input, '%') && glint_target_is_same(input, output));
}

/* Returns whether A and B are the same output; "-" is standard output. */
static bool is_shared(const char *a, const char *b)
{
    if (strcmp(a, "-") == 0)
        return strcmp(b, "-") == 0 || glint_target_is_input(b, a);
    return glint_target_is_input(a, b) || glint_target_is_same(a, b);
}

static int refuse_lost(const struct tool *tool, const struct apart_file *input,
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

int apart_check(const struct tool *tool, const struct apart *files)
{
    for (int i = 0; i < files->n_written; i++) {
        const struct apart_file *const to = &files->written[i];

        for (int k = 0; k < files->n_read; k++)
            if (is_lost(files->read[k].path, to->path))
                return refuse_lost(tool, &files->read[k], to);
        for (int k = 0; k < i; k++)
            if (is_shared(files->written[k].path, to->path))
                return tool_usage(
                    tool, "%s and %s both write %s; name two files",
                    files->written[k].option, to->option, to->path);
    }
    return EXIT_OK;
}
