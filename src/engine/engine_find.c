/* SPDX-License-Identifier: MIT
 *
 * Finds the lamps of a picture. */
#include "engine/engine_parts.h"

struct glint_engine_lamp glint_engine_lamp_of(const struct glint_lamp *lamp,
                                              uint32_t id)
{
    return (struct glint_engine_lamp){
        .lamp = *lamp, .id = id, .level = 1, .share = 1};
}

void glint_engine_elapsed(struct glint_engine *engine, int32_t elapsed_us)
{
    engine->find.elapsed_us = elapsed_us;
    engine->expose.is_done = false;
}

void glint_engine_mark_cut(struct glint_engine *engine)
{
    engine->find.is_cut = true;
}

void glint_engine_forget_lamps(struct glint_engine *engine)
{
    if (engine->find.detector.max > 0)
        glint_lamp_detector_restart_tracking(&engine->find.detector);
}

int glint_engine_find(struct glint_engine *engine,
                      const struct glint_image *image, int32_t elapsed_us,
                      struct glint_engine_lamp *lamps, int max)
{
    struct glint_engine_finding *const find = &engine->find;
    struct glint_lamp_detector *const d = &find->detector;
    int n;

    glint_engine_elapsed(engine, elapsed_us);
    if (d->max == 0)
        return 0;
    n = glint_lamp_detector_find_lamps(
        d, image, elapsed_us, &engine->paint.frame.view,
        engine->optics.setup->optics.focal_mm, find->found);
    find->is_searched = true;
    n = n < max ? n : max;
    for (int i = 0; i < n; i++) {
        const struct glint_lamp_track *const track = &d->track[i];

        lamps[i] = glint_engine_lamp_of(&find->found[i], track->id);
        lamps[i].level = track->level_q15 / 32768.0;
        lamps[i].seen_px = d->headroom_ev < 0 ? track->size_q8 / 256.0 : 0;
        lamps[i].is_found = 1;
        lamps[i].track = *track;
    }
    return n;
}

int glint_engine_doubtful(const struct glint_engine *engine, int i,
                          struct glint_spot *spot)
{
    const struct glint_spot *const found =
        glint_lamp_detector_doubtful(&engine->find.detector, i);

    if (found)
        *spot = *found;
    return found != NULL;
}
