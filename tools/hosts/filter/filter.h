/* SPDX-License-Identifier: MIT
 *
 * filter.h - a flare over the pictures of a host, as glint overlay draws it,
 * with parameters that may change from picture to picture.
 *
 *     filter_values_init(&values);
 *     filter_set_text(&values, i, "heliar-tronnier");   0 <= i, in the order
 *     filter_set_number(&values, i, 0.75);              of filter_parameter()
 *     filter = filter_create("frei0r", width, height);
 *     filter_set(filter, &values);
 *     filter_draw(filter, &image, elapsed_us);          each picture
 */
#ifndef GLINT_TOOLS_FILTER_FILTER_H
#define GLINT_TOOLS_FILTER_FILTER_H

#include <stdbool.h>

#include "glint/image.h"

enum { FILTER_MAX = 16 }; /* parameters, at most */

enum filter_type { FILTER_NUMBER, FILTER_SWITCH, FILTER_TEXT };

/* A parameter of hosts: an option of the engine by its name, or auto, x and y,
 * which place one lamp. */
struct filter_parameter {
    const char *name, *label, *help;
    enum filter_type type;
    double low, high, initial; /* in the option's unit; a switch is 0 or 1 */
    bool is_live;              /* takes effect with the next picture */
};

/* Sets PARAMETER to that of INDEX, from 0. Returns false if there is none. */
bool filter_parameter(int index, struct filter_parameter *parameter);

/* The value of each parameter. */
struct filter_values {
    double number[FILTER_MAX]; /* of a switch 0 or 1 */
    char *text[FILTER_MAX];    /* allocated, or NULL for "" */
};

/* Sets VALUES to the defaults; frees its texts. */
void filter_values_init(struct filter_values *values);
void filter_values_free(struct filter_values *values);

/* Set the parameter INDEX. A number is clamped to its range; if it is not
 * finite, the default is set. A number at its default, or an empty text, leaves
 * the value of the style. NULL: "". */
void filter_set_number(struct filter_values *values, int index, double number);
void filter_set_text(struct filter_values *values, int index, const char *text);

struct filter;

/* Returns a filter of pictures of WIDTH x HEIGHT, or NULL without memory. It
 * opens its lens with the first picture. Messages begin with "glint HOST". */
struct filter *filter_create(const char *host, int width, int height);
void filter_destroy(struct filter *filter);

/* Sets all parameters of FILTER, which opens its lens again if any changes that
 * is not live; or those that are live alone. */
void filter_set(struct filter *filter, const struct filter_values *values);
void filter_set_live(struct filter *filter, const struct filter_values *values);

/* Return whether FILTER draws pictures of WIDTH x HEIGHT; and with VALUES,
 * without opening its lens again. */
bool filter_has_size(const struct filter *filter, int width, int height);
bool filter_fits(const struct filter *filter,
                 const struct filter_values *values, int width, int height);

/* Opens the lens before the first picture: a bake, if it is needed, takes
 * seconds to hours. Returns false on failure, as filter_draw() does. */
bool filter_open(struct filter *filter);

/* Returns why filter_draw() or filter_open() failed last; "" if only standard
 * error has the reason. */
const char *filter_cause(const struct filter *filter);

/* Draws the flare on IMAGE, which comes ELAPSED_US after the last one; 0: a
 * still picture. On failure, prints a line on standard error, once, leaves
 * pictures as they are until a parameter changes that is not live, and returns
 * false. */
bool filter_draw(struct filter *filter, const struct glint_image *image,
                 int32_t elapsed_us);

#endif
