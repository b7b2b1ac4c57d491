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

/* A baked lens in memory; closed if all is 0. */
struct model_file {
    struct glint_lens lens; /* points into data */
    void *data;
    size_t bytes;
    struct glint_zoom_lens *zoom; /* of a zoom, of which lens is a position;
                                     NULL: it has one position */
};

/* Returns whether ARGUMENT is the name of a file: with a slash, or ending in
 * .lens, .glint, .env or .motion. Otherwise it is that of a lens that comes
 * with glint, whatever the current folder holds. */
bool tool_is_file_name(const char *argument);

/* Returns whether PATH is the name of a file that begins as models do. */
bool tool_is_model(const char *path);

/* Reads and checks the model at PATH. Returns an exit code; on failure prints
 * the reason and leaves MODEL closed. */
int tool_model(const struct tool *tool, const char *path,
               struct model_file *model);

/* Sets MODEL, of a zoom, to ZOOM: mm of focal length, or 0 to 1 along its way.
 * GLINT_E_ARGUMENT: it does not go there; ERROR states how far it does, and
 * MODEL stays as it was. */
enum glint_status model_file_zoom(struct model_file *model, double zoom,
                                  struct glint_error *error);

/* Returns the number of positions of ZOOM that have all ghosts. */
int model_file_positions(const struct glint_zoom_lens *zoom);

/* Closes MODEL, unless it is closed already. */
void model_file_close(struct model_file *model);

/* Returns X as a double. */
double model_real_of(struct glint_real x);

#endif
