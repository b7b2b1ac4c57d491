/* SPDX-License-Identifier: MIT */
#include "glint/options.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/options/texts.h"
#include "glint/dials.h"

#define LAMPS      GLINT_OPTIONS_LAMPS
#define ARTIST     GLINT_OPTIONS_ARTIST
#define SCENE      GLINT_OPTIONS_SCENE
#define SHADING    GLINT_OPTIONS_SHADING
#define LENS       GLINT_OPTIONS_LENS
#define BRIGHTNESS GLINT_OPTIONS_BRIGHTNESS
#define SPEED      GLINT_OPTIONS_SPEED
#define PICTURE    GLINT_OPTION_PICTURE
#define TABLE      GLINT_OPTION_TABLE
#define PROGRAM    GLINT_OPTION_PROGRAM
#define CREATE     GLINT_OPTION_CREATE
#define RESIZE     GLINT_OPTION_RESIZE
#define FRAME      GLINT_OPTION_FRAME

static const struct glint_option table[] = {
#define NUMBER(type, name, value, low, high, initial, unit, group, scope,     \
               changes, help)                                                 \
    {name,  value, unit,   help, "", low, high, initial, GLINT_OPTION_##type, \
     group, scope, changes},
#define GLINT_ROW_REAL(member, ...)    NUMBER(REAL, __VA_ARGS__)
#define GLINT_ROW_INTEGER(member, ...) NUMBER(INTEGER, __VA_ARGS__)
#define GLINT_ROW_FLAG(member, name, group, scope, changes, help) \
    {name, "", "", help, "", 0, 1, 0, GLINT_OPTION_FLAG, group, scope, changes},
#define GLINT_ROW_WORD(member, name, value, words, initial, group, scope, \
                       changes, help)                                     \
    {name,  value, words,  help, "", 0, 0, initial, GLINT_OPTION_WORD,    \
     group, scope, changes},
#define GLINT_ROW_TEXT(member, name, value, initial, accepts, group, scope, \
                       changes, help)                                       \
    {name, value, accepts,           help,  initial, 0,                     \
     0,    NAN,   GLINT_OPTION_TEXT, group, scope,   changes},
#include "glint/options.inc"
};

/* The bytes of each option's value in struct glint_options: begin .. end -
 * 1. */
static const struct place {
    size_t begin, end;
} place[] = {
#define PLACE(member)                         \
    {offsetof(struct glint_options, member),  \
     offsetof(struct glint_options, member) + \
         sizeof((struct glint_options){0}.member)},
#define GLINT_ROW_REAL(member, ...)    PLACE(member)
#define GLINT_ROW_INTEGER(member, ...) PLACE(member)
#define GLINT_ROW_FLAG(member, ...)    PLACE(member)
#define GLINT_ROW_WORD(member, ...)    PLACE(member)
#define GLINT_ROW_TEXT(member, ...)    PLACE(member)
#include "glint/options.inc"
};

const struct glint_option *glint_option(int index)
{
    return index >= 0 && index < GLINT_N_OPTIONS ? &table[index] : NULL;
}

const struct glint_option *glint_option_named(const char *name)
{
    for (int i = 0; i < GLINT_N_OPTIONS; i++)
        if (strcmp(table[i].name, name) == 0)
            return &table[i];
    return NULL;
}

/* ----------------------------------------------------------------- setting */

static void store_option_value(struct glint_options *options, int i,
                               double value)
{
    void *const at = (char *)options + place[i].begin;

    switch (table[i].type) {
    case GLINT_OPTION_REAL:
        *(double *)at = value;
        break;
    case GLINT_OPTION_FLAG:
        *(bool *)at = value != 0;
        break;
    default:
        *(int *)at = (int)value;
    }
}

static void store_option_text(struct glint_options *options, int i,
                              const char *text)
{
    *(const char **)((char *)options + place[i].begin) = text;
}

/* Returns whether OPTIONS contain option I. A program compiled for an older
 * version of the library has a smaller struct with fewer options. */
static bool has_option_row(const struct glint_options *options, int i)
{
    return place[i].end <= options->size;
}

/* Returns the index of option NAME, or -1 if OPTIONS do not contain it. */
static int find_option_row(const struct glint_options *options,
                           const char *name)
{
    const struct glint_option *const option = glint_option_named(name);
    const int i = option ? (int)(option - table) : -1;

    return i >= 0 && has_option_row(options, i) ? i : -1;
}

void glint_options_defaults_sized(struct glint_options *options, size_t size)
{
    memset(options, 0, size);
    options->size = size;
    for (int i = 0; i < GLINT_N_OPTIONS && has_option_row(options, i); i++)
        if (table[i].type == GLINT_OPTION_TEXT)
            store_option_text(options, i,
                              table[i].text[0] ? table[i].text : NULL);
        else if (!isnan(table[i].initial))
            store_option_value(options, i, table[i].initial);
}

struct glint_options
glint_options_complete_with_defaults(const struct glint_options *options)
{
    struct glint_options whole;

    glint_options_defaults(&whole);
    memcpy(&whole, options,
           options->size < sizeof whole ? options->size : sizeof whole);
    whole.size = sizeof whole;
    return whole;
}

/* Finds word INDEX among the words of OPTION, which are separated by "|". Sets
 * WORD to the word and N to its length. Returns the number of words. */
static int find_option_word(const struct glint_option *option, int index,
                            size_t *n, const char **word)
{
    const char *at = option->accepts;
    int count = 0;

    for (;; at++, count++) {
        const size_t length = strcspn(at, "|");

        if (count == index) {
            *word = at;
            *n = length;
        }
        at += length;
        if (!*at)
            return count + 1;
    }
}

static int find_word_index(const struct glint_option *option, const char *text)
{
    const char *word = NULL;
    size_t n = 0;

    for (int i = 0; i < find_option_word(option, i, &n, &word); i++)
        if (strlen(text) == n && memcmp(text, word, n) == 0)
            return i;
    return -1;
}

/* Writes a description of the values that a numeric OPTION accepts to TEXT:
 * "UNIT, LOW to HIGH, or WORD". */
static void describe_number_range(const struct glint_option *option, char *text,
                                  size_t bytes)
{
    const char *const unit = option->accepts;
    const bool is_word = strncmp(unit, "or ", 3) == 0;
    const char *const or = is_word ? unit : strstr(unit, ", or ");
    const int n = (int)(or ? or -unit : (ptrdiff_t)strlen(unit));
    char range[64];

    if (option->high >= INT_MAX)
        snprintf(range, sizeof range, "from %g", option->low);
    else if (option->low > 0 && option->low < 1e-5)
        snprintf(range, sizeof range, "above 0 and up to %.10g", option->high);
    else
        snprintf(range, sizeof range, "%.10g to %.10g", option->low,
                 option->high);
    snprintf(text, bytes, "%s%.*s%s%s%s%s",
             option->type == GLINT_OPTION_INTEGER && n == 0 ? "a whole number, "
                                                            : "",
             n, unit, n ? ", " : "", range, is_word ? " " : "", or ? or : "");
}

void glint_option_accepts(const struct glint_option *option, char *text,
                          size_t bytes)
{
    const char *word = NULL;
    size_t n = 0;
    int count, used = 0;

    switch (option->type) {
    case GLINT_OPTION_FLAG:
        snprintf(text, bytes, "no value");
        break;
    case GLINT_OPTION_TEXT:
        snprintf(text, bytes, "%s", option->accepts);
        break;
    case GLINT_OPTION_WORD:
        count = find_option_word(option, 0, &n, &word);
        for (int i = 0; i < count && used < (int)bytes; i++) {
            find_option_word(option, i, &n, &word);
            used += snprintf(text + used, bytes - (size_t)used, "%s%.*s",
                             i == 0           ? ""
                             : i == count - 1 ? " or "
                                              : ", ",
                             (int)n, word);
        }
        break;
    default:
        describe_number_range(option, text, bytes);
    }
}

static enum glint_status reject_option_value(const struct glint_option *option,
                                             struct glint_error *error)
{
    glint_option_accepts(option, error->text, sizeof error->text);
    return GLINT_E_ARGUMENT;
}

static enum glint_status reject_option_name(const char *name,
                                            struct glint_error *error)
{
    snprintf(error->text, sizeof error->text, "there is no option %s", name);
    return GLINT_E_ARGUMENT;
}

/* Records that the caller has set option I. Of two options that exclude each
 * other, the one that was set last is used. */
static void mark_option_given(struct glint_options *options, int i)
{
    options->given[i] = true;
    if (i == GLINT_OPTION_OF_strength)
        GLINT_OPTION_GIVEN(options, exposure) = false;
    if (i == GLINT_OPTION_OF_exposure)
        GLINT_OPTION_GIVEN(options, strength) = false;
    if (i == GLINT_OPTION_OF_quality)
        GLINT_OPTION_GIVEN(options, error) = false;
    if (i == GLINT_OPTION_OF_error) {
        GLINT_OPTION_GIVEN(options, quality) = false;
        options->quality = glint_quality_for_error(options->error);
    }
}

/* Returns whether option I accepts VALUE, given the values of the other options
 * in OPTIONS. VALUE is in the range of option I. */
static bool is_option_value_accepted(const struct glint_options *options, int i,
                                     double value)
{
    switch (i) {
    case GLINT_OPTION_OF_dispersion:
        return value == 0 || value >= 0.1;
    case GLINT_OPTION_OF_veil:
        return value + options->haze <= GLINT_MOST_VEIL;
    case GLINT_OPTION_OF_haze:
        return value + options->veil <= GLINT_MOST_VEIL;
    default:
        return true;
    }
}

enum glint_status glint_options_set(struct glint_options *options,
                                    const char *name, double value,
                                    struct glint_error *error)
{
    const int i = find_option_row(options, name);
    const struct glint_option *const option = i < 0 ? NULL : &table[i];
    const char *word;
    double high;
    size_t n;

    if (!option)
        return reject_option_name(name, error);
    if (option->type == GLINT_OPTION_TEXT)
        return reject_option_value(option, error);
    high = option->type == GLINT_OPTION_WORD
               ? find_option_word(option, -1, &n, &word) - 1
               : option->high;
    if (!(value >= option->low && value <= high) || isinf(value) ||
        (option->type != GLINT_OPTION_REAL && value != floor(value)) ||
        !is_option_value_accepted(options, i, value))
        return reject_option_value(option, error);
    store_option_value(options, i, value);
    mark_option_given(options, i);
    return GLINT_OK;
}

/* ----------------------------------------------------------------- parsing */

/* Parses TEXT as a word that stands for a value of numeric option I, such as
 * "default" for a quality. Returns false if it is not such a word. */
static bool parse_named_number(struct glint_options *options, int i,
                               const char *text, double *value)
{
    if (i == GLINT_OPTION_OF_starburst && strcmp(text, "off") == 0) {
        *value = 0;
        return true;
    }
    if (i != GLINT_OPTION_OF_quality)
        return false;
    if (strcmp(text, "exact") == 0) {
        options->rays = GLINT_RAYS_EXACT;
        GLINT_OPTION_GIVEN(options, rays) = true;
        *value = 1;
        return true;
    }
    for (int k = 0; k < GLINT_QUALITY_NAMES; k++)
        if (strcmp(text, glint_quality_name[k]) == 0) {
            *value = glint_quality_named(k);
            return true;
        }
    return false;
}

/* Parses TEXT as the value of a flag; NULL and "" mean yes. Returns false if
 * TEXT is invalid. */
static bool parse_flag_value(const char *text, double *value)
{
    static const char *const words[] = {"no", "yes", "0", "1"};

    *value = 1;
    if (!text || !*text)
        return true;
    for (int i = 0; i < 4; i++)
        if (strcmp(text, words[i]) == 0) {
            *value = i & 1;
            return true;
        }
    return false;
}

static enum glint_status set_text_option(struct glint_options *options, int i,
                                         const char *text,
                                         struct glint_error *error)
{
    const bool is_set = text && *text;

    if (is_set && !glint_option_text_is_valid((enum glint_option_id)i, text))
        return reject_option_value(&table[i], error);
    store_option_text(options, i,
                      is_set             ? text
                      : table[i].text[0] ? table[i].text
                                         : NULL);
    options->given[i] = is_set;
    return GLINT_OK;
}

enum glint_status glint_options_set_text(struct glint_options *options,
                                         const char *name, const char *text,
                                         struct glint_error *error)
{
    const int i = find_option_row(options, name);
    const struct glint_option *const option = i < 0 ? NULL : &table[i];
    double value = 1;

    error->text[0] = '\0';
    if (!option)
        return reject_option_name(name, error);
    switch (option->type) {
    case GLINT_OPTION_TEXT:
        return set_text_option(options, i, text, error);
    case GLINT_OPTION_FLAG:
        if (!parse_flag_value(text, &value))
            return reject_option_value(option, error);
        break;
    case GLINT_OPTION_WORD:
        value = text ? find_word_index(option, text) : -1;
        break;
    default:
        if (!text)
            return reject_option_value(option, error);
        /* Infinity is stored as 0 and cannot be given as a number. */
        if (i == GLINT_OPTION_OF_focus && strcmp(text, "inf") == 0) {
            options->focus = 0;
            options->given[i] = true;
            return GLINT_OK;
        }
        if (!parse_named_number(options, i, text, &value) &&
            glint_option_numbers(text, &value, 1) != 1)
            return reject_option_value(option, error);
    }
    return glint_options_set(options, name, value, error);
}

/* ------------------------------------------------------------ what follows */

struct glint_quality glint_options_quality(const struct glint_options *options)
{
    const struct glint_options whole =
        glint_options_complete_with_defaults(options);
    const struct glint_options *const o = &whole;
    struct glint_quality q = glint_quality_at(o->quality);

    if (GLINT_OPTION_GIVEN(o, grid))
        q.dials.fineness = o->grid;
    if (GLINT_OPTION_GIVEN(o, quantum)) {
        q.quantum = o->quantum;
        q.dials.irradiance_steps = glint_quality_steps(o->quantum);
    }
    if (GLINT_OPTION_GIVEN(o, whole))
        q.dials.snap_codes_q8 = (int)lrint(o->whole * 256);
    if (GLINT_OPTION_GIVEN(o, dispersion))
        q.dials.dispersion_q8 = (int)lrint(o->dispersion * 256);
    if (GLINT_OPTION_GIVEN(o, cull))
        q.dials.cull_codes = o->cull;
    if (GLINT_OPTION_GIVEN(o, dim))
        q.dials.dim_codes = o->dim;
    if (GLINT_OPTION_GIVEN(o, still))
        q.dials.still_px = o->still;
    if (o->half)
        q.dials.flags |= GLINT_DIAL_ALWAYS_HALF;
    return q;
}
