/* SPDX-License-Identifier: MIT
 *
 * Options common to all commands that draw flares: what is drawn, and how.
 */
#ifndef GLINT_TOOLS_MODEL_SETTINGS_H
#define GLINT_TOOLS_MODEL_SETTINGS_H

#include "options/engine_options.h"
#include "model/coating.h"
#include "glint/engine.h"
#include "glint/quality.h"
#include "model/zoom_option.h"
#include "options/json_writer.h"
#include "options/tool.h"

/* Max number of lamps on the command line; files may have more */
enum { SETTINGS_MAX_LAMPS = 1024 };

/* How to open a table without a model. BAKE: bake it; TRACE: use exact rays;
 * SEARCH: bake it when a lamp is detected. */
enum settings_unbaked { SETTINGS_BAKE, SETTINGS_TRACE, SETTINGS_SEARCH };

struct settings {
    struct glint_options options; /* values as set on the command line */

    /* roundness of the aperture blades, 0 .. 1, unless --stop sets a shape */
    double roundness;

    /* The members down to TOLERANCE are computed from OPTIONS whenever an
     * option is set. */
    struct coating coating;
    struct zoom_option zoom;
    struct glint_engine_camera camera; /* camera of the engine, without masks */
    bool has_stop; /* whether the command line sets the stop's shape */
    /* wavelengths of the camera, nm */
    double wavelength_nm[GLINT_MAX_WAVELENGTHS];
    int n_wavelengths;
    /* quality parameters; max_lights and area_points are set by their own
     * options */
    struct glint_dials dials;
    double quantum;   /* dials.irradiance_steps, in percent */
    double tolerance; /* error tolerance of the bake */

    /* max angle of lamps that the model is baked for, degrees */
    double max_deg;
    /* The input image, which is validated before a lens is baked. NULL: not
     * known yet. */
    const char *picture;
    /* How to open a table without a model, an enum settings_unbaked */
    int unbaked;
    const char *f_number_from; /* "FILE:LINE" that sets the f-number; NULL: the
                                  command line */
};

#define COMMON_HELP                                                           \
    "Common\n"                                                                \
    "  -j, --threads N     default: all processors; never changes a result\n" \
    "  --kernels K         c | sse41 | avx2 | neon | auto: never changes a "  \
    "result\n"                                                                \
    "  --seed N            seed of live -d test and synth; all else is "      \
    "deterministic\n"                                                         \
    "  --json   -q   -v   --help   --help-all   --version\n"

/* settings_set_defaults() sets the defaults of a plain image of a lens: no
 * starburst, the table's coatings, straight blades, three wavelengths.
 * settings_set_photo_defaults() sets those of flares on photographs: the option
 * table's defaults, and blades of PHOTO_ROUNDNESS, as spikes of straight
 * blades are thinner and longer than those in photographs. */
#define PHOTO_ROUNDNESS 0.2
void settings_set_defaults(struct settings *settings);
void settings_set_photo_defaults(struct settings *settings);

/* Sets the engine option OPTION to VALUE. Returns -1 on success, -2 if
 * OPTION is not an engine option, else an exit code. */
int settings_apply_option(const struct tool *tool, struct settings *settings,
                          int option, const char *value);

/* Prints TEXT, the reason why the f-number of S is impossible, and the line
 * of the file that requests it, if any. Returns an exit code. */
int settings_report_bad_stop(const struct tool *tool, const struct settings *s,
                             const char *text);

/* Set the option NAME. TEXT is its value as text; VALUE is a number, the
 * index of a word, or 0 or 1 for a flag. Return false, without a change, if
 * the value is invalid. */
bool settings_set_text(struct settings *settings, const char *name,
                       const char *text);
bool settings_set_number(struct settings *settings, const char *name,
                         double value);

/* Sets --quality, 0 .. 1. */
void settings_set_quality(struct settings *settings, double quality);

/* Returns whether --grid, --quality or --error was given. */
bool settings_has_grid_option(const struct settings *settings);

/* Returns the index of the only ghost that is drawn, or -1 if all are drawn. */
int settings_get_selected_ghost(const struct settings *settings);

/* Returns whether a veil, light spread over the whole image, is drawn. */
bool settings_has_veil(const struct settings *settings);

/* Returns how a command that draws a single picture opens a table without a
 * model: with exact rays, unless an option requests or needs a model. */
enum settings_unbaked
settings_choose_method_without_model(const struct settings *settings);

/* Returns the factor on the flare's light, gain * 2^EV. */
double settings_compute_brightness_scale(const struct settings *settings);

/* Writes the report of a frame as members of a JSON object. */
void settings_write_json(struct json_writer *json,
                         const struct glint_engine_report *report);

/* Writes the numbers of lights found and drawn as text. */
void settings_write_light_counts(const struct glint_engine_report *report,
                                 char text[64]);

/* Prints warnings to standard error: lights outside the model's angles, and
 * lights that were merged because there are too many; even with -q: ray
 * bundles are missing or the frame is drawn coarser; with -v: cells without
 * light. */
void settings_print_light_warnings(const struct tool *tool,
                                   const struct glint_engine_report *report);

#endif
