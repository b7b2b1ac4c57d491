/* SPDX-License-Identifier: MIT */
#include "live/live_input.h"

#include <string.h>

static bool is_test(const char *name)
{
    return strcmp(name, "test") == 0 || strcmp(name, "none") == 0;
}

bool live_input_is_camera(const char *name)
{
    return !is_test(name) && !glint_y4m_is_name(name) && strcmp(name, "-") != 0;
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
    } else if (is_test(name)) {
        source = &input->as.test.timed.source;
        status = live_test_open(&input->as.test, &wish->camera, seed,
                                strcmp(name, "none") == 0, error);
    } else {
        source = &input->as.video.timed.source;
        status = live_video_open(&input->as.video, &wish->camera, error);
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

/* Returns whether NAME has the extension of a file, as no device has. */
static bool is_file_name(const char *name)
{
    const char *const slash = strrchr(name, '/');

    return strncmp(name, "/dev/", 5) != 0 && strchr(slash ? slash : name, '.');
}

int live_input_fail(const struct live_log *log, const char *device,
                    enum glint_status status, const struct glint_error *error)
{
    char text[sizeof error->text + 120];

    if (status == GLINT_E_DEVICE && is_file_name(device)) {
        snprintf(text, sizeof text,
                 "%.160s: no camera; videos and pictures are for glint "
                 "overlay, or 'ffmpeg -i FILE -f yuv4mpegpipe - | glint live "
                 "-d -'",
                 device);
        return tool_fail(log->tool, status, text);
    }
    return live_log_fail(
        log, status, error,
        live_input_is_camera(device) ? "-d test, or a .y4m file" : NULL);
}
