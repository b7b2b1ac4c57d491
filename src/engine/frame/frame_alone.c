/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/frame_parts.h"

static uint32_t find_max_light_magnitude(const int32_t *linear_q20, size_t n)
{
    uint32_t peak = 0;

    for (size_t i = 0; i < n; i++) {
        const uint32_t size = linear_q20[i] < 0 ? 0U - (uint32_t)linear_q20[i]
                                                : (uint32_t)linear_q20[i];

        peak = size > peak ? size : peak;
    }
    return peak;
}

/* Returns log2 of the factor by which a picture with the brightest pixel PEAK
 * should be scaled and drawn again, or 0 if it need not be drawn again. The
 * result is never 1, as one octave gains too little. It is negative if light
 * was clamped, so that the true peak is unknown. */
static int choose_picture_scale_log2(uint32_t peak,
                                     struct glint_frame_scale scale)
{
    const int room = scale.most - scale.likely;
    int up = 0;

    if (peak >= INT32_MAX)
        return -6;
    for (; peak && peak < UINT32_C(1) << 29; peak *= 2)
        up++;
    up = up < room ? up : room;
    return up > 1 ? up : 0;
}

enum glint_status glint_frame_draw_flare_alone(
    struct glint_frame *frame, const struct glint_lamp *lamps, int n_lamps,
    double gain, float *rgb, struct glint_engine_report *report)
{
    const int width = frame->view.width, height = frame->view.height;
    const size_t n = 3 * (size_t)width * (size_t)height;
    struct glint_frame_scale scale;
    int32_t *linear_q20 = malloc(n * sizeof *linear_q20);
    const struct glint_image layer =
        glint_image_over(linear_q20, GLINT_LINEAR_Q20, width, height);
    enum glint_status status =
        linear_q20 ? glint_frame_predict_scale(frame, lamps, n_lamps, &scale)
                   : GLINT_E_MEMORY;
    const double share = frame->star.share;
    const double glare = frame->veil.glare, haze = frame->veil.haze;
    const struct glint_front_dirt *front = frame->veil.front;
    double unit;
    int up = 1;

    frame->star.share = frame->veil.glare = frame->veil.haze = 0;
    frame->veil.front = NULL;
    frame->veil.is_set = false;
    for (int i = 0; i < 4 && up && status == GLINT_OK; i++) {
        memset(linear_q20, 0, n * sizeof *linear_q20);
        status = glint_frame_draw(frame, lamps, n_lamps, exp2(scale.likely),
                                  &layer, report);
        up = choose_picture_scale_log2(find_max_light_magnitude(linear_q20, n),
                                       scale);
        scale.likely += i < 3 ? up : 0;
    }
    unit = status == GLINT_OK ? exp2(-20 - scale.likely) : 0;
    for (size_t i = 0; i < n && status == GLINT_OK; i++)
        rgb[i] = (float)(linear_q20[i] * unit * gain);
    frame->star.share = share;
    frame->veil.glare = glare;
    frame->veil.haze = haze;
    frame->veil.front = front;
    if (status == GLINT_OK && glint_frame_has_veil(frame))
        status = glint_frame_veil_draw_alone(frame, lamps, n_lamps, gain,
                                             linear_q20, rgb);
    if (status == GLINT_OK && share > 0)
        status = glint_frame_star_draw_alone(frame, lamps, n_lamps, gain,
                                             linear_q20, rgb);
    free(linear_q20);
    return status;
}
