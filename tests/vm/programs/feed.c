/* SPDX-License-Identifier: MIT
 *
 * feed [-c CAMERA] [-n COUNT] [-r FPS] [-t] DEVICE FOURCC WxH FILE... - writes
 * the frames of files, in a loop, to a video output, so that a camera's frames
 * are known bit by bit. -t: the frames are declared to have BT.709's transfer
 * curve, like y4m video.
 *
 * DEVICE is vivid's output, whose HDMI socket is then connected to CAMERA's
 * HDMI input (same timings and format on both, no text overlay), or a node of
 * v4l2loopback. An uncompressed file contains one or more frames; a file of
 * MJPG or JPEG is one frame, of any bytes. Without -r, vivid's timings set the
 * frame rate. When the device has accepted more frames than it has buffers, the
 * file /tmp/fed is created.
 */
#include <sys/mman.h>

#include "device.h"

#define N_BUFFERS 3

struct frame {
    const uint8_t *bytes;
    size_t n_bytes;
};

struct feed {
    int fd;
    size_t image_bytes; /* size of a buffer */
    /* bytes per frame in a file; 0: compressed, one frame per file */
    size_t packed_bytes;
    struct frame *frame;
    int n_frames;
    /* number of buffers of the device; 0: frames are written by write() */
    uint32_t n_buffers;
    uint8_t *memory[N_BUFFERS];
};

static void add_frame_bytes(struct feed *feed, const uint8_t *bytes,
                            size_t n_bytes)
{
    feed->frame = realloc(feed->frame,
                          (size_t)(feed->n_frames + 1) * sizeof *feed->frame);
    if (!feed->frame)
        die("no memory");
    feed->frame[feed->n_frames++] = (struct frame){bytes, n_bytes};
}

static void add_frame_file(struct feed *feed, const char *path)
{
    size_t n_bytes;
    const uint8_t *bytes = read_file(path, &n_bytes);
    size_t step = feed->packed_bytes ? feed->packed_bytes : n_bytes;
    if (step > feed->image_bytes)
        die("%s: more than the %zu bytes of a frame", path, feed->image_bytes);
    if (feed->packed_bytes && (n_bytes == 0 || n_bytes % step != 0))
        die("%s: %zu bytes are no whole frames of %zu", path, n_bytes, step);
    size_t at = 0;
    do { /* an empty file is one empty frame */
        add_frame_bytes(feed, bytes + at, step);
        at += step;
    } while (at < n_bytes);
}

/* Declares the transfer curve of BT.709. Must be the last call, as S_FMT with
 * only size and format would reset the curve. */
static void set_transfer_curve(int fd)
{
    struct v4l2_format format = {.type = V4L2_BUF_TYPE_VIDEO_OUTPUT};
    must_ioctl(fd, VIDIOC_G_FMT, &format, "VIDIOC_G_FMT");
    format.fmt.pix.priv = V4L2_PIX_FMT_PRIV_MAGIC;
    format.fmt.pix.xfer_func = V4L2_XFER_FUNC_709;
    must_ioctl(fd, VIDIOC_S_FMT, &format, "VIDIOC_S_FMT");
}

/* Returns the index of the HDMI output, the first that accepts DV timings, or
 * -1 if there is none, as with v4l2loopback. */
static int find_hdmi_output(int fd)
{
    struct v4l2_output output = {.index = 0};
    for (; try_ioctl(fd, VIDIOC_ENUMOUTPUT, &output) == 0; output.index++)
        if (output.capabilities & V4L2_OUT_CAP_DV_TIMINGS)
            return (int)output.index;
    return -1;
}
static int find_hdmi_input(int fd)
{
    struct v4l2_input input = {.index = 0};
    for (; try_ioctl(fd, VIDIOC_ENUMINPUT, &input) == 0; input.index++)
        if (input.capabilities & V4L2_IN_CAP_DV_TIMINGS)
            return (int)input.index;
    die("the camera has no HDMI input");
}

static double compute_timings_fps(const struct v4l2_bt_timings *bt)
{
    double pixels = (double)V4L2_DV_BT_FRAME_WIDTH(bt) *
                    (double)V4L2_DV_BT_FRAME_HEIGHT(bt);
    return (double)bt->pixelclock / pixels;
}

/* Returns the progressive timings for a size whose frame rate is nearest to
 * FPS, or to 60 if FPS is 0. */
static struct v4l2_dv_timings find_nearest_timings(int fd, uint32_t width,
                                                   uint32_t height, double fps)
{
    struct v4l2_enum_dv_timings at = {.index = 0};
    struct v4l2_dv_timings best = {.type = 0};
    double least = 1e9;
    for (; try_ioctl(fd, VIDIOC_ENUM_DV_TIMINGS, &at) == 0; at.index++) {
        const struct v4l2_bt_timings *bt = &at.timings.bt;
        double off = compute_timings_fps(bt) - (fps > 0.0 ? fps : 60.0);
        off = off < 0.0 ? -off : off;
        if (bt->width == width && bt->height == height && !bt->interlaced &&
            off < least) {
            least = off;
            best = at.timings;
        }
    }
    if (least > 1e8)
        die("HDMI knows no timings of %ux%u", width, height);
    return best;
}

static void set_control_by_name(int fd, const char *name, int32_t value)
{
    struct v4l2_queryctrl query = {.id = V4L2_CTRL_FLAG_NEXT_CTRL};
    while (try_ioctl(fd, VIDIOC_QUERYCTRL, &query) == 0) {
        if (strcmp((const char *)query.name, name) == 0) {
            struct v4l2_control control = {query.id, value};
            must_ioctl(fd, VIDIOC_S_CTRL, &control, name);
            return;
        }
        query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    }
    die("no control \"%s\"", name);
}

/* Sets the same timings on the output and on the input at the other end of the
 * cable, and sets the format of the camera. */
static void connect_hdmi_ends(int out, int socket, const char *camera,
                              uint32_t fourcc, uint32_t width, uint32_t height,
                              double fps)
{
    if (!camera)
        die("vivid's output needs -c CAMERA");
    int in = open_device(camera);
    int input = find_hdmi_input(in);
    must_ioctl(out, VIDIOC_S_OUTPUT, &socket, "VIDIOC_S_OUTPUT");
    must_ioctl(in, VIDIOC_S_INPUT, &input, "VIDIOC_S_INPUT");
    struct v4l2_dv_timings timings =
        find_nearest_timings(out, width, height, fps);
    must_ioctl(out, VIDIOC_S_DV_TIMINGS, &timings, "VIDIOC_S_DV_TIMINGS (out)");
    must_ioctl(in, VIDIOC_S_DV_TIMINGS, &timings, "VIDIOC_S_DV_TIMINGS (in)");
    set_format(in, V4L2_BUF_TYPE_VIDEO_CAPTURE, fourcc, width, height);
    set_control_by_name(in, "OSD Text Mode", 2);
    set_control_by_name(in, "Loop Video", 1);
    close(in);
}

static void wait_for_frame_time(struct timespec *next, double fps)
{
    long step = (long)(1e9 / fps);
    next->tv_nsec += step;
    next->tv_sec += next->tv_nsec / 1000000000;
    next->tv_nsec %= 1000000000;
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, next, NULL) == EINTR)
        ;
}

static void request_buffers(struct feed *feed)
{
    struct v4l2_requestbuffers request = {.count = N_BUFFERS,
                                          .type = V4L2_BUF_TYPE_VIDEO_OUTPUT,
                                          .memory = V4L2_MEMORY_MMAP};
    must_ioctl(feed->fd, VIDIOC_REQBUFS, &request, "VIDIOC_REQBUFS");
    feed->n_buffers = request.count < N_BUFFERS ? request.count : N_BUFFERS;
    for (uint32_t i = 0; i < feed->n_buffers; i++) {
        struct v4l2_buffer buffer = {
            .index = i, .type = request.type, .memory = request.memory};
        must_ioctl(feed->fd, VIDIOC_QUERYBUF, &buffer, "VIDIOC_QUERYBUF");
        feed->memory[i] = mmap(NULL, buffer.length, PROT_READ | PROT_WRITE,
                               MAP_SHARED, feed->fd, (off_t)buffer.m.offset);
        if (feed->memory[i] == MAP_FAILED)
            die("mmap: %s", strerror(errno));
    }
}

/* Waits until there is a buffer that the device does not use, and returns its
 * index. */
static uint32_t wait_for_free_buffer(const struct feed *feed, long i)
{
    if (i < (long)feed->n_buffers)
        return (uint32_t)i;
    struct v4l2_buffer buffer = {.type = V4L2_BUF_TYPE_VIDEO_OUTPUT,
                                 .memory = V4L2_MEMORY_MMAP};
    must_ioctl(feed->fd, VIDIOC_DQBUF, &buffer, "VIDIOC_DQBUF");
    return buffer.index;
}

/* Writes a frame by write() to v4l2loopback, which does not count queued
 * frames. */
static void write_frame(int fd, const struct frame *frame)
{
    ssize_t n = write(fd, frame->bytes, frame->n_bytes);
    if (n != (ssize_t)frame->n_bytes)
        die("write: %s", n < 0 ? strerror(errno) : "cut short");
}

static void queue_frame(const struct feed *feed, const struct frame *frame,
                        long i)
{
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    struct v4l2_buffer buffer = {.index = wait_for_free_buffer(feed, i),
                                 .type = (uint32_t)type,
                                 .memory = V4L2_MEMORY_MMAP,
                                 .bytesused = (uint32_t)frame->n_bytes,
                                 .field = V4L2_FIELD_NONE};
    memcpy(feed->memory[buffer.index], frame->bytes, frame->n_bytes);
    must_ioctl(feed->fd, VIDIOC_QBUF, &buffer, "VIDIOC_QBUF");
    if (i == 0)
        must_ioctl(feed->fd, VIDIOC_STREAMON, &type, "VIDIOC_STREAMON");
}

static void write_frames(const struct feed *feed, long count, double fps)
{
    struct timespec next;
    clock_gettime(CLOCK_MONOTONIC, &next);
    for (long i = 0; count == 0 || i < count; i++) {
        const struct frame *frame = &feed->frame[i % feed->n_frames];
        if (feed->n_buffers)
            queue_frame(feed, frame, i);
        else
            write_frame(feed->fd, frame);
        if (i == N_BUFFERS)
            close(open("/tmp/fed", O_CREAT | O_WRONLY, 0644));
        if (fps > 0.0)
            wait_for_frame_time(&next, fps);
    }
}

int main(int argc, char **argv)
{
    const char *camera = NULL;
    long count = 0;
    double fps = 0.0;
    int option, is_video = 0;
    while ((option = getopt(argc, argv, "c:n:r:t")) != -1) {
        switch (option) {
        case 'c':
            camera = optarg;
            break;
        case 'n':
            count = atol(optarg);
            break;
        case 'r':
            fps = atof(optarg);
            break;
        case 't':
            is_video = 1;
            break;
        default:
            die("see the head of feed.c");
        }
    }
    if (argc - optind < 4)
        die("feed [-c CAMERA] [-n COUNT] [-r FPS] [-t] DEVICE FOURCC WxH "
            "FILE...");
    char **word = argv + optind;
    uint32_t width, height, fourcc = fourcc_of(word[1]);
    size_of(word[2], &width, &height);
    struct feed feed = {.fd = open_device(word[0]),
                        .packed_bytes = packed_bytes(fourcc, width, height)};
    int socket = find_hdmi_output(feed.fd);
    if (socket >= 0)
        connect_hdmi_ends(feed.fd, socket, camera, fourcc, width, height, fps);
    else if (fps <= 0.0)
        fps = 30.0;
    feed.image_bytes =
        set_format(feed.fd, V4L2_BUF_TYPE_VIDEO_OUTPUT, fourcc, width, height);
    if (is_video)
        set_transfer_curve(feed.fd);
    for (char **path = word + 3; *path; path++)
        add_frame_file(&feed, *path);
    if (socket >= 0)
        request_buffers(&feed);
    write_frames(&feed, count, fps);
    return 0;
}
