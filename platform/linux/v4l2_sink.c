/* SPDX-License-Identifier: MIT */
#include "linux/v4l2_sink.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <linux/videodev2.h>

#include "linux/fourcc.h"
#include "linux/request.h"
#include "posix/error.h"

/* Reports that WHAT failed, by errno. */
static enum glint_status
report_request_failure(const struct glint_v4l2_sink *out, const char *what,
                       struct glint_error *error)
{
    const int number = errno;
    const char *hint = "";

    if (number == EBUSY)
        hint = "; another program writes to it";
    else if (number == EACCES)
        hint = "; join its group: usermod -aG video USER, then log in again";
    else if (number == ENOENT)
        hint = "; modprobe v4l2loopback creates one";
    else if (number == ENODEV)
        hint = "; the device was removed";
    return glint_error_report(error, GLINT_E_DEVICE, out->name, "%s: %s%s",
                              what, strerror(number), hint);
}

/* ----------------------------------------------------------------- opening */

static enum glint_status check_output_node(struct glint_v4l2_sink *out,
                                           struct glint_error *error)
{
    struct v4l2_capability cap = {.capabilities = 0};
    uint32_t can;

    if (glint_ioctl(out->fd, VIDIOC_QUERYCAP, &cap) < 0)
        return errno == ENOTTY || errno == EINVAL
                   ? glint_error_report(error, GLINT_E_DEVICE, out->name,
                                        "is not a video device")
                   : report_request_failure(out, "VIDIOC_QUERYCAP", error);
    memcpy(out->card, cap.card, 32);
    can = cap.capabilities & V4L2_CAP_DEVICE_CAPS ? cap.device_caps
                                                  : cap.capabilities;
    if (!(can & V4L2_CAP_VIDEO_OUTPUT))
        return glint_error_report(
            error, GLINT_E_DEVICE, out->name,
            "%s is not a video output, or another program uses it", out->card);
    if (!(can & V4L2_CAP_READWRITE))
        return glint_error_report(error, GLINT_E_DEVICE, out->name,
                                  "%s does not accept frames by write()",
                                  out->card);
    return GLINT_OK;
}

static enum glint_status set_output_format(struct glint_v4l2_sink *out,
                                           uint32_t fourcc,
                                           struct v4l2_format *f,
                                           struct glint_error *error)
{
    const struct glint_image *const like = &out->frame;
    struct v4l2_pix_format *const px = &f->fmt.pix;
    enum glint_pixel_format format;
    struct glint_v4l2_colour colour;
    char want[5], got[5];

    glint_v4l2_colour_from_image(&colour, like);
    *f = (struct v4l2_format){.type = V4L2_BUF_TYPE_VIDEO_OUTPUT};
    px->width = (uint32_t)like->width;
    px->height = (uint32_t)like->height;
    px->pixelformat = fourcc;
    px->field = V4L2_FIELD_NONE;
    px->colorspace = colour.colorspace;
    px->ycbcr_enc = colour.ycbcr_enc;
    px->quantization = colour.quantization;
    px->xfer_func = colour.xfer_func;
    px->priv = V4L2_PIX_FMT_PRIV_MAGIC; /* priv must have this value, or drivers
                                           ignore the last three members */
    if (glint_ioctl(out->fd, VIDIOC_S_FMT, f) < 0)
        return report_request_failure(out, "VIDIOC_S_FMT", error);
    if (glint_fourcc_to_format(px->pixelformat, &format) &&
        format == like->format && px->width == (uint32_t)like->width &&
        px->height == (uint32_t)like->height)
        return GLINT_OK;
    glint_fourcc_text(fourcc, want);
    glint_fourcc_text(px->pixelformat, got);
    return glint_error_report(
        error, GLINT_E_DEVICE, out->name,
        "accepts %s %u x %u, not %s %d x %d: the driver does not support this "
        "format, or another program uses the device",
        got, px->width, px->height, want, like->width, like->height);
}

/* Starts streaming, although frames are sent by write(2). This is needed for
 * v4l2loopback 0.12 with exclusive_caps=1: otherwise it accepts no output any
 * more after glint ends. Other drivers refuse because no buffers were
 * requested; this error is ignored. */
static void start_streaming(const struct glint_v4l2_sink *out)
{
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;

    glint_ioctl(out->fd, VIDIOC_STREAMON, &type);
}

/* Sets the rate that readers of the device see. Drivers may ignore it. */
static void set_frame_rate(const struct glint_v4l2_sink *out, int num, int den)
{
    struct v4l2_streamparm parm = {.type = V4L2_BUF_TYPE_VIDEO_OUTPUT};

    if (num < 1 || den < 1)
        return;
    parm.parm.output.timeperframe.numerator = (uint32_t)den;
    parm.parm.output.timeperframe.denominator = (uint32_t)num;
    glint_ioctl(out->fd, VIDIOC_S_PARM, &parm);
}

/* Sets the frame's layout and allocates its memory. All planes lie in one block
 * of SIZE bytes (0: not stated). Luma rows are STRIDE bytes apart; the strides
 * of chroma are in proportion. */
static enum glint_status set_frame_layout(struct glint_v4l2_sink *out,
                                          size_t stride, size_t size,
                                          struct glint_error *error)
{
    struct glint_image *const f = &out->frame;
    const size_t least = glint_image_row_bytes(f->format, 0, f->width);
    const int n_planes = glint_image_planes(f->format);
    size_t at[3];

    if (stride < least)
        stride = least;
    out->bytes = 0;
    for (int i = 0; i < n_planes; i++) {
        const size_t row = glint_image_row_bytes(f->format, i, f->width);
        const size_t each = i == 0                 ? stride
                            : 2 * row <= least + 1 ? stride / 2
                                                   : stride;

        at[i] = out->bytes;
        f->stride_bytes[i] = (ptrdiff_t)(each < row ? row : each);
        out->bytes += (size_t)f->stride_bytes[i] *
                      (size_t)glint_image_plane_height(f->format, i, f->height);
    }
    if (size && size < out->bytes)
        return glint_error_report(
            error, GLINT_E_DEVICE, out->name,
            "the driver requests frames of %zu bytes with rows of %zu bytes; "
            "%d x %d needs %zu bytes; choose another size",
            size, stride, f->width, f->height, out->bytes);
    out->mem = calloc(1, out->bytes);
    if (!out->mem)
        return glint_error_report(error, GLINT_E_MEMORY, out->name,
                                  "no memory for a %d x %d frame", f->width,
                                  f->height);
    for (int i = 0; i < n_planes; i++)
        f->plane[i] = out->mem + at[i];
    return GLINT_OK;
}

/* ------------------------------------------------------------------ frames */

static uintptr_t compute_plane_offset(const struct glint_image *image,
                                      int plane)
{
    return (uintptr_t)image->plane[plane] - (uintptr_t)image->plane[0];
}

static bool has_device_layout(const struct glint_v4l2_sink *out,
                              const struct glint_image *image)
{
    const struct glint_image *const f = &out->frame;

    for (int i = 0; i < glint_image_planes(f->format); i++)
        if (image->stride_bytes[i] != f->stride_bytes[i] ||
            compute_plane_offset(image, i) != compute_plane_offset(f, i))
            return false;
    return true;
}

static void copy_to_device_layout(const struct glint_v4l2_sink *out,
                                  const struct glint_image *image)
{
    const struct glint_image *const to = &out->frame;

    for (int i = 0; i < glint_image_planes(to->format); i++)
        for (int y = 0; y < glint_image_plane_height(to->format, i, to->height);
             y++)
            memcpy(to->plane[i] + y * to->stride_bytes[i],
                   image->plane[i] + y * image->stride_bytes[i],
                   glint_image_row_bytes(to->format, i, to->width));
}

static enum glint_status write_frame(struct glint_sink *sink,
                                     const struct glint_image *image,
                                     struct glint_error *error)
{
    struct glint_v4l2_sink *const out = (struct glint_v4l2_sink *)sink;
    const uint8_t *data = image->plane[0];
    ssize_t n;

    if (image->format != out->frame.format ||
        image->width != out->frame.width || image->height != out->frame.height)
        return glint_error_report(error, GLINT_E_DEVICE, out->name,
                                  "was opened for %d x %d pixels; a frame of "
                                  "another size or format came (%d x %d)",
                                  out->frame.width, out->frame.height,
                                  image->width, image->height);
    if (!has_device_layout(out, image)) {
        copy_to_device_layout(out, image);
        data = out->mem;
    }
    do
        n = write(out->fd, data, out->bytes);
    while (n < 0 && errno == EINTR);
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
        out->n_dropped++;
        return GLINT_OK;
    }
    if (n < 0)
        return report_request_failure(out, "write", error);
    if ((size_t)n < out->bytes)
        return glint_error_report(error, GLINT_E_DEVICE, out->name,
                                  "accepted %zu of %zu bytes of a frame",
                                  (size_t)n, out->bytes);
    out->n_frames++;
    return GLINT_OK;
}

static void close_v4l2_sink(struct glint_sink *sink)
{
    struct glint_v4l2_sink *const out = (struct glint_v4l2_sink *)sink;

    if (out->fd >= 0)
        close(out->fd);
    out->fd = -1;
    free(out->mem);
    out->mem = NULL;
}

enum glint_status glint_v4l2_sink_open(struct glint_v4l2_sink *out,
                                       const char *path,
                                       const struct glint_image *like,
                                       int fps_num, int fps_den,
                                       struct glint_error *error)
{
    const uint32_t fourcc = glint_fourcc_from_format(like->format);
    enum glint_status status = GLINT_OK;
    struct v4l2_format format;

    *out = (struct glint_v4l2_sink){
        .sink = {.put = write_frame, .close = close_v4l2_sink},
        .name = path,
        .fd = -1,
        .frame = *like};
    if (!fourcc)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                                  "V4L2 has no code for this pixel format");
    out->fd = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (out->fd < 0)
        status = report_request_failure(out, "open", error);
    if (!status)
        status = check_output_node(out, error);
    if (!status)
        status = set_output_format(out, fourcc, &format, error);
    if (!status)
        status = set_frame_layout(out, format.fmt.pix.bytesperline,
                                  format.fmt.pix.sizeimage, error);
    if (status) {
        close_v4l2_sink(&out->sink);
        return status;
    }
    set_frame_rate(out, fps_num, fps_den);
    start_streaming(out);
    return GLINT_OK;
}
