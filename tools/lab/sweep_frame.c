/* SPDX-License-Identifier: MIT */
#include "lab/sweep.h"

enum glint_status sweep_frame(struct glint_frame *frame,
                              const struct glint_lamp *lamp, int n,
                              double exposure, const struct glint_image *image,
                              struct glint_engine_report *report)
{
    return glint_frame_draw(frame, lamp, n, exposure, image, report);
}
