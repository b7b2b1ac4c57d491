/* SPDX-License-Identifier: MIT */
#include "panel/null.h"

static enum glint_status put(struct glint_sink *sink,
                             const struct glint_image *image,
                             struct glint_error *error)
{
    (void)image, (void)error;
    ((struct glint_null_sink *)sink)->n_frames++;
    return GLINT_OK;
}

static void close_null(struct glint_sink *sink)
{
    (void)sink;
}

void glint_null_sink_open(struct glint_null_sink *null)
{
    *null = (struct glint_null_sink){.sink = {put, close_null}};
}
