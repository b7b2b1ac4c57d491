/* SPDX-License-Identifier: MIT
 *
 * Reads random bytes as a Y4M stream. The first byte sets how many bytes each
 * read returns, 1 to 200. An accepted header, printed and parsed again, must be
 * unchanged. Every sample of each frame must be readable, and writing the frame
 * must succeed.
 *
 *     make fuzz FUZZ=y4m SECONDS=60
 */
#include "fuzz/fuzz.h"
#include "video/y4m.h"

/* global, so that the compiler cannot remove the reads */
unsigned glint_fuzz_sink;

struct memory {
    const uint8_t *data;
    size_t bytes, chunk;
};

static ptrdiff_t read_stream_bytes_from_memory(void *ctx, void *dst,
                                               size_t bytes)
{
    struct memory *const m = ctx;
    size_t n = m->bytes < m->chunk ? m->bytes : m->chunk;

    n = n < bytes ? n : bytes;
    memcpy(dst, m->data, n);
    m->data += n;
    m->bytes -= n;
    return (ptrdiff_t)n;
}

static void check_printed_header(const struct glint_y4m_header *header)
{
    struct glint_y4m_header again;
    struct glint_error error;
    char line[GLINT_Y4M_PRINTED], twice[GLINT_Y4M_PRINTED];
    size_t len = glint_y4m_header_print(line, header);

    require(header->width >= 1 && header->width <= GLINT_MAX_SIDE);
    require(header->height >= 1 && header->height <= GLINT_MAX_SIDE);
    require(len == strlen(line) && len < sizeof line && line[len - 1] == '\n');
    /* Printing can add tags, which make the line too long. */
    if (len > GLINT_Y4M_LINE)
        return;
    line[len - 1] = 0;
    require(!glint_y4m_header_parse(&again, line, "again", &error));
    line[len - 1] = '\n';
    require(glint_y4m_header_print(twice, &again) == len);
    require(!memcmp(line, twice, len));
    require(again.format == header->format && again.range == header->range);
}

/* Prints the header as it was read, then from its fields alone, and checks that
 * both texts parse to the same header. */
static void check_header_round_trip(const struct glint_y4m_header *header)
{
    struct glint_y4m_header own = *header;

    check_printed_header(header);
    own.line[0] = '\0';
    check_printed_header(&own);
}

/* Returns the sum of all samples; reading them reveals uninitialised ones to
 * memory checkers. */
static unsigned sum_samples(const struct glint_image *frame)
{
    unsigned sum = 0;

    for (int i = 0; i < glint_image_planes(frame->format); i++) {
        const int across =
            (int)glint_image_row_bytes(frame->format, i, frame->width);
        const int down =
            glint_image_plane_height(frame->format, i, frame->height);

        for (int y = 0; y < down; y++)
            for (int x = 0; x < across; x++)
                sum += frame->plane[i][y * frame->stride_bytes[i] + x];
    }
    return sum;
}

static void read_all_frames(struct glint_y4m_reader *reader)
{
    const struct glint_image *frame;
    struct glint_y4m_writer writer;
    struct glint_error error;

    check_header_round_trip(&reader->header);
    require(
        !glint_y4m_writer_open(&writer, "/dev/null", &reader->header, &error));
    while (!glint_y4m_reader_next(reader, &frame, &error) && frame) {
        glint_fuzz_sink += sum_samples(frame);
        require(
            !glint_y4m_writer_put(&writer, frame, reader->frame_tags, &error));
    }
    require(writer.n_frames == reader->n_frames);
    require(!glint_y4m_writer_commit(&writer, &error));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct memory memory;
    struct glint_y4m_reader reader;
    struct glint_error error;

    if (size < 1)
        return 0;
    memory = (struct memory){data + 1, size - 1, 1 + data[0] % 200U};
    if (!glint_y4m_reader_start(&reader, read_stream_bytes_from_memory, &memory,
                                "fuzz", &error))
        read_all_frames(&reader);
    glint_y4m_reader_close(&reader);
    return 0;
}
