/* SPDX-License-Identifier: MIT
 *
 * Replaces settings_table.c, table_file.c and stop_mask.c in programs without
 * the offline half, which read baked models only.
 */
#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "model/stop_option.h"
#include "model/table_file.h"
#include "model/settings_table.h"

int settings_open_table(const struct tool *tool, struct settings *settings,
                        const char *name)
{
    struct glint_error error;

    (void)settings;
    if (!tool_is_file_name(name))
        snprintf(error.text, sizeof error.text,
                 "%.120s names no file: that of a model has a slash or ends in "
                 ".glint",
                 name);
    else if (access(name, R_OK) == 0)
        snprintf(error.text, sizeof error.text,
                 "%.120s is no model; this program takes baked ones only "
                 "(glint bake, on any machine)",
                 name);
    else
        snprintf(error.text, sizeof error.text,
                 "%.120s: %s; a baked model is "
                 "required (glint bake, on any machine)",
                 name, strerror(errno));
    return tool_fail(tool, GLINT_E_LENS, error.text);
}

int tool_lens(const struct tool *tool, const char *argument,
              struct glint_prescription *lens)
{
    (void)lens;
    return settings_open_table(tool, NULL, argument);
}

int stop_mask_read(const struct tool *tool, const char *file, uint8_t **mask,
                   int *width, int *height)
{
    (void)width, (void)height;
    *mask = NULL;
    return tool_usage(tool, "%s is a picture; this program reads none", file);
}

int stop_option_open(const struct tool *tool, struct stop_option *stop)
{
    return stop_mask_read(tool, stop->mask_file, &stop->mask,
                          &stop->iris.mask_width, &stop->iris.mask_height);
}

/* Reports that there is no model. It is not reached, as all settings that were
 * opened have one. */
enum glint_status settings_table_setup(struct settings *settings,
                                       const struct stop_option *stop,
                                       struct glint_error *error)
{
    (void)settings, (void)stop;
    snprintf(error->text, sizeof error->text, "there is no model");
    return GLINT_E_LENS;
}

const struct glint_frame_rays *settings_table_rays(void)
{
    return NULL;
}
