/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "engine/frame/frame_parts.h"

/* Draws a few frames with one lamp, and measures the time of the fastest frame.
 * Sets *LEAST_MS to this time, ms, if it is shorter. */
static enum glint_status
measure_test_frame_time(struct glint_frame *frame,
                        const struct glint_image *image,
                        struct glint_engine_report *report, double *least_ms)
{
    const struct glint_lamp lamp = {
        fmin(12, glint_frame_get_max_angle_deg(frame)),
        33,
        1e6,
        {1, 1, 1},
        {0, 0},
        0};
    enum glint_status status = GLINT_OK;

    for (int i = 0; i < 4 && status == GLINT_OK; i++) {
        status = glint_frame_draw(frame, &lamp, 1, 1, image, report);
        if (i > 0) /* The first frame is not counted, as it allocates memory. */
            *least_ms = fmin(*least_ms, report->plan_ms + report->bin_ms +
                                            report->draw_ms);
    }
    return status;
}

enum glint_status glint_frame_calibrate_budget(struct glint_frame *frame)
{
    struct glint_image image = {.format = GLINT_YUYV,
                                .width = frame->view.width,
                                .height = frame->view.height};
    void *mem =
        calloc(1, glint_image_bytes(GLINT_YUYV, image.width, image.height));
    struct glint_budget *b = &frame->budget;
    struct glint_engine_report report = {.lights = 0};
    double least_ms = 1e9;
    struct glint_frame plain;
    enum glint_status status = GLINT_E_MEMORY;

    glint_frame_init_like(&plain, frame, frame->view);
    plain.only_ghost = -1;
    plain.dials.dispersion_q8 = 0;
    if (mem) {
        glint_image_place(&image, mem);
        status = measure_test_frame_time(&plain, &image, &report, &least_ms);
    }
    if (status == GLINT_OK && report.stats.bundles > 0) {
        const struct glint_cost_plan plan = glint_frame_make_cost_plan(&plain);
        const struct glint_cost cost = glint_cost_of(&plan, &plan.dials);

        b->calibrated_minsn = glint_cost_convert_to_minsn(&cost);
        b->ms_per_minsn = least_ms / b->calibrated_minsn;
    }
    glint_frame_finish(&plain);
    free(mem);
    return status;
}
