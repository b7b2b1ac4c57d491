/* SPDX-License-Identifier: MIT */
#include "linux/v4l2_buffers.h"

#include <errno.h>
#include <linux/videodev2.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "linux/request.h"
#include "posix/clock.h"

#define PAGE 4096
/* us; stamps of an unknown clock that are older are not trusted */
#define MAX_AGE_US 5000000

static bool is_multiplanar(const struct glint_v4l2 *v)
{
    return V4L2_TYPE_IS_MULTIPLANAR(v->device.type);
}

/* ----------------------------------------------------------------- requests */

/* Returns a struct v4l2_buffer for buffer INDEX; it uses PLANES. */
static struct v4l2_buffer describe(const struct glint_v4l2 *v, int index,
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

int glint_v4l2_queue(struct glint_v4l2 *v, int index)
{
    struct glint_v4l2_buffer *buffer = &v->buffer[index];
    struct v4l2_plane planes[3];
    struct v4l2_buffer b = describe(v, index, planes);

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

/* Returns the time of B's frame by the monotonic clock: its stamp, if the
 * driver says that it is of that clock, or does not say, as v4l2loopback, and
 * the stamp is at most MAX_AGE_US old. Otherwise, or if the stamp lies ahead,
 * the time now. */
static int64_t capture_time_us(const struct v4l2_buffer *b)
{
    const uint32_t clock = b->flags & V4L2_BUF_FLAG_TIMESTAMP_MASK;
    const int64_t now_us = glint_now_us();
    const int64_t stamp_us =
        (int64_t)b->timestamp.tv_sec * 1000000 + b->timestamp.tv_usec;
    const bool is_it = clock == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC ||
                       (clock == V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN &&
                        now_us - stamp_us < MAX_AGE_US);

    return is_it && stamp_us <= now_us ? stamp_us : now_us;
}

static enum glint_v4l2_outcome outcome_of(int number)
{
    return number == EAGAIN                      ? GLINT_V4L2_NOTHING
           : number == ENODEV || number == ENXIO ? GLINT_V4L2_GONE
                                                 : GLINT_V4L2_BROKEN;
}

static enum glint_v4l2_outcome dequeue(struct glint_v4l2 *v,
                                       struct glint_v4l2_taken *t)
{
    struct v4l2_plane planes[3];
    struct v4l2_buffer b = describe(v, 0, planes);

    if (glint_ioctl(v->device.fd, VIDIOC_DQBUF, &b) < 0)
        return outcome_of(errno);
    if (b.index >= (uint32_t)v->n_buffers || !v->buffer[b.index].queued)
        return GLINT_V4L2_BROKEN;
    *t = (struct glint_v4l2_taken){.index = (int)b.index,
                                   .bytes = {b.bytesused},
                                   .sequence = b.sequence,
                                   .time_us = capture_time_us(&b),
                                   .damaged = b.flags & V4L2_BUF_FLAG_ERROR};
    if (is_multiplanar(v))
        for (int i = 0; i < v->device.format.n_blocks; i++) {
            t->bytes[i] = planes[i].bytesused;
            t->start[i] = planes[i].data_offset;
        }
    v->buffer[t->index].queued = false;
    return GLINT_V4L2_TAKEN;
}

static enum glint_v4l2_outcome read_frame(struct glint_v4l2 *v,
                                          struct glint_v4l2_taken *t)
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
        return outcome_of(errno);
    *t = (struct glint_v4l2_taken){.index = i,
                                   .bytes = {(size_t)got},
                                   .sequence = v->n_read++,
                                   .time_us = glint_now_us()};
    v->buffer[i].queued = false;
    return GLINT_V4L2_TAKEN;
}

enum glint_v4l2_outcome glint_v4l2_take(struct glint_v4l2 *v,
                                        struct glint_v4l2_taken *t)
{
    return v->io == GLINT_V4L2_READ ? read_frame(v, t) : dequeue(v, t);
}

/* ------------------------------------------------------------------ buffers */

/* Asks the driver for N buffers in MEMORY; 0 frees them all. Returns the number
 * granted, or 0 with errno set. */
static uint32_t request_buffers(struct glint_v4l2 *v, enum v4l2_memory memory,
                                int n)
{
    struct v4l2_requestbuffers r = {
        .type = v->device.type, .memory = memory, .count = (uint32_t)n};

    if (glint_ioctl(v->device.fd, VIDIOC_REQBUFS, &r) < 0)
        return 0;
    errno = ENOMEM; /* the driver granted none */
    return r.count < GLINT_V4L2_MAX_BUFFERS ? r.count : GLINT_V4L2_MAX_BUFFERS;
}

void glint_v4l2_release_buffers(struct glint_v4l2 *v)
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
    /* Buffers are freed in the driver even if there are none here: freeing may
     * have failed before, and until it succeeds no format can be set. */
    if (v->io == GLINT_V4L2_MMAP || v->io == GLINT_V4L2_USERPTR)
        request_buffers(v,
                        v->io == GLINT_V4L2_MMAP ? V4L2_MEMORY_MMAP
                                                 : V4L2_MEMORY_USERPTR,
                        0);
    v->n_buffers = 0;
}

/* Maps a block of buffer INDEX. Returns NULL, or the call that failed. */
static const char *map_block(struct glint_v4l2 *v, int index, int block,
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

/* Maps all blocks of buffer INDEX. Returns NULL, or the call that failed. */
static const char *map_buffer(struct glint_v4l2 *v, int index)
{
    struct v4l2_plane planes[3];
    struct v4l2_buffer b = describe(v, index, planes);
    const char *failed = NULL;

    if (glint_ioctl(v->device.fd, VIDIOC_QUERYBUF, &b) < 0)
        return "VIDIOC_QUERYBUF";
    if (!is_multiplanar(v))
        return map_block(v, index, 0, b.length, b.m.offset);
    for (int i = 0; !failed && i < v->device.format.n_blocks; i++)
        failed =
            map_block(v, index, i, planes[i].length, planes[i].m.mem_offset);
    return failed;
}

/* Allocates all blocks of buffer INDEX. Returns NULL, or what failed. */
static const char *own_buffer(struct glint_v4l2 *v, int index)
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

bool glint_v4l2_can_export(const struct glint_v4l2 *v)
{
    struct v4l2_exportbuffer e = {.type = v->device.type};

    if (v->io != GLINT_V4L2_MMAP ||
        glint_ioctl(v->device.fd, VIDIOC_EXPBUF, &e) < 0)
        return false;
    close(e.fd);
    return true;
}

/* Returns the us that reading every other word of MEM[BYTES] twice takes;
 * uncached memory is slow both times. */
static int64_t read_time_us(const void *mem, size_t bytes)
{
    const volatile uint64_t *at = mem;
    const int64_t start = glint_now_us();

    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < bytes / sizeof *at; i += 2)
            (void)at[i];
    return glint_now_us() - start;
}

bool glint_v4l2_is_cached(const struct glint_v4l2 *v)
{
    static uint64_t own[8192];
    size_t bytes = v->buffer[0].bytes[0];
    int64_t own_us, best_us = INT64_MAX;

    if (v->io != GLINT_V4L2_MMAP)
        return true;
    bytes = bytes < sizeof own ? bytes : sizeof own;
    memset(own, 0, sizeof own);
    own_us = read_time_us(own, bytes);
    for (int k = 0; k < 3; k++) {
        const int64_t t = read_time_us(v->buffer[0].mem[0], bytes);

        best_us = t < best_us ? t : best_us;
    }
    return best_us <= 4 * own_us + 20;
}

static const char *fill_buffers(struct glint_v4l2 *v, uint32_t n)
{
    const char *failed = NULL;

    v->n_buffers = (int)n;
    for (int i = 0; !failed && i < v->n_buffers; i++)
        failed = (v->io == GLINT_V4L2_MMAP ? map_buffer : own_buffer)(v, i);
    return failed;
}

/* Gets buffers by IO. Returns NULL, or the call that failed, with errno set.
 * Asks twice, as drivers that were just stopped refuse once. */
static const char *try_io(struct glint_v4l2 *v, enum glint_v4l2_io io)
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
    failed = fill_buffers(v, n);
    if (failed) {
        const int number = errno;

        glint_v4l2_release_buffers(v);
        errno = number;
    }
    return failed;
}

/* Checks whether there are no buffers because the driver lacks their kind of
 * memory, which it says by EINVAL. */
static bool is_lacking(const struct glint_v4l2 *v)
{
    return v->n_buffers == 0 && errno == EINVAL;
}

const char *glint_v4l2_get_buffers(struct glint_v4l2 *v)
{
    const uint32_t caps = v->device.caps;
    const enum glint_v4l2_io wish = v->wish_io;
    const bool may_stream =
        wish != GLINT_V4L2_READ && caps & V4L2_CAP_STREAMING;
    const char *failed = NULL;

    errno = EINVAL;
    if (may_stream && wish != GLINT_V4L2_USERPTR)
        failed = try_io(v, GLINT_V4L2_MMAP);
    if (may_stream && wish != GLINT_V4L2_MMAP && is_lacking(v))
        failed = try_io(v, GLINT_V4L2_USERPTR);
    if ((wish == GLINT_V4L2_READ || wish == GLINT_V4L2_AUTO) &&
        caps & V4L2_CAP_READWRITE && v->device.format.n_blocks == 1 &&
        is_lacking(v))
        failed = try_io(v, GLINT_V4L2_READ);
    if (v->n_buffers || failed)
        return failed;
    errno = ENOTSUP;
    return "streaming or reading, as --io allows";
}
