/* SPDX-License-Identifier: MIT
 *
 * filter.h - draws a flare onto the pictures of a host application, as glint
 * overlay does, with parameters that may change from picture to picture.
 *
 *     filter_values_init(&values);
 *     filter_set_text(&values, i, "heliar-tronnier");  filter_get_parameter()
 *     filter_set_number(&values, i, 0.75);             lists parameters i
 *     filter = filter_create("frei0r", width, height);
 *     filter_set_values(filter, &values);
 *     filter_draw_flare(filter, &image, elapsed_us);   each picture
 */
#ifndef GLINT_TOOLS_FILTER_FILTER_H
#define GLINT_TOOLS_FILTER_FILTER_H

#include <stdbool.h>

#include "glint/image.h"

enum { FILTER_MAX = 16 }; /* max number of parameters */

enum filter_type { FILTER_NUMBER, FILTER_SWITCH, FILTER_TEXT };

/* A parameter that hosts show. A parameter is an engine option of this name, or
 * one of auto, x and y, which place a lamp manually. */
struct filter_parameter {
    const char *name, *label, *help;
    enum filter_type type;
    /* range and default, in the option's unit; for a switch 0 or 1 */
    double low, high, initial;
    bool is_live; /* true: a change takes effect with the next
                     picture, without opening the lens again */
};

/* Sets PARAMETER to parameter INDEX, counted from 0. Returns false if there is
 * no such parameter. */
bool filter_get_parameter(int index, struct filter_parameter *parameter);

/* Values of all parameters */
struct filter_values {
    double number[FILTER_MAX]; /* value of each number; 0 or 1 for a switch */
    /* value of each text, owned by the struct; NULL means "" */
    char *text[FILTER_MAX];
};

/* Sets VALUES to the defaults; frees its texts. */
void filter_values_init(struct filter_values *values);
void filter_values_free(struct filter_values *values);

/* filter_set_number() and filter_set_text() set the parameter INDEX. NUMBER is
 * clamped to its range; if it is not finite, the default is set. A number that
 * equals its default, and an empty text, leave the value to the style. A TEXT
 * of NULL means "". */
void filter_set_number(struct filter_values *values, int index, double number);
void filter_set_text(struct filter_values *values, int index, const char *text);

struct filter;

/* Returns a filter for pictures of WIDTH x HEIGHT, or NULL if there is no
 * memory. The lens is opened at the first picture. Messages begin with
 * "glint HOST". */
struct filter *filter_create(const char *host, int width, int height);
void filter_destroy(struct filter *filter);

/* filter_set_values() sets all parameters; if one that is not live has changed,
 * the next picture opens the lens again. filter_set_live_values() sets only
 * live parameters. */
void filter_set_values(struct filter *filter,
                       const struct filter_values *values);
void filter_set_live_values(struct filter *filter,
                            const struct filter_values *values);

/* filter_has_size() returns whether FILTER draws pictures of WIDTH x HEIGHT.
 * filter_is_reusable() returns whether FILTER can also draw with VALUES without
 * opening its lens again. */
bool filter_has_size(const struct filter *filter, int width, int height);
bool filter_is_reusable(const struct filter *filter,
                        const struct filter_values *values, int width,
                        int height);

/* Opens the lens before the first picture. If the lens's model is not cached,
 * bakes the model, which takes seconds to hours. Returns false on failure. */
bool filter_open_lens(struct filter *filter);

/* Returns the cause of the last failure of filter_draw_flare() or
 * filter_open_lens(). Returns "" if the cause was only printed to standard
 * error. */
const char *filter_error_text(const struct filter *filter);

/* Draws the flare onto IMAGE. ELAPSED_US: microseconds since the previous
 * picture; 0: a still image. On the first failure prints the cause to standard
 * error. Returns false on failure; pictures then remain unchanged until a
 * parameter that is not live changes. */
bool filter_draw_flare(struct filter *filter, const struct glint_image *image,
                       int32_t elapsed_us);

#endif
