/* SPDX-License-Identifier: MIT
 *
 * In place of scene_table.c, for programs without the offline
 * half: a lens is a baked model, and frames are drawn from one.
 */
#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "options/scene_table.h"

int scene_open_table(const struct tool *tool, struct scene *scene,
                     const char *name)
{
    struct glint_error error;

    (void)scene;
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

/* Every scene that opened has a model, so that what follows is not reached; it
 * would say so. */
enum glint_status scene_table_setup(struct scene *scene,
                                    struct glint_error *error)
{
    (void)scene;
    snprintf(error->text, sizeof error->text, "there is no model");
    return GLINT_E_LENS;
}

const struct glint_frame_rays *scene_table_rays(void)
{
    return NULL;
}
