/* SPDX-License-Identifier: MIT
 *
 * panel/null.h - a sink that shows nothing, to measure all that comes before.
 */
#ifndef GLINT_PLATFORM_PANEL_NULL_H
#define GLINT_PLATFORM_PANEL_NULL_H

#include "source_sink.h"

struct glint_null_sink {
    struct glint_sink sink;
    long n_frames; /* frames put so far */
};

void glint_null_sink_open(struct glint_null_sink *null);

#endif
