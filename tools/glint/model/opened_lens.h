/* SPDX-License-Identifier: MIT
 *
 * A lens that is opened for drawing: its table or model, and the optical setup
 * that the settings define.
 *
 *     code = opened_lens_open(tool, &lens, &settings, "heliar-tronnier");
 *     opened_lens_configure_engine(tool, &lens, &settings, w, h, &cfg);
 *     opened_lens_close(&lens);
 */
#ifndef GLINT_TOOLS_MODEL_OPENED_LENS_H
#define GLINT_TOOLS_MODEL_OPENED_LENS_H

#include "model/model_file.h"
#include "model/settings.h"
#include "model/stop_mask.h"

/* A lens that is opened for drawing; all zero bytes while it is closed. SETUP
 * points to TABLE; see opened_lens_update_table_pointer(). */
struct opened_lens {
    /* lens table; for a model only its name and film are set */
    struct glint_prescription table;
    struct model_file model; /* baked model; closed if rays are exact */
    /* whether the lens is a table whose model the settings forbid to open or
     * bake */
    bool is_unbaked;
    struct glint_setup setup;
    /* projection for --projection lens; else all zero */
    struct glint_projection projection;
    struct glint_tint *tints; /* tint factors of --ghosts */
    struct stop_mask mask;
    /* dirt on the stop, to which SETUP points */
    struct glint_dirt *dirt;
    struct glint_front_dirt *front; /* dirt on the front element; NULL: none */
};

/* Reads the table or model NAME and prepares LENS, which must be closed, as
 * SETTINGS require. A table without a model is baked, unless rays are exact or
 * settings->unbaked forbids it. Returns an exit code. The caller must call
 * opened_lens_close() also after a failure. */
int opened_lens_open(const struct tool *tool, struct opened_lens *lens,
                     const struct settings *settings, const char *name);

void opened_lens_close(struct opened_lens *lens);

/* Updates the pointer from the setup of LENS to the table of LENS, after LENS
 * was copied to a new address. */
void opened_lens_update_table_pointer(struct opened_lens *lens);

/* Sets the stop of LENS to that of SETTINGS. Returns GLINT_E_ARGUMENT if the
 * model was baked with a narrower stop; ERROR then states the limit. */
enum glint_status opened_lens_set_stop(struct opened_lens *lens,
                                       const struct settings *settings,
                                       struct glint_error *error);

/* Moves the zoom lens LENS to ZOOM like model_file_set_zoom(). Returns
 * GLINT_E_ARGUMENT with the reason in ERROR if the lens has no such
 * position. */
enum glint_status opened_lens_set_zoom(struct opened_lens *lens,
                                       const struct settings *settings,
                                       double zoom, struct glint_error *error);

/* Sets the dirt on the front element of LENS from CAMERA and from the mask
 * image FILE (NULL: none). Returns an exit code. */
int opened_lens_set_front_dirt(const struct tool *tool,
                               struct opened_lens *lens,
                               const struct glint_engine_camera *camera,
                               const char *file);

/* Returns the camera of SETTINGS with the stop mask of LENS. If SETTINGS do not
 * set the stop's shape and the lens table has a circular stop, the stop is a
 * circle. */
struct glint_engine_camera
opened_lens_make_camera(const struct opened_lens *lens,
                        const struct settings *settings);

struct glint_view opened_lens_compute_view(const struct opened_lens *lens,
                                           const struct settings *settings,
                                           int width, int height);

/* Sets CFG to the configuration of an engine for images of WIDTH x HEIGHT
 * through LENS. */
void opened_lens_configure_engine(const struct tool *tool,
                                  const struct opened_lens *lens,
                                  const struct settings *settings, int width,
                                  int height, struct glint_engine_config *cfg);

#endif
