/* SPDX-License-Identifier: MIT */
#include "engine/engine_parts.h"

#include <stdio.h>

enum glint_status glint_engine_front(struct glint_engine *engine,
                                     const struct glint_front *front,
                                     struct glint_error *error)
{
    struct glint_frame_veil *veil = &engine->frame.veil;
    const struct glint_front_dirt *before = veil->front;
    struct glint_front_dirt *dirt;
    enum glint_status status = glint_front_make(&dirt, front, error);

    if (status != GLINT_OK)
        return status;
    veil->front = engine->strength.gain > 0 ? dirt : NULL;
    status = glint_frame_veil_hold(&engine->frame);
    if (status == GLINT_OK) {
        glint_front_free(engine->front);
        engine->front = dirt;
        engine->free_front = glint_front_free;
        return GLINT_OK;
    }
    snprintf(error->text, sizeof error->text, "%s", glint_status_text(status));
    veil->front = before;
    glint_front_free(dirt);
    return status;
}
