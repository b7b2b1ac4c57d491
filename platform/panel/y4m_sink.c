/* SPDX-License-Identifier: MIT */
#include "panel/y4m_sink.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "posix/error.h"

/* Prepares the frames to write, with memory for them where Y4M does not know
 * the format of the images. */
static enum glint_status take_planes(struct glint_y4m_sink *y,
                                     const struct glint_y4m_header *header,
                                     struct glint_error *error)
{
    const size_t bytes =
        glint_image_bytes(header->format, header->width, header->height);

    y->planes = y->like;
    y->planes.format = header->format;
    y->planes.range = header->range;
    y->planes.matrix = header->matrix;
    if (header->format == y->like.format)
        return GLINT_OK;
    y->mem = malloc(bytes + glint_row_rgb_bytes(header->width));
    if (!y->mem)
        return glint_error_report(error, GLINT_E_MEMORY, y->path,
                                  "no memory for a %d x %d frame",
                                  header->width, header->height);
    glint_image_place(&y->planes, y->mem);
    glint_row_rgb_init(&y->row, (uint8_t *)y->mem + bytes, header->width);
    return GLINT_OK;
}

static enum glint_status begin(struct glint_y4m_sink *y,
                               const struct glint_image *image,
                               struct glint_error *error)
{
    struct glint_y4m_header header;
    enum glint_status status;

    y->like = *image;
    glint_y4m_header_init(&header, image->width, image->height,
                          glint_planar_format(image->format), y->fps_num,
                          y->fps_den);
    if (!glint_image_is_rgb(image->format))
        header.range = image->range;
    header.range_stated = true;
    status = take_planes(y, &header, error);
    if (!status)
        status = glint_y4m_writer_open(&y->writer, y->path, &header, error);
    if (status) {
        free(y->mem);
        y->mem = NULL;
    }
    y->is_open = !status;
    return status;
}

static bool is_ready(const struct glint_y4m_sink *y)
{
    struct pollfd writable = {.fd = y->writer.out.fd, .events = POLLOUT};

    return poll(&writable, 1, 0) != 0; /* Errors show when writing. */
}

static enum glint_status put(struct glint_sink *sink,
                             const struct glint_image *image,
                             struct glint_error *error)
{
    struct glint_y4m_sink *const y = (struct glint_y4m_sink *)sink;
    enum glint_status status = GLINT_OK;

    if (!y->is_open)
        status = begin(y, image, error);
    if (status)
        return status;
    if (image->format != y->like.format || image->width != y->like.width ||
        image->height != y->like.height || image->range != y->like.range)
        return glint_error_report(error, GLINT_E_OUTPUT, y->writer.out.name,
                                  "frames of another size or format, now %d x "
                                  "%d, need a stream of their own",
                                  image->width, image->height);
    if (!is_ready(y)) {
        y->n_dropped++;
        return GLINT_OK;
    }
    if (y->mem)
        glint_planar_write(&y->planes, image, &y->row);
    status = glint_y4m_writer_put(&y->writer, y->mem ? &y->planes : image, "",
                                  error);
    if (!status)
        y->n_frames++;
    return status;
}

enum glint_status glint_y4m_sink_finish(struct glint_y4m_sink *y4m,
                                        struct glint_error *error)
{
    const bool was_open = y4m->is_open;

    free(y4m->mem);
    y4m->mem = NULL;
    y4m->is_open = false;
    return was_open ? glint_y4m_writer_commit(&y4m->writer, error) : GLINT_OK;
}

static void close_y4m(struct glint_sink *sink)
{
    struct glint_error error;

    glint_y4m_sink_finish((struct glint_y4m_sink *)sink, &error);
}

void glint_y4m_sink_open(struct glint_y4m_sink *y4m, const char *path,
                         int fps_num, int fps_den)
{
    *y4m = (struct glint_y4m_sink){
        .sink = {put, close_y4m},
        .path = path,
        .fps_num = fps_num,
        .fps_den = fps_den,
    };
}
