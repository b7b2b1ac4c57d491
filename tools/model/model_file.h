/* SPDX-License-Identifier: MIT
 *
 * Reading a baked lens from its file.
 *
 *     if (tool_is_model(path))
 *         code = tool_model(tool, path, &model);
 *     ... model.lens ...
 *     model_file_close(&model);
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_FILE_H
#define GLINT_TOOLS_MODEL_MODEL_FILE_H

#include "glint/model.h"
#include "options/tool.h"

/* Closed when zeroed. */
struct model_file {
    struct glint_lens lens; /* points into data */
    void *data;
    size_t bytes;
};

/* Returns whether ARGUMENT is the name of a file: with a slash, or ending in
 * .lens or .glint. Else it is that of a lens that comes with glint, whatever
 * lies in the current folder. */
bool tool_is_file_name(const char *argument);

/* PATH is such a name, of a file that begins as models do. */
bool tool_is_model(const char *path);

/* Reads and checks the model at PATH. Returns an exit code; has printed on
 * failure, and MODEL is closed then. */
int tool_model(const struct tool *tool, const char *path,
               struct model_file *model);

/* Does nothing when closed already. */
void model_file_close(struct model_file *model);

/* X as a double. */
double model_real_of(struct glint_real x);

#endif
