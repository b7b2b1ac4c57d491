/* SPDX-License-Identifier: MIT */
#include "jpeg/mjpeg.h"

#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

#include "posix/error.h"

#define ALIGN 64 /* alignment of planes and their rows, bytes */
/* max number of rows of a plane that one row of MCUs (minimum coded units) has:
 * 4 blocks of 8 rows */
#define MAX_ROWS  32
#define N_PLANES  3
#define MARKER    0xff
#define SOI       0xd8
#define EOI       0xd9
#define SOS       0xda
#define RST_FIRST 0xd0
#define TEM       0x01

struct glint_mjpeg {
    const char *name;
    int max_width, max_height;
    ptrdiff_t stride_bytes; /* stride of all planes, for the widest frame */
    size_t plane_bytes;
    uint8_t *mem; /* N_PLANES planes of plane_bytes each */

    /* The members below are the state of the frame being decoded. */
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_source_mgr source;
    bool in_scan; /* true: the header has been read */
    bool ended;   /* true: libjpeg requested more bytes than the frame has */
    jmp_buf escape;
    enum glint_status status; /* error to return after a jump to escape */
    struct glint_error *error;
};

bool glint_mjpeg_available(void)
{
    return true;
}

/* ------------------------------------------------------------------- memory */

enum glint_status glint_mjpeg_open(struct glint_mjpeg **decoder,
                                   const char *name, int max_width,
                                   int max_height, struct glint_error *error)
{
    struct glint_mjpeg *d;
    void *mem;

    *decoder = NULL;
    if (max_width < 1 || max_width > GLINT_PANEL_SIDE || max_height < 1 ||
        max_height > GLINT_PANEL_SIDE)
        return glint_error_report(
            error, GLINT_E_ARGUMENT, name,
            "MJPEG frames of %d x %d pixels: width and height must be 1 to %d",
            max_width, max_height, GLINT_PANEL_SIDE);
    d = calloc(1, sizeof *d);
    if (!d)
        return glint_error_report(error, GLINT_E_MEMORY, name,
                                  "no memory for the MJPEG decoder");
    d->name = name;
    d->max_width = max_width;
    d->max_height = max_height;
    /* libjpeg writes whole blocks and needs pointers to whole rows of MCUs. */
    d->stride_bytes = (max_width + ALIGN - 1) / ALIGN * ALIGN;
    d->plane_bytes = (size_t)d->stride_bytes * (size_t)(max_height + MAX_ROWS);
    if (posix_memalign(&mem, ALIGN, N_PLANES * d->plane_bytes)) {
        free(d);
        return glint_error_report(error, GLINT_E_MEMORY, name,
                                  "no memory for the MJPEG decoder");
    }
    d->mem = mem;
    *decoder = d;
    return GLINT_OK;
}

void glint_mjpeg_close(struct glint_mjpeg *decoder)
{
    if (decoder)
        free(decoder->mem);
    free(decoder);
}

/* ----------------------------------------------------- errors and warnings */

/* Leaves libjpeg with STATUS, by a jump to d->escape. The caller must have set
 * d->error. */
static void leave_libjpeg(struct glint_mjpeg *d, enum glint_status status)
{
    d->status = status;
    longjmp(d->escape, 1);
}

static void leave_libjpeg_with_message(j_common_ptr jpeg,
                                       enum glint_status status)
{
    struct glint_mjpeg *const d = jpeg->client_data;
    char text[JMSG_LENGTH_MAX];

    jpeg->err->format_message(jpeg, text);
    leave_libjpeg(
        d, glint_error_report(d->error, status, d->name, "MJPEG: %s", text));
}

static void on_libjpeg_error(j_common_ptr jpeg)
{
    switch (jpeg->err->msg_code) {
    case JERR_OUT_OF_MEMORY:
        leave_libjpeg_with_message(jpeg, GLINT_E_MEMORY);
        return;
    case JERR_BAD_PRECISION:
    case JERR_SOF_UNSUPPORTED:
        leave_libjpeg_with_message(jpeg, GLINT_E_UNSUPPORTED);
        return;
    }
    leave_libjpeg_with_message(jpeg, GLINT_E_FORMAT);
}

/* Leaves libjpeg at the three warnings after which samples are wrong; samples
 * are right after other warnings. Messages with LEVEL >= 0 are not warnings. */
static void on_libjpeg_message(j_common_ptr jpeg, int level)
{
    struct glint_mjpeg *const d = jpeg->client_data;

    if (level >= 0)
        return;
    switch (jpeg->err->msg_code) {
    case JWRN_HIT_MARKER:
        if (d->ended)
            leave_libjpeg(d, glint_error_report(
                                 d->error, GLINT_E_FORMAT, d->name,
                                 "MJPEG: the frame is cut off in row %d of %d",
                                 (int)d->jpeg.output_scanline,
                                 (int)d->jpeg.output_height));
        leave_libjpeg_with_message(jpeg, GLINT_E_FORMAT);
        return;
    case JWRN_HUFF_BAD_CODE:
    case JWRN_MUST_RESYNC:
        leave_libjpeg_with_message(jpeg, GLINT_E_FORMAT);
    }
}

static void on_libjpeg_output(j_common_ptr jpeg)
{
    (void)jpeg;
}

/* --------------------------------------------------------- input of libjpeg */

static void on_source_start(j_decompress_ptr jpeg)
{
    (void)jpeg;
}

/* Called when libjpeg needs more data than the frame has. While the header is
 * read, leaves libjpeg with an error. In the scan, supplies an end-of-image
 * marker instead: libjpeg reads ahead, so that it may have decoded all samples
 * already. */
static boolean on_data_end(j_decompress_ptr jpeg)
{
    static const JOCTET end[] = {MARKER, EOI};
    struct glint_mjpeg *const d = jpeg->client_data;

    if (!d->in_scan)
        leave_libjpeg(
            d, glint_error_report(d->error, GLINT_E_FORMAT, d->name,
                                  "MJPEG: the frame is cut off in its header"));
    d->ended = true;
    d->source.next_input_byte = end;
    d->source.bytes_in_buffer = sizeof end;
    return TRUE;
}

static void on_skip_bytes(j_decompress_ptr jpeg, long bytes)
{
    struct glint_mjpeg *const d = jpeg->client_data;
    const size_t wanted = bytes > 0 ? (size_t)bytes : 0;
    const size_t n =
        wanted < d->source.bytes_in_buffer ? wanted : d->source.bytes_in_buffer;

    d->source.next_input_byte += n;
    d->source.bytes_in_buffer -= n;
}

static bool is_marker_without_data(int marker)
{
    return marker == TEM || (marker >= RST_FIRST && marker <= EOI);
}

/* Returns the offset of the last start-of-image marker before the image's data.
 * Cameras may send several such markers, and libjpeg accepts only one. */
static size_t find_image_start(const uint8_t *data, size_t bytes)
{
    size_t start = 0, at = 0;

    while (at + 4 <= bytes && data[at] == MARKER && data[at + 1] != SOS) {
        const int marker = data[at + 1];

        if (marker == SOI)
            start = at;
        /* Bytes 0xff in front of a marker, which itself begins with 0xff, are
         * padding. */
        if (marker == MARKER)
            at++;
        else if (is_marker_without_data(marker))
            at += 2;
        else
            at += 2 + ((size_t)data[at + 2] << 8 | data[at + 3]);
    }
    return start;
}

static void set_libjpeg_source(struct glint_mjpeg *d, const uint8_t *data,
                               size_t bytes)
{
    const size_t start = find_image_start(data, bytes);

    d->source = (struct jpeg_source_mgr){
        .next_input_byte = data + start,
        .bytes_in_buffer = bytes - start,
        .init_source = on_source_start,
        .fill_input_buffer = on_data_end,
        .skip_input_data = on_skip_bytes,
        .resync_to_restart = jpeg_resync_to_restart,
        .term_source = on_source_start,
    };
    d->jpeg.src = &d->source;
}

/* ------------------------------------------------------------------- frames */

static void reject_frame(struct glint_mjpeg *d, const char *cause)
{
    leave_libjpeg(d, glint_error_report(d->error, GLINT_E_UNSUPPORTED, d->name,
                                        "MJPEG: %s", cause));
}

/* Returns the pixel format for the frame's chroma subsampling; rejects
 * subsamplings that glint does not support. Only the ratios of Y's sampling
 * factors to those of Cb and Cr matter. */
static enum glint_pixel_format choose_pixel_format(struct glint_mjpeg *d)
{
    const jpeg_component_info *const c = d->jpeg.comp_info;
    const int across = c[0].h_samp_factor, down = c[0].v_samp_factor;
    char text[64];

    if (d->jpeg.num_components == 1)
        return GLINT_GREY;
    if (c[1].h_samp_factor == c[2].h_samp_factor &&
        c[1].v_samp_factor == c[2].v_samp_factor) {
        if (across == c[1].h_samp_factor && down == c[1].v_samp_factor)
            return GLINT_I444;
        if (across == 2 * c[1].h_samp_factor && down == c[1].v_samp_factor)
            return GLINT_I422;
        if (across == 2 * c[1].h_samp_factor && down == 2 * c[1].v_samp_factor)
            return GLINT_I420;
    }
    snprintf(text, sizeof text,
             "chroma subsampling %dx%d,%dx%d,%dx%d is not supported", across,
             down, c[1].h_samp_factor, c[1].v_samp_factor, c[2].h_samp_factor,
             c[2].v_samp_factor);
    reject_frame(d, text);
    return GLINT_GREY;
}

/* Rejects frames that are too large, would cost too much memory or time, or
 * have colours that glint does not support. */
static void check_jpeg_header(struct glint_mjpeg *d)
{
    const struct jpeg_decompress_struct *const j = &d->jpeg;

    if (j->image_width > (JDIMENSION)d->max_width ||
        j->image_height > (JDIMENSION)d->max_height)
        leave_libjpeg(
            d, glint_error_report(d->error, GLINT_E_UNSUPPORTED, d->name,
                                  "MJPEG: frame of %u x %u pixels is larger "
                                  "than %d x %d",
                                  j->image_width, j->image_height, d->max_width,
                                  d->max_height));
    if (j->jpeg_color_space != JCS_YCbCr &&
        j->jpeg_color_space != JCS_GRAYSCALE)
        reject_frame(d, "only YCbCr and greyscale frames are supported");
    if (j->arith_code)
        reject_frame(d, "arithmetic coding is not supported");
    if (jpeg_has_multiple_scans(&d->jpeg))
        reject_frame(d, "progressive frames (several scans) are not supported");
}

static void start_decoding(struct glint_mjpeg *d, struct glint_image *image)
{
    jpeg_read_header(&d->jpeg, TRUE);
    check_jpeg_header(d);
    *image = (struct glint_image){
        .format = choose_pixel_format(d),
        .width = (int)d->jpeg.image_width,
        .height = (int)d->jpeg.image_height,
        .range = GLINT_RANGE_FULL,
        .matrix = GLINT_MATRIX_BT601,
        .transfer = GLINT_TONE_SRGB,
    };
    for (int p = 0; p < glint_image_planes(image->format); p++) {
        image->plane[p] = d->mem + (size_t)p * d->plane_bytes;
        image->stride_bytes[p] = d->stride_bytes;
    }
    d->jpeg.out_color_space = d->jpeg.jpeg_color_space;
    d->jpeg.raw_data_out = TRUE;
    /* With this method libjpeg's SIMD code gives the same bits as its C
     * code. */
    d->jpeg.dct_method = JDCT_ISLOW;
    d->in_scan = true;
    jpeg_start_decompress(&d->jpeg);
}

/* Decodes the frame to the planes of IMAGE, one row of MCUs (minimum coded
 * units) at a time. The last row of MCUs may extend below the picture, so the
 * planes have MAX_ROWS spare rows. */
static void decode_jpeg_to_planes(struct glint_mjpeg *d,
                                  const struct glint_image *image)
{
    struct jpeg_decompress_struct *const j = &d->jpeg;
    const int lines = j->max_v_samp_factor * DCTSIZE;
    JSAMPROW row[N_PLANES][MAX_ROWS];
    JSAMPARRAY planes[N_PLANES] = {row[0], row[1], row[2]};

    for (int mcu_row = 0; j->output_scanline < j->output_height; mcu_row++) {
        for (int p = 0; p < j->num_components; p++) {
            const int n = j->comp_info[p].v_samp_factor * DCTSIZE;

            for (int y = 0; y < n; y++)
                row[p][y] = image->plane[p] +
                            (ptrdiff_t)(mcu_row * n + y) * d->stride_bytes;
        }
        jpeg_read_raw_data(j, planes, (JDIMENSION)lines);
    }
}

/* Uses a new libjpeg object per frame: a reused object would apply the last
 * frame's tables to the next frame. */
enum glint_status glint_mjpeg_decode(struct glint_mjpeg *decoder,
                                     const void *data, size_t bytes,
                                     struct glint_image *image,
                                     struct glint_error *error)
{
    struct glint_mjpeg *const d = decoder;
    struct glint_image frame;

    if (bytes == 0)
        return glint_error_report(error, GLINT_E_FORMAT, d->name,
                                  "MJPEG: frame is empty");
    d->in_scan = d->ended = false;
    d->error = error;
    d->jpeg = (struct jpeg_decompress_struct){
        .err = jpeg_std_error(&d->errors),
        .client_data = d,
    };
    d->errors.error_exit = on_libjpeg_error;
    d->errors.emit_message = on_libjpeg_message;
    d->errors.output_message = on_libjpeg_output;
    if (setjmp(d->escape)) {
        jpeg_destroy_decompress(&d->jpeg);
        return d->status;
    }
    jpeg_create_decompress(&d->jpeg);
    set_libjpeg_source(d, data, bytes);
    start_decoding(d, &frame);
    decode_jpeg_to_planes(d, &frame);
    jpeg_destroy_decompress(&d->jpeg);
    *image = frame;
    return GLINT_OK;
}
