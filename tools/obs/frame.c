/* SPDX-License-Identifier: MIT */
#include "obs/frame.h"

#include <math.h>

#include "glint/glint.h"

static bool format_of(enum video_format from, enum glint_pixel_format *to)
{
    static const struct {
        enum video_format from;
        enum glint_pixel_format to;
    } pairs[] = {
        {VIDEO_FORMAT_I420, GLINT_I420},
        {VIDEO_FORMAT_NV12, GLINT_NV12},
        {VIDEO_FORMAT_YUY2, GLINT_YUYV},
        {VIDEO_FORMAT_UYVY, GLINT_UYVY},
        {VIDEO_FORMAT_I422, GLINT_I422},
        {VIDEO_FORMAT_I444, GLINT_I444},
        {VIDEO_FORMAT_RGBA, GLINT_XBGR8888},
        {VIDEO_FORMAT_BGRA, GLINT_XRGB8888},
        {VIDEO_FORMAT_BGRX, GLINT_XRGB8888},
        {VIDEO_FORMAT_BGR3, GLINT_BGR24},
        {VIDEO_FORMAT_Y800, GLINT_GREY},
    };

    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        if (pairs[i].from == from) {
            *to = pairs[i].to;
            return true;
        }
    return false;
}

/* Returns the matrix of luma that FRAME's own, from codes to R, G, B, is
 * nearest to: what Cr gives to R is 1.40 of BT.601 and 1.57 of BT.709 at full
 * range. A source that says nothing has zeros there. */
static enum glint_matrix matrix_of(const struct obs_source_frame *frame)
{
    const float cr = frame->color_matrix[2];
    const float between = frame->full_range ? 1.488F : 1.694F;

    return cr > between ? GLINT_MATRIX_BT709 : GLINT_MATRIX_BT601;
}

/* Returns the curve from codes to light: that of the frame, else what is usual
 * for R, G, B and for luma. */
static enum glint_tone tone_of(const struct obs_source_frame *frame,
                               bool is_rgb)
{
    return frame->trc == VIDEO_TRC_SRGB ||
                   (frame->trc == VIDEO_TRC_DEFAULT && is_rgb)
               ? GLINT_TONE_SRGB
               : GLINT_TONE_BT709;
}

bool frame_image(const struct obs_source_frame *frame,
                 struct glint_image *image)
{
    enum glint_pixel_format format;

    if (!format_of(frame->format, &format) || frame->trc == VIDEO_TRC_PQ ||
        frame->trc == VIDEO_TRC_HLG || frame->width - 1 >= GLINT_MAX_SIDE ||
        frame->height - 1 >= GLINT_MAX_SIDE)
        return false;
    *image = (struct glint_image){
        .format = format,
        .width = (int)frame->width,
        .height = (int)frame->height,
        .range = frame->full_range ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED,
        .matrix = matrix_of(frame),
        .transfer = tone_of(frame, glint_image_is_rgb(format))};
    for (int i = 0; i < glint_image_planes(format); i++) {
        const ptrdiff_t stride = (ptrdiff_t)frame->linesize[i];
        const int rows = glint_image_plane_height(format, i, image->height);

        image->plane[i] =
            frame->data[i] + (frame->flip ? (rows - 1) * stride : 0);
        image->stride_bytes[i] = frame->flip ? -stride : stride;
    }
    return true;
}
