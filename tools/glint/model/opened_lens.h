/* SPDX-License-Identifier: MIT
 *
 * A lens that is opened to draw with: its table or model, and the setup that
 * settings give it.
 *
 *     code = opened_lens_open(tool, &lens, &settings, "heliar-tronnier");
 *     opened_lens_engine(tool, &lens, &settings, width, height, &cfg);
 *     opened_lens_close(&lens);
 */
#ifndef GLINT_TOOLS_MODEL_OPENED_LENS_H
#define GLINT_TOOLS_MODEL_OPENED_LENS_H

#include "model/model_file.h"
#include "model/settings.h"
#include "model/stop_mask.h"

/* Closed if all is 0. SETUP points to TABLE: see opened_lens_moved(). */
struct opened_lens {
    struct glint_prescription table; /* of a model only its name and film */
    struct model_file model;         /* closed for exact rays */
    struct glint_setup setup;
    struct glint_projection projection; /* of --projection lens; else zeros */
    struct glint_tint *tints;           /* by --ghosts */
    struct stop_mask mask;              /* of --stop-mask */
    struct glint_dirt *dirt;            /* on the stop, of SETUP */
    struct glint_front_dirt *front;     /* on the front element; NULL: none */
};

/* Reads the table or model NAME and prepares LENS, which is closed, as SETTINGS
 * say. The model of a table is baked if there is none yet, unless rays are
 * exact. Returns an exit code; opened_lens_close() in any case. */
int opened_lens_open(const struct tool *tool, struct opened_lens *lens,
                     const struct settings *settings, const char *name);

void opened_lens_close(struct opened_lens *lens);

/* Points the setup of LENS to its own table, after LENS was copied here. */
void opened_lens_moved(struct opened_lens *lens);

/* Makes the setup of LENS for the stop of SETTINGS. GLINT_E_ARGUMENT with
 * ERROR: the model was not baked for so wide a stop. */
enum glint_status opened_lens_stop(struct opened_lens *lens,
                                   const struct settings *settings,
                                   struct glint_error *error);

/* Zooms LENS, whose model is that of a zoom, as model_file_zoom().
 * GLINT_E_ARGUMENT: ERROR states why not. */
enum glint_status opened_lens_zoom(struct opened_lens *lens,
                                   const struct settings *settings, double zoom,
                                   struct glint_error *error);

/* Lays the dirt of CAMERA and the mask of the picture FILE, NULL for none, on
 * the front element of LENS. Returns an exit code. */
int opened_lens_front(const struct tool *tool, struct opened_lens *lens,
                      const struct glint_engine_camera *camera,
                      const char *file);

/* Returns the camera of SETTINGS, with the mask of LENS: where the line
 * requests no shape of the stop, a circle if the table of LENS says so. */
struct glint_engine_camera opened_lens_camera(const struct opened_lens *lens,
                                              const struct settings *settings);

struct glint_view opened_lens_view(const struct opened_lens *lens,
                                   const struct settings *settings, int width,
                                   int height);

/* Sets CFG to the configuration of an engine for pictures of WIDTH x HEIGHT
 * through LENS. */
void opened_lens_engine(const struct tool *tool, const struct opened_lens *lens,
                        const struct settings *settings, int width, int height,
                        struct glint_engine_config *cfg);

#endif
