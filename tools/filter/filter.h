/* SPDX-License-Identifier: MIT
 *
 * filter.h - a flare over the pictures of a host, as glint overlay draws it,
 * turned by parameters that may change from picture to picture.
 */
#ifndef GLINT_TOOLS_FILTER_FILTER_H
#define GLINT_TOOLS_FILTER_FILTER_H

#include <stdbool.h>

#include "glint/image.h"

/* Numbers are 0 .. 1. A number at its default leaves a style's own value. */
enum filter_number {
    FILTER_STRENGTH,  /* as --strength */
    FILTER_GAIN,      /* half of --gain: 0.5 is 1 */
    FILTER_STARBURST, /* half of --starburst: 0.5 is 1 */
    FILTER_QUALITY,   /* as --quality */
    FILTER_AUTO,      /* from 0.5 on lamps are found; else there is one, at: */
    FILTER_X,         /* place in widths of the picture, from the left */
    FILTER_Y,         /* and in heights, from the top */
    FILTER_NUMBERS
};

/* Words, "" where none is given. */
enum filter_word {
    FILTER_LENS,     /* as --lens */
    FILTER_STYLE,    /* as --style */
    FILTER_F_NUMBER, /* as --f-number */
    FILTER_WORDS
};

extern const double filter_default[FILTER_NUMBERS];

struct filter;

/* Returns a filter of pictures of WIDTH x HEIGHT, or NULL without memory. It
 * opens its lens with the first picture. HOST is what its messages begin with,
 * behind "glint". */
struct filter *filter_create(const char *host, int width, int height);
void filter_destroy(struct filter *filter);

/* Set a parameter. What is not finite or out of range is clamped. */
void filter_set_number(struct filter *filter, enum filter_number which,
                       double value);
void filter_set_word(struct filter *filter, enum filter_word which,
                     const char *text);
double filter_number(const struct filter *filter, enum filter_number which);
const char *filter_word(const struct filter *filter, enum filter_word which);

/* Opens the lens before the first picture comes: where it is not baked yet,
 * that takes seconds to hours. Returns whether it could, as filter_draw()
 * does. */
bool filter_open(struct filter *filter);

/* Returns why the last picture was not drawn, or the lens not opened; "" where
 * standard error alone has the reason. */
const char *filter_cause(const struct filter *filter);

/* Draws the flare on IMAGE, which comes ELAPSED_US after the last one; 0: a
 * picture by itself. Where it cannot, a line on standard error says why, once,
 * and the picture stays as it is until a parameter changes. Returns whether it
 * could. */
bool filter_draw(struct filter *filter, const struct glint_image *image,
                 int32_t elapsed_us);

#endif
