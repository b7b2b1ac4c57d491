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
    struct glint_zoom_lens *zoom; /* a zoom lens, of which LENS is one position;
                                     NULL if it does not zoom */
};

/* Returns whether ARGUMENT names a file: it has a slash or ends in .lens,
 * .glint, .env or .motion. Any other name is of a lens that comes with glint,
 * even if the current folder has a file of that name. */
bool tool_is_file_name(const char *argument);

/* Returns whether PATH names a file that begins as models do. */
bool tool_is_model(const char *path);

/* Reads and checks the model at PATH. Returns an exit code; on failure prints
 * the reason and leaves MODEL closed. */
int tool_model(const struct tool *tool, const char *path,
               struct model_file *model);

/* Sets MODEL, of a zoom lens, to ZOOM: its focal length in mm, or 0 to 1 from
 * its first position to its last. Returns GLINT_E_ARGUMENT if ZOOM is out of
 * range: ERROR states the range, and MODEL is unchanged. */
enum glint_status model_file_zoom(struct model_file *model, double zoom,
                                  struct glint_error *error);

/* Returns the number of positions of ZOOM that have all ghosts. */
int model_file_positions(const struct glint_zoom_lens *zoom);

/* Closes MODEL, unless it is closed already. */
void model_file_close(struct model_file *model);

/* Returns X as a double. */
double model_real_of(struct glint_real x);

#endif
