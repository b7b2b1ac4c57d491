/* SPDX-License-Identifier: MIT */
#include "linux/v4l2_device.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "jpeg/mjpeg.h"
#include "linux/fourcc.h"
#include "linux/request.h"
#include "posix/error.h"

/* Formats in order of preference, by the cost of drawing: packed Y'CbCr;
 * planes; RGB; JPEG, which must be decoded. Grey is last, because it has no
 * colours. */
static const uint32_t preferred[] = {
    V4L2_PIX_FMT_YUYV,   V4L2_PIX_FMT_UYVY,    V4L2_PIX_FMT_NV12,
    V4L2_PIX_FMT_NV21,   V4L2_PIX_FMT_YUV420,  V4L2_PIX_FMT_NV12M,
    V4L2_PIX_FMT_NV21M,  V4L2_PIX_FMT_YUV420M, V4L2_PIX_FMT_YUV422P,
    V4L2_PIX_FMT_XBGR32, V4L2_PIX_FMT_BGR32,   V4L2_PIX_FMT_BGR24,
    V4L2_PIX_FMT_RGB24,  V4L2_PIX_FMT_RGB565,  V4L2_PIX_FMT_MJPEG,
    V4L2_PIX_FMT_JPEG,   V4L2_PIX_FMT_GREY};

enum { N_PREFERRED = (int)(sizeof preferred / sizeof *preferred) };

static bool is_jpeg_fourcc(uint32_t fourcc)
{
    return fourcc == V4L2_PIX_FMT_MJPEG || fourcc == V4L2_PIX_FMT_JPEG;
}

static bool can_read_format(uint32_t fourcc)
{
    enum glint_pixel_format unused;

    return is_jpeg_fourcc(fourcc) ? glint_mjpeg_available()
                                  : glint_fourcc_to_format(fourcc, &unused);
}

static bool is_multiplanar(const struct glint_v4l2_device *d)
{
    return V4L2_TYPE_IS_MULTIPLANAR(d->type);
}

/* ---------------------------------------------------- choice of the format */

static bool has_device_frame_size(const struct glint_v4l2_device *d,
                                  uint32_t fourcc, uint32_t w, uint32_t h)
{
    struct v4l2_frmsizeenum size = {.pixel_format = fourcc};

    if (glint_ioctl(d->fd, VIDIOC_ENUM_FRAMESIZES, &size) < 0)
        /* The device does not list its frame sizes, so it may support W x H. */
        return true;
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

/* Returns whether the frame interval A is short enough for the requested rate,
 * with a tolerance of 0.5 %. The tolerance is needed because USB states
 * intervals in units of 100 ns, and because 29.97 frames per second are also
 * called 30. */
static bool is_interval_short_enough(const struct glint_v4l2_device *d,
                                     struct v4l2_fract a)
{
    return 200.0 * a.numerator * d->wish.fps_num <=
           201.0 * a.denominator * d->wish.fps_den;
}

static bool does_size_have_requested_rate(const struct glint_v4l2_device *d,
                                          uint32_t fourcc, uint32_t w,
                                          uint32_t h)
{
    struct v4l2_frmivalenum interval = {
        .pixel_format = fourcc, .width = w, .height = h};

    if (d->wish.fps_num == 0 ||
        glint_ioctl(d->fd, VIDIOC_ENUM_FRAMEINTERVALS, &interval) < 0)
        return true;
    if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE)
        return is_interval_short_enough(d, interval.stepwise.min);
    do {
        if (is_interval_short_enough(d, interval.discrete))
            return true;
        interval.index++;
    } while (glint_ioctl(d->fd, VIDIOC_ENUM_FRAMEINTERVALS, &interval) == 0);
    return false;
}

/* Returns the formats that the device has and glint can read, as a bit mask:
 * bit i stands for preferred[i]. */
static uint32_t find_offered_formats(const struct glint_v4l2_device *d)
{
    struct v4l2_fmtdesc f = {.type = d->type};
    uint32_t have = 0;

    for (; glint_ioctl(d->fd, VIDIOC_ENUM_FMT, &f) == 0; f.index++)
        for (int i = 0; i < N_PREFERRED; i++)
            if (f.pixelformat == preferred[i] && can_read_format(f.pixelformat))
                have |= UINT32_C(1) << i;
    return have;
}

/* Returns the first format of preferred[] that the device has in size W x H at
 * the requested rate. If there is none, returns the first format of preferred[]
 * that the device has in any size. Returns 0 if glint can read none of the
 * device's formats. */
static uint32_t choose_offered_format(const struct glint_v4l2_device *d,
                                      uint32_t w, uint32_t h)
{
    const uint32_t have = find_offered_formats(d);
    uint32_t first = 0, sized = 0;

    for (int i = N_PREFERRED - 1; i >= 0; i--) {
        if (!(have >> i & 1))
            continue;
        first = preferred[i];
        if (has_device_frame_size(d, first, w, h) &&
            does_size_have_requested_rate(d, first, w, h))
            sized = first;
    }
    return sized ? sized : first;
}

/* ------------------------------------------------------------------- format */

struct pix { /* members that the single-planar and multi-planar struct
                v4l2_format share */
    uint32_t width, height, fourcc, n_blocks, stride_bytes[3], bytes[3];
    struct glint_v4l2_colour colour;
};

static struct pix read_members_of_v4l2_format(const struct v4l2_format *f,
                                              bool multiplanar)
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

static void write_members_of_v4l2_format(struct v4l2_format *f,
                                         bool multiplanar, uint32_t fourcc,
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

/* Sets the planes of F from PIX. Returns false if the planes do not fit into
 * the blocks of F, or there is neither one block nor one per plane. If there is
 * only one block, the planes follow each other in it, and the strides of chroma
 * are computed from the stride of luma. */
static bool set_format_planes(struct glint_v4l2_format *f,
                              const struct pix *pix)
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
        if (stride < row) /* some drivers set the stride to 0 */
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

static void set_format_colour(struct glint_v4l2_device *d,
                              const struct glint_v4l2_colour *colour)
{
    struct glint_v4l2_format *f = &d->format;
    struct glint_image image = {.format = f->is_jpeg ? GLINT_I420 : f->pixels};

    glint_v4l2_colour_to_image(colour, &image);
    /* JPEG frames have the colours of JFIF, even if the driver states
     * others. */
    if (f->is_jpeg) {
        image.range = GLINT_RANGE_FULL;
        image.matrix = GLINT_MATRIX_BT601;
    }
    f->range =
        d->wish.range < 0 ? image.range : (enum glint_range)d->wish.range;
    f->matrix =
        d->wish.matrix < 0 ? image.matrix : (enum glint_matrix)d->wish.matrix;
    f->transfer = image.transfer;
}

static enum glint_status adopt_device_format(struct glint_v4l2_device *d,
                                             const struct pix *pix,
                                             struct glint_error *error)
{
    struct glint_v4l2_format *f = &d->format;
    char name[5];

    glint_fourcc_text(pix->fourcc, name);
    *f = (struct glint_v4l2_format){.fourcc = pix->fourcc,
                                    .is_jpeg = is_jpeg_fourcc(pix->fourcc),
                                    .width = (int)pix->width,
                                    .height = (int)pix->height,
                                    .n_blocks = (int)pix->n_blocks};
    if (pix->width < 1 || pix->width > GLINT_PANEL_SIDE || pix->height < 1 ||
        pix->height > GLINT_PANEL_SIDE || pix->n_blocks < 1 ||
        pix->n_blocks > 3)
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, d->path,
            "delivers pictures of %ux%u pixels in %u blocks of memory; glint "
            "supports 1 to %d pixels a side and 1 to 3 blocks",
            pix->width, pix->height, pix->n_blocks, GLINT_PANEL_SIDE);
    for (int i = 0; i < f->n_blocks; i++)
        f->block_bytes[i] = pix->bytes[i];
    if (!f->is_jpeg && !glint_fourcc_to_format(pix->fourcc, &f->pixels))
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, d->path,
            "delivers pixel format %s, which glint does not support; "
            "--list-formats lists the formats of this camera",
            name);
    if (!f->is_jpeg && !set_format_planes(f, pix))
        return glint_error_report(
            error, GLINT_E_DEVICE, d->path,
            "%ux%u %s needs more bytes than the %u that the driver reports",
            pix->width, pix->height, name, pix->bytes[0]);
    set_format_colour(d, &pix->colour);
    return GLINT_OK;
}

/* Requests the configured format, and adopts the format with which the device
 * answers. Returns the errors of glint_v4l2_device_open(). */
static enum glint_status request_format(struct glint_v4l2_device *d,
                                        struct glint_error *error)
{
    const bool multiplanar = is_multiplanar(d);
    struct v4l2_format f = {.type = d->type};
    uint32_t fourcc = d->wish.fourcc;
    struct pix pix;

    if (glint_ioctl(d->fd, VIDIOC_G_FMT, &f) < 0)
        return glint_report_ioctl_error(error, d->path, "VIDIOC_G_FMT");
    pix = read_members_of_v4l2_format(&f, multiplanar);
    if (d->wish.width) {
        pix.width = (uint32_t)d->wish.width;
        pix.height = (uint32_t)d->wish.height;
    }
    if (!fourcc)
        fourcc = choose_offered_format(d, pix.width, pix.height);
    write_members_of_v4l2_format(&f, multiplanar, fourcc ? fourcc : pix.fourcc,
                                 pix.width, pix.height);
    if (glint_ioctl(d->fd, VIDIOC_S_FMT, &f) < 0)
        return glint_report_ioctl_error(error, d->path, "VIDIOC_S_FMT");
    pix = read_members_of_v4l2_format(&f, multiplanar);
    if (d->wish.fourcc && pix.fourcc != d->wish.fourcc) {
        char asked[5], got[5];

        glint_fourcc_text(d->wish.fourcc, asked);
        glint_fourcc_text(pix.fourcc, got);
        return glint_error_report(
            error, GLINT_E_DEVICE, d->path,
            "does not support %s (the driver returns %s instead); "
            "--list-formats lists the formats of this camera",
            asked, got);
    }
    return adopt_device_format(d, &pix, error);
}

static bool is_positive_int(uint32_t n)
{
    return n >= 1 && n <= INT32_MAX;
}

/* Requests the frame rate of d->wish, unless it is 0, and stores the rate that
 * the device reports; some inputs have a fixed rate. */
static void request_frame_rate(struct glint_v4l2_device *d)
{
    struct v4l2_streamparm parm = {.type = d->type};
    struct v4l2_fract *t = &parm.parm.capture.timeperframe;

    if (d->wish.fps_num) {
        t->numerator = (uint32_t)d->wish.fps_den;
        t->denominator = (uint32_t)d->wish.fps_num;
        glint_ioctl(d->fd, VIDIOC_S_PARM, &parm);
    }
    if (glint_ioctl(d->fd, VIDIOC_G_PARM, &parm) == 0 &&
        is_positive_int(t->numerator) && is_positive_int(t->denominator)) {
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

/* ------------------------------------------------------------------- device */

static enum glint_status open_device_node(struct glint_v4l2_device *d,
                                          struct glint_error *error)
{
    struct stat st;

    if (stat(d->path, &st) < 0)
        return glint_error_report(
            error, GLINT_E_DEVICE, d->path, "%s",
            errno == ENOENT ? "no such device; --list-devices shows the cameras"
                            : strerror(errno));
    if (!S_ISCHR(st.st_mode))
        return glint_error_report(error, GLINT_E_DEVICE, d->path,
                                  "not a device");
    d->fd = open(d->path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return d->fd < 0
               ? glint_report_ioctl_error(error, d->path, "cannot be opened")
               : GLINT_OK;
}

/* Opens the device NAME and reads its capabilities and name, without changing
 * settings. On failure D is closed. */
static enum glint_status open_device_by_name(struct glint_v4l2_device *d,
                                             const char *name,
                                             struct glint_error *error)
{
    struct v4l2_capability cap = {.driver = ""};
    enum glint_status status;

    *d = (struct glint_v4l2_device){.fd = -1, .has_signal = true};
    if (snprintf(d->path, sizeof d->path, "%s%s",
                 isdigit((unsigned char)*name) ? "/dev/video" : "",
                 name) >= GLINT_V4L2_PATH)
        return glint_error_report(
            error, GLINT_E_DEVICE, name,
            "the name of the device is too long (max %d bytes)",
            GLINT_V4L2_PATH - 1);
    status = open_device_node(d, error);
    if (status != GLINT_OK)
        return status;
    if (glint_ioctl(d->fd, VIDIOC_QUERYCAP, &cap) < 0) {
        status =
            errno == ENODEV
                ? glint_report_ioctl_error(error, d->path, "VIDIOC_QUERYCAP")
                : glint_error_report(
                      error, GLINT_E_DEVICE, d->path,
                      "not a camera: the device does not support V4L2; "
                      "--list-devices shows the cameras");
        glint_v4l2_device_close(d);
        return status;
    }
    d->caps = cap.capabilities & V4L2_CAP_DEVICE_CAPS ? cap.device_caps
                                                      : cap.capabilities;
    d->type = d->caps & V4L2_CAP_VIDEO_CAPTURE
                  ? V4L2_BUF_TYPE_VIDEO_CAPTURE
                  : V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
    snprintf(d->card, sizeof d->card, "%s", (const char *)cap.card);
    d->is_loopback = strcmp((const char *)cap.driver, "v4l2 loopback") == 0;
    if (d->caps & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE))
        return GLINT_OK;
    glint_v4l2_device_close(d);
    return glint_error_report(
        error, GLINT_E_DEVICE, d->path,
        "not a camera: the device '%s' does not capture pictures",
        (const char *)cap.card);
}

void glint_v4l2_device_close(struct glint_v4l2_device *d)
{
    if (d->fd >= 0)
        close(d->fd);
    d->fd = -1;
}

/* -------------------------------------------------------------------- input */

static void read_current_input(struct glint_v4l2_device *d)
{
    struct v4l2_input input = {.index = 0};
    int index = 0;

    if (glint_ioctl(d->fd, VIDIOC_G_INPUT, &index) < 0)
        return;
    d->input = input.index = (uint32_t)index;
    if (glint_ioctl(d->fd, VIDIOC_ENUMINPUT, &input) == 0)
        d->is_dv = input.capabilities & V4L2_IN_CAP_DV_TIMINGS;
}

/* Drivers whose source never changes refuse with EINVAL, which is ignored. */
static void subscribe_to_source_changes(const struct glint_v4l2_device *d)
{
    struct v4l2_event_subscription wanted = {.type = V4L2_EVENT_SOURCE_CHANGE,
                                             .id = d->input};

    glint_ioctl(d->fd, VIDIOC_SUBSCRIBE_EVENT, &wanted);
}

static enum glint_status select_input(struct glint_v4l2_device *d,
                                      struct glint_error *error)
{
    int index = d->wish.input;

    if (index >= 0 && glint_ioctl(d->fd, VIDIOC_S_INPUT, &index) < 0)
        return errno == EINVAL
                   ? glint_error_report(
                         error, GLINT_E_DEVICE, d->path,
                         "has no input %d; --list-devices lists them",
                         d->wish.input)
                   : glint_report_ioctl_error(error, d->path, "VIDIOC_S_INPUT");
    read_current_input(d);
    subscribe_to_source_changes(d);
    return GLINT_OK;
}

static bool has_same_timings(const struct v4l2_bt_timings *a,
                             const struct v4l2_bt_timings *b)
{
    return a->width == b->width && a->height == b->height &&
           a->pixelclock == b->pixelclock && a->interlaced == b->interlaced;
}

bool glint_v4l2_device_has_new_timings(struct glint_v4l2_device *d)
{
    struct v4l2_dv_timings now, set;

    if (!d->is_dv)
        return false;
    d->has_signal = glint_ioctl(d->fd, VIDIOC_QUERY_DV_TIMINGS, &now) == 0;
    return d->has_signal &&
           glint_ioctl(d->fd, VIDIOC_G_DV_TIMINGS, &set) == 0 &&
           !has_same_timings(&now.bt, &set.bt);
}

/* Sets an HDMI input to the timings that it receives, as drivers do not adopt
 * new timings on their own. Sets d->has_signal. */
static enum glint_status adopt_received_timings(struct glint_v4l2_device *d,
                                                struct glint_error *error)
{
    struct v4l2_dv_timings now;

    if (!d->is_dv)
        return GLINT_OK;
    d->has_signal = glint_ioctl(d->fd, VIDIOC_QUERY_DV_TIMINGS, &now) == 0;
    if (d->has_signal && glint_ioctl(d->fd, VIDIOC_S_DV_TIMINGS, &now) < 0)
        return glint_report_ioctl_error(error, d->path, "VIDIOC_S_DV_TIMINGS");
    return GLINT_OK;
}

enum glint_status glint_v4l2_device_negotiate(struct glint_v4l2_device *d,
                                              struct glint_error *error)
{
    enum glint_status status = adopt_received_timings(d, error);

    if (status == GLINT_OK)
        status = request_format(d, error);
    if (status == GLINT_OK)
        request_frame_rate(d);
    return status;
}

enum glint_status glint_v4l2_device_open(struct glint_v4l2_device *d,
                                         const struct glint_v4l2_config *wish,
                                         struct glint_error *error)
{
    enum glint_status status = open_device_by_name(d, wish->device, error);

    if (status != GLINT_OK)
        return status;
    d->wish = *wish;
    status = select_input(d, error);
    if (status == GLINT_OK)
        status = glint_v4l2_device_negotiate(d, error);
    if (status != GLINT_OK)
        glint_v4l2_device_close(d);
    return status;
}

enum { MAX_NODES = 256 };

/* ------------------------------------------------------------------ devices */

static int compare_numbers(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* Sets NUMBER to the numbers N of all device nodes /dev/videoN, in rising
 * order. Returns how many there are, at most MAX_NODES. */
static int list_device_numbers(int number[MAX_NODES])
{
    DIR *dev = opendir("/dev");
    const struct dirent *entry;
    int n = 0;

    if (!dev)
        return 0;
    while (n < MAX_NODES && (entry = readdir(dev))) {
        char *end;

        if (strncmp(entry->d_name, "video", 5) != 0)
            continue;
        number[n] = (int)strtol(entry->d_name + 5, &end, 10);
        n += end > entry->d_name + 5 && *end == '\0';
    }
    closedir(dev);
    qsort(number, (size_t)n, sizeof *number, compare_numbers);
    return n;
}

static void print_json_string(FILE *out, const char *text)
{
    putc('"', out);
    for (; *text; text++)
        if (*text == '"' || *text == '\\')
            fprintf(out, "\\%c", *text);
        else
            putc((unsigned char)*text < 32 ? ' ' : *text, out);
    putc('"', out);
}

static void print_device_inputs(FILE *out, const struct glint_v4l2_device *d,
                                bool json)
{
    struct v4l2_input input = {.index = 0};

    for (; glint_ioctl(d->fd, VIDIOC_ENUMINPUT, &input) == 0; input.index++) {
        if (json) {
            fprintf(out, "%s", input.index ? ", " : "");
            print_json_string(out, (const char *)input.name);
        } else
            fprintf(out, "    --input %u  %s\n", input.index,
                    (const char *)input.name);
    }
}

static void print_device(FILE *out, const struct glint_v4l2_device *d,
                         bool json, int n_before)
{
    if (!json) {
        fprintf(out, "%s  %s\n", d->path, d->card);
        print_device_inputs(out, d, false);
        return;
    }
    fprintf(out, "%s\n  {\"device\": ", n_before ? "," : "");
    print_json_string(out, d->path);
    fputs(", \"card\": ", out);
    print_json_string(out, d->card);
    fputs(", \"inputs\": [", out);
    print_device_inputs(out, d, true);
    fputs("]}", out);
}

enum glint_status glint_v4l2_list_devices(FILE *out, bool json)
{
    int number[MAX_NODES], n_cameras = 0, n_refused = 0;
    const int n = list_device_numbers(number);
    struct glint_error why = {""}, error;

    fputs(json ? "{\"devices\": [" : "", out);
    for (int i = 0; i < n; i++) {
        struct glint_v4l2_device d;
        char name[16];

        snprintf(name, sizeof name, "%d", number[i]);
        if (open_device_by_name(&d, name, &error) != GLINT_OK) {
            n_refused++;
            why = error;
            continue;
        }
        print_device(out, &d, json, n_cameras++);
        glint_v4l2_device_close(&d);
    }
    if (json)
        fputs("\n]}\n", out);
    else if (n_cameras == 0)
        fprintf(out, "no camera: %s\n",
                n == 0 ? "there is no /dev/video*" : why.text);
    else if (n_refused)
        fprintf(out, "%d more node%s of /dev/video* capture%s no pictures\n",
                n_refused, n_refused == 1 ? "" : "s",
                n_refused == 1 ? "s" : "");
    return GLINT_OK;
}

/* ------------------------------------------------------------------ formats */

static double compute_frame_rate(struct v4l2_fract interval)
{
    return interval.numerator
               ? (double)interval.denominator / interval.numerator
               : 0;
}

static void print_frame_rates(FILE *out, const struct glint_v4l2_device *d,
                              uint32_t fourcc, uint32_t width, uint32_t height,
                              bool json)
{
    struct v4l2_frmivalenum i = {
        .pixel_format = fourcc, .width = width, .height = height};

    fputs(json ? "\"fps\": [" : "", out);
    while (glint_ioctl(d->fd, VIDIOC_ENUM_FRAMEINTERVALS, &i) == 0) {
        if (i.type == V4L2_FRMIVAL_TYPE_DISCRETE)
            fprintf(out, json ? "%s%.5g" : "%s%.4g", i.index ? ", " : "",
                    compute_frame_rate(i.discrete));
        else
            fprintf(out, json ? "%.5g, %.5g" : "%.4g to %.4g",
                    compute_frame_rate(i.stepwise.max),
                    compute_frame_rate(i.stepwise.min));
        i.index++;
        if (i.type != V4L2_FRMIVAL_TYPE_DISCRETE)
            break;
    }
    fputs(json ? "]" : i.index ? " fps\n" : "\n", out);
}

static void print_frame_size(FILE *out, const struct glint_v4l2_device *d,
                             const struct v4l2_frmsizeenum *size, bool json)
{
    const bool discrete = size->type == V4L2_FRMSIZE_TYPE_DISCRETE;
    const uint32_t w =
        discrete ? size->discrete.width : size->stepwise.max_width;
    const uint32_t h =
        discrete ? size->discrete.height : size->stepwise.max_height;

    if (json)
        fprintf(out, "%s{\"width\": %u, \"height\": %u, ",
                size->index ? ", " : "", w, h);
    else
        fprintf(out, "    %s%ux%u  ", discrete ? "" : "up to ", w, h);
    print_frame_rates(out, d, size->pixel_format, w, h, json);
    fputs(json ? "}" : "", out);
}

static void print_frame_sizes(FILE *out, const struct glint_v4l2_device *d,
                              uint32_t fourcc, bool json)
{
    struct v4l2_frmsizeenum size = {.pixel_format = fourcc};

    for (; glint_ioctl(d->fd, VIDIOC_ENUM_FRAMESIZES, &size) == 0;
         size.index++) {
        print_frame_size(out, d, &size, json);
        if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE)
            return;
    }
}

static void print_pixel_format(FILE *out, const struct glint_v4l2_device *d,
                               const struct v4l2_fmtdesc *f, bool json)
{
    const bool is_read = can_read_format(f->pixelformat);
    char name[5];

    glint_fourcc_text(f->pixelformat, name);
    if (json) {
        fprintf(out, "%s\n  {\"format\": ", f->index ? "," : "");
        print_json_string(out, name);
        fprintf(out, ", \"read\": %s, \"sizes\": [",
                is_read ? "true" : "false");
        print_frame_sizes(out, d, f->pixelformat, true);
        fputs("]}", out);
    } else if (is_read) {
        fprintf(out, "%s  %s\n", name, (const char *)f->description);
        print_frame_sizes(out, d, f->pixelformat, false);
    }
}

enum glint_status glint_v4l2_list_formats(FILE *out, const char *device,
                                          bool json, struct glint_error *error)
{
    struct glint_v4l2_device d;
    const enum glint_status status = open_device_by_name(&d, device, error);
    struct v4l2_fmtdesc f = {.type = d.type};

    if (status != GLINT_OK)
        return status;
    fputs(json ? "{\"formats\": [" : "", out);
    for (; glint_ioctl(d.fd, VIDIOC_ENUM_FMT, &f) == 0; f.index++)
        print_pixel_format(out, &d, &f, json);
    fputs(json ? "\n]}\n" : "", out);
    glint_v4l2_device_close(&d);
    return GLINT_OK;
}
