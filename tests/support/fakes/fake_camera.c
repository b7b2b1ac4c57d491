/* SPDX-License-Identifier: MIT */
#include "support/fakes/fake_camera.h"

#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "support/fakes/wrapped.h"

struct fake_camera camera = {.fd = -1};
bool fake_lacks_jpeg;

static int64_t now_us;
static int n_blocks, n_asked;

static struct {
    unsigned long request;
    int number, times;
} refusal;

static struct {
    int n, at, number;
    bool forever;
} calls;

/* ------------------------------------------------------------ failing calls */

static int set_errno_and_fail(int number)
{
    errno = number;
    return -1;
}

static bool must_fail_this_call(void)
{
    const int n = ++calls.n;

    if (calls.at == 0 || n < calls.at || (n > calls.at && !calls.forever))
        return false;
    errno = calls.number;
    return true;
}

int fake_camera_fail_call(int n, int number, bool forever)
{
    const int so_far = calls.n;

    calls.n = 0;
    calls.at = n;
    calls.number = number;
    calls.forever = forever;
    return so_far;
}

void fake_camera_fail_request(unsigned long request, int number, int times)
{
    refusal.request = request;
    refusal.number = number;
    refusal.times = times;
}

static bool is_request_refused(unsigned long request, const void *arg)
{
    const struct v4l2_requestbuffers *r = arg;

    if (refusal.request != request || refusal.times == 0 ||
        /* Requests to free the buffers never fail. */
        (request == VIDIOC_REQBUFS && r->count == 0))
        return false;
    if (refusal.times > 0)
        refusal.times--;
    errno = refusal.number;
    return true;
}

/* ---------------------------------------------------- settings of the fake */

void fake_camera_reset(void)
{
    camera = (struct fake_camera){
        .fd = -1,
        .caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING,
        .n_inputs = 1,
        .mode = {{V4L2_PIX_FMT_YUYV, 64, 48, 30, 1}},
        .now = {V4L2_PIX_FMT_YUYV, 64, 48, 30, 1},
        .max_buffers = FAKE_BUFFERS,
        .colorspace = V4L2_COLORSPACE_SRGB,
        .has_signal = true,
        .timings = {.width = 64, .height = 48, .pixelclock = 1000000},
        .received = {.width = 64, .height = 48, .pixelclock = 1000000},
    };
    refusal.times = 0;
    fake_lacks_jpeg = false;
    fake_camera_fail_call(0, 0, false);
    now_us = 1000000000;
    n_blocks = 0;
}

struct fake_frame *fake_camera_add_frame(uint32_t sequence, int code)
{
    struct fake_frame *f = &camera.frame[camera.n_frames++];

    *f = (struct fake_frame){
        .sequence = sequence, .code = code, .time_us = now_us};
    return f;
}

void fake_camera_advance_clock(int64_t us)
{
    now_us += us;
}

int64_t fake_camera_time_us(void)
{
    return now_us;
}

int fake_camera_count_leaks(void)
{
    return n_blocks;
}

int fake_camera_count_allocations(void)
{
    return n_asked;
}

/* ------------------------------------------------------------------- format */

static int count_memory_blocks(uint32_t fourcc)
{
    return fourcc == V4L2_PIX_FMT_NV12M || fourcc == V4L2_PIX_FMT_NV21M ? 2
           : fourcc == V4L2_PIX_FMT_YUV420M                             ? 3
                                                                        : 1;
}

/* Returns the bytes per row in block BLOCK, 0 for compressed formats. */
static uint32_t compute_row_bytes_of_block(const struct fake_mode *m, int block)
{
    switch (m->fourcc) {
    case V4L2_PIX_FMT_YUYV:
    case V4L2_PIX_FMT_UYVY:
    case V4L2_PIX_FMT_RGB565:
        return 2 * m->width + camera.stride_more;
    case V4L2_PIX_FMT_RGB24:
    case V4L2_PIX_FMT_BGR24:
        return 3 * m->width + camera.stride_more;
    case V4L2_PIX_FMT_YUV420M:
        return (m->width + camera.stride_more) / (block ? 2 : 1);
    case V4L2_PIX_FMT_MJPEG:
    case V4L2_PIX_FMT_JPEG:
    case V4L2_PIX_FMT_H264:
        return 0;
    }
    return m->width + camera.stride_more;
}

static uint32_t compute_block_bytes(const struct fake_mode *m, int block)
{
    const uint32_t luma = compute_row_bytes_of_block(m, block) * m->height;

    if (camera.sizeimage)
        return camera.sizeimage;
    switch (m->fourcc) {
    case V4L2_PIX_FMT_NV12:
    case V4L2_PIX_FMT_NV21:
    case V4L2_PIX_FMT_YUV420:
        return luma + luma / 2;
    case V4L2_PIX_FMT_NV12M:
    case V4L2_PIX_FMT_NV21M:
    case V4L2_PIX_FMT_YUV420M:
        return block ? luma / 2 : luma;
    case V4L2_PIX_FMT_MJPEG:
    case V4L2_PIX_FMT_JPEG:
    case V4L2_PIX_FMT_H264:
        return 2 * m->width * m->height;
    }
    return luma;
}

static int answer_get_format(struct v4l2_format *f)
{
    const struct fake_mode *m = &camera.now;
    struct v4l2_pix_format_mplane *mp = &f->fmt.pix_mp;

    memset(&f->fmt, 0, sizeof f->fmt);
    if (!camera.multiplanar) {
        f->fmt.pix = (struct v4l2_pix_format){
            .width = m->width,
            .height = m->height,
            .pixelformat = m->fourcc,
            .bytesperline =
                camera.reports_no_stride ? 0 : compute_row_bytes_of_block(m, 0),
            .sizeimage = compute_block_bytes(m, 0),
            .colorspace = camera.colorspace,
            .quantization = camera.quantization,
            .ycbcr_enc = camera.ycbcr_enc};
        return 0;
    }
    mp->width = m->width;
    mp->height = m->height;
    mp->pixelformat = m->fourcc;
    mp->colorspace = camera.colorspace;
    mp->quantization = (uint8_t)camera.quantization;
    mp->num_planes = (uint8_t)count_memory_blocks(m->fourcc);
    for (int i = 0; i < mp->num_planes; i++) {
        mp->plane_fmt[i].bytesperline =
            camera.reports_no_stride ? 0 : compute_row_bytes_of_block(m, i);
        mp->plane_fmt[i].sizeimage = compute_block_bytes(m, i);
    }
    return 0;
}

static bool mode_has_fourcc(uint32_t fourcc)
{
    for (int i = 0; i < FAKE_MODES && camera.mode[i].fourcc; i++)
        if (camera.mode[i].fourcc == fourcc)
            return true;
    return false;
}

static int answer_set_format(struct v4l2_format *f)
{
    struct fake_mode *m = &camera.now;
    const uint32_t fourcc =
        camera.multiplanar ? f->fmt.pix_mp.pixelformat : f->fmt.pix.pixelformat;

    if (camera.n_buffers)
        return set_errno_and_fail(EBUSY);
    m->width = camera.multiplanar ? f->fmt.pix_mp.width : f->fmt.pix.width;
    m->height = camera.multiplanar ? f->fmt.pix_mp.height : f->fmt.pix.height;
    m->fourcc = mode_has_fourcc(fourcc) && !camera.ignores_fourcc
                    ? fourcc
                    : camera.mode[0].fourcc;
    if (camera.rounds) {
        m->width = (m->width + 15) / 16 * 16;
        m->height = (m->height + 15) / 16 * 16;
    }
    for (int i = FAKE_MODES - 1; i >= 0; i--)
        if (camera.mode[i].fourcc == m->fourcc &&
            camera.mode[i].width == m->width) {
            m->fps_num = camera.mode[i].fps_num;
            m->fps_den = camera.mode[i].fps_den;
        }
    return answer_get_format(f);
}

/* Returns mode number INDEX, from 0, of the modes for which WITHIN(mode, KEY)
 * is true. Modes that LIKE() reports as equal count once. Returns NULL if there
 * are fewer modes. */
static const struct fake_mode *
find_mode(uint32_t index,
          bool (*like)(const struct fake_mode *a, const struct fake_mode *b),
          const struct fake_mode *key,
          bool (*within)(const struct fake_mode *a, const struct fake_mode *b))
{
    for (int i = 0; i < FAKE_MODES && camera.mode[i].fourcc; i++) {
        const struct fake_mode *m = &camera.mode[i];
        bool is_new = within(m, key);

        for (int k = 0; k < i; k++)
            is_new &= !like(m, &camera.mode[k]);
        if (is_new && index-- == 0)
            return m;
    }
    return NULL;
}

static bool accepts_any_mode(const struct fake_mode *a,
                             const struct fake_mode *b)
{
    return a && b;
}

static bool modes_have_same_fourcc(const struct fake_mode *a,
                                   const struct fake_mode *b)
{
    return a->fourcc == b->fourcc;
}

static bool modes_have_same_size(const struct fake_mode *a,
                                 const struct fake_mode *b)
{
    return modes_have_same_fourcc(a, b) && a->width == b->width &&
           a->height == b->height;
}

static bool modes_are_equal(const struct fake_mode *a,
                            const struct fake_mode *b)
{
    return modes_have_same_size(a, b) && a->fps_num == b->fps_num &&
           a->fps_den == b->fps_den;
}

static int answer_enum_format(struct v4l2_fmtdesc *f)
{
    const struct fake_mode key = {.fourcc = 0};
    const struct fake_mode *m =
        find_mode(f->index, modes_have_same_fourcc, &key, accepts_any_mode);

    if (!m)
        return set_errno_and_fail(EINVAL);
    f->pixelformat = m->fourcc;
    memcpy(f->description, "of the fake", 12);
    return 0;
}

static int answer_enum_size(struct v4l2_frmsizeenum *s)
{
    const struct fake_mode key = {.fourcc = s->pixel_format};
    const struct fake_mode *m =
        find_mode(s->index, modes_have_same_size, &key, modes_have_same_fourcc);

    if (camera.has_no_sizes)
        return set_errno_and_fail(ENOTTY);
    if (!m || (camera.is_stepwise && s->index))
        return set_errno_and_fail(EINVAL);
    s->type = V4L2_FRMSIZE_TYPE_DISCRETE;
    s->discrete.width = m->width;
    s->discrete.height = m->height;
    if (camera.is_stepwise) {
        s->type = V4L2_FRMSIZE_TYPE_STEPWISE;
        s->stepwise =
            (struct v4l2_frmsize_stepwise){16, m->width, 16, 16, m->height, 16};
    }
    return 0;
}

static int answer_enum_interval(struct v4l2_frmivalenum *i)
{
    const struct fake_mode key = {
        .fourcc = i->pixel_format, .width = i->width, .height = i->height};
    const struct fake_mode *m =
        find_mode(i->index, modes_are_equal, &key, modes_have_same_size);

    if (camera.has_no_sizes)
        return set_errno_and_fail(ENOTTY);
    if (!m || (camera.is_stepwise && i->index))
        return set_errno_and_fail(EINVAL);
    i->type = V4L2_FRMIVAL_TYPE_DISCRETE;
    i->discrete = (struct v4l2_fract){m->fps_den, m->fps_num};
    if (camera.is_stepwise) {
        i->type = V4L2_FRMIVAL_TYPE_STEPWISE;
        i->stepwise = (struct v4l2_frmival_stepwise){
            {m->fps_den, m->fps_num}, {1, 1}, {1, 1000}};
    }
    return 0;
}

static int answer_frame_interval(struct v4l2_streamparm *p, bool set)
{
    struct v4l2_fract *t = &p->parm.capture.timeperframe;

    if (set && t->numerator && t->denominator) {
        for (int i = FAKE_MODES - 1; i >= 0; i--)
            if (camera.mode[i].fourcc == camera.now.fourcc &&
                camera.mode[i].fps_num * t->numerator ==
                    camera.mode[i].fps_den * t->denominator) {
                camera.now.fps_num = camera.mode[i].fps_num;
                camera.now.fps_den = camera.mode[i].fps_den;
            }
    }
    *t = (struct v4l2_fract){camera.now.fps_den, camera.now.fps_num};
    if (camera.rate.numerator)
        *t = camera.rate;
    return 0;
}

/* -------------------------------------------------------------------- input */

static int answer_get_input(struct v4l2_input *input)
{
    if (input->index >= camera.n_inputs)
        return set_errno_and_fail(EINVAL);
    memcpy(input->name, "HDMI", 5);
    input->capabilities = camera.has_dv ? V4L2_IN_CAP_DV_TIMINGS : 0;
    return 0;
}

static int answer_set_input(int index)
{
    if (index < 0 || (uint32_t)index >= camera.n_inputs)
        return set_errno_and_fail(EINVAL);
    camera.input = (uint32_t)index;
    return 0;
}

static int answer_query_timings(struct v4l2_dv_timings *t)
{
    memset(t, 0, sizeof *t);
    if (!camera.has_signal)
        return set_errno_and_fail(ENOLINK);
    t->bt = camera.received;
    return 0;
}

static int answer_set_timings(const struct v4l2_dv_timings *t)
{
    const bool same = t->bt.width == camera.timings.width &&
                      t->bt.height == camera.timings.height;

    camera.n_s_dv_timings++;
    if (camera.n_buffers && !same)
        return set_errno_and_fail(EBUSY);
    camera.timings = t->bt;
    camera.now.width = t->bt.width;
    camera.now.height = t->bt.height;
    return 0;
}

static int answer_dequeue_event(struct v4l2_event *e)
{
    if (camera.n_events == 0)
        return set_errno_and_fail(ENOENT);
    camera.n_events--;
    memset(e, 0, sizeof *e);
    e->type = V4L2_EVENT_SOURCE_CHANGE;
    e->u.src_change.changes = V4L2_EVENT_SRC_CH_RESOLUTION;
    return 0;
}

/* ------------------------------------------------------------------ buffers */

static bool is_buffer_mapped(void)
{
    for (uint32_t i = 0; i < camera.n_buffers; i++)
        for (int k = 0; k < 3; k++)
            if (camera.buffer[i].map[k])
                return true;
    return false;
}

static int answer_request_buffers(struct v4l2_requestbuffers *r)
{
    camera.n_reqbufs++;
    if (camera.lacks_mmap && r->memory == V4L2_MEMORY_MMAP)
        return set_errno_and_fail(EINVAL);
    if (camera.streams || is_buffer_mapped())
        return set_errno_and_fail(EBUSY);
    memset(camera.buffer, 0, sizeof camera.buffer);
    camera.n_queued = 0;
    if (r->count > camera.max_buffers)
        r->count = camera.max_buffers;
    camera.n_buffers = r->count;
    for (uint32_t i = 0; i < r->count; i++)
        for (int k = 0; k < count_memory_blocks(camera.now.fourcc); k++)
            camera.buffer[i].bytes[k] =
                compute_block_bytes(&camera.now, k) - camera.length_less;
    return 0;
}

static int answer_query_buffer(struct v4l2_buffer *b)
{
    const struct fake_buffer *own = &camera.buffer[b->index];

    if (b->index >= camera.n_buffers)
        return set_errno_and_fail(EINVAL);
    if (!camera.multiplanar) {
        b->length = own->bytes[0];
        b->m.offset = 16 * 4096 * b->index;
        return 0;
    }
    b->length = (uint32_t)count_memory_blocks(camera.now.fourcc);
    for (uint32_t k = 0; k < b->length; k++) {
        b->m.planes[k].length = own->bytes[k];
        b->m.planes[k].m.mem_offset = 16 * 4096 * b->index + 4096 * k;
    }
    return 0;
}

static int answer_queue_buffer(const struct v4l2_buffer *b)
{
    struct fake_buffer *own = &camera.buffer[b->index];

    if (b->index >= camera.n_buffers || own->queued ||
        (camera.multiplanar &&
         b->length < (uint32_t)count_memory_blocks(camera.now.fourcc))) {
        camera.breaches++;
        return set_errno_and_fail(EINVAL);
    }
    own->queued = true;
    if (b->memory == V4L2_MEMORY_USERPTR) {
        own->own[0] = b->m.userptr;
        own->bytes[0] = b->length;
        for (int k = 0;
             camera.multiplanar && k < count_memory_blocks(camera.now.fourcc);
             k++) {
            own->own[k] = b->m.planes[k].m.userptr;
            own->bytes[k] = b->m.planes[k].length;
        }
    }
    camera.order[camera.n_queued++] = b->index;
    return 0;
}

static struct fake_frame remove_oldest_frame(void)
{
    const struct fake_frame f = camera.frame[0];

    camera.n_frames--;
    memmove(camera.frame, camera.frame + 1, (size_t)camera.n_frames * sizeof f);
    return f;
}

static void fill_buffer_with_frame(const struct fake_frame *f,
                                   const struct fake_buffer *b, int block)
{
    uint8_t *mem = b->own[block] ? (uint8_t *)b->own[block] : b->map[block];

    if (!mem) {
        camera.breaches++;
        return;
    }
    memset(mem, f->code, b->bytes[block]);
    memset(mem, 0, f->data_offset[block]);
    if (f->data)
        memcpy(mem + f->data_offset[block], f->data, f->bytesused[0]);
}

static uint32_t compute_bytes_used(const struct fake_frame *f, int block)
{
    return f->bytesused[block] || f->is_odd
               ? f->bytesused[block]
               : compute_block_bytes(&camera.now, block) +
                     f->data_offset[block];
}

static int answer_dequeue_buffer(struct v4l2_buffer *b)
{
    struct fake_frame f;
    struct fake_buffer *own;

    if (camera.on_dequeue)
        camera.on_dequeue();
    if (camera.is_broken)
        return set_errno_and_fail(EIO);
    if (!camera.streams)
        return set_errno_and_fail(EINVAL);
    if (camera.n_frames && camera.frame[0].error)
        return set_errno_and_fail(remove_oldest_frame().error);
    if (camera.n_frames == 0 || camera.n_queued == 0)
        return set_errno_and_fail(EAGAIN);
    f = remove_oldest_frame();
    b->index = camera.order[0];
    own = &camera.buffer[b->index];
    camera.n_queued--;
    memmove(camera.order, camera.order + 1,
            (size_t)camera.n_queued * sizeof *camera.order);
    own->queued = false;
    if (camera.returned_index)
        b->index = (uint32_t)camera.returned_index - 1;
    b->sequence = f.sequence;
    b->flags = f.flags | (f.unknown_clock ? V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN
                                          : V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC);
    b->timestamp.tv_sec = f.time_us / 1000000;
    b->timestamp.tv_usec = f.time_us % 1000000;
    for (int k = 0; k < count_memory_blocks(camera.now.fourcc); k++) {
        fill_buffer_with_frame(&f, own, k);
        if (camera.multiplanar) {
            b->m.planes[k].bytesused = compute_bytes_used(&f, k);
            b->m.planes[k].data_offset = f.data_offset[k];
        } else
            b->bytesused = compute_bytes_used(&f, k);
    }
    return 0;
}

static int answer_stream_on_or_off(bool on)
{
    if (on && camera.n_buffers == 0)
        return set_errno_and_fail(EINVAL);
    if (on && camera.on_stream)
        camera.on_stream();
    camera.n_streamons += on;
    camera.streams = on;
    if (!on) {
        camera.is_broken = false;
        camera.n_queued = 0;
        for (uint32_t i = 0; i < camera.n_buffers; i++)
            camera.buffer[i].queued = false;
    }
    return 0;
}

static int answer_export_buffer(struct v4l2_exportbuffer *e)
{
    e->fd = __real_open64("/dev/null", O_RDWR);
    camera.n_exports++;
    return 0;
}

/* ---------------------------------------------------- replaced system calls */

static int answer_camera_ioctl(unsigned long request, void *arg)
{
    struct v4l2_capability *cap = arg;

    switch (request) {
    case VIDIOC_QUERYCAP:
        *cap = (struct v4l2_capability){.card = "Fake",
                                        .capabilities =
                                            V4L2_CAP_DEVICE_CAPS | camera.caps,
                                        .device_caps = camera.caps};
        return 0;
    case VIDIOC_ENUM_FMT:
        return answer_enum_format(arg);
    case VIDIOC_ENUM_FRAMESIZES:
        return answer_enum_size(arg);
    case VIDIOC_ENUM_FRAMEINTERVALS:
        return answer_enum_interval(arg);
    case VIDIOC_G_FMT:
        return answer_get_format(arg);
    case VIDIOC_S_FMT:
        return answer_set_format(arg);
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
        return answer_frame_interval(arg, request == VIDIOC_S_PARM);
    case VIDIOC_G_INPUT:
        *(int *)arg = (int)camera.input;
        return 0;
    case VIDIOC_S_INPUT:
        return answer_set_input(*(const int *)arg);
    case VIDIOC_ENUMINPUT:
        return answer_get_input(arg);
    case VIDIOC_QUERY_DV_TIMINGS:
        return answer_query_timings(arg);
    case VIDIOC_G_DV_TIMINGS:
        ((struct v4l2_dv_timings *)arg)->bt = camera.timings;
        return 0;
    case VIDIOC_S_DV_TIMINGS:
        return answer_set_timings(arg);
    case VIDIOC_SUBSCRIBE_EVENT:
        return 0;
    case VIDIOC_DQEVENT:
        return answer_dequeue_event(arg);
    case VIDIOC_REQBUFS:
        return answer_request_buffers(arg);
    case VIDIOC_QUERYBUF:
        return answer_query_buffer(arg);
    case VIDIOC_QBUF:
        return answer_queue_buffer(arg);
    case VIDIOC_DQBUF:
        return answer_dequeue_buffer(arg);
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
        return answer_stream_on_or_off(request == VIDIOC_STREAMON);
    case VIDIOC_EXPBUF:
        return answer_export_buffer(arg);
    }
    return set_errno_and_fail(ENOTTY);
}

int __wrap_ioctl(int fd, unsigned long request, ...)
{
    va_list args;
    void *arg;

    va_start(args, request);
    arg = va_arg(args, void *);
    va_end(args);
    if (fd != camera.fd || fd < 0)
        return __real_ioctl(fd, request, arg);
    if (request == VIDIOC_STREAMOFF || camera.is_gone)
        /* the stream stops even if the request is made to fail below */
        camera.streams = false;
    if (must_fail_this_call() || is_request_refused(request, arg))
        return -1;
    return camera.is_gone ? set_errno_and_fail(ENODEV)
                          : answer_camera_ioctl(request, arg);
}

int __wrap_open64(const char *path, int flags, ...)
{
    int mode;
    va_list args;

    va_start(args, flags);
    mode = flags & O_CREAT ? va_arg(args, int) : 0;
    va_end(args);
    if (strcmp(path, FAKE_PATH) != 0)
        return __real_open64(path, flags, mode);
    if (must_fail_this_call())
        return -1;
    if (camera.is_gone)
        return set_errno_and_fail(ENODEV);
    if (camera.fd >= 0)
        camera.breaches++;
    return camera.fd = __real_open64("/dev/null", flags);
}

int __real_stat64(const char *path, struct stat *st);
int __wrap_stat64(const char *path, struct stat *st);
int __wrap_stat64(const char *path, struct stat *st)
{
    if (strcmp(path, FAKE_PATH) != 0)
        return __real_stat64(path, st);
    return camera.is_gone ? set_errno_and_fail(ENOENT)
                          : __real_stat64("/dev/null", st);
}

/* Closes the camera as the kernel does: the stream stops, mapped buffers
 * stay mapped. */
int __wrap_close(int fd)
{
    if (fd == camera.fd && fd >= 0) {
        camera.fd = -1;
        camera.streams = false;
        camera.n_queued = 0;
        if (!is_buffer_mapped())
            camera.n_buffers = 0;
    }
    return __real_close(fd);
}

ssize_t __real_read(int fd, void *dst, size_t bytes);
ssize_t __wrap_read(int fd, void *dst, size_t bytes);
ssize_t __wrap_read(int fd, void *dst, size_t bytes)
{
    struct fake_frame f;
    size_t n;

    if (fd != camera.fd || fd < 0)
        return __real_read(fd, dst, bytes);
    if (must_fail_this_call())
        return -1;
    if (camera.is_gone || camera.read_errno)
        return set_errno_and_fail(camera.is_gone ? ENODEV : camera.read_errno);
    /* read() starts the stream, which runs until the device is closed */
    camera.streams = true;
    camera.n_buffers = 1;
    if (camera.n_frames == 0)
        return set_errno_and_fail(EAGAIN);
    f = remove_oldest_frame();
    n = compute_bytes_used(&f, 0) < bytes ? compute_bytes_used(&f, 0) : bytes;
    memset(dst, f.code, n);
    if (f.data)
        memcpy(dst, f.data, n);
    return (ssize_t)n;
}

/* ------------------------------------------------------------------- memory */

void __real_free(void *mem);

void *__wrap_mmap64(void *at, size_t bytes, int how, int flags, int fd,
                    off_t offset)
{
    const off_t page = offset / 4096;
    struct fake_buffer *b = &camera.buffer[page / 16 % FAKE_BUFFERS];

    if (fd != camera.fd || fd < 0)
        return __real_mmap64(at, bytes, how, flags, fd, offset);
    if (must_fail_this_call())
        return MAP_FAILED;
    if (page % 16 > 2 || (uint32_t)(page / 16) >= camera.n_buffers ||
        bytes != b->bytes[page % 16] || bytes == 0) {
        errno = EINVAL;
        return MAP_FAILED;
    }
    /* allocated by malloc(), so that sanitizers detect reads outside it or
     * after munmap() */
    b->map[page % 16] = __real_malloc(bytes);
    memset(b->map[page % 16], 0, bytes);
    camera.n_maps++;
    return b->map[page % 16];
}

int __wrap_munmap(void *at, size_t bytes)
{
    for (int i = 0; i < FAKE_BUFFERS; i++)
        for (int k = 0; k < 3; k++)
            if (at && camera.buffer[i].map[k] == at) {
                camera.breaches +=
                    camera.buffer[i].bytes[k] != bytes || camera.streams;
                camera.buffer[i].map[k] = NULL;
                camera.n_maps--;
                __real_free(at);
                return 0;
            }
    return __real_munmap(at, bytes);
}

void *__wrap_malloc(size_t bytes)
{
    void *const mem = must_fail_this_call() ? NULL : __real_malloc(bytes);

    n_asked++;
    n_blocks += mem != NULL;
    return mem;
}

void *__wrap_calloc(size_t n, size_t bytes)
{
    void *const mem = must_fail_this_call() ? NULL : __real_calloc(n, bytes);

    n_asked++;
    n_blocks += mem != NULL;
    return mem;
}

void *__wrap_realloc(void *old, size_t bytes)
{
    void *const mem = must_fail_this_call() ? NULL : __real_realloc(old, bytes);

    n_asked++;
    n_blocks += mem != NULL && old == NULL;
    return mem;
}

int __wrap_posix_memalign(void **mem, size_t align, size_t bytes)
{
    const int number =
        must_fail_this_call() ? 12 : __real_posix_memalign(mem, align, bytes);

    n_asked++;
    n_blocks += number == 0;
    return number;
}

char *__real_strdup(const char *text);
char *__wrap_strdup(const char *text);
char *__wrap_strdup(const char *text)
{
    char *const mem = must_fail_this_call() ? NULL : __real_strdup(text);

    n_asked++;
    n_blocks += mem != NULL;
    return mem;
}

char *__real_realpath(const char *path, char *into);
char *__wrap_realpath(const char *path, char *into);
char *__wrap_realpath(const char *path, char *into)
{
    char *const mem =
        must_fail_this_call() ? NULL : __real_realpath(path, into);

    n_asked++;
    n_blocks += mem != NULL && !into;
    return mem;
}

void __wrap_free(void *mem);
void __wrap_free(void *mem)
{
    n_blocks -= mem != NULL;
    if (mem) /* Overwriting the freed block reveals code that still reads it. */
        memset(mem, 0xdd, malloc_usable_size(mem));
    __real_free(mem);
}

/* --------------------------------------------------------------------- time */

int __wrap_clock_gettime(clockid_t clock, struct timespec *t);
int __wrap_clock_gettime(clockid_t clock, struct timespec *t)
{
    (void)clock;
    t->tv_sec = now_us / 1000000;
    t->tv_nsec = now_us % 1000000 * 1000;
    return 0;
}

int __wrap_nanosleep(const struct timespec *t, struct timespec *left);
int __wrap_nanosleep(const struct timespec *t, struct timespec *left)
{
    (void)left;
    now_us += (int64_t)t->tv_sec * 1000000 + t->tv_nsec / 1000;
    return 0;
}

/* --------------------------------------------------------------------- jpeg */

bool __real_glint_mjpeg_available(void);
bool __wrap_glint_mjpeg_available(void);
bool __wrap_glint_mjpeg_available(void)
{
    return !fake_lacks_jpeg && __real_glint_mjpeg_available();
}
