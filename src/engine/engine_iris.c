/* SPDX-License-Identifier: MIT */
#include "engine/engine_parts.h"

enum glint_status glint_engine_iris(struct glint_engine *engine, int n_blades,
                                    double rotation_deg,
                                    const struct glint_iris *iris,
                                    struct glint_error *error)
{
    struct glint_engine_shape shape = engine->optics.shape;

    shape.n_blades = n_blades;
    shape.rotation_deg = rotation_deg;
    shape.iris = *iris;
    shape.set_iris = glint_setup_iris;
    return glint_engine_reshape(engine, &shape, false, error);
}
