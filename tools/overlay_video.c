/* SPDX-License-Identifier: MIT
 *
 * The frames of a video, one after the other.
 */
#include "overlay.h"

#include <math.h>

#include "plain/y4m.h"
#include "posix/error.h"

static int video_frames(struct tool *tool, struct overlay *o,
                        struct glint_y4m_reader *in,
                        struct glint_y4m_writer *out)
{
    struct glint_error error = {""};
    const struct glint_image *image;
    int code = EXIT_OK;

    while (code == EXIT_OK) {
        enum glint_status status = glint_y4m_reader_next(in, &image, &error);

        if (status == GLINT_OK && !image)
            break;
        if (status == GLINT_OK) {
            code = overlay_draw(tool, o, image);
            if (code != EXIT_OK)
                break;
            status = glint_y4m_writer_put(out, image, in->frame_tags, &error);
            overlay_progress(tool, o);
        }
        if (status == GLINT_E_CLOSED)
            break;
        if (status != GLINT_OK)
            code = tool_fail(tool, status, error.text);
    }
    if (code == EXIT_OK && o->look.n_frames == 0) {
        fprintf(stderr, "glint overlay: %s: no frames\n", in->in.name);
        code = EXIT_INPUT;
    }
    return code;
}

/* The time from frame to frame; 25 a second where that is not known. */
static int32_t frame_us(const struct glint_y4m_header *header)
{
    const double us = header->fps_num > 0
                          ? 1e6 * header->fps_den / header->fps_num
                          : 1e6 / 25;

    return (int32_t)fmin(fmax(us + 0.5, 1), 1e9);
}

int overlay_video(struct tool *tool, struct overlay *o)
{
    struct glint_error error = {""};
    struct glint_y4m_reader in;
    struct glint_y4m_writer out;
    enum glint_status status = glint_y4m_reader_open(&in, o->input, &error);
    int code;

    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (o->range)
        in.header.range =
            o->range == 1 ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED;
    if (o->matrix)
        in.header.matrix =
            o->matrix == 1 ? GLINT_MATRIX_BT601 : GLINT_MATRIX_BT709;
    status = glint_y4m_writer_open(&out, o->output, &in.header, &error);
    if (status != GLINT_OK) {
        glint_y4m_reader_close(&in);
        return tool_fail(tool, status, error.text);
    }
    o->elapsed_us = frame_us(&in.header);
    code = video_frames(tool, o, &in, &out);
    if (code == EXIT_OK) {
        status = glint_y4m_writer_commit(&out, &error);
        if (status != GLINT_OK)
            code = tool_fail(tool, status, error.text);
    }
    glint_y4m_writer_abort(&out);
    glint_y4m_reader_close(&in);
    return code;
}
