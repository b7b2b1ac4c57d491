/* SPDX-License-Identifier: MIT
 *
 * Stands in for settings_table.c in programs without the offline half, which
 * take baked models only.
 */
#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "options/settings_table.h"

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
                 "asked for (glint bake, on any machine)",
                 name, strerror(errno));
    return tool_fail(tool, GLINT_E_LENS, error.text);
}

/* Reports that there is no model. It is not reached, as all settings that were
 * opened have one. */
enum glint_status settings_table_setup(struct settings *settings,
                                       struct glint_error *error)
{
    (void)settings;
    snprintf(error->text, sizeof error->text, "there is no model");
    return GLINT_E_LENS;
}

const struct glint_frame_rays *settings_table_rays(void)
{
    return NULL;
}
