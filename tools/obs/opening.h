/* SPDX-License-Identifier: MIT
 *
 * opening.h - a filter that opens its lens in a thread of its own, as that may
 * take minutes, in which OBS goes on.
 */
#ifndef GLINT_TOOLS_OBS_OPENING_H
#define GLINT_TOOLS_OBS_OPENING_H

#include <stdbool.h>

#include "filter/filter.h"

struct opening;

/* Begins to open a filter with VALUES for frames of WIDTH x HEIGHT. Returns
 * NULL without memory or threads. */
struct opening *opening_begin(const struct filter_values *values, int width,
                              int height);

/* Returns whether the filter is open, or has failed to open; if so it is the
 * caller's, and OPENING is freed. */
bool opening_end(struct opening *opening, struct filter **filter);

/* Leaves an opening, or NULL, to itself: it frees what it has when it is done.
 */
void opening_leave(struct opening *opening);

#endif
