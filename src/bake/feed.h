/* SPDX-License-Identifier: MIT
 *
 * What feeding exact rays and feeding a model's have in common.
 */
#ifndef GLINT_BAKE_FEED_H
#define GLINT_BAKE_FEED_H

#include "glint/bake.h"

/* The ghost's box on the sensor, turned by the light's azimuth, meets the
 * picture. */
bool glint_feed_in_view(const struct glint_feed_config *cfg,
                        const struct glint_feed *feed);

/* The grid for a ghost that bends by BEND_MM and whose outlines bend by
 * OUTLINE_MM (struct glint_survey). */
int glint_feed_cells(const struct glint_feed_config *cfg, double bend_mm,
                     double outline_mm, bool folds);

/* glint_feed_plan and _trace of a model. */
void glint_feed_plan_model(const struct glint_feed_config *cfg,
                           struct glint_feed *feed);
void glint_feed_trace_model(const struct glint_feed_config *cfg,
                            const struct glint_feed *feed,
                            struct glint_vertex *vertex);

#endif
