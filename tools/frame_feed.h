/* SPDX-License-Identifier: MIT
 *
 * frame.h for exact rays.
 */
#ifndef GLINT_TOOLS_FRAME_FEED_H
#define GLINT_TOOLS_FRAME_FEED_H

#include "frame.h"

double frame_feed_scale(struct frame *frame, const struct glint_lamp *lamps,
                        int n_lamps);
enum glint_status frame_feed_draw(struct frame *frame,
                                  const struct glint_lamp *lamps, int n_lamps,
                                  double scale, const struct glint_image *image,
                                  struct frame_report *report);

/* Of frame.c: ghost or part GHOST is in this frame. */
void frame_note_ghost(struct frame *frame, int ghost);

/* Of frame.c: stages of REPORT from the moments between them. */
void frame_report_times(struct frame_report *report, const double times[5]);

#endif
