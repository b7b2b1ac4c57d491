/* SPDX-License-Identifier: MIT */
#include "linux/fourcc.h"

#include <stddef.h>
#include <string.h>
#include <strings.h>

#include <linux/videodev2.h>

/* Table of pixel formats by FOURCC. If a format has several entries,
 * glint_fourcc_from_format() returns the first whose planes lie in one block of
 * memory. */
static const struct {
    uint32_t fourcc;
    enum glint_pixel_format format;
    int memory_planes;
} formats[] = {
    {V4L2_PIX_FMT_YUYV, GLINT_YUYV, 1},
    {V4L2_PIX_FMT_UYVY, GLINT_UYVY, 1},
    {V4L2_PIX_FMT_NV12, GLINT_NV12, 1},
    {V4L2_PIX_FMT_NV21, GLINT_NV21, 1},
    {V4L2_PIX_FMT_YUV420, GLINT_I420, 1},
    {V4L2_PIX_FMT_YUV422P, GLINT_I422, 1},
    {V4L2_PIX_FMT_GREY, GLINT_GREY, 1},
    {V4L2_PIX_FMT_RGB24, GLINT_RGB24, 1},
    {V4L2_PIX_FMT_BGR24, GLINT_BGR24, 1},
    {V4L2_PIX_FMT_XBGR32, GLINT_XRGB8888, 1},
    {V4L2_PIX_FMT_ABGR32, GLINT_XRGB8888, 1},
    {V4L2_PIX_FMT_BGR32, GLINT_XRGB8888, 1},
    {V4L2_PIX_FMT_RGB565, GLINT_RGB565, 1},
    {V4L2_PIX_FMT_RGBX32, GLINT_XBGR8888, 1},
    {V4L2_PIX_FMT_RGBA32, GLINT_XBGR8888, 1},
    {V4L2_PIX_FMT_NV12M, GLINT_NV12, 2},
    {V4L2_PIX_FMT_NV21M, GLINT_NV21, 2},
    {V4L2_PIX_FMT_YUV420M, GLINT_I420, 3},
    {V4L2_PIX_FMT_YUV422M, GLINT_I422, 3},
    {V4L2_PIX_FMT_YUV444M, GLINT_I444, 3},
};

/* Table of names of pixel formats: those of ffmpeg, and a few common ones. */
static const struct {
    const char *name;
    uint32_t fourcc;
} names[] = {
    {"yuyv422", V4L2_PIX_FMT_YUYV},    {"yuy2", V4L2_PIX_FMT_YUYV},
    {"uyvy422", V4L2_PIX_FMT_UYVY},    {"yuv420p", V4L2_PIX_FMT_YUV420},
    {"yuvj420p", V4L2_PIX_FMT_YUV420}, {"i420", V4L2_PIX_FMT_YUV420},
    {"yuv422p", V4L2_PIX_FMT_YUV422P}, {"yuvj422p", V4L2_PIX_FMT_YUV422P},
    {"yuv444p", V4L2_PIX_FMT_YUV444M}, {"gray", V4L2_PIX_FMT_GREY},
    {"gray8", V4L2_PIX_FMT_GREY},      {"rgb24", V4L2_PIX_FMT_RGB24},
    {"bgr24", V4L2_PIX_FMT_BGR24},     {"bgr0", V4L2_PIX_FMT_XBGR32},
    {"bgra", V4L2_PIX_FMT_ABGR32},     {"rgb565", V4L2_PIX_FMT_RGB565},
    {"rgb565le", V4L2_PIX_FMT_RGB565}, {"mjpeg", V4L2_PIX_FMT_MJPEG},
    {"mjpg", V4L2_PIX_FMT_MJPEG},      {"jpeg", V4L2_PIX_FMT_JPEG},
    {"h264", V4L2_PIX_FMT_H264},
};

#define N_FORMATS (sizeof formats / sizeof *formats)
#define N_NAMES   (sizeof names / sizeof *names)

bool glint_fourcc_to_format(uint32_t fourcc, enum glint_pixel_format *format)
{
    for (size_t i = 0; i < N_FORMATS; i++)
        if (formats[i].fourcc == fourcc) {
            *format = formats[i].format;
            return true;
        }
    return false;
}

uint32_t glint_fourcc_from_format(enum glint_pixel_format format)
{
    for (size_t i = 0; i < N_FORMATS; i++)
        if (formats[i].format == format && formats[i].memory_planes == 1)
            return formats[i].fourcc;
    return 0;
}

static bool is_printable_character(uint32_t character)
{
    return character >= ' ' && character <= '~';
}

void glint_fourcc_text(uint32_t fourcc, char text[5])
{
    for (int i = 0; i < 4; i++) {
        const uint32_t character = fourcc >> 8 * i & 255;

        text[i] = is_printable_character(character) ? (char)character : '?';
    }
    text[4] = 0;
}

static bool parse_format_name(const char *text, uint32_t *fourcc)
{
    char own[5];

    for (size_t i = 0; i < N_FORMATS; i++) {
        glint_fourcc_text(formats[i].fourcc, own);
        if (!strcasecmp(own, text)) {
            *fourcc = formats[i].fourcc;
            return true;
        }
    }
    for (size_t i = 0; i < N_NAMES; i++)
        if (!strcasecmp(names[i].name, text)) {
            *fourcc = names[i].fourcc;
            return true;
        }
    return false;
}

bool glint_fourcc_parse(const char *text, uint32_t *fourcc)
{
    uint32_t value = 0;

    if (parse_format_name(text, fourcc))
        return true;
    if (strlen(text) != 4)
        return false;
    for (int i = 0; i < 4; i++) {
        if (!is_printable_character((unsigned char)text[i]))
            return false;
        value |= (uint32_t)(unsigned char)text[i] << 8 * i;
    }
    *fourcc = value;
    return true;
}

/* ------------------------------------------------------------------ colours */

bool glint_v4l2_colour_to_image(const struct glint_v4l2_colour *colour,
                                struct glint_image *image)
{
    const bool rgb = glint_image_is_rgb(image->format);
    /* By default grey is full range, as sensors without colour use all
     * codes. */
    const bool is_grey = image->format == GLINT_GREY;
    const uint32_t space = colour->colorspace;
    uint32_t enc = colour->ycbcr_enc;
    uint32_t quantization = colour->quantization;
    uint32_t xfer = colour->xfer_func;

    if (enc == V4L2_YCBCR_ENC_DEFAULT)
        enc = V4L2_MAP_YCBCR_ENC_DEFAULT(space);
    if (quantization == V4L2_QUANTIZATION_DEFAULT)
        quantization =
            V4L2_MAP_QUANTIZATION_DEFAULT(rgb || is_grey, space, enc);
    if (xfer == V4L2_XFER_FUNC_DEFAULT)
        xfer = V4L2_MAP_XFER_FUNC_DEFAULT(space);
    image->range = rgb || quantization == V4L2_QUANTIZATION_FULL_RANGE
                       ? GLINT_RANGE_FULL
                       : GLINT_RANGE_LIMITED;
    image->matrix = enc == V4L2_YCBCR_ENC_601 || enc == V4L2_YCBCR_ENC_XV601
                        ? GLINT_MATRIX_BT601
                        : GLINT_MATRIX_BT709;
    image->transfer =
        xfer == V4L2_XFER_FUNC_SRGB ? GLINT_TONE_SRGB : GLINT_TONE_BT709;
    if (rgb && quantization != V4L2_QUANTIZATION_FULL_RANGE)
        return false;
    if (!rgb && enc != V4L2_YCBCR_ENC_601 && enc != V4L2_YCBCR_ENC_709)
        return false;
    return xfer == V4L2_XFER_FUNC_SRGB || xfer == V4L2_XFER_FUNC_709;
}

void glint_v4l2_colour_from_image(struct glint_v4l2_colour *colour,
                                  const struct glint_image *image)
{
    const bool srgb = image->transfer == GLINT_TONE_SRGB;

    colour->colorspace = srgb ? V4L2_COLORSPACE_SRGB : V4L2_COLORSPACE_REC709;
    colour->ycbcr_enc = image->matrix == GLINT_MATRIX_BT601
                            ? V4L2_YCBCR_ENC_601
                            : V4L2_YCBCR_ENC_709;
    colour->quantization =
        glint_image_is_rgb(image->format) || image->range == GLINT_RANGE_FULL
            ? V4L2_QUANTIZATION_FULL_RANGE
            : V4L2_QUANTIZATION_LIM_RANGE;
    colour->xfer_func = srgb ? V4L2_XFER_FUNC_SRGB : V4L2_XFER_FUNC_709;
}
