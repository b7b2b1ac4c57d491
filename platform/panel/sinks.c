/* SPDX-License-Identifier: MIT */
#include "panel/sinks.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "posix/error.h"

static enum glint_status discard_frame(struct glint_sink *sink,
                                       const struct glint_image *image,
                                       struct glint_error *error)
{
    (void)image, (void)error;
    ((struct glint_null_sink *)sink)->n_frames++;
    return GLINT_OK;
}

static void close_null_sink(struct glint_sink *sink)
{
    (void)sink;
}

void glint_null_sink_open(struct glint_null_sink *null)
{
    *null = (struct glint_null_sink){
        .sink = {.put = discard_frame, .close = close_null_sink}};
}

enum glint_pixel_format glint_get_planar_format(enum glint_pixel_format format)
{
    switch (format) {
    case GLINT_NV12:
    case GLINT_NV21:
        return GLINT_I420;
    case GLINT_YUYV:
    case GLINT_UYVY:
        return GLINT_I422;
    case GLINT_GREY:
    case GLINT_I420:
    case GLINT_I422:
        return format;
    default:
        return GLINT_I444;
    }
}

static uint8_t *get_plane_row(const struct glint_image *image, int plane, int y)
{
    return image->plane[plane] + y * image->stride_bytes[plane];
}

static void copy_plane_rows(const struct glint_image *to,
                            const struct glint_image *from, int plane)
{
    const size_t bytes = glint_image_row_bytes(to->format, plane, to->width);
    const int rows = glint_image_plane_height(to->format, plane, to->height);

    for (int y = 0; y < rows; y++)
        memcpy(get_plane_row(to, plane, y), get_plane_row(from, plane, y),
               bytes);
}

/* Splits row Y of FROM, YUYV or UYVY, into the planes of TO. If the width is
 * odd, the second pixel of the last pair is dropped. */
static void split_packed_row(const struct glint_image *to,
                             const struct glint_image *from,
                             struct glint_row_rgb *row, int y)
{
    const int half = (from->width + 1) / 2;
    uint8_t *const cb = get_plane_row(to, 1, y), *const cr =
                                                     get_plane_row(to, 2, y);

    glint_split_packed_pixels(from->format, row->luma, cb, cr,
                              get_plane_row(from, 0, y), half);
    memcpy(get_plane_row(to, 0, y), row->luma, (size_t)from->width);
}

static void split_chroma_plane(const struct glint_image *to,
                               const struct glint_image *from)
{
    const int cb = from->format == GLINT_NV12 ? 1 : 2;

    for (int y = 0; y < (from->height + 1) / 2; y++)
        glint_split_byte_pairs(
            get_plane_row(to, cb, y), get_plane_row(to, 3 - cb, y),
            get_plane_row(from, 1, y), (from->width + 1) / 2);
}

/* --------------------------------------------------------------- from RGB */

enum { ONE_Q16 = 1 << 16, HALF_Q16 = 1 << 15 };

/* Conversion of R', G', B' to Y', Cb, Cr. by_q16: matrix with one row per
 * result. zero_q16: constant that is added to each row: the code that stands
 * for zero, plus 1/2 for rounding. */
struct ycc_matrix {
    int32_t by_q16[3][3], zero_q16[3];
};

/* clang-format off */
#define Q16(x) ((int32_t)((x) * ONE_Q16 + ((x) < 0 ? -0.5 : 0.5)))
#define MATRIX(black, luma, chroma, r, b) {                                    \
    {{Q16((luma) * (r)), Q16((luma) * (1 - (r) - (b))), Q16((luma) * (b))},    \
     {Q16((chroma) * -.5 * (r) / (1 - (b))),                                   \
      Q16((chroma) * -.5 * (1 - (r) - (b)) / (1 - (b))), Q16((chroma) * .5)},  \
     {Q16((chroma) * .5), Q16((chroma) * -.5 * (1 - (r) - (b)) / (1 - (r))),   \
      Q16((chroma) * -.5 * (b) / (1 - (r)))}},                                 \
    {(black) * ONE_Q16 + HALF_Q16, 128 * ONE_Q16 + HALF_Q16,                   \
     128 * ONE_Q16 + HALF_Q16}}

static const struct ycc_matrix ycc_matrices[2][2] = {
    [GLINT_MATRIX_BT601] = {
        [GLINT_RANGE_FULL] = MATRIX(0, 1., 1., .299, .114),
        [GLINT_RANGE_LIMITED] = MATRIX(16, 219. / 255, 224. / 255, .299, .114)},
    [GLINT_MATRIX_BT709] = {
        [GLINT_RANGE_FULL] = MATRIX(0, 1., 1., .2126, .0722),
        [GLINT_RANGE_LIMITED] =
            MATRIX(16, 219. / 255, 224. / 255, .2126, .0722)},
};
/* clang-format on */

/* Returns SUM as a code, clamped to 255: chroma of pure red and blue in full
 * range exceeds 255 by half a code. */
static uint8_t convert_to_code(int32_t sum_q16)
{
    return (uint8_t)(sum_q16 >= 256 * ONE_Q16 ? 255 : sum_q16 >> 16);
}

static void convert_rgb_row_to_ycc(const struct ycc_matrix *m,
                                   uint8_t *restrict to, int i,
                                   const uint8_t *const channel[3], int n)
{
    const int32_t r = m->by_q16[i][0], g = m->by_q16[i][1], b = m->by_q16[i][2],
                  zero = m->zero_q16[i];

    for (int x = 0; x < n; x++)
        to[x] = convert_to_code(channel[0][x] * r + channel[1][x] * g +
                                channel[2][x] * b + zero);
}

/* ---------------------------------------------------------------- pictures */

void glint_convert_to_planes(const struct glint_image *to,
                             const struct glint_image *from,
                             struct glint_row_rgb *row)
{
    switch (from->format) {
    case GLINT_YUYV:
    case GLINT_UYVY:
        for (int y = 0; y < from->height; y++)
            split_packed_row(to, from, row, y);
        return;
    case GLINT_NV12:
    case GLINT_NV21:
        copy_plane_rows(to, from, 0);
        split_chroma_plane(to, from);
        return;
    case GLINT_GREY:
    case GLINT_I420:
    case GLINT_I422:
    case GLINT_I444:
        for (int i = 0; i < glint_image_planes(to->format); i++)
            copy_plane_rows(to, from, i);
        return;
    default:
        for (int y = 0; y < from->height; y++) {
            glint_row_rgb_read(row, from, 0, y, from->width);
            for (int i = 0; i < 3; i++)
                convert_rgb_row_to_ycc(&ycc_matrices[to->matrix][to->range],
                                       get_plane_row(to, i, y), i, row->channel,
                                       from->width);
        }
    }
}

/* Sets HEADER and the planes of the frame to write. Allocates planes if Y4M
 * does not support the format of the images. */
static enum glint_status
prepare_output_planes(struct glint_y4m_sink *y,
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

static enum glint_status open_y4m_stream(struct glint_y4m_sink *y,
                                         const struct glint_image *image,
                                         struct glint_error *error)
{
    struct glint_y4m_header header;
    enum glint_status status;

    y->like = *image;
    glint_y4m_header_init(&header, image->width, image->height,
                          glint_get_planar_format(image->format), y->fps_num,
                          y->fps_den);
    if (!glint_image_is_rgb(image->format))
        header.range = image->range;
    header.range_stated = true;
    status = prepare_output_planes(y, &header, error);
    if (!status)
        status = glint_y4m_writer_open(&y->writer, y->path, &header, error);
    if (status) {
        free(y->mem);
        y->mem = NULL;
    }
    y->is_open = !status;
    return status;
}

static bool is_reader_ready(const struct glint_y4m_sink *y)
{
    struct pollfd writable = {.fd = y->writer.out.fd, .events = POLLOUT};

    /* An error that poll() reports counts as writable, because the next write
     * reports it, too. */
    return poll(&writable, 1, 0) != 0;
}

static enum glint_status write_y4m_frame(struct glint_sink *sink,
                                         const struct glint_image *image,
                                         struct glint_error *error)
{
    struct glint_y4m_sink *const y = (struct glint_y4m_sink *)sink;
    enum glint_status status = GLINT_OK;

    if (!y->is_open)
        status = open_y4m_stream(y, image, error);
    if (status)
        return status;
    if (image->format != y->like.format || image->width != y->like.width ||
        image->height != y->like.height || image->range != y->like.range)
        return glint_error_report(
            error, GLINT_E_OUTPUT, y->writer.out.name,
            "the size or format of the frames changed, to %d x %d; a stream "
            "has one size and format",
            image->width, image->height);
    if (!is_reader_ready(y)) {
        y->n_dropped++;
        return GLINT_OK;
    }
    if (y->mem)
        glint_convert_to_planes(&y->planes, image, &y->row);
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

static void close_y4m_sink(struct glint_sink *sink)
{
    struct glint_error error;

    glint_y4m_sink_finish((struct glint_y4m_sink *)sink, &error);
}

void glint_y4m_sink_open(struct glint_y4m_sink *y4m, const char *path,
                         int fps_num, int fps_den)
{
    *y4m = (struct glint_y4m_sink){
        .sink = {.put = write_y4m_frame, .close = close_y4m_sink},
        .path = path,
        .fps_num = fps_num,
        .fps_den = fps_den,
    };
}
