/* SPDX-License-Identifier: MIT */
#include "engine/engine_parts.h"

#include <stdio.h>

enum glint_status glint_engine_front(struct glint_engine *engine,
                                     const struct glint_front *front,
                                     struct glint_error *error)
{
    struct glint_engine_optics *const o = &engine->optics;
    const struct glint_front_dirt *const before = o->front;
    struct glint_front_dirt *dirt;
    enum glint_status status = glint_front_make(&dirt, front, error);

    if (status != GLINT_OK)
        return status;
    o->front = dirt;
    /* an address may be that of what was freed before */
    engine->paint.frame.veil.table_of = NULL;
    glint_engine_choose(engine, engine->paint.parts,
                        engine->paint.frame.star.share,
                        engine->expose.light.gain > 0);
    status = glint_frame_veil_hold(&engine->paint.frame);
    if (status == GLINT_OK) {
        glint_front_free(o->own_front);
        o->own_front = dirt;
        o->free_front = glint_front_free;
        return GLINT_OK;
    }
    snprintf(error->text, sizeof error->text, "%s", glint_status_text(status));
    o->front = before;
    glint_engine_choose(engine, engine->paint.parts,
                        engine->paint.frame.star.share,
                        engine->expose.light.gain > 0);
    glint_front_free(dirt);
    return status;
}
