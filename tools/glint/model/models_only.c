/* SPDX-License-Identifier: MIT
 *
 * Replaces opened_table.c, table_file.c and stop_mask.c in programs without the
 * offline half (ray tracing and baking), which read baked models only.
 */
#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "model/table_file.h"
#include "model/opened_table.h"

int tool_read_lens(const struct tool *tool, const char *argument,
                   struct glint_prescription *lens)
{
    struct glint_error error;

    (void)lens;
    if (!tool_is_file_name(argument))
        snprintf(error.text, sizeof error.text,
                 "%.120s is not the name of a model file, which has a slash or "
                 "ends in .glint",
                 argument);
    else if (access(argument, R_OK) == 0)
        snprintf(error.text, sizeof error.text,
                 "%.120s is not a model; this program reads baked models only "
                 "(glint bake, on any machine)",
                 argument);
    else
        snprintf(error.text, sizeof error.text,
                 "%.120s: %s; a baked model is "
                 "required (glint bake, on any machine)",
                 argument, strerror(errno));
    return tool_fail(tool, GLINT_E_LENS, error.text);
}

int opened_table_open(const struct tool *tool, struct opened_lens *lens,
                      const struct settings *settings, const char *name)
{
    (void)settings;
    return tool_read_lens(tool, name, &lens->table);
}

int stop_mask_read_image(const struct tool *tool, const char *file,
                         struct stop_mask *mask)
{
    (void)mask;
    return tool_usage(
        tool, "%s is a picture; this program does not read pictures", file);
}

/* Returns an error. It is never called, because every lens that this program
 * opens has a model. */
enum glint_status
opened_table_make_setup(struct opened_lens *lens,
                        const struct glint_engine_camera *camera,
                        struct glint_error *error)
{
    (void)lens, (void)camera;
    snprintf(error->text, sizeof error->text,
             "the lens has no model; make one with glint bake");
    return GLINT_E_LENS;
}

const struct glint_frame_rays *opened_table_ray_functions(void)
{
    return NULL;
}
