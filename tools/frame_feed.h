/* SPDX-License-Identifier: MIT
 *
 * frame.h for exact rays.
 */
#ifndef GLINT_TOOLS_FRAME_FEED_H
#define GLINT_TOOLS_FRAME_FEED_H

#include "frame.h"

double frame_feed_scale(struct frame *frame, const struct glint_lamp *lamps,
                        int n_lamps);

/* TIMES: the moments between plan, transfer, bin and draw, and before and
 * after. What was drawn stays in the frame's feeds. */
enum glint_status frame_feed_draw(struct frame *frame,
                                  const struct glint_lamp *lamps, int n_lamps,
                                  double scale, const struct glint_image *image,
                                  struct glint_flare_stats *stats,
                                  double times[5]);

#endif
