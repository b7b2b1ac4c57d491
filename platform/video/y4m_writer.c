/* SPDX-License-Identifier: MIT
 *
 * The writing half of video/y4m.h. */
#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "video/y4m.h"

enum glint_status glint_y4m_writer_open(struct glint_y4m_writer *writer,
                                        const char *path,
                                        const struct glint_y4m_header *header,
                                        struct glint_error *error)
{
    char line[GLINT_Y4M_PRINTED];
    const size_t len = glint_y4m_header_print(line, header);
    enum glint_status status;

    writer->n_frames = 0;
    status = glint_output_open(&writer->out, path, GLINT_OUTPUT_BINARY, error);
    if (!status)
        status = glint_output_write(&writer->out, line, len, error);
    if (status)
        glint_y4m_writer_abort(writer);
    return status;
}

static enum glint_status put_plane(struct glint_output *out,
                                   const struct glint_image *frame, int plane,
                                   struct glint_error *error)
{
    const int across =
        (int)glint_image_row_bytes(frame->format, plane, frame->width);
    const int down =
        glint_image_plane_height(frame->format, plane, frame->height);
    const ptrdiff_t stride = frame->stride_bytes[plane];
    const uint8_t *row = frame->plane[plane];
    enum glint_status status = GLINT_OK;

    if (stride == across)
        return glint_output_write(out, row, (size_t)across * (size_t)down,
                                  error);
    for (int y = 0; y < down && !status; y++) {
        status = glint_output_write(out, row, (size_t)across, error);
        row += stride;
    }
    return status;
}

enum glint_status glint_y4m_writer_put(struct glint_y4m_writer *writer,
                                       const struct glint_image *frame,
                                       const char *tags,
                                       struct glint_error *error)
{
    char line[sizeof "FRAME\n" + GLINT_Y4M_FRAME_TAGS];
    const int len = snprintf(line, sizeof line, "FRAME%s\n", tags);
    enum glint_status status;

    assert(strlen(tags) < GLINT_Y4M_FRAME_TAGS);
    status = glint_output_write(&writer->out, line, (size_t)len, error);
    for (int i = 0; i < glint_image_planes(frame->format) && !status; i++)
        status = put_plane(&writer->out, frame, i, error);
    if (!status)
        status = glint_output_flush(&writer->out, error);
    if (!status)
        writer->n_frames++;
    return status;
}

enum glint_status glint_y4m_writer_put_planes(struct glint_y4m_writer *writer,
                                              const uint8_t *planes,
                                              size_t bytes, const char *tags,
                                              struct glint_error *error)
{
    char line[sizeof "FRAME\n" + GLINT_Y4M_FRAME_TAGS];
    const int len = snprintf(line, sizeof line, "FRAME%s\n", tags);
    enum glint_status status =
        glint_output_write(&writer->out, line, (size_t)len, error);

    if (!status)
        status = glint_output_write(&writer->out, planes, bytes, error);
    if (!status)
        status = glint_output_flush(&writer->out, error);
    writer->n_frames += !status;
    return status;
}

enum glint_status glint_y4m_writer_commit(struct glint_y4m_writer *writer,
                                          struct glint_error *error)
{
    return glint_output_commit(&writer->out, error);
}

void glint_y4m_writer_abort(struct glint_y4m_writer *writer)
{
    glint_output_abort(&writer->out);
}
