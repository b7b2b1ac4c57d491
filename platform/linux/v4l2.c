/* SPDX-License-Identifier: MIT */
#include "linux/v4l2.h"

#include <errno.h>
#include <linux/videodev2.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "jpeg/mjpeg.h"
#include "linux/request.h"
#include "posix/clock.h"
#include "posix/error.h"

/* results of take_filled_buffer() */
enum glint_v4l2_outcome {
    GLINT_V4L2_TAKEN,
    GLINT_V4L2_NOTHING,
    GLINT_V4L2_BROKEN,
    GLINT_V4L2_GONE
};

struct glint_v4l2_taken {
    int index;
    /* bytes: size of each block of the buffer; start: offset of the data in the
     * block, bytes */
    size_t bytes[3], start[3];
    uint32_t sequence;
    int64_t time_us;
    bool damaged;
};

#define PAGE 4096
/* max age, us, of a time stamp whose clock is unknown; older time stamps are
 * ignored */
#define MAX_AGE_US 5000000

static bool is_multiplanar(const struct glint_v4l2 *v)
{
    return V4L2_TYPE_IS_MULTIPLANAR(v->device.type);
}

/* ----------------------------------------------------------------- requests */

/* Returns a struct v4l2_buffer that describes buffer INDEX. It may point to
 * PLANES. */
static struct v4l2_buffer fill_buffer_description(const struct glint_v4l2 *v,
                                                  int index,
                                                  struct v4l2_plane planes[3])
{
    struct v4l2_buffer b = {.type = v->device.type,
                            .index = (uint32_t)index,
                            .memory = v->io == GLINT_V4L2_USERPTR
                                          ? V4L2_MEMORY_USERPTR
                                          : V4L2_MEMORY_MMAP};

    memset(planes, 0, 3 * sizeof *planes);
    if (is_multiplanar(v)) {
        b.m.planes = planes;
        b.length = (uint32_t)v->device.format.n_blocks;
    }
    return b;
}

/* Passes buffer INDEX to the driver. Returns 0, or -1 with errno set. */
static int queue_buffer(struct glint_v4l2 *v, int index)
{
    struct glint_v4l2_buffer *buffer = &v->buffer[index];
    struct v4l2_plane planes[3];
    struct v4l2_buffer b = fill_buffer_description(v, index, planes);

    if (v->io == GLINT_V4L2_USERPTR && is_multiplanar(v))
        for (int i = 0; i < v->device.format.n_blocks; i++) {
            planes[i].m.userptr = (unsigned long)buffer->mem[i];
            planes[i].length = (uint32_t)buffer->bytes[i];
        }
    else if (v->io == GLINT_V4L2_USERPTR) {
        b.m.userptr = (unsigned long)buffer->mem[0];
        b.length = (uint32_t)buffer->bytes[0];
    }
    if (v->io != GLINT_V4L2_READ &&
        glint_ioctl(v->device.fd, VIDIOC_QBUF, &b) < 0)
        return -1;
    buffer->queued = true;
    return 0;
}

/* Returns the capture time of B's frame on the monotonic clock, us. Uses the
 * driver's time stamp if it is on that clock, or if its clock is not stated
 * (v4l2loopback) and it is at most MAX_AGE_US old. Otherwise, or if the stamp
 * lies in the future, returns the current time. */
static int64_t compute_capture_time_us(const struct v4l2_buffer *b)
{
    const uint32_t clock = b->flags & V4L2_BUF_FLAG_TIMESTAMP_MASK;
    const int64_t now_us = glint_get_time_us();
    const int64_t stamp_us =
        (int64_t)b->timestamp.tv_sec * 1000000 + b->timestamp.tv_usec;
    const bool is_it = clock == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC ||
                       (clock == V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN &&
                        now_us - stamp_us < MAX_AGE_US);

    return is_it && stamp_us <= now_us ? stamp_us : now_us;
}

static enum glint_v4l2_outcome convert_errno_to_outcome(int number)
{
    return number == EAGAIN                      ? GLINT_V4L2_NOTHING
           : number == ENODEV || number == ENXIO ? GLINT_V4L2_GONE
                                                 : GLINT_V4L2_BROKEN;
}

static enum glint_v4l2_outcome dequeue_buffer(struct glint_v4l2 *v,
                                              struct glint_v4l2_taken *t)
{
    struct v4l2_plane planes[3];
    struct v4l2_buffer b = fill_buffer_description(v, 0, planes);

    if (glint_ioctl(v->device.fd, VIDIOC_DQBUF, &b) < 0)
        return convert_errno_to_outcome(errno);
    if (b.index >= (uint32_t)v->n_buffers || !v->buffer[b.index].queued)
        return GLINT_V4L2_BROKEN;
    *t = (struct glint_v4l2_taken){.index = (int)b.index,
                                   .bytes = {b.bytesused},
                                   .sequence = b.sequence,
                                   .time_us = compute_capture_time_us(&b),
                                   .damaged = b.flags & V4L2_BUF_FLAG_ERROR};
    if (is_multiplanar(v))
        for (int i = 0; i < v->device.format.n_blocks; i++) {
            t->bytes[i] = planes[i].bytesused;
            t->start[i] = planes[i].data_offset;
        }
    v->buffer[t->index].queued = false;
    return GLINT_V4L2_TAKEN;
}

static enum glint_v4l2_outcome
read_frame_into_buffer(struct glint_v4l2 *v, struct glint_v4l2_taken *t)
{
    ssize_t got;
    int i = 0;

    while (i < v->n_buffers && !v->buffer[i].queued)
        i++;
    if (i == v->n_buffers)
        return GLINT_V4L2_NOTHING;
    do
        got = read(v->device.fd, v->buffer[i].mem[0], v->buffer[i].bytes[0]);
    while (got < 0 && errno == EINTR);
    if (got < 0)
        return convert_errno_to_outcome(errno);
    *t = (struct glint_v4l2_taken){.index = i,
                                   .bytes = {(size_t)got},
                                   .sequence = v->n_read++,
                                   .time_us = glint_get_time_us()};
    v->buffer[i].queued = false;
    return GLINT_V4L2_TAKEN;
}

/* Dequeues a filled buffer from the driver, or reads a frame with read(2), and
 * describes it in T. */
static enum glint_v4l2_outcome take_filled_buffer(struct glint_v4l2 *v,
                                                  struct glint_v4l2_taken *t)
{
    return v->io == GLINT_V4L2_READ ? read_frame_into_buffer(v, t)
                                    : dequeue_buffer(v, t);
}

/* ------------------------------------------------------------------ buffers */

/* Requests N buffers of type MEMORY from the driver; N = 0 frees all buffers.
 * Returns the number that the driver granted, or 0 with errno set. */
static uint32_t request_buffers(struct glint_v4l2 *v, enum v4l2_memory memory,
                                int n)
{
    struct v4l2_requestbuffers r = {
        .type = v->device.type, .memory = memory, .count = (uint32_t)n};

    if (glint_ioctl(v->device.fd, VIDIOC_REQBUFS, &r) < 0)
        return 0;
    errno = ENOMEM; /* used if the driver granted no buffers */
    return r.count < GLINT_V4L2_MAX_BUFFERS ? r.count : GLINT_V4L2_MAX_BUFFERS;
}

static void release_buffers(struct glint_v4l2 *v)
{
    for (int i = 0; i < GLINT_V4L2_MAX_BUFFERS; i++)
        for (int k = 0; k < 3; k++) {
            void *const mem = v->buffer[i].mem[k];

            if (mem && v->io == GLINT_V4L2_MMAP)
                munmap(mem, v->buffer[i].bytes[k]);
            else
                free(mem);
        }
    memset(v->buffer, 0, sizeof v->buffer);
    /* The driver's buffers are freed even if n_buffers is 0: an earlier attempt
     * to free them may have failed, and the driver accepts no format while it
     * has buffers. */
    if (v->io == GLINT_V4L2_MMAP || v->io == GLINT_V4L2_USERPTR)
        request_buffers(v,
                        v->io == GLINT_V4L2_MMAP ? V4L2_MEMORY_MMAP
                                                 : V4L2_MEMORY_USERPTR,
                        0);
    v->n_buffers = 0;
}

/* Maps one block of buffer INDEX into memory. Returns NULL, or the name of
 * the call that failed. */
static const char *map_buffer_block(struct glint_v4l2 *v, int index, int block,
                                    size_t bytes, size_t offset)
{
    struct glint_v4l2_buffer *b = &v->buffer[index];
    void *mem = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED,
                     v->device.fd, (off_t)offset);

    if (mem == MAP_FAILED)
        return "mmap";
    b->mem[block] = mem;
    b->bytes[block] = bytes;
    return NULL;
}

/* Like map_buffer_block(), for all blocks. */
static const char *map_buffer(struct glint_v4l2 *v, int index)
{
    struct v4l2_plane planes[3];
    struct v4l2_buffer b = fill_buffer_description(v, index, planes);
    const char *failed = NULL;

    if (glint_ioctl(v->device.fd, VIDIOC_QUERYBUF, &b) < 0)
        return "VIDIOC_QUERYBUF";
    if (!is_multiplanar(v))
        return map_buffer_block(v, index, 0, b.length, b.m.offset);
    for (int i = 0; !failed && i < v->device.format.n_blocks; i++)
        failed = map_buffer_block(v, index, i, planes[i].length,
                                  planes[i].m.mem_offset);
    return failed;
}

/* Like map_buffer(), with memory of glint. */
static const char *allocate_buffer(struct glint_v4l2 *v, int index)
{
    struct glint_v4l2_buffer *b = &v->buffer[index];

    for (int i = 0; i < v->device.format.n_blocks; i++) {
        b->bytes[i] =
            (v->device.format.block_bytes[i] + PAGE - 1) / PAGE * PAGE;
        if (posix_memalign(&b->mem[i], PAGE, b->bytes[i]) != 0) {
            b->mem[i] = NULL;
            errno = ENOMEM;
            return "buffers";
        }
    }
    return NULL;
}

/* Returns whether the driver can export buffers as DMABUF, which other devices
 * read without a copy. glint uses this in reports only. */
static bool can_export_dmabuf(const struct glint_v4l2 *v)
{
    struct v4l2_exportbuffer e = {.type = v->device.type};

    if (v->io != GLINT_V4L2_MMAP ||
        glint_ioctl(v->device.fd, VIDIOC_EXPBUF, &e) < 0)
        return false;
    close(e.fd);
    return true;
}

/* Returns the time, us, of reading every other word of MEM[BYTES] twice.
 * Uncached memory is as slow the second time as the first. */
static int64_t measure_read_time_us(const void *mem, size_t bytes)
{
    const volatile uint64_t *at = mem;
    const int64_t start = glint_get_time_us();

    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < bytes / sizeof *at; i += 2)
            (void)at[i];
    return glint_get_time_us() - start;
}

/* Returns whether reading buffers is about as fast as reading other memory.
 * Measures it for mapped buffers, as no driver reports it; others are
 * cached. */
static bool is_buffer_memory_cached(const struct glint_v4l2 *v)
{
    static uint64_t own[8192];
    size_t bytes = v->buffer[0].bytes[0];
    int64_t own_us, best_us = INT64_MAX;

    if (v->io != GLINT_V4L2_MMAP)
        return true;
    bytes = bytes < sizeof own ? bytes : sizeof own;
    memset(own, 0, sizeof own);
    own_us = measure_read_time_us(own, bytes);
    for (int k = 0; k < 3; k++) {
        const int64_t t = measure_read_time_us(v->buffer[0].mem[0], bytes);

        best_us = t < best_us ? t : best_us;
    }
    return best_us <= 4 * own_us + 20;
}

static const char *allocate_all_buffers(struct glint_v4l2 *v, uint32_t n)
{
    const char *failed = NULL;

    v->n_buffers = (int)n;
    for (int i = 0; !failed && i < v->n_buffers; i++)
        failed =
            (v->io == GLINT_V4L2_MMAP ? map_buffer : allocate_buffer)(v, i);
    return failed;
}

/* Allocates buffers of type IO. Returns NULL, or the name of the call that
 * failed, with errno set. Unless the device is busy, a failed first request is
 * repeated once, because a driver that was just stopped refuses it. */
static const char *allocate_buffers(struct glint_v4l2 *v, enum glint_v4l2_io io)
{
    const enum v4l2_memory memory =
        io == GLINT_V4L2_MMAP ? V4L2_MEMORY_MMAP : V4L2_MEMORY_USERPTR;
    uint32_t n = (uint32_t)v->wish_buffers;
    const char *failed;

    v->io = io;
    if (io != GLINT_V4L2_READ) {
        n = request_buffers(v, memory, v->wish_buffers);
        if (n == 0 && errno != EBUSY)
            n = request_buffers(v, memory, v->wish_buffers);
        if (n == 0)
            return "VIDIOC_REQBUFS";
    }
    failed = allocate_all_buffers(v, n);
    if (failed) {
        const int number = errno;

        release_buffers(v);
        errno = number;
    }
    return failed;
}

/* Returns whether the request for buffers failed because the driver does not
 * support the requested type of memory (EINVAL). */
static bool is_memory_type_unsupported(const struct glint_v4l2 *v)
{
    return v->n_buffers == 0 && errno == EINVAL;
}

/* Allocates buffers of the first type that both the configuration and the
 * device allow. Returns NULL, or the name of the call that failed. */
static const char *allocate_supported_buffers(struct glint_v4l2 *v)
{
    const uint32_t caps = v->device.caps;
    const enum glint_v4l2_io wish = v->wish_io;
    const bool may_stream =
        wish != GLINT_V4L2_READ && caps & V4L2_CAP_STREAMING;
    const char *failed = NULL;

    errno = EINVAL;
    if (may_stream && wish != GLINT_V4L2_USERPTR)
        failed = allocate_buffers(v, GLINT_V4L2_MMAP);
    if (may_stream && wish != GLINT_V4L2_MMAP && is_memory_type_unsupported(v))
        failed = allocate_buffers(v, GLINT_V4L2_USERPTR);
    if ((wish == GLINT_V4L2_READ || wish == GLINT_V4L2_AUTO) &&
        caps & V4L2_CAP_READWRITE && v->device.format.n_blocks == 1 &&
        is_memory_type_unsupported(v))
        failed = allocate_buffers(v, GLINT_V4L2_READ);
    if (v->n_buffers || failed)
        return failed;
    errno = ENOTSUP;
    return "streaming or reading (whichever --io allows)";
}

/* time limit for restarting a broken stream, us */
#define PATIENCE_US 900000
/* A stream has stalled if no frame has arrived for STALL_US us and for
 * STALL_FRAMES frame times. */
#define STALL_US     2000000
#define STALL_FRAMES 4
/* largest gap of sequence numbers that is counted as dropped frames */
#define MAX_GAP 4096
/* number of damaged frames in a row after which the stream restarts */
#define USELESS 30

/* ------------------------------------------------------------------- stream */

static void stop_stream(struct glint_v4l2 *v)
{
    int type = (int)v->device.type;

    if (v->streams && v->io != GLINT_V4L2_READ)
        glint_ioctl(v->device.fd, VIDIOC_STREAMOFF, &type);
    v->streams = false;
    release_buffers(v);
}

static int start_stream(struct glint_v4l2 *v)
{
    int type = (int)v->device.type;

    if (v->io == GLINT_V4L2_READ ||
        glint_ioctl(v->device.fd, VIDIOC_STREAMON, &type) == 0)
        return 0;
    return errno == EINVAL ? glint_ioctl(v->device.fd, VIDIOC_STREAMON, &type)
                           : -1;
}

static enum glint_status open_jpeg_decoder(struct glint_v4l2 *v,
                                           struct glint_error *error)
{
    const struct glint_v4l2_format *f = &v->device.format;

    glint_mjpeg_close(v->jpeg);
    v->jpeg = NULL;
    return f->is_jpeg ? glint_mjpeg_open(&v->jpeg, v->device.path, f->width,
                                         f->height, error)
                      : GLINT_OK;
}

/* Allocates buffers, and for MJPEG a decoder, for the current format. */
static enum glint_status prepare_stream(struct glint_v4l2 *v,
                                        struct glint_error *error)
{
    const char *const failed = allocate_supported_buffers(v);

    if (failed)
        return glint_report_ioctl_error(error, v->device.path, failed);
    v->is_cached = is_buffer_memory_cached(v);
    v->exports_dmabuf = can_export_dmabuf(v);
    return open_jpeg_decoder(v, error);
}

static enum glint_status queue_and_start_stream(struct glint_v4l2 *v,
                                                struct glint_error *error)
{
    int n_queued = 0;

    for (int i = 0; i < v->n_buffers; i++)
        /* A buffer that the driver refuses now is queued later. */
        n_queued += queue_buffer(v, i) == 0;
    if (n_queued == 0)
        return glint_report_ioctl_error(error, v->device.path, "VIDIOC_QBUF");
    if (start_stream(v) < 0)
        return glint_report_ioctl_error(error, v->device.path,
                                        "VIDIOC_STREAMON");
    v->streams = true;
    v->n_numbered = 0;
    v->n_useless = 0;
    v->heard_us = glint_get_time_us();
    return GLINT_OK;
}

static bool is_restart_time_left(const struct glint_v4l2 *v)
{
    return v->broken_us && glint_get_time_us() - v->broken_us <= PATIENCE_US;
}

/* Implements glint_source.start. If the stream has never been started, failures
 * are returned immediately; after a restart read_next_frame() tries again for
 * PATIENCE_US. */
static enum glint_status start_source(struct glint_source *source,
                                      struct glint_error *error)
{
    struct glint_v4l2 *v = (struct glint_v4l2 *)source;
    const enum glint_status status = v->streams || v->n_buffers == 0
                                         ? GLINT_OK
                                         : queue_and_start_stream(v, error);

    if (status == GLINT_OK || !is_restart_time_left(v))
        return status;
    stop_stream(v);
    return GLINT_OK;
}

static enum glint_status report_device_removed(const struct glint_v4l2 *v,
                                               struct glint_error *error)
{
    return glint_error_report(error, GLINT_E_DEVICE, v->device.path,
                              "the camera was removed");
}

static bool is_device_present(const struct glint_v4l2 *v)
{
    struct v4l2_capability cap;

    return glint_ioctl(v->device.fd, VIDIOC_QUERYCAP, &cap) == 0;
}

/* Negotiates the format again. A device that is read by read(2) is closed and
 * opened again first, because it streams until it is closed and accepts no new
 * format while it streams. */
static enum glint_status renegotiate_format(struct glint_v4l2 *v,
                                            struct glint_error *error)
{
    const struct glint_v4l2_config wish = v->device.wish;
    enum glint_status status;

    if (v->io != GLINT_V4L2_READ)
        return glint_v4l2_device_negotiate(&v->device, error);
    glint_v4l2_device_close(&v->device);
    status = glint_v4l2_device_open(&v->device, &wish, error);
    v->source.fd = v->device.fd;
    return status;
}

/* Stops the stream and prepares it again with the current format of the device.
 * Only the next frame shows whether this has succeeded, so failures are ignored
 * for PATIENCE_US until a frame arrives, unless the device was removed or has
 * no supported format. After that time returns the error of the failed request,
 * or, if the stream had been started, an error with the text WHY. */
static enum glint_status restart_stream(struct glint_v4l2 *v, const char *why,
                                        struct glint_error *error)
{
    const struct timespec breath = {0, 20000000};
    const bool started = v->streams;
    enum glint_status status;
    bool is_late = false;

    stop_stream(v);
    if (!is_device_present(v))
        return report_device_removed(v, error);
    if (v->broken_us == 0)
        v->broken_us = glint_get_time_us();
    else {
        nanosleep(&breath, NULL);
        is_late = !is_restart_time_left(v);
    }
    if (is_late && started)
        return glint_error_report(error, GLINT_E_DEVICE, v->device.path,
                                  "%s; restarting the stream failed", why);
    status = renegotiate_format(v, error);
    if (status == GLINT_OK)
        status = prepare_stream(v, error);
    v->source.n_restarts += status == GLINT_OK;
    if (status == GLINT_E_UNSUPPORTED || v->device.fd < 0 || is_late)
        return status;
    if (status != GLINT_OK)
        stop_stream(v);
    return GLINT_OK;
}

/* ------------------------------------------------------------------- frames */

/* Restarts the time limits STALL_US and PATIENCE_US. Called if the source has
 * changed or has no signal. */
static void restart_time_limits(struct glint_v4l2 *v)
{
    v->heard_us = glint_get_time_us();
    if (v->broken_us)
        v->broken_us = v->heard_us;
}

/* Returns whether the source has changed. */
static bool dequeue_events(struct glint_v4l2 *v)
{
    struct v4l2_event event;
    bool is_other = false;

    while (glint_ioctl(v->device.fd, VIDIOC_DQEVENT, &event) == 0)
        if (event.type == V4L2_EVENT_SOURCE_CHANGE) {
            is_other |= !v->device.is_dv ||
                        glint_v4l2_device_has_new_timings(&v->device);
            restart_time_limits(v);
        }
    return is_other;
}

static bool is_frame_complete(const struct glint_v4l2 *v,
                              const struct glint_v4l2_taken *t)
{
    const struct glint_v4l2_format *f = &v->device.format;
    const struct glint_v4l2_buffer *b = &v->buffer[t->index];

    if (t->damaged || t->bytes[0] == 0)
        return false;
    for (int i = 0; i < f->n_blocks; i++)
        if (t->start[i] > t->bytes[i] || t->bytes[i] > b->bytes[i])
            return false;
    for (int p = 0; !f->is_jpeg && p < glint_image_planes(f->pixels); p++) {
        const int k = f->plane[p].block;

        if (t->start[k] + f->plane[p].offset + f->plane[p].bytes > t->bytes[k])
            return false;
    }
    return true;
}

static void return_buffer(struct glint_v4l2 *v, int index)
{
    v->buffer[index].lent = false;
    queue_buffer(v, index); /* If the driver refuses the buffer, a later call
                               reports the failure. */
}

static void queue_idle_buffers(struct glint_v4l2 *v)
{
    for (int i = 0; i < v->n_buffers; i++)
        if (!v->buffer[i].queued && !v->buffer[i].lent)
            queue_buffer(v, i);
}

/* Returns the number of frames lost before the frame with number SEQUENCE.
 * Returns 0 in three cases in which sequence numbers are unreliable. The first
 * two frames after a start: v4l2loopback begins with an old number. A number
 * that the driver repeats. A gap above MAX_GAP: so long a gap would have been a
 * stall. */
static int count_missing_frames(struct glint_v4l2 *v, uint32_t sequence)
{
    const uint32_t missing = sequence - v->sequence - 1;
    const bool counts = v->n_numbered == 2 && missing <= MAX_GAP;

    v->sequence = sequence;
    v->n_numbered += v->n_numbered < 2;
    return counts ? (int)missing : 0;
}

/* Dequeues all filled buffers, sets NEWEST to the latest complete frame and
 * requeues the others. Counts late, corrupt and dropped frames in FRAME. */
static enum glint_v4l2_outcome
take_newest_frame(struct glint_v4l2 *v, struct glint_v4l2_taken *newest,
                  struct glint_source_frame *frame)
{
    enum glint_v4l2_outcome outcome = GLINT_V4L2_NOTHING;
    struct glint_v4l2_taken t;

    newest->index = -1;
    for (int k = 0; k <= v->n_buffers; k++) {
        outcome = take_filled_buffer(v, &t);
        if (outcome != GLINT_V4L2_TAKEN)
            break;
        v->heard_us = glint_get_time_us();
        frame->n_dropped += count_missing_frames(v, t.sequence);
        if (!is_frame_complete(v, &t)) {
            frame->n_corrupt++;
            v->n_useless++;
            return_buffer(v, t.index);
            continue;
        }
        if (newest->index >= 0) {
            frame->n_late++;
            return_buffer(v, newest->index);
        }
        *newest = t;
    }
    return newest->index >= 0            ? GLINT_V4L2_TAKEN
           : v->n_useless >= USELESS     ? GLINT_V4L2_BROKEN
           : outcome == GLINT_V4L2_TAKEN ? GLINT_V4L2_NOTHING
                                         : outcome;
}

static void set_image_planes(const struct glint_v4l2 *v,
                             const struct glint_v4l2_taken *t,
                             struct glint_image *image)
{
    const struct glint_v4l2_format *f = &v->device.format;

    image->format = f->pixels;
    image->width = f->width;
    image->height = f->height;
    for (int p = 0; p < glint_image_planes(f->pixels); p++) {
        const int k = f->plane[p].block;

        image->plane[p] = (uint8_t *)v->buffer[t->index].mem[k] + t->start[k] +
                          f->plane[p].offset;
        image->stride_bytes[p] = f->plane[p].stride_bytes;
    }
}

/* Decodes the JPEG frame in T to the decoder's planes, and returns T's buffer
 * to the driver. On failure returns false and leaves IMAGE without planes. */
static bool decode_jpeg_frame(struct glint_v4l2 *v,
                              const struct glint_v4l2_taken *t,
                              struct glint_image *image)
{
    struct glint_error unsaid;
    const bool done =
        glint_mjpeg_decode(
            v->jpeg, (const uint8_t *)v->buffer[t->index].mem[0] + t->start[0],
            t->bytes[0] - t->start[0], image, &unsaid) == GLINT_OK;

    if (!done)
        image->plane[0] = NULL;
    return_buffer(v, t->index);
    return done;
}

static void set_source_frame(struct glint_v4l2 *v,
                             const struct glint_v4l2_taken *t,
                             struct glint_source_frame *frame)
{
    const struct glint_v4l2_format *f = &v->device.format;

    if (f->is_jpeg && !decode_jpeg_frame(v, t, &frame->image)) {
        frame->n_corrupt++;
        v->n_useless++;
        return;
    }
    if (!f->is_jpeg) {
        set_image_planes(v, t, &frame->image);
        v->buffer[t->index].lent = true;
        frame->buffer = &v->buffer[t->index];
    }
    frame->image.range = f->range;
    frame->image.matrix = f->matrix;
    frame->image.transfer = f->transfer;
    frame->sequence = t->sequence;
    frame->time_us = t->time_us;
    frame->is_drawable = f->is_jpeg || (v->is_cached && !v->device.is_loopback);
    v->n_useless = 0;
    v->broken_us = 0;
}

/* Returns whether no frame has arrived within the time limits. An HDMI input
 * without a signal never stalls. */
static bool is_stream_stalled(struct glint_v4l2 *v)
{
    const struct glint_v4l2_format *f = &v->device.format;
    const int64_t frame_us =
        f->fps_num ? INT64_C(1000000) * f->fps_den / f->fps_num : 0;

    if (glint_get_time_us() - v->heard_us < STALL_US + STALL_FRAMES * frame_us)
        return false;
    glint_v4l2_device_has_new_timings(&v->device);
    if (!v->device.has_signal)
        restart_time_limits(v);
    return v->device.has_signal;
}

static enum glint_status take_next_frame(struct glint_v4l2 *v,
                                         struct glint_source_frame *frame,
                                         struct glint_error *error)
{
    struct glint_v4l2_taken newest;

    *frame = (struct glint_source_frame){.sequence = 0};
    if (!v->streams && v->n_buffers == 0)
        return restart_stream(v, "the stream is broken", error);
    if (!v->streams) {
        const enum glint_status status = start_source(&v->source, error);

        if (!v->streams)
            return status;
    }
    if (dequeue_events(v))
        return restart_stream(v, "the source changed", error);
    queue_idle_buffers(v);
    switch (take_newest_frame(v, &newest, frame)) {
    case GLINT_V4L2_TAKEN:
        set_source_frame(v, &newest, frame);
        if (frame->image.plane[0] || v->n_useless < USELESS)
            return GLINT_OK;
        break;
    case GLINT_V4L2_NOTHING:
        return is_stream_stalled(v)
                   ? restart_stream(v, "no frames arrive", error)
                   : GLINT_OK;
    case GLINT_V4L2_GONE:
        return report_device_removed(v, error);
    case GLINT_V4L2_BROKEN:
        break;
    }
    return restart_stream(v,
                          v->n_useless >= USELESS ? "all frames are damaged"
                                                  : "the stream is broken",
                          error);
}

static enum glint_status read_next_frame(struct glint_source *source,
                                         struct glint_source_frame *frame,
                                         struct glint_error *error)
{
    struct glint_v4l2 *v = (struct glint_v4l2 *)source;
    const enum glint_status status = take_next_frame(v, frame, error);

    source->has_signal = v->device.has_signal;
    return status;
}

static void return_frame(struct glint_source *source,
                         struct glint_source_frame *frame)
{
    struct glint_v4l2 *v = (struct glint_v4l2 *)source;
    struct glint_v4l2_buffer *b = frame->buffer;

    /* If the stream was restarted meanwhile, buffer B was freed and is no
     * longer lent. */
    if (b && b->lent)
        return_buffer(v, (int)(b - v->buffer));
    frame->buffer = NULL;
    frame->image.plane[0] = NULL;
}

static void close_camera(struct glint_source *source)
{
    struct glint_v4l2 *v = (struct glint_v4l2 *)source;

    if (v->device.fd >= 0)
        stop_stream(v);
    glint_mjpeg_close(v->jpeg);
    v->jpeg = NULL;
    glint_v4l2_device_close(&v->device);
    v->source.fd = -1;
}

static void describe_source_format(const struct glint_source *source,
                                   struct glint_source_format *format)
{
    static const char *const io[] = {"", "mapped", "user", "read"};
    const struct glint_v4l2 *v = (const struct glint_v4l2 *)source;
    const struct glint_v4l2_format *f = &v->device.format;
    char text[96];

    *format = (struct glint_source_format){
        .image = {.format = f->is_jpeg ? GLINT_I420 : f->pixels,
                  .width = f->width,
                  .height = f->height,
                  .range = f->range,
                  .matrix = f->matrix,
                  .transfer = f->transfer},
        .fps_num = f->fps_num,
        .fps_den = f->fps_den,
        .detail = v->exports_dmabuf
                      ? "the driver can export its buffers as DMABUF"
                      : NULL};
    glint_v4l2_format_text(f, text);
    snprintf(format->text, sizeof format->text,
             "%s (%s): %s, %d %s buffers%s%s", v->device.path, v->device.card,
             text, v->n_buffers, io[v->io],
             !v->is_cached           ? ", uncached: copied first"
             : v->device.is_loopback ? ", shared: copied first"
                                     : "",
             v->device.has_signal ? "" : "; NO SIGNAL");
}

enum glint_status glint_v4l2_open(struct glint_v4l2 *camera,
                                  const struct glint_v4l2_config *wish,
                                  enum glint_v4l2_io io, int n_buffers,
                                  struct glint_error *error)
{
    enum glint_status status;

    *camera = (struct glint_v4l2){.source = {.fd = -1,
                                             .start = start_source,
                                             .next = read_next_frame,
                                             .done = return_frame,
                                             .describe = describe_source_format,
                                             .close = close_camera},
                                  .wish_io = io,
                                  .wish_buffers = n_buffers};
    status = glint_v4l2_device_open(&camera->device, wish, error);
    if (status != GLINT_OK)
        return status;
    status = prepare_stream(camera, error);
    if (status != GLINT_OK)
        close_camera(&camera->source);
    camera->source.fd = camera->device.fd;
    camera->source.has_signal = camera->device.has_signal;
    return status;
}
