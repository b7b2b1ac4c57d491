/* SPDX-License-Identifier: MIT
 *
 * The options that all commands that draw flares have in common, and the
 * parameters derived from them.
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

/* How a lens table is drawn. BAKE: by its model, which is baked unless it is
 * cached. TRACE: by exact rays. SEARCH: by its model, which is baked once a
 * lamp is detected. */
enum settings_unbaked { SETTINGS_BAKE, SETTINGS_TRACE, SETTINGS_SEARCH };

struct settings {
    struct glint_options options; /* values as set on the command line */

    /* roundness of the aperture blades, 0 .. 1, unless --stop sets a shape */
    double roundness;

    /* All members down to TOLERANCE are derived from OPTIONS, again after each
     * change of an option. */
    struct coating coating;
    struct zoom_option zoom;
    struct glint_engine_camera camera; /* camera of the engine, without masks */
    bool has_stop; /* whether the command line sets the stop's shape */
    /* wavelengths of the camera, nm */
    double wavelength_nm[GLINT_MAX_WAVELENGTHS];
    int n_wavelengths;
    /* quality parameters; options of their own set max_lights and
     * area_points */
    struct glint_dials dials;
    double quantum;   /* dials.irradiance_steps, in percent */
    double tolerance; /* error tolerance of the bake */

    /* max angle of a lamp, degrees, for which the model is baked */
    double max_deg;
    /* f-number of the camera of the input picture, to which the stop of a lens
     * without a model is set unless --f-number is given; 0: unknown */
    double photo_f_number;
    /* how a table is drawn, an enum settings_unbaked */
    int unbaked;
    /* "FILE:LINE" of the f-number; NULL: from the command line */
    const char *f_number_from;
};

#define COMMON_HELP                                                           \
    "Common\n"                                                                \
    "  -j, --threads N     default: all processors; never changes a result\n" \
    "  --kernels K         c | sse41 | avx2 | neon | auto: never changes a "  \
    "result\n"                                                                \
    "  --seed N            seed of live -d test and synth; all else is "      \
    "deterministic\n"                                                         \
    "  --json   -q   -v   --help   --help-all   --version\n"

/* settings_set_defaults() sets the defaults for images of a lens alone: no
 * starburst, straight blades, three wavelengths.
 * settings_set_photo_defaults() sets the defaults for photographs: those of the
 * option table, and blades of PHOTO_ROUNDNESS. Straight blades would make the
 * spikes thinner and longer than in photographs. */
#define PHOTO_ROUNDNESS 0.2
void settings_set_defaults(struct settings *settings);
void settings_set_photo_defaults(struct settings *settings);

/* Sets the engine option OPTION to VALUE. Returns -1 on success, -2 if
 * OPTION is not an engine option, else an exit code. */
int settings_apply_option(const struct tool *tool, struct settings *settings,
                          int option, const char *value);

/* Prints TEXT, why the lens cannot have the f-number of S, with the line of the
 * file that sets the f-number, if any. Returns an exit code. */
int settings_report_bad_stop(const struct tool *tool, const struct settings *s,
                             const char *text);

/* Set the option NAME. TEXT is its value as a text. VALUE is its value as a
 * number; for words VALUE is the index, for flags 0 or 1. Return false, without
 * a change, if the value is invalid. */
bool settings_set_text(struct settings *settings, const char *name,
                       const char *text);
bool settings_set_number(struct settings *settings, const char *name,
                         double value);

void settings_set_quality(struct settings *settings, double quality);

/* Returns whether --grid, --quality or --error was given. */
bool settings_has_grid_option(const struct settings *settings);

/* Returns the index of the only ghost that is drawn, or -1 if all are drawn. */
int settings_get_selected_ghost(const struct settings *settings);

/* Returns whether a veil, light spread over the whole image, is drawn. */
bool settings_has_veil(const struct settings *settings);

/* Returns how a command that draws a single image draws a table: by exact rays,
 * unless an option requests or needs a model. */
enum settings_unbaked
settings_choose_method_without_model(const struct settings *settings);

/* Returns the factor on the light of the flare: gain * 2^exposure. */
double settings_compute_brightness_scale(const struct settings *settings);

/* Writes REPORT, the engine's report of a frame, as members of a JSON
 * object. */
void settings_write_json(struct json_writer *json,
                         const struct glint_engine_report *report);

/* Writes the numbers of lights found and drawn as text. */
void settings_write_light_counts(const struct glint_engine_report *report,
                                 char text[64]);

/* Prints warnings: lights outside the model's angles; lights that were merged
 * because of the max number of lights; ray bundles that were omitted, or a
 * frame drawn coarser, even with -q; cells without light, only with -v. */
void settings_print_light_warnings(const struct tool *tool,
                                   const struct glint_engine_report *report);

#endif
