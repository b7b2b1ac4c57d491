/* SPDX-License-Identifier: MIT
 *
 * The options that set what is drawn and how, for all commands that draw.
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

enum { SETTINGS_MAX_LAMPS = 1024 }; /* lamps by hand; a file may have more */

struct settings {
    struct glint_options options; /* as set */

    double roundness; /* of the blades, unless --stop has a shape */

    /* What follows from options. Setting one overwrites all of these. */
    struct coating coating;
    struct zoom_option zoom;
    struct glint_engine_camera camera;           /* without masks */
    bool has_stop;                               /* the line names a shape */
    double wavelength_nm[GLINT_MAX_WAVELENGTHS]; /* of the camera's waves */
    int n_wavelengths;
    struct glint_dials dials; /* but for max_lights and area_points by option */
    double quantum;           /* dials.irradiance_steps, in percent */
    double tolerance;         /* tolerance that a model is baked with */

    double max_deg; /* largest angle of the lamps that a model is baked for */
    /* The input picture: it is validated before a lens is baked. NULL: that is
     * not known yet. */
    const char *picture;
    const char *f_number_from; /* "FILE:LINE" that sets the f-number; NULL: the
                                  command line */
};

#define COMMON_HELP                                                           \
    "Common\n"                                                                \
    "  -j, --threads N     default: all processors; never changes a result\n" \
    "  --kernels K         c | sse41 | avx2 | neon | auto: never changes a "  \
    "result\n"                                                                \
    "  --seed N            of live -d test and synth; nothing else is "       \
    "random\n"                                                                \
    "  --json   -q   -v   --help   --help-all   --version\n"

/* Sets SETTINGS to the defaults of a plain picture of a lens, without a star,
 * with the coatings of the lens table, straight blades and three wavelengths;
 * or of flares on photographs, as in the table of options, with blades of
 * PHOTO_ROUNDNESS: spikes of straight ones are thinner and longer than those of
 * lamps in photographs. */
#define PHOTO_ROUNDNESS 0.2
void settings_defaults(struct settings *settings);
void settings_defaults_photo(struct settings *settings);

/* Sets the engine's option of CODE. Returns -1, or -2 if it is none of these,
 * or an exit code. */
int settings_option(const struct tool *tool, struct settings *settings,
                    int option, const char *value);

/* Prints why the f-number of S is not possible, TEXT, and which line of a file
 * requests it. Returns an exit code. */
int settings_refuse_stop(const struct tool *tool, const struct settings *s,
                         const char *text);

/* Set the option NAME. Return false, and change nothing, if it does not accept
 * TEXT, or VALUE: a number, the index of a word, or 0 or 1. */
bool settings_set(struct settings *settings, const char *name,
                  const char *text);
bool settings_set_number(struct settings *settings, const char *name,
                         double value);

/* The same of --quality. */
void settings_set_quality(struct settings *settings, double quality);

/* Returns whether --grid, --quality or --error was given. */
bool settings_has_grid(const struct settings *settings);

/* Returns the index of the only ghost that is drawn; -1: all are. */
int settings_only_ghost(const struct settings *settings);

/* Returns whether light is spread over the picture. */
bool settings_has_veil(const struct settings *settings);

/* Returns the factor on all light, gain * 2^EV. */
double settings_scale(const struct settings *settings);

/* Writes the report of a frame as members of an object. */
void settings_json(struct json_writer *json,
                   const struct glint_engine_report *report);

/* Writes as text how many lights there were and are drawn. */
void settings_lights_text(const struct glint_engine_report *report,
                          char text[64]);

/* Warns on standard error of lights that lie beyond the model or were merged
 * because they were too many; even with -q, if bundles are missing or the frame
 * is drawn coarser; with -v, of cells that give no light. */
void settings_warn_lights(const struct tool *tool,
                          const struct glint_engine_report *report);

#endif
