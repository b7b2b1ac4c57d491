/* SPDX-License-Identifier: MIT */
#include "linux/v4l2_format.h"

#include <linux/videodev2.h>
#include <stdio.h>
#include <string.h>

#include "jpeg/mjpeg.h"
#include "linux/fourcc.h"
#include "linux/request.h"
#include "posix/error.h"
#include "source_sink.h"

/* Formats in order of preference: two bytes a pixel that are drawn into where
 * they lie, planes, RGB, JPEG, which has to be decoded, and grey, which has no
 * colours. */
static const uint32_t preferred[] = {
    V4L2_PIX_FMT_YUYV,   V4L2_PIX_FMT_UYVY,    V4L2_PIX_FMT_NV12,
    V4L2_PIX_FMT_NV21,   V4L2_PIX_FMT_YUV420,  V4L2_PIX_FMT_NV12M,
    V4L2_PIX_FMT_NV21M,  V4L2_PIX_FMT_YUV420M, V4L2_PIX_FMT_YUV422P,
    V4L2_PIX_FMT_XBGR32, V4L2_PIX_FMT_BGR32,   V4L2_PIX_FMT_BGR24,
    V4L2_PIX_FMT_RGB24,  V4L2_PIX_FMT_RGB565,  V4L2_PIX_FMT_MJPEG,
    V4L2_PIX_FMT_JPEG,   V4L2_PIX_FMT_GREY};

enum { N_PREFERRED = (int)(sizeof preferred / sizeof *preferred) };

static bool is_jpeg(uint32_t fourcc)
{
    return fourcc == V4L2_PIX_FMT_MJPEG || fourcc == V4L2_PIX_FMT_JPEG;
}

bool glint_v4l2_is_read(uint32_t fourcc)
{
    enum glint_pixel_format unused;

    return is_jpeg(fourcc) ? glint_mjpeg_available()
                           : glint_fourcc_to_format(fourcc, &unused);
}

static bool is_multiplanar(const struct glint_v4l2_device *d)
{
    return V4L2_TYPE_IS_MULTIPLANAR(d->type);
}

/* ----------------------------------------------------- the cheapest format */

static bool has_size(const struct glint_v4l2_device *d, uint32_t fourcc,
                     uint32_t w, uint32_t h)
{
    struct v4l2_frmsizeenum size = {.pixel_format = fourcc};

    if (glint_ioctl(d->fd, VIDIOC_ENUM_FRAMESIZES, &size) < 0)
        return true; /* The device does not say; it may have the size. */
    if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE)
        return w >= size.stepwise.min_width && w <= size.stepwise.max_width &&
               h >= size.stepwise.min_height && h <= size.stepwise.max_height;
    do {
        if (size.discrete.width == w && size.discrete.height == h)
            return true;
        size.index++;
    } while (glint_ioctl(d->fd, VIDIOC_ENUM_FRAMESIZES, &size) == 0);
    return false;
}

/* Checks whether the interval A is no longer than that of the rate wished for,
 * but for one part in 200: USB has units of 100 ns, and 29.97 is also called
 * 30. */
static bool is_fast(const struct glint_v4l2_device *d, struct v4l2_fract a)
{
    return 200.0 * a.numerator * d->wish.fps_num <=
           201.0 * a.denominator * d->wish.fps_den;
}

static bool has_rate(const struct glint_v4l2_device *d, uint32_t fourcc,
                     uint32_t w, uint32_t h)
{
    struct v4l2_frmivalenum interval = {
        .pixel_format = fourcc, .width = w, .height = h};

    if (d->wish.fps_num == 0 ||
        glint_ioctl(d->fd, VIDIOC_ENUM_FRAMEINTERVALS, &interval) < 0)
        return true;
    if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE)
        return is_fast(d, interval.stepwise.min);
    do {
        if (is_fast(d, interval.discrete))
            return true;
        interval.index++;
    } while (glint_ioctl(d->fd, VIDIOC_ENUM_FRAMEINTERVALS, &interval) == 0);
    return false;
}

/* Returns a mask whose bit i is set if the device has preferred[i] and glint
 * reads it. */
static uint32_t offered(const struct glint_v4l2_device *d)
{
    struct v4l2_fmtdesc f = {.type = d->type};
    uint32_t have = 0;

    for (; glint_ioctl(d->fd, VIDIOC_ENUM_FMT, &f) == 0; f.index++)
        for (int i = 0; i < N_PREFERRED; i++)
            if (f.pixelformat == preferred[i] &&
                glint_v4l2_is_read(f.pixelformat))
                have |= UINT32_C(1) << i;
    return have;
}

/* Returns the first of preferred[] that the device has in W x H at the rate
 * wished for; if none, the first that it has; 0 if glint reads none of its
 * formats. */
static uint32_t cheapest(const struct glint_v4l2_device *d, uint32_t w,
                         uint32_t h)
{
    const uint32_t have = offered(d);
    uint32_t first = 0, sized = 0;

    for (int i = N_PREFERRED - 1; i >= 0; i--) {
        if (!(have >> i & 1))
            continue;
        first = preferred[i];
        if (has_size(d, first, w, h) && has_rate(d, first, w, h))
            sized = first;
    }
    return sized ? sized : first;
}

/* ------------------------------------------------------------------- format */

struct pix { /* the members that both kinds of struct v4l2_format have */
    uint32_t width, height, fourcc, n_blocks, stride_bytes[3], bytes[3];
    struct glint_v4l2_colour colour;
};

static struct pix read_pix(const struct v4l2_format *f, bool multiplanar)
{
    const struct v4l2_pix_format *p = &f->fmt.pix;
    const struct v4l2_pix_format_mplane *m = &f->fmt.pix_mp;
    struct pix pix = {
        .width = p->width,
        .height = p->height,
        .fourcc = p->pixelformat,
        .n_blocks = 1,
        .stride_bytes = {p->bytesperline},
        .bytes = {p->sizeimage},
        .colour = {p->colorspace, p->ycbcr_enc, p->quantization, p->xfer_func}};

    if (!multiplanar)
        return pix;
    pix.width = m->width;
    pix.height = m->height;
    pix.fourcc = m->pixelformat;
    pix.n_blocks = m->num_planes;
    for (uint32_t i = 0; i < pix.n_blocks && i < 3; i++) {
        pix.stride_bytes[i] = m->plane_fmt[i].bytesperline;
        pix.bytes[i] = m->plane_fmt[i].sizeimage;
    }
    pix.colour = (struct glint_v4l2_colour){m->colorspace, m->ycbcr_enc,
                                            m->quantization, m->xfer_func};
    return pix;
}

static void write_pix(struct v4l2_format *f, bool multiplanar, uint32_t fourcc,
                      uint32_t width, uint32_t height)
{
    if (multiplanar) {
        f->fmt.pix_mp.pixelformat = fourcc;
        f->fmt.pix_mp.width = width;
        f->fmt.pix_mp.height = height;
        memset(f->fmt.pix_mp.plane_fmt, 0, sizeof f->fmt.pix_mp.plane_fmt);
    } else {
        f->fmt.pix.pixelformat = fourcc;
        f->fmt.pix.width = width;
        f->fmt.pix.height = height;
        f->fmt.pix.bytesperline = f->fmt.pix.sizeimage = 0;
    }
}

/* Sets the planes of F from PIX, or returns false if they do not fit its
 * blocks. A single block holds the planes one after the other, and strides of
 * chroma follow from that of luma. */
static bool lay_out(struct glint_v4l2_format *f, const struct pix *pix)
{
    const int n = glint_image_planes(f->pixels);
    uint64_t offset = 0; /* 64 bits, as a driver may state any size */

    if (f->n_blocks != 1 && f->n_blocks != n)
        return false;
    for (int p = 0; p < n; p++) {
        const size_t row = glint_image_row_bytes(f->pixels, p, f->width);
        const uint64_t rows =
            (uint64_t)glint_image_plane_height(f->pixels, p, f->height);
        const int block = f->n_blocks == 1 ? 0 : p;
        uint64_t stride = pix->stride_bytes[block], bytes;

        if (f->n_blocks == 1 && p > 0 && n == 3)
            stride /= 2;
        if (stride < row) /* some drivers leave it 0 */
            stride = row;
        bytes = (rows - 1) * stride + row;
        if (offset + bytes > f->block_bytes[block])
            return false;
        f->plane[p].block = block;
        f->plane[p].offset = (size_t)offset;
        f->plane[p].stride_bytes = (ptrdiff_t)stride;
        f->plane[p].bytes = (size_t)bytes;
        offset += f->n_blocks == 1 ? rows * stride : 0;
    }
    return true;
}

static void take_colour(struct glint_v4l2_device *d,
                        const struct glint_v4l2_colour *colour)
{
    struct glint_v4l2_format *f = &d->format;
    struct glint_image image = {.format = f->is_jpeg ? GLINT_I420 : f->pixels};

    glint_v4l2_colour_read(colour, &image);
    if (f->is_jpeg) { /* as JFIF has it, whatever the driver says */
        image.range = GLINT_RANGE_FULL;
        image.matrix = GLINT_MATRIX_BT601;
    }
    f->range =
        d->wish.range < 0 ? image.range : (enum glint_range)d->wish.range;
    f->matrix =
        d->wish.matrix < 0 ? image.matrix : (enum glint_matrix)d->wish.matrix;
    f->transfer = image.transfer;
}

static enum glint_status take_format(struct glint_v4l2_device *d,
                                     const struct pix *pix,
                                     struct glint_error *error)
{
    struct glint_v4l2_format *f = &d->format;
    char name[5];

    glint_fourcc_text(pix->fourcc, name);
    *f = (struct glint_v4l2_format){.fourcc = pix->fourcc,
                                    .is_jpeg = is_jpeg(pix->fourcc),
                                    .width = (int)pix->width,
                                    .height = (int)pix->height,
                                    .n_blocks = (int)pix->n_blocks};
    if (pix->width < 1 || pix->width > GLINT_PANEL_SIDE || pix->height < 1 ||
        pix->height > GLINT_PANEL_SIDE || pix->n_blocks < 1 ||
        pix->n_blocks > 3)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, d->path,
                                  "pictures of %ux%u", pix->width, pix->height);
    for (int i = 0; i < f->n_blocks; i++)
        f->block_bytes[i] = pix->bytes[i];
    if (!f->is_jpeg && !glint_fourcc_to_format(pix->fourcc, &f->pixels))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, d->path,
                                  "delivers %s, which glint does not read; "
                                  "--list-formats shows what there is",
                                  name);
    if (!f->is_jpeg && !lay_out(f, pix))
        return glint_error_report(error, GLINT_E_DEVICE, d->path,
                                  "%ux%u %s does not fit the %u bytes that the "
                                  "driver says it has",
                                  pix->width, pix->height, name, pix->bytes[0]);
    take_colour(d, &pix->colour);
    return GLINT_OK;
}

enum glint_status glint_v4l2_set_format(struct glint_v4l2_device *d,
                                        struct glint_error *error)
{
    const bool multiplanar = is_multiplanar(d);
    struct v4l2_format f = {.type = d->type};
    uint32_t fourcc = d->wish.fourcc;
    struct pix pix;

    if (glint_ioctl(d->fd, VIDIOC_G_FMT, &f) < 0)
        return glint_ioctl_failed(error, d->path, "VIDIOC_G_FMT");
    pix = read_pix(&f, multiplanar);
    if (d->wish.width) {
        pix.width = (uint32_t)d->wish.width;
        pix.height = (uint32_t)d->wish.height;
    }
    if (!fourcc)
        fourcc = cheapest(d, pix.width, pix.height);
    write_pix(&f, multiplanar, fourcc ? fourcc : pix.fourcc, pix.width,
              pix.height);
    if (glint_ioctl(d->fd, VIDIOC_S_FMT, &f) < 0)
        return glint_ioctl_failed(error, d->path, "VIDIOC_S_FMT");
    pix = read_pix(&f, multiplanar);
    if (d->wish.fourcc && pix.fourcc != d->wish.fourcc) {
        char asked[5], got[5];

        glint_fourcc_text(d->wish.fourcc, asked);
        glint_fourcc_text(pix.fourcc, got);
        return glint_error_report(error, GLINT_E_DEVICE, d->path,
                                  "has no %s (gives %s instead); "
                                  "--list-formats shows what there is",
                                  asked, got);
    }
    return take_format(d, &pix, error);
}

static bool is_count(uint32_t n)
{
    return n >= 1 && n <= INT32_MAX;
}

void glint_v4l2_set_rate(struct glint_v4l2_device *d)
{
    struct v4l2_streamparm parm = {.type = d->type};
    struct v4l2_fract *t = &parm.parm.capture.timeperframe;

    if (d->wish.fps_num) {
        t->numerator = (uint32_t)d->wish.fps_den;
        t->denominator = (uint32_t)d->wish.fps_num;
        glint_ioctl(d->fd, VIDIOC_S_PARM, &parm);
    }
    if (glint_ioctl(d->fd, VIDIOC_G_PARM, &parm) == 0 &&
        is_count(t->numerator) && is_count(t->denominator)) {
        d->format.fps_num = (int)t->denominator;
        d->format.fps_den = (int)t->numerator;
    }
}

void glint_v4l2_format_text(const struct glint_v4l2_format *f, char text[96])
{
    char name[5], rate[32] = "";

    glint_fourcc_text(f->fourcc, name);
    if (f->fps_num)
        snprintf(rate, sizeof rate, " at %g fps",
                 (double)f->fps_num / f->fps_den);
    snprintf(text, 96, "%s %dx%d%s, %s %s, %s", name, f->width, f->height, rate,
             f->matrix == GLINT_MATRIX_BT601 ? "BT.601" : "BT.709",
             f->range == GLINT_RANGE_FULL ? "full" : "limited",
             f->transfer == GLINT_TONE_SRGB ? "sRGB" : "BT.709 transfer");
}
