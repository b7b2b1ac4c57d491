/* SPDX-License-Identifier: MIT */
#include "live/live_input.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "formats/paint.h"
#include "linux/fourcc.h"
#include "posix/clock.h"

static void ignore_returned_frame(struct glint_source *source,
                                  struct glint_source_frame *frame)
{
    (void)source, (void)frame;
}

static void get_timed_source_format(const struct glint_source *source,
                                    struct glint_source_format *format)
{
    *format = ((const struct live_timed *)source)->format;
}

/* Starts the timer, unless the source has its own descriptor. */
static enum glint_status start_frame_timer(struct glint_source *source,
                                           struct glint_error *error)
{
    struct live_timed *timed = (struct live_timed *)source;
    const struct glint_source_format *f = &timed->format;
    const int64_t stated = 1000000000LL * f->fps_den / f->fps_num;
    /* an interval of 0 would stop the timer */
    const int64_t ns = stated > 1000 ? stated : 1000;
    const struct timespec period = {(time_t)(ns / 1000000000),
                                    (long)(ns % 1000000000)};
    const struct itimerspec times = {period, period};

    if (source->fd >= 0)
        return GLINT_OK;
    timed->timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
    if (timed->timer < 0 || timerfd_settime(timed->timer, 0, &times, NULL) < 0)
        return glint_error_report(error, GLINT_E_DEVICE, timed->name,
                                  "no timer: %s", strerror(errno));
    source->fd = timed->timer;
    return GLINT_OK;
}

/* Initialises TIMED for frames of FORMAT; rate, range and matrix of WISH, if
 * set, override those of FORMAT. CARD is a description of the source.
 * start() starts a timer and makes it the source's descriptor. The caller
 * sets next() and close(). */
static void init_timed_source(struct live_timed *timed,
                              const struct glint_source_format *format,
                              const struct glint_v4l2_config *wish,
                              const char *card)
{
    struct glint_source_format *f = &timed->format;

    timed->source = (struct glint_source){.fd = -1,
                                          .has_signal = true,
                                          .start = start_frame_timer,
                                          .done = ignore_returned_frame,
                                          .describe = get_timed_source_format};
    timed->format = *format;
    timed->name = wish->device;
    timed->timer = -1;
    timed->n = 0;
    if (f->fps_num == 0)
        f->fps_num = 30, f->fps_den = 1;
    if (wish->fps_num) {
        f->fps_num = wish->fps_num;
        f->fps_den = wish->fps_den;
    }
    if (wish->range >= 0)
        f->image.range = (enum glint_range)wish->range;
    if (wish->matrix >= 0)
        f->image.matrix = (enum glint_matrix)wish->matrix;
    snprintf(f->text, sizeof f->text, "%.256s (%s): %dx%d, %.5g fps",
             wish->device, card, f->image.width, f->image.height,
             (double)f->fps_num / f->fps_den);
}

/* Returns the number of frames that are due now. The first frame is due at
 * once. Without a timer every call finds one frame due. */
static uint64_t count_frames_due_by_now(struct live_timed *timed)
{
    uint64_t n = 0;

    if (timed->timer < 0 || timed->n == 0)
        return 1;
    return read(timed->timer, &n, sizeof n) == (ssize_t)sizeof n ? n : 0;
}

/* Begins FRAME. Returns the number of frames that became due since the last
 * call; the caller shows only the last one. */
static uint64_t begin_timed_frame(struct live_timed *timed,
                                  struct glint_source_frame *frame)
{
    const uint64_t n = count_frames_due_by_now(timed);

    *frame = (struct glint_source_frame){.is_drawable = true};
    if (n > 0)
        frame->time_us = glint_get_time_us();
    return n;
}

/* Completes FRAME with IMAGE, the last of N frames due. */
static void complete_timed_frame(struct live_timed *timed,
                                 struct glint_source_frame *frame,
                                 const struct glint_image *image, uint64_t n)
{
    frame->image = *image;
    frame->image.range = timed->format.image.range;
    frame->image.matrix = timed->format.image.matrix;
    frame->sequence = (uint32_t)timed->n;
    frame->n_late = (int)(n - 1);
}

static void stop_frame_timer(struct live_timed *timed)
{
    if (timed->timer >= 0)
        close(timed->timer);
    timed->timer = -1;
    timed->source.fd = -1;
}

enum { HOUSES = 14, DARKEST = 22, BRIGHTEST = 235 };

static uint32_t hash_32_bits(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/* Draws house number HOUSE from the bottom up. Some of its windows are lit, but
 * too dark to be detected as lamps. */
static void draw_house_of_test_street(struct live_timed *s, int house)
{
    const int w = s->image.width, h = s->image.height;
    const int left = house * w / HOUSES, right = (house + 1) * w / HOUSES;
    const int tall =
        h / 5 + (int)(hash_32_bits((uint32_t)house + 7) % 100) * h / 400;
    const int pane = 2 + h / 120;

    for (int y = h - tall; y < h; y++)
        for (int x = left; x < right; x++) {
            const int column = (x - left) / (2 * pane),
                      row = (y - h + tall) / (3 * pane);
            const uint32_t bits =
                hash_32_bits((uint32_t)(house * 997 + column * 31 + row * 7));
            const int is_pane = (x - left) % (2 * pane) < pane &&
                                (y - h + tall) % (3 * pane) < 2 * pane;

            s->still[y * w + x] =
                (uint8_t)(is_pane && bits % 5 == 0 ? 70 + bits % 40 : 30);
        }
}

static void draw_test_street(struct live_timed *s)
{
    const int w = s->image.width, h = s->image.height;

    for (int y = 0; y < h; y++)
        memset(s->still + (size_t)y * (size_t)w, DARKEST + 14 * y / h,
               (size_t)w);
    for (int house = 0; house < HOUSES; house++)
        draw_house_of_test_street(s, house);
}

/* Copies the static street to the frame and adds noise of -1 .. 2 codes that
 * depends on the seed and N. */
static void draw_frame_background(struct live_timed *s, int64_t n)
{
    const int w = s->image.width;
    uint32_t bits = hash_32_bits(s->seed * 2654435761u + (uint32_t)n) | 1;

    for (int y = 0; y < s->image.height; y++) {
        uint8_t *row = s->image.plane[0] + y * s->image.stride_bytes[0];
        const uint8_t *from = s->still + (size_t)y * (size_t)w;

        for (int x = 0; x < w; x++) {
            bits ^= bits << 13; /* [Marsaglia03] */
            bits ^= bits >> 17;
            bits ^= bits << 5;
            row[x] = (uint8_t)(from[x] + (bits >> 8 & 3) - 1);
        }
    }
}

/* Adds a disc of RADIUS pixels at (CX, CY), with a halo that falls with the
 * square of the distance. */
static void add_lamp_to_test_frame(struct live_timed *s, double cx, double cy,
                                   double radius)
{
    const int reach = (int)(12 * radius) + 1;

    for (int y = (int)cy - reach; y <= (int)cy + reach; y++)
        for (int x = (int)cx - reach; x <= (int)cx + reach; x++) {
            const double r = hypot(x - cx, y - cy) / radius;
            const double halo = 60 / (1 + r * r) - 60 / 145.0;
            const double add = r < 1 ? 255 : r < 2 ? 255 * (2 - r) : 0;
            uint8_t *at;
            double code;

            if (x < 0 || y < 0 || x >= s->image.width || y >= s->image.height)
                continue;
            at = s->image.plane[0] + y * s->image.stride_bytes[0] + x;
            code = *at + fmax(halo, 0) + add;
            *at = (uint8_t)(code < BRIGHTEST ? code : BRIGHTEST);
        }
}

/* Draws frame N of the test image: street, noise and the circling lamp. */
static void draw_test_frame(struct live_timed *s, int64_t n)
{
    const struct glint_image *i = &s->image;
    const double per_second = (double)s->format.fps_num / s->format.fps_den;
    const double turn = fmod((double)n / (8 * per_second), 1);
    const double angle = 6.283185307179586 * turn;

    if (s->is_black) {
        paint_set_image_black(i);
        return;
    }
    draw_frame_background(s, n);
    for (int p = 1; p < 3; p++) /* chroma planes, bluish as at night */
        for (int y = 0; y < glint_image_plane_height(i->format, p, i->height);
             y++)
            memset(i->plane[p] + y * i->stride_bytes[p], p == 1 ? 134 : 125,
                   glint_image_row_bytes(i->format, p, i->width));
    add_lamp_to_test_frame(s, i->width * (0.5 + 0.32 * cos(angle)),
                           i->height * (0.38 + 0.25 * sin(angle)),
                           fmax(1.5, i->height / 120.0));
}

/* ------------------------------------------------------------------- source */

static enum glint_status read_next_test_frame(struct glint_source *source,
                                              struct glint_source_frame *frame,
                                              struct glint_error *error)
{
    struct live_timed *s = (struct live_timed *)source;
    const uint64_t n = begin_timed_frame(s, frame);

    (void)error;
    if (n == 0)
        return GLINT_OK;
    s->n += (int64_t)n;
    draw_test_frame(s, s->n - 1);
    complete_timed_frame(s, frame, &s->image, n);
    return GLINT_OK;
}

static void close_test_image(struct glint_source *source)
{
    struct live_timed *s = (struct live_timed *)source;

    stop_frame_timer(s);
    free(s->mem);
    s->mem = NULL;
}

/* Returns the test image, still without planes: limited range, the size of
 * WISH, or 640 x 360. */
static struct glint_image make_test_format(const struct glint_v4l2_config *wish)
{
    const int width = wish->width ? wish->width : 640;
    const int height = wish->width ? wish->height : 360;

    return (struct glint_image){.format = GLINT_I420,
                                .width = width,
                                .height = height,
                                .range = GLINT_RANGE_LIMITED,
                                .matrix = height < 720 ? GLINT_MATRIX_BT601
                                                       : GLINT_MATRIX_BT709,
                                .transfer = GLINT_TONE_BT709};
}

static enum glint_status allocate_test_images(struct live_timed *s)
{
    const int w = s->image.width, h = s->image.height;
    const size_t luma = (size_t)w * (size_t)h;

    s->mem = malloc(glint_image_bytes(GLINT_I420, w, h) + luma);
    if (!s->mem)
        return GLINT_E_MEMORY;
    s->still = s->mem;
    glint_image_place(&s->image, s->still + luma);
    draw_test_street(s);
    return GLINT_OK;
}

/* Opens the test image as TEST. WISH may set width and height, 16 to
 * GLINT_PANEL_SIDE pixels, rate, range and matrix. SEED is the seed of the
 * noise. The lamp circles in eight seconds. If IS_BLACK, all frames are black
 * instead. Errors: GLINT_E_UNSUPPORTED, GLINT_E_MEMORY. */
static enum glint_status open_test_image(struct live_timed *test,
                                         const struct glint_v4l2_config *wish,
                                         uint32_t seed, bool is_black,
                                         struct glint_error *error)
{
    const struct glint_image image = make_test_format(wish);

    if (image.width < 16 || image.height < 16 ||
        image.width > GLINT_PANEL_SIDE || image.height > GLINT_PANEL_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, "test",
                                  "must have sides of 16 to %d pixels",
                                  GLINT_PANEL_SIDE);
    *test =
        (struct live_timed){.image = image, .seed = seed, .is_black = is_black};
    if (allocate_test_images(test) != GLINT_OK)
        return glint_error_report(error, GLINT_E_MEMORY, "test",
                                  "no memory for %d x %d pixels", image.width,
                                  image.height);
    init_timed_source(test, &(struct glint_source_format){.image = image}, wish,
                      is_black ? "black" : "a lamp over a night street");
    test->source.next = read_next_test_frame;
    test->source.close = close_test_image;
    return GLINT_OK;
}

/* Reads the last frame that is due, or the last frame of the video if it ends
 * before. Skipped frames are counted as late. */
static enum glint_status read_next_video_frame(struct glint_source *source,
                                               struct glint_source_frame *frame,
                                               struct glint_error *error)
{
    struct live_timed *v = (struct live_timed *)source;
    const uint64_t n = begin_timed_frame(v, frame);
    const struct glint_image *image = NULL, *after = NULL;
    uint64_t n_read = 0;

    while (n_read < n) {
        const enum glint_status status =
            glint_y4m_reader_next(&v->reader, &after, error);

        if (status != GLINT_OK)
            return status;
        if (!after)
            break;
        image = after;
        n_read++;
    }
    v->n += (int64_t)n_read;
    if (image)
        complete_timed_frame(v, frame, image, n_read);
    return n > 0 && !image ? GLINT_E_CLOSED : GLINT_OK;
}

static void close_video_input(struct glint_source *source)
{
    struct live_timed *v = (struct live_timed *)source;

    stop_frame_timer(v);
    glint_y4m_reader_close(&v->reader);
}

/* Opens the video FILE.y4m or "-" that WISH names as its device. WISH may
 * override rate, range and matrix. On failure VIDEO is closed. */
static enum glint_status open_video_input(struct live_timed *video,
                                          const struct glint_v4l2_config *wish,
                                          struct glint_error *error)
{
    const struct glint_y4m_header *h = &video->reader.header;
    const enum glint_status status =
        glint_y4m_reader_open(&video->reader, wish->device, error);

    if (status != GLINT_OK)
        return status;
    init_timed_source(
        video,
        &(struct glint_source_format){.image = {.format = h->format,
                                                .width = h->width,
                                                .height = h->height,
                                                .range = h->range,
                                                .matrix = h->matrix,
                                                .transfer = GLINT_TONE_BT709},
                                      .fps_num = h->fps_num,
                                      .fps_den = h->fps_den},
        wish, "a video");
    video->source.next = read_next_video_frame;
    video->source.close = close_video_input;
    if (strcmp(wish->device, "-") == 0)
        video->source.fd = video->reader.in.fd;
    return GLINT_OK;
}

/* ----------------------------------------------------- pipes of bare frames */

/* Reads bytes of a frame while there are any, without waiting. Returns 1 if the
 * frame is complete, 0 if not, -1 at the end of the pipe or, with errno set, on
 * failure. */
static int read_bare_bytes(struct live_timed *v)
{
    struct pollfd pipe = {.fd = v->pipe.fd, .events = POLLIN};

    errno = 0;
    while (v->n_read < v->frame_bytes) {
        ptrdiff_t got;

        if (poll(&pipe, 1, 0) <= 0)
            return 0;
        got =
            glint_input_read_available(&v->pipe, (uint8_t *)v->mem + v->n_read,
                                       v->frame_bytes - v->n_read);
        if (got <= 0)
            return -1;
        v->n_read += (size_t)got;
    }
    return 1;
}

static enum glint_status read_next_bare_frame(struct glint_source *source,
                                              struct glint_source_frame *frame,
                                              struct glint_error *error)
{
    struct live_timed *v = (struct live_timed *)source;
    const int state = read_bare_bytes(v);

    *frame = (struct glint_source_frame){.is_drawable = true};
    if (state < 0 && errno)
        return glint_error_report(error, GLINT_E_IO, v->pipe.name, "%s",
                                  strerror(errno));
    if (state < 0 && v->n_read == 0)
        return GLINT_E_CLOSED;
    if (state < 0)
        return glint_error_report(
            error, GLINT_E_IO, v->pipe.name,
            "ends within frame %lld, after %zu of %zu bytes; are --size, "
            "--format and --stride those of the frames?",
            (long long)v->n, v->n_read, v->frame_bytes);
    if (state == 0)
        return GLINT_OK;
    v->n_read = 0;
    v->n++;
    frame->time_us = glint_get_time_us();
    complete_timed_frame(v, frame, &v->image, 1);
    return GLINT_OK;
}

static void close_bare_frames(struct glint_source *source)
{
    struct live_timed *v = (struct live_timed *)source;

    glint_input_close(&v->pipe);
    free(v->mem);
    v->mem = NULL;
    source->fd = -1;
}

/* Places the planes of IMAGE in MEM, with rows of luma STRIDE bytes apart, and
 * those of half as many samples half as far; MEM may be NULL. Returns the
 * bytes of a frame. */
static uint64_t place_bare_frame(struct glint_image *image, uint8_t *mem,
                                 size_t stride)
{
    const bool is_halved =
        image->format == GLINT_I420 || image->format == GLINT_I422;
    uint64_t bytes = 0;

    for (int p = 0; p < glint_image_planes(image->format); p++) {
        const size_t row =
            glint_image_row_bytes(image->format, p, image->width);
        size_t apart = p > 0 && is_halved ? (stride + 1) / 2 : stride;

        if (apart < row)
            apart = row;
        image->plane[p] = mem ? mem + bytes : NULL;
        image->stride_bytes[p] = (ptrdiff_t)apart;
        bytes += (uint64_t)apart * (uint64_t)glint_image_plane_height(
                                       image->format, p, image->height);
    }
    return bytes;
}

/* Opens standard input as frames of the format, size and stride of WISH. */
static enum glint_status open_bare_frames(struct live_timed *v,
                                          const struct live_wish *wish,
                                          struct glint_error *error)
{
    const struct glint_v4l2_config *const c = &wish->camera;
    struct glint_image image = make_test_format(c);
    size_t row, stride;
    uint64_t bytes;

    if (!glint_fourcc_to_format(c->fourcc, &image.format) || c->width < 1)
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, c->device,
            "bare frames need --size WxH and --format YUYV, UYVY, NV12, I420, "
            "GREY or RGB24");
    if (glint_image_is_rgb(image.format))
        image.range = GLINT_RANGE_FULL;
    row = glint_image_row_bytes(image.format, 0, image.width);
    stride = wish->stride_bytes ? (size_t)wish->stride_bytes : row;
    if (stride < row)
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, c->device,
            "a row of %d pixels has %zu bytes, more than --stride %zu",
            image.width, row, stride);
    *v = (struct live_timed){.image = image};
    bytes = place_bare_frame(&v->image, NULL, stride);
    v->frame_bytes = (size_t)bytes;
    v->mem = bytes < SIZE_MAX / 2 ? malloc(v->frame_bytes) : NULL;
    if (!v->mem)
        return glint_error_report(error, GLINT_E_MEMORY, c->device,
                                  "no memory for a frame of %llu bytes",
                                  (unsigned long long)bytes);
    place_bare_frame(&v->image, v->mem, stride);
    init_timed_source(v, &(struct glint_source_format){.image = image}, c,
                      "bare frames");
    v->source.next = read_next_bare_frame;
    v->source.close = close_bare_frames;
    return GLINT_OK;
}

static enum glint_status start_bare_frames(struct live_timed *v,
                                           struct glint_error *error)
{
    const enum glint_status status = glint_input_open(&v->pipe, v->name, error);

    if (status != GLINT_OK) {
        close_bare_frames(&v->source);
        return status;
    }
    v->source.fd = v->pipe.fd;
    return GLINT_OK;
}

static bool is_test_device(const char *name)
{
    return strcmp(name, "test") == 0 || strcmp(name, "none") == 0;
}

bool live_input_is_camera(const char *name)
{
    return !is_test_device(name) && !glint_y4m_has_extension(name) &&
           strcmp(name, "-") != 0;
}

enum glint_status live_input_open(struct live_input *input,
                                  const struct live_wish *wish, uint32_t seed,
                                  struct glint_error *error)
{
    const char *const name = wish->camera.device;
    struct glint_source *source;
    enum glint_status status;

    if (live_input_is_camera(name)) {
        source = &input->as.camera.source;
        status = glint_v4l2_open(&input->as.camera, &wish->camera, wish->io,
                                 wish->n_buffers, error);
    } else if (is_test_device(name)) {
        source = &input->as.timed.source;
        status = open_test_image(&input->as.timed, &wish->camera, seed,
                                 strcmp(name, "none") == 0, error);
    } else if (strcmp(name, "-") == 0 && wish->camera.fourcc) {
        source = &input->as.timed.source;
        status = open_bare_frames(&input->as.timed, wish, error);
        if (status == GLINT_OK)
            status = start_bare_frames(&input->as.timed, error);
    } else {
        source = &input->as.timed.source;
        status = open_video_input(&input->as.timed, &wish->camera, error);
    }
    input->source = status == GLINT_OK ? source : NULL;
    return status;
}

enum glint_status live_input_start(struct live_input *input,
                                   struct glint_error *error)
{
    const enum glint_status status = input->source->start(input->source, error);

    if (status != GLINT_OK)
        live_input_close(input);
    return status;
}

void live_input_close(struct live_input *input)
{
    if (input->source)
        input->source->close(input->source);
    input->source = NULL;
}

/* Returns whether NAME has a file extension. Returns false for names in /dev/.
 */
static bool has_file_extension(const char *name)
{
    const char *const slash = strrchr(name, '/');

    return strncmp(name, "/dev/", 5) != 0 && strchr(slash ? slash : name, '.');
}

int live_input_report_error(const struct live_log *log, const char *device,
                            enum glint_status status,
                            const struct glint_error *error)
{
    char text[sizeof error->text + 120];

    if (status == GLINT_E_DEVICE && has_file_extension(device)) {
        snprintf(
            text, sizeof text,
            "%.160s: not a camera; use glint overlay for videos and pictures, "
            "or 'ffmpeg -i FILE -f yuv4mpegpipe - | glint live -d -'",
            device);
        return tool_fail(log->tool, status, text);
    }
    return live_log_print_error(
        log, status, error,
        live_input_is_camera(device) ? "-d test, or a .y4m file" : NULL);
}
