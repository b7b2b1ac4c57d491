/* SPDX-License-Identifier: MIT
 *
 * jpeg encode VIDEO.y4m OUT.jpg
 *     Writes the first frame of the video, C422 of limited range, as a camera
 *     would send it: JPEG of 4:2:2 and full range. The image has no colours.
 * jpeg decode OUT.y4m IN.jpg...
 *     Decodes JPEG frames of one size and format as glint decodes the frames
 *     of a camera, and writes them as a video.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include "jpeg/mjpeg.h"
#include "video/y4m.h"

#define MAX_SIDE 2048
/* limit of a JPEG file's size, bytes */
#define MAX_BYTES (1 << 20)

static void exit_with_error(const char *why)
{
    fprintf(stderr, "jpeg: %s\n", why);
    exit(2);
}

static uint8_t widen_to_full_range(uint8_t code)
{
    const int value = ((code - 16) * 255 + 109) / 219;

    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

/* Compresses a row of LUMA; its chroma is grey. */
static void compress_luma_row(struct jpeg_compress_struct *j,
                              const uint8_t *luma)
{
    static uint8_t ycc[3 * MAX_SIDE];
    JSAMPROW row = ycc;

    for (size_t x = 0; x < j->image_width; x++) {
        ycc[3 * x] = widen_to_full_range(luma[x]);
        ycc[3 * x + 1] = ycc[3 * x + 2] = 128;
    }
    jpeg_write_scanlines(j, &row, 1);
}

static void write_grey_jpeg(const struct glint_image *image, FILE *file)
{
    struct jpeg_compress_struct j;
    struct jpeg_error_mgr errors;

    j.err = jpeg_std_error(&errors);
    jpeg_create_compress(&j);
    jpeg_stdio_dest(&j, file);
    j.image_width = (JDIMENSION)image->width;
    j.image_height = (JDIMENSION)image->height;
    j.input_components = 3;
    j.in_color_space = JCS_YCbCr;
    jpeg_set_defaults(&j);
    jpeg_set_quality(&j, 90, TRUE);
    j.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&j, TRUE);
    for (int y = 0; y < image->height; y++)
        compress_luma_row(&j, image->plane[0] + y * image->stride_bytes[0]);
    jpeg_finish_compress(&j);
    jpeg_destroy_compress(&j);
}

static void encode_file(const char *from, const char *to)
{
    struct glint_error error = {""};
    const struct glint_image *frame = NULL;
    struct glint_y4m_reader in;
    FILE *file;

    if (glint_y4m_reader_open(&in, from, &error) != GLINT_OK ||
        glint_y4m_reader_next(&in, &frame, &error) != GLINT_OK || !frame)
        exit_with_error(*error.text ? error.text : "the video has no frame");
    if (frame->width > MAX_SIDE)
        exit_with_error("the video is too wide");
    file = fopen(to, "wb");
    if (!file)
        exit_with_error("cannot write the output");
    write_grey_jpeg(frame, file);
    glint_y4m_reader_close(&in);
    if (fclose(file) != 0)
        exit_with_error("cannot write the output");
}

static size_t read_file(const char *name, uint8_t *data)
{
    FILE *file = fopen(name, "rb");
    size_t n;

    if (!file)
        exit_with_error(name);
    n = fread(data, 1, MAX_BYTES, file);
    if (n == MAX_BYTES || fclose(file) != 0)
        exit_with_error(name);
    return n;
}

static void decode_files(const char *to, char **from)
{
    static uint8_t data[MAX_BYTES];
    struct glint_error error = {""};
    struct glint_mjpeg *decoder;
    struct glint_y4m_header header;
    struct glint_y4m_writer out;
    struct glint_image image;
    enum glint_status status =
        glint_mjpeg_open(&decoder, "jpeg", MAX_SIDE, MAX_SIDE, &error);

    for (int i = 0; from[i] && status == GLINT_OK; i++) {
        status = glint_mjpeg_decode(decoder, data, read_file(from[i], data),
                                    &image, &error);
        if (status == GLINT_OK && i == 0) {
            glint_y4m_header_init(&header, image.width, image.height,
                                  image.format, 30, 1);
            header.range = GLINT_RANGE_FULL;
            status = glint_y4m_writer_open(&out, to, &header, &error);
        }
        if (status == GLINT_OK)
            status = glint_y4m_writer_put(&out, &image, "", &error);
    }
    if (status == GLINT_OK)
        status = glint_y4m_writer_commit(&out, &error);
    glint_mjpeg_close(decoder);
    if (status != GLINT_OK)
        exit_with_error(error.text);
}

int main(int argc, char **argv)
{
    if (argc == 4 && strcmp(argv[1], "encode") == 0)
        encode_file(argv[2], argv[3]);
    else if (argc > 3 && strcmp(argv[1], "decode") == 0)
        decode_files(argv[2], argv + 3);
    else
        exit_with_error("see the head of jpeg.c");
    return 0;
}
