/* SPDX-License-Identifier: MIT */
#include "live/live_input.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "posix/error.h"

static bool is_test(const char *name)
{
    return strcmp(name, "test") == 0 || strcmp(name, "none") == 0;
}

bool live_input_is_camera(const char *name)
{
    return !is_test(name) && !glint_y4m_is_name(name) && strcmp(name, "-") != 0;
}

enum glint_status live_input_check(const char *name, struct glint_error *error)
{
    struct glint_v4l2_device device;
    enum glint_status status;

    if (glint_y4m_is_name(name) && access(name, R_OK) != 0)
        return glint_error_report(error, GLINT_E_IO, name, "%s",
                                  strerror(errno));
    if (!live_input_is_camera(name))
        return GLINT_OK;
    status = glint_v4l2_device_attach(&device, name, error);
    if (status == GLINT_OK)
        glint_v4l2_device_close(&device);
    return status;
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

void live_input_close(struct live_input *input)
{
    if (input->source)
        input->source->close(input->source);
    input->source = NULL;
}
