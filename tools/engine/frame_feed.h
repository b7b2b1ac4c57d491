/* SPDX-License-Identifier: MIT
 *
 * frame.h for exact rays.
 */
#ifndef GLINT_TOOLS_ENGINE_FRAME_FEED_H
#define GLINT_TOOLS_ENGINE_FRAME_FEED_H

#include "engine/frame.h"

/* Powers of two, as their logarithms. */
struct frame_scale {
    int likely; /* brings the brightest ghost near 32 times display white, of
                   the 2048 that a pixel may reach */
    int most;   /* no light is cut down: together it is below 2^24 */
};

/* Of the brightest ghost's mean light and of all flux together. */
struct frame_scale frame_scale_of(int brightest_log2, int together_log2);

/* SCALE becomes {0, 0} where there is no light. GLINT_E_MEMORY: it is not
 * known, or LAMPS have more bundles than can be held. */
enum glint_status frame_feed_scale(struct frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   struct frame_scale *scale);

/* TIMES: the moments between plan, transfer, bin and draw, and before and
 * after. What was drawn stays in the frame's feeds. */
enum glint_status frame_feed_draw(struct frame *frame,
                                  const struct glint_lamp *lamps, int n_lamps,
                                  double scale, const struct glint_image *image,
                                  struct glint_flare_stats *stats,
                                  double times[5]);

#endif
