/* SPDX-License-Identifier: MIT
 *
 * Reading a baked lens from its file.
 *
 *     if (tool_is_model(path))
 *         code = tool_open_model(tool, path, &model);
 *     ... model.lens ...
 *     model_file_close(&model);
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_FILE_H
#define GLINT_TOOLS_MODEL_MODEL_FILE_H

#include "glint/model.h"
#include "options/tool.h"

/* Min PSNR, dB, of a model that is reported as accurate */
#define PICTURE_CHECK_DB 50.0

/* A baked lens in memory. All zero bytes: closed. */
struct model_file {
    struct glint_lens lens; /* points into data */
    void *data;
    size_t bytes;
    /* zoom lens whose present position defines LENS; NULL: not a zoom lens */
    struct glint_zoom_lens *zoom;
};

/* Returns whether ARGUMENT is a file name: it contains a slash or ends in
 * .lens, .glint, .env or .motion. Any other argument is the name of a lens that
 * comes with glint, even if the current folder contains a file of that name. */
bool tool_is_file_name(const char *argument);

/* Returns whether PATH is a regular file that begins with the magic number
 * of models. */
bool tool_is_model(const char *path);

/* Reads and checks the model at PATH. Returns an exit code; on failure prints
 * the reason and leaves MODEL closed. */
int tool_open_model(const struct tool *tool, const char *path,
                    struct model_file *model);

/* Moves the zoom lens of MODEL to ZOOM: a focal length in mm, or 0 .. 1 from
 * its first position to its last. Returns GLINT_E_ARGUMENT if ZOOM is out of
 * range: ERROR states the range, and MODEL is unchanged. */
enum glint_status model_file_set_zoom(struct model_file *model, double zoom,
                                      struct glint_error *error);

/* Returns the number of zoom positions at which all ghosts are baked. */
int model_file_count_positions(const struct glint_zoom_lens *zoom);

/* Returns the note at the end of the model of LENS, or NULL if it has none. */
const struct glint_model_note *model_get_note(const struct glint_lens *lens);

/* Closes MODEL; does nothing if it is closed. */
void model_file_close(struct model_file *model);

double model_convert_real_to_double(struct glint_real x);

#endif
