/* SPDX-License-Identifier: MIT
 *
 * Replaces scene_file.c in programs that read only baked scenes, without the
 * code for baking.
 */
#include "posix/ending.h"
#include "scenes/scene_file.h"

bool tool_is_scene_text(const char *argument)
{
    return glint_has_extension(argument, ".scene");
}

int tool_bake_scene(const struct tool *tool, const char *path, uint8_t **data,
                    size_t *bytes, struct glint_scene_bake_report *report)
{
    struct glint_error error;

    (void)data, (void)bytes, (void)report;
    snprintf(error.text, sizeof error.text,
             "%.120s is a text; this program reads baked scenes only (glint "
             "bake, on any machine)",
             path);
    return tool_fail(tool, GLINT_E_LENS, error.text);
}
