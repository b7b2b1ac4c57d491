/* SPDX-License-Identifier: MIT
 *
 * obs_host MODULE FORMAT WxH [KEY=VALUE[@FRAME]]... - filters raw frames from
 * standard input by the OBS filter of MODULE and writes them to standard
 * output. The program starts the core of libobs with its graphics thread, a
 * source that outputs the frames, the filter of MODULE, and a second filter
 * that captures its output. Values begin with bool:, number: or word:. The
 * first frame is repeated until the filter has opened its lens, for at most
 * WAIT_S seconds.
 */
#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <obs-module.h>

enum { WAIT_S = 3600, FRAME_MS = 40, POLL_US = 2000, SLOW_POLLS = 100000 };

/* ------------------------------------------------------------------- frames */

/* Sets the number of rows, and of bytes per row, of each plane of a WIDTH x
 * HEIGHT frame. Returns the number of planes. */
static int compute_plane_sizes(enum video_format format, uint32_t width,
                               uint32_t height, uint32_t bytes[3],
                               uint32_t rows[3])
{
    const uint32_t w2 = (width + 1) / 2, h2 = (height + 1) / 2;

    rows[0] = height;
    bytes[0] = width;
    switch (format) {
    case VIDEO_FORMAT_I420:
        rows[1] = rows[2] = h2;
        bytes[1] = bytes[2] = w2;
        return 3;
    case VIDEO_FORMAT_NV12:
        rows[1] = h2;
        bytes[1] = 2 * w2;
        return 2;
    case VIDEO_FORMAT_YUY2:
    case VIDEO_FORMAT_UYVY:
        bytes[0] = 4 * w2;
        return 1;
    case VIDEO_FORMAT_Y800:
        return 1;
    default: /* The remaining formats have four bytes per pixel. */
        bytes[0] = 4 * width;
        return 1;
    }
}

static enum video_format find_format_by_name(const char *name)
{
    for (int f = VIDEO_FORMAT_I420; f <= VIDEO_FORMAT_AYUV; f++)
        if (strcmp(get_video_format_name((enum video_format)f), name) == 0)
            return (enum video_format)f;
    fprintf(stderr, "obs_host: unknown pixel format %s\n", name);
    exit(2);
}

/* ----------------------------------------------- source and capture filter */

/* The last frame that the filter output; its rows have no padding. */
static struct {
    pthread_mutex_t lock;
    uint64_t timestamp;
    unsigned char *bytes;
} seen = {.lock = PTHREAD_MUTEX_INITIALIZER};

static const char *get_source_name(void *type)
{
    (void)type;
    return "of the host";
}

static void *create_source_without_data(obs_data_t *settings,
                                        obs_source_t *source)
{
    (void)settings;
    return source;
}

static void do_nothing_with_source(void *data)
{
    (void)data;
}

static struct obs_source_frame *
record_output_frame(void *data, struct obs_source_frame *frame)
{
    uint32_t bytes[3], rows[3];
    const int n = compute_plane_sizes(frame->format, frame->width,
                                      frame->height, bytes, rows);
    unsigned char *to;

    (void)data;
    pthread_mutex_lock(&seen.lock);
    to = seen.bytes;
    for (int p = 0; p < n; p++)
        for (uint32_t y = 0; y < rows[p]; y++, to += bytes[p])
            memcpy(to, frame->data[p] + (size_t)y * frame->linesize[p],
                   bytes[p]);
    seen.timestamp = frame->timestamp;
    pthread_mutex_unlock(&seen.lock);
    return frame;
}

static struct obs_source_info feed = {.id = "host_feed",
                                      .type = OBS_SOURCE_TYPE_INPUT,
                                      .output_flags = OBS_SOURCE_ASYNC_VIDEO,
                                      .get_name = get_source_name,
                                      .create = create_source_without_data,
                                      .destroy = do_nothing_with_source};
static struct obs_source_info probe = {.id = "host_probe",
                                       .type = OBS_SOURCE_TYPE_FILTER,
                                       .output_flags = OBS_SOURCE_ASYNC_VIDEO,
                                       .get_name = get_source_name,
                                       .create = create_source_without_data,
                                       .destroy = do_nothing_with_source,
                                       .filter_video = record_output_frame};

/* ---------------------------------------------- start, settings, filtering */

struct run {
    enum video_format format;
    uint32_t width, height, bytes[3], rows[3];
    int n_planes;
    size_t size;
    obs_source_t *source, *filter;
};

static void exit_with_error(const char *what)
{
    fprintf(stderr, "obs_host: %s\n", what);
    exit(1);
}

/* Prints warnings and errors of OBS to standard error, as standard output
 * contains the frames. */
static void log_obs_message(int level, const char *format, va_list args,
                            void *ctx)
{
    (void)ctx;
    if (level > LOG_WARNING)
        return;
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
}

static void start_obs(const char *path)
{
    struct obs_video_info video = {.graphics_module = "libobs-opengl",
                                   .fps_num = 120,
                                   .fps_den = 1,
                                   .base_width = 64,
                                   .base_height = 64,
                                   .output_width = 64,
                                   .output_height = 64,
                                   .output_format = VIDEO_FORMAT_NV12,
                                   .gpu_conversion = true,
                                   .colorspace = VIDEO_CS_709,
                                   .range = VIDEO_RANGE_PARTIAL};
    obs_module_t *module;

    base_set_log_handler(log_obs_message, NULL);
    if (!obs_startup("en-US", NULL, NULL))
        exit_with_error("libobs does not start");
    if (obs_reset_video(&video) != OBS_VIDEO_SUCCESS)
        exit_with_error("libobs cannot start its graphics");
    if (obs_open_module(&module, path, NULL) != MODULE_SUCCESS ||
        !obs_init_module(module))
        exit_with_error("libobs cannot load the module");
    fprintf(stderr, "obs_host: libobs %s, %s\n", obs_get_version_string(),
            obs_get_module_name(module));
    obs_register_source(&feed);
    obs_register_source(&probe);
}

/* Applies to the filter the settings among SETTINGS[N] whose frame number is
 * FRAME. */
static void apply_frame_settings(struct run *r, char **settings, int n,
                                 long frame)
{
    obs_data_t *const data = obs_source_get_settings(r->filter);

    for (int i = 0; i < n; i++) {
        char key[64], value[256];
        long at = 0;

        if (sscanf(settings[i], "%63[^=]=%255[^@]@%ld", key, value, &at) < 2)
            exit_with_error(settings[i]);
        if (at != frame)
            continue;
        if (strncmp(value, "number:", 7) == 0)
            obs_data_set_double(data, key, strtod(value + 7, NULL));
        else if (strncmp(value, "bool:", 5) == 0)
            obs_data_set_bool(data, key, strcmp(value + 5, "true") == 0);
        else
            obs_data_set_string(data, key, value + strlen("word:"));
    }
    obs_source_update(r->filter, data);
    obs_data_release(data);
}

/* Passes the frame BYTES, with a time stamp of MS milliseconds, to the source,
 * and waits until the filter has output it. */
static void filter_and_write_frame(struct run *r, unsigned char *bytes,
                                   uint64_t ms)
{
    struct obs_source_frame frame = {.width = r->width,
                                     .height = r->height,
                                     .timestamp = ms * 1000000,
                                     .format = r->format,
                                     .full_range = !format_is_yuv(r->format)};
    uint64_t timestamp;
    int polls = 0;

    if (format_is_yuv(r->format))
        video_format_get_parameters(VIDEO_CS_601, VIDEO_RANGE_PARTIAL,
                                    frame.color_matrix, frame.color_range_min,
                                    frame.color_range_max);
    for (int p = 0; p < r->n_planes; p++) {
        frame.data[p] = bytes;
        frame.linesize[p] = r->bytes[p];
        bytes += r->bytes[p] * r->rows[p];
    }
    obs_source_output_video(r->source, &frame);
    do {
        usleep(POLL_US);
        pthread_mutex_lock(&seen.lock);
        timestamp = seen.timestamp;
        pthread_mutex_unlock(&seen.lock);
    } while (timestamp != frame.timestamp && polls++ < SLOW_POLLS);
    if (timestamp != frame.timestamp)
        exit_with_error("the filter did not output a frame");
}

static void filter_all_frames(struct run *r, char **settings, int n_settings)
{
    unsigned char *const frame = malloc(r->size);
    uint64_t ms = 1000;

    seen.bytes = malloc(r->size);
    if (!frame || !seen.bytes)
        exit_with_error("out of memory");
    for (long i = 0; fread(frame, r->size, 1, stdin) == 1; i++) {
        const uint64_t end = ms + (uint64_t)WAIT_S * 1000;

        apply_frame_settings(r, settings, n_settings, i);
        do {
            filter_and_write_frame(r, frame, ms);
            ms += FRAME_MS;
        } while (i == 0 && memcmp(seen.bytes, frame, r->size) == 0 &&
                 obs_source_enabled(r->filter) && ms < end);
        fwrite(seen.bytes, r->size, 1, stdout);
    }
    if (!obs_source_enabled(r->filter))
        fputs("obs_host: disabled\n", stderr);
    free(frame);
}

int main(int argc, char **argv)
{
    struct run r = {.n_planes = 0};
    obs_source_t *watch;

    if (argc < 4 ||
        sscanf(argv[3], "%" SCNu32 "x%" SCNu32, &r.width, &r.height) != 2) {
        fputs("usage: obs_host MODULE FORMAT WxH [KEY=VALUE[@FRAME]]...\n",
              stderr);
        return 2;
    }
    start_obs(argv[1]);
    r.format = find_format_by_name(argv[2]);
    r.n_planes =
        compute_plane_sizes(r.format, r.width, r.height, r.bytes, r.rows);
    for (int p = 0; p < r.n_planes; p++)
        r.size += (size_t)r.bytes[p] * r.rows[p];
    r.source = obs_source_create_private("host_feed", "feed", NULL);
    r.filter = obs_source_create_private("glint_flare", "flare", NULL);
    watch = obs_source_create_private("host_probe", "probe", NULL);
    if (!r.source || !r.filter || !watch)
        exit_with_error("libobs cannot create source or filter");
    obs_source_set_async_unbuffered(r.source, true);
    obs_source_filter_add(r.source, r.filter);
    obs_source_filter_add(r.source, watch);
    obs_set_output_source(0, r.source);
    filter_all_frames(&r, argv + 4, argc - 4);
    obs_set_output_source(0, NULL);
    obs_source_release(watch);
    obs_source_release(r.filter);
    obs_source_release(r.source);
    obs_shutdown();
    return ferror(stdout) ? 1 : 0;
}
