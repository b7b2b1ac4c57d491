/* SPDX-License-Identifier: MIT
 *
 * Makes stops with round blades, soft edges, dust or masks, and dirt on the
 * front element. Only programs that call these functions link this file. */
#include "engine/engine_parts.h"

const struct glint_engine_stops glint_engine_all_stops = {
    glint_setup_iris, glint_front_make, glint_front_free};

enum glint_status glint_engine_iris(struct glint_engine *engine, int n_blades,
                                    double rotation_deg,
                                    const struct glint_iris *iris,
                                    struct glint_error *error)
{
    struct glint_engine_camera camera = engine->optics.camera;

    camera.n_blades = n_blades;
    camera.blade_rotation_deg = rotation_deg;
    camera.iris = *iris;
    camera.stops = &glint_engine_all_stops;
    return glint_engine_change_stop(engine, &camera, false, error);
}
