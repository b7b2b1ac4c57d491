/* SPDX-License-Identifier: MIT
 *
 * glint/options.h - the options of the engine, by name.
 *
 *     glint_options_defaults(&options);
 *     glint_options_set(&options, "f-number", 5.6, &error);
 *     glint_options_set_text(&options, "stop", "polygon:6", &error);
 *
 * glint/options.inc has one row an option. Parsers, help, manual pages,
 * completions, and the parameters of plug-ins and of Python are made from it:
 * glint_option() returns the rows. Numbers in texts have a decimal point in
 * every locale. */
#ifndef GLINT_OPTIONS_H
#define GLINT_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/quality.h"
#include "glint/setup.h"
#include "glint/status.h"
#include "glint/view.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Values of --rays, --layer, --only and --projection. */
enum { GLINT_RAYS_MODEL, GLINT_RAYS_EXACT };
enum { GLINT_LAYER_COMPOSITE, GLINT_LAYER_FLARE, GLINT_LAYER_FLARE_ALPHA };
enum {
    GLINT_ONLY_GHOSTS,
    GLINT_ONLY_STARBURST,
    GLINT_ONLY_VEIL,
    GLINT_ONLY_ALL
};
enum { GLINT_PROJECTION_TAN, GLINT_PROJECTION_LENS };

enum glint_option_type {
    GLINT_OPTION_REAL,
    GLINT_OPTION_INTEGER,
    GLINT_OPTION_FLAG, /* set or not set, without a value */
    GLINT_OPTION_WORD, /* one of some words, of which the index is the value */
    GLINT_OPTION_TEXT
};

enum glint_option_group {
    GLINT_OPTIONS_LAMPS,
    GLINT_OPTIONS_ARTIST,
    GLINT_OPTIONS_SCENE,
    GLINT_OPTIONS_SHADING, /* of scenes */
    GLINT_OPTIONS_LENS,
    GLINT_OPTIONS_BRIGHTNESS,
    GLINT_OPTIONS_SPEED,
    GLINT_OPTION_GROUPS
};

/* When an option takes effect: when an engine is created, when the size of its
 * pictures changes, or with the next frame. */
enum glint_option_change {
    GLINT_OPTION_CREATE,
    GLINT_OPTION_RESIZE,
    GLINT_OPTION_FRAME
};

/* A row of the table. */
struct glint_option {
    const char *name;    /* without dashes */
    const char *value;   /* stands for the value in a help; "" of a flag */
    const char *accepts; /* WORD: the words, separated by '|'; TEXT: a sentence;
                            numbers: the unit, which may end in "or WORD" */
    const char *help;    /* a sentence, in one line */
    const char *text;    /* TEXT: the default, or "" */
    double low, high;    /* limits of a number */
    double initial;      /* default of a number or a word; NAN: none */
    enum glint_option_type type;
    enum glint_option_group group;
    enum glint_option_change changes;
};

/* Identifiers GLINT_OPTION_OF_f_number ..., in the order of the table. */
enum glint_option_id {
#define GLINT_ROW_REAL(member, ...)    GLINT_OPTION_OF_##member,
#define GLINT_ROW_INTEGER(member, ...) GLINT_OPTION_OF_##member,
#define GLINT_ROW_FLAG(member, ...)    GLINT_OPTION_OF_##member,
#define GLINT_ROW_WORD(member, ...)    GLINT_OPTION_OF_##member,
#define GLINT_ROW_TEXT(member, ...)    GLINT_OPTION_OF_##member,
#include "glint/options.inc"
    GLINT_N_OPTIONS
};

/* The value of each option, by its row, and whether it was set. Without a
 * default, a value is 0 or NULL until then. The struct grows with the table:
 * programs that are to work with other versions of the library set options by
 * name. */
struct glint_options {
#define GLINT_ROW_REAL(member, ...)    double member;
#define GLINT_ROW_INTEGER(member, ...) int member;
#define GLINT_ROW_FLAG(member, ...)    bool member;
#define GLINT_ROW_WORD(member, ...)    int member;
#define GLINT_ROW_TEXT(member, ...)    const char *member; /* not copied */
#include "glint/options.inc"
    bool given[GLINT_N_OPTIONS];
};

/* Whether MEMBER of OPTIONS was set. */
#define GLINT_OPTION_GIVEN(options, member) \
    ((options)->given[GLINT_OPTION_OF_##member])

/* Return row INDEX, from 0, or the row NAME; NULL if there is none. */
const struct glint_option *glint_option(int index);
const struct glint_option *glint_option_named(const char *name);

/* Sets OPTIONS to the defaults of the table. */
void glint_options_defaults(struct glint_options *options);

/* Set option NAME. Of --quality and --error, the one that is set last counts.
 * VALUE: a number, the index of a word, or 0 or 1. TEXT: as on a command line;
 * of a flag yes, no, 1, 0, or "" or NULL for yes; of an option of type TEXT it
 * is kept, not copied, and NULL or "" restores the default. GLINT_E_ARGUMENT
 * with ERROR: there is no such option, or it does not accept that; the value
 * stays. */
enum glint_status glint_options_set(struct glint_options *options,
                                    const char *name, double value,
                                    struct glint_error *error);
enum glint_status glint_options_set_text(struct glint_options *options,
                                         const char *name, const char *text,
                                         struct glint_error *error);

/* Returns the quality of OPTIONS, with the parameters that were set one by one,
 * but for max_lights and area_points. */
struct glint_quality glint_options_quality(const struct glint_options *options);

/* Writes to TEXT, [BYTES], in words what OPTION accepts. */
void glint_option_accepts(const struct glint_option *option, char *text,
                          size_t bytes);

/* ------------------------------------------------------- values within texts
 */

/* Reads the number at TEXT, with a decimal point whatever the locale, and sets
 * END behind it, to TEXT if there is none. */
double glint_option_number(const char *text, const char **end);

/* Reads all of TEXT as up to MAX finite numbers with commas. Returns how many;
 * 0: TEXT is malformed. */
int glint_option_numbers(const char *text, double *values, int max);

/* The values of options of type TEXT. Each function returns false if TEXT is
 * not what its option accepts. */

/* --stop */
struct glint_stop_shape {
    int n_blades; /* 3 .. 64; 0: a circle */
    double rotation_deg;
    double roundness, softness; /* as in struct glint_iris */
};
bool glint_option_stop(const char *text, struct glint_stop_shape *stop);

/* --dust and --front-dust: the fraction covered, and where (SEED, default 1) */
bool glint_option_dust(const char *text, double *fraction, int *seed);

/* --wavelengths: a LIST, or the number N of those that glint_spectrum()
 * chooses; AUTO: each ghost has as many as it needs */
enum glint_waves_kind { GLINT_WAVES_LIST, GLINT_WAVES_COUNT, GLINT_WAVES_AUTO };
struct glint_waves {
    enum glint_waves_kind kind;
    int n;                            /* not of AUTO */
    double nm[GLINT_MAX_WAVELENGTHS]; /* [n] of a LIST */
};
bool glint_option_waves(const char *text, struct glint_waves *waves);

/* --sensor: width and height, mm */
bool glint_option_sensor(const char *text, double mm[2]);

/* --threshold: stops from white that a lamp reaches, and to which it extends */
bool glint_option_threshold(const char *text, double ev[2]);

/* --light-at: x and y in pixels, and stops over a white pixel */
#define GLINT_LIGHT_AT_EV 16 /* default: a street lamp in a night picture */
bool glint_option_light_at(const char *text, double xy_ev[3]);

/* --light: a lamp by its angles */
bool glint_option_light(const char *text, struct glint_lamp *lamp);

/* Returns whether POWER is 0 .. GLINT_MAX_LAMP_POWER, and RGB and POWER * RGB
 * are at most that. */
#define GLINT_MAX_LAMP_POWER 1e30 /* such a lamp is finite in all outputs */
bool glint_lamp_power_is_valid(double power, const double rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
