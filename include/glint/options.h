/* SPDX-License-Identifier: MIT
 *
 * glint/options.h - the options of the engine, set by name.
 *
 *     glint_options_defaults(&options);
 *     glint_options_set(&options, "f-number", 5.6, &error);
 *     glint_options_set_text(&options, "stop", "polygon:6", &error);
 *
 * glint/options.inc has one row per option. Parsers, help, manual pages,
 * completions, and the parameters of plug-ins and of the Python module are
 * generated from its rows; glint_option() returns them. Numbers in texts have a
 * decimal point in every locale. */
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
    /* One of a list of words. The value of the option is the index of the
     * word. */
    GLINT_OPTION_WORD,
    GLINT_OPTION_TEXT
};

enum glint_option_group {
    GLINT_OPTIONS_LAMPS,
    GLINT_OPTIONS_ARTIST,
    GLINT_OPTIONS_SCENE,
    GLINT_OPTIONS_SHADING, /* shading of 3-D scenes */
    GLINT_OPTIONS_LENS,
    GLINT_OPTIONS_BRIGHTNESS,
    GLINT_OPTIONS_SPEED,
    GLINT_OPTION_GROUPS
};

/* Where an option is applied: by the engine, to pictures; by the code that
 * opens the lens, to the lens table; or by the program, to files, scenes and
 * videos. */
enum glint_option_scope {
    GLINT_OPTION_PICTURE,
    GLINT_OPTION_TABLE,
    GLINT_OPTION_PROGRAM
};

/* When an option takes effect: when an engine is created, when the size of its
 * pictures changes, or with the next frame. */
enum glint_option_change {
    GLINT_OPTION_CREATE,
    GLINT_OPTION_RESIZE,
    GLINT_OPTION_FRAME
};

/* An option: a row of glint/options.inc. */
struct glint_option {
    const char *name;  /* name without dashes */
    const char *value; /* placeholder of the value in help texts; "" for a
                          flag */
    /* Accepted values. WORD: the words, separated by '|'. TEXT: a description.
     * Numbers: the unit, to which ", or WORD" may be appended. */
    const char *accepts;
    const char *help; /* description for help, one line */
    const char *text; /* default of an option of type TEXT, or "" */
    double low, high; /* range of a number */
    double initial;   /* default of a number or a word; NAN: none */
    enum glint_option_type type;
    enum glint_option_group group;
    enum glint_option_scope scope;
    enum glint_option_change changes;
};

/* Identifiers such as GLINT_OPTION_OF_f_number, in the order of the table. */
enum glint_option_id {
#define GLINT_ROW_REAL(member, ...)    GLINT_OPTION_OF_##member,
#define GLINT_ROW_INTEGER(member, ...) GLINT_OPTION_OF_##member,
#define GLINT_ROW_FLAG(member, ...)    GLINT_OPTION_OF_##member,
#define GLINT_ROW_WORD(member, ...)    GLINT_OPTION_OF_##member,
#define GLINT_ROW_TEXT(member, ...)    GLINT_OPTION_OF_##member,
#include "glint/options.inc"
    GLINT_N_OPTIONS
};

enum { GLINT_MAX_OPTIONS = 256 }; /* max rows of the table, for all versions */

/* The value of each option, one member per row, and whether the option was set.
 * An option without a default is 0 or NULL until it is set. New options are
 * added at the end of the struct. An older program has a smaller struct, and
 * the options that it lacks keep their defaults. */
struct glint_options {
    size_t size; /* sizeof this struct in the program, set by
                    glint_options_defaults() */
    bool given[GLINT_MAX_OPTIONS];
#define GLINT_ROW_REAL(member, ...)    double member;
#define GLINT_ROW_INTEGER(member, ...) int member;
#define GLINT_ROW_FLAG(member, ...)    bool member;
#define GLINT_ROW_WORD(member, ...)    int member;
#define GLINT_ROW_TEXT(member, ...)    const char *member; /* not copied */
#include "glint/options.inc"
};

/* True if the caller has set option MEMBER in OPTIONS. */
#define GLINT_OPTION_GIVEN(options, member) \
    ((options)->given[GLINT_OPTION_OF_##member])

/* Return the row with the index INDEX, from 0, or the name NAME; NULL if there
 * is no such row. */
const struct glint_option *glint_option(int index);
const struct glint_option *glint_option_named(const char *name);

/* Sets OPTIONS, a struct of SIZE bytes, to the defaults of the table; programs
 * call glint_options_defaults(). */
void glint_options_defaults_sized(struct glint_options *options, size_t size);

/* Sets OPTIONS to the defaults of the table. */
static inline void glint_options_defaults(struct glint_options *options)
{
    glint_options_defaults_sized(options, sizeof *options);
}

/* Set option NAME. If both --quality and --error are set, the last one applies;
 * the same holds for --strength and --exposure. VALUE is a number, the index of
 * a word, or 0 or 1 for a flag. TEXT is written as on a command line. A flag
 * accepts the texts yes, no, 1 and 0; "" or NULL mean yes. The text of an
 * option of type TEXT is not copied and must outlive OPTIONS; NULL or ""
 * restores the default. Returns GLINT_E_ARGUMENT and sets ERROR if there is no
 * such option, or it does not accept the value; the option is unchanged. */
enum glint_status glint_options_set(struct glint_options *options,
                                    const char *name, double value,
                                    struct glint_error *error);
enum glint_status glint_options_set_text(struct glint_options *options,
                                         const char *name, const char *text,
                                         struct glint_error *error);

/* Returns the quality parameters that OPTIONS select. The option quality
 * determines all of them; then options for single parameters replace these,
 * except max_lights and area_points. */
struct glint_quality glint_options_quality(const struct glint_options *options);

/* Writes to TEXT[BYTES] a description of the values that OPTION accepts. */
void glint_option_accepts(const struct glint_option *option, char *text,
                          size_t bytes);

/* ----------------------------------------------------- values within texts */

/* Parses the number at the start of TEXT, with a decimal point in any locale,
 * and sets *END to the first character after the number, or to TEXT if there is
 * no number. */
double glint_option_number(const char *text, const char **end);

/* Parses all of TEXT as a list of up to MAX finite numbers, separated by
 * commas. Returns how many there are; 0 if TEXT is malformed. */
int glint_option_numbers(const char *text, double *values, int max);

/* Parsers of the values of options of type TEXT. Each returns false if its
 * option does not accept TEXT. */

/* --stop */
struct glint_stop_shape {
    int n_blades; /* number of blades, 3 .. 64; 0: a circle */
    double rotation_deg;
    double roundness, softness; /* as in struct glint_iris */
};
bool glint_option_stop(const char *text, struct glint_stop_shape *stop);

/* --dust and --front-dust: the fraction covered, and the seed of the pattern
 * (default 1) */
bool glint_option_dust(const char *text, double *fraction, int *seed);

/* --wavelengths */
bool glint_option_waves(const char *text, struct glint_waves *waves);

/* --sensor: width and height, mm */
bool glint_option_sensor(const char *text, double mm[2]);

/* --threshold: upper and lower threshold, stops from white; see threshold_ev of
 * struct glint_engine_search */
bool glint_option_threshold(const char *text, double ev[2]);

/* --light-at */
#define GLINT_LIGHT_AT_EV 16 /* default power: a street lamp at night */
struct glint_light_at {
    /* position from the top left corner, pixels; if IS_PERCENT, percent of the
     * picture's width and height */
    double xy[2];
    bool is_percent[2];
    bool has_ev; /* whether the text sets the power */
    double ev;   /* power, stops above a white pixel; -INFINITY: "off", which
                    removes the lamp found there */
};
bool glint_option_light_at(const char *text, struct glint_light_at *at);

/* --light: a lamp, given by its angles */
bool glint_option_light(const char *text, struct glint_lamp *lamp);

/* Returns whether POWER is 0 .. GLINT_MAX_LAMP_POWER, and no channel of RGB or
 * POWER * RGB exceeds GLINT_MAX_LAMP_POWER. */
#define GLINT_MAX_LAMP_POWER 1e30 /* max power: all outputs are then finite */
bool glint_lamp_power_is_valid(double power, const double rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
