/* SPDX-License-Identifier: MIT
 *
 * opening.h - a filter that opens its lens in a thread of its own, as that may
 * take minutes, in which OBS goes on.
 */
#ifndef GLINT_TOOLS_OBS_OPENING_H
#define GLINT_TOOLS_OBS_OPENING_H

#include <stdbool.h>

#include "filter/filter.h"

enum { WORD_BYTES = 4096 };

/* What a user has set. */
struct flare_settings {
    double number[FILTER_NUMBERS];
    char word[FILTER_WORDS][WORD_BYTES];
};

/* Hands over what may change from frame to frame. */
void flare_settings_turn(const struct flare_settings *settings,
                         struct filter *filter);

/* Returns whether a filter that was opened with A serves B, but for that. */
bool flare_settings_serve(const struct flare_settings *a,
                          const struct flare_settings *b);

struct opening;

/* Begins to open a filter for frames of WIDTH x HEIGHT. Returns NULL without
 * memory or threads. */
struct opening *opening_begin(const struct flare_settings *settings, int width,
                              int height);

/* Returns whether the filter is there; if so it is the caller's, SETTINGS,
 * WIDTH and HEIGHT are those that it was opened with, and the opening is gone.
 */
bool opening_end(struct opening *opening, struct filter **filter,
                 struct flare_settings *settings, int *width, int *height);

/* Leaves an opening, or NULL, to itself: it frees what it has when it is done.
 */
void opening_leave(struct opening *opening);

#endif
