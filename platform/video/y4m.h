/* SPDX-License-Identifier: MIT
 *
 * video/y4m.h - YUV4MPEG2 video in and out, frame by frame.
 *
 *     glint_y4m_reader_open(&in, "-", &error);
 *     glint_y4m_writer_open(&out, "x.y4m", &in.header, &error);
 *     while (!(status = glint_y4m_reader_next(&in, &frame, &error)) && frame) {
 *         ... change the samples of FRAME in place ...
 *         glint_y4m_writer_put(&out, frame, in.frame_tags, &error);
 *     }
 *     glint_y4m_writer_commit(&out, &error);
 *     glint_y4m_reader_close(&in);
 *
 * ffmpeg -f yuv4mpegpipe writes and reads such streams: one header line and
 * then, for each frame, a line FRAME and the planes Y, Cb, Cr without padding.
 * Chroma of subsampled formats has (side + 1) / 2 samples, as everywhere in
 * glint. The supported layouts are listed below. The positions of the chroma
 * samples of 4:2:0 relative to luma (siting) are ignored. A frame is returned
 * as an 8-bit BT.709 copy, for analysis, if it has more than 8 bits, is 4:1:1,
 * or has a transfer or primaries other than BT.709. The stored planes, with the
 * alpha plane if there is one, are in reader->planes: glint_y4m_light adds
 * light to them, and glint_y4m_writer_put_planes() writes them. Both fields of
 * an interlaced frame are treated as one picture.
 *
 * Colours of a stream, unless the caller changes them in the header after open:
 *   range     limited; full only by the tag XCOLORRANGE=FULL. C420jpeg
 *             alone states chroma siting only, and is limited, too
 *   matrix    BT.601 below 720 lines, BT.709 from there on; there is no tag.
 *             Full range as C420jpeg or without a C tag is BT.601 in any size,
 *             as JPEG pictures are
 *   transfer, primaries  BT.709; there are no tags
 *
 * Tags that glint does not use, of the stream and of each frame, are copied
 * unchanged. Frames are counted from 0.
 *
 * Layouts of a frame by the tag C:
 *
 *     C420 420jpeg 420mpeg2 420paldv 411 422 444 444alpha mono
 *     and 420 422 444 with p9 p10 p12 p14 p16, mono with 9 10 12 14 16
 *
 * A sample of more than 8 bits has two bytes, little-endian.
 */
#ifndef GLINT_PLATFORM_VIDEO_Y4M_H
#define GLINT_PLATFORM_VIDEO_Y4M_H

#include <stdbool.h>

#include "glint/image.h"
#include "posix/input.h"
#include "posix/output.h"
#include "video/transfer.h"

struct glint_y4m_seen;

struct glint_y4m_layout {
    /* GLINT_GREY, _I420, _I422 or _I444; for 4:1:1 _I422, the format of its
     * 8-bit copy */
    enum glint_pixel_format format;
    int bits;       /* bits per sample, 8 .. 16 */
    bool has_alpha; /* a fourth plane of full size, which is copied unchanged */
    bool is_411;    /* 4:1:1: chroma has a quarter of the width */
};

#define GLINT_Y4M_LINE 512 /* max bytes of a line that is parsed */

#define GLINT_Y4M_PRINTED 1024 /* max bytes of a line that is printed */

#define GLINT_Y4M_FRAME_TAGS 128

/* Parameters of a stream, as its header line states them. */
struct glint_y4m_header {
    int width, height;              /* 1 .. GLINT_MAX_SIDE */
    enum glint_pixel_format format; /* GLINT_GREY, _I420, _I422 or _I444 */
    struct glint_y4m_layout layout; /* layout of a stored frame */
    enum glint_range range;
    enum glint_matrix matrix;
    enum glint_transfer_curve transfer;
    enum glint_primaries primaries;
    int fps_num, fps_den; /* frames per second; 0, 0: not known */
    /* Value of the tag I: p progressive, t or b top or bottom field first, m
     * mixed, ? unknown; 0: not stated. */
    char interlace;
    char aspect[24];            /* aspect ratio of a pixel, "1:1"; "": not
                                   stated */
    char colour[16];            /* value of the tag C, "420mpeg2"; "": not
                                   stated */
    bool range_stated;          /* the stream has the tag XCOLORRANGE */
    char extra[GLINT_Y4M_LINE]; /* all other tags, each after a space */
    /* The header line that was read, or "". glint_y4m_header_print() prints it
     * unchanged if range still equals line_range. */
    char line[GLINT_Y4M_LINE];
    enum glint_range line_range;
};

/* ----------------------------------------------------------------- reading */

/* Reads 1 .. BYTES bytes of the stream to DST and returns their number; returns
 * 0 at the end, or -1 with errno set on failure. */
typedef ptrdiff_t glint_y4m_source_fn(void *ctx, void *dst, size_t bytes);

struct glint_y4m_reader {
    /* Parameters of the stream. The caller may change range, matrix, transfer
     * and primaries before the first frame. */
    struct glint_y4m_header header;
    /* Tags of the last frame: the text after FRAME, or "". */
    char frame_tags[GLINT_Y4M_FRAME_TAGS];
    long n_frames; /* frames delivered so far */

    /* Private members. */
    const char *name;
    bool is_raw;   /* true: the stream has no header and no FRAME lines */
    size_t stride; /* distance between rows of luma, bytes; 0: rows have no
                      padding */
    struct glint_input in; /* input file, if source is NULL */
    glint_y4m_source_fn *source;
    void *ctx;
    struct glint_image frame;
    uint8_t *planes; /* planes of the last frame, as they were stored */
    uint8_t *mem;    /* memory of planes, followed by the memory of frame */
    /* Tables that convert frames to the BT.709 copy; NULL: frames are BT.709
     * already. */
    struct glint_y4m_seen *seen;
    uint8_t ahead[4096];
    /* Bytes ahead_at .. ahead_end - 1 of the array ahead were read from the
     * input, but not parsed yet. */
    size_t ahead_at, ahead_end;
};

/* ----------------------------------------------------------------- writing */

struct glint_y4m_writer {
    struct glint_output out;
    long n_frames; /* frames written so far */
};

/* Returns whether stored frames have the layout of struct glint_image and need
 * no conversion: 8 bits, BT.709, not 4:1:1. An alpha plane may follow. */
bool glint_y4m_is_8_bit_bt709(const struct glint_y4m_header *header);

/* Returns the number of bytes of all planes of a frame. */
size_t glint_y4m_layout_bytes(const struct glint_y4m_layout *layout, int width,
                              int height);

/* Returns whether NAME ends in .y4m. */
bool glint_y4m_has_extension(const char *name);

/* Sets HEADER for a new stream: progressive, square pixels, limited range.
 * FORMAT is GLINT_GREY, _I420, _I422 or _I444. FPS_NUM and FPS_DEN >= 1, or 0
 * and 0: not known. */
void glint_y4m_header_init(struct glint_y4m_header *header, int width,
                           int height, enum glint_pixel_format format,
                           int fps_num, int fps_den);

/* Parses LINE into HEADER. LINE must have no line feed and be shorter than
 * GLINT_Y4M_LINE. NAME is for errors. Returns GLINT_E_FORMAT if LINE is
 * malformed, GLINT_E_UNSUPPORTED if the layout is not supported or a side is
 * above GLINT_MAX_SIDE. */
enum glint_status glint_y4m_header_parse(struct glint_y4m_header *header,
                                         const char *line, const char *name,
                                         struct glint_error *error);

/* Writes HEADER to LINE, with a line feed: unchanged if it was read, else in
 * the order W H F I A C, extra tags, XCOLORRANGE. XCOLORRANGE is written if
 * range_stated is set or the range is full. Returns the length. */
size_t glint_y4m_header_print(char line[GLINT_Y4M_PRINTED],
                              const struct glint_y4m_header *header);

/* Opens PATH ("-": standard input), which must outlive READER, and reads the
 * header. On failure READER is closed. Returns the errors of
 * glint_y4m_header_parse(), or GLINT_E_IO. */
enum glint_status glint_y4m_reader_open(struct glint_y4m_reader *reader,
                                        const char *path,
                                        struct glint_error *error);

/* Opens PATH, a stream of raw frames in the format of HEADER. It has no header
 * and no FRAME lines, like the output of camera programs. Rows of luma begin
 * STRIDE bytes apart, rows of narrower chroma half as far apart; if STRIDE is
 * 0, rows have no padding. Returns GLINT_E_IO on failure. */
enum glint_status
glint_y4m_reader_open_raw(struct glint_y4m_reader *reader, const char *path,
                          const struct glint_y4m_header *header, size_t stride,
                          struct glint_error *error);

/* Starts to read the stream that SOURCE delivers. NAME, SOURCE and CTX must
 * outlive READER. Returns the errors of glint_y4m_reader_open(). */
enum glint_status glint_y4m_reader_start(struct glint_y4m_reader *reader,
                                         glint_y4m_source_fn *source, void *ctx,
                                         const char *name,
                                         struct glint_error *error);

/* Points *FRAME at the next frame, or sets it to NULL after the last. The frame
 * belongs to READER; its samples may be changed, and the next call overwrites
 * them. Returns GLINT_E_FORMAT if a FRAME line is missing or the stream ends
 * inside a frame (ERROR has the frame's number), GLINT_E_IO or
 * GLINT_E_MEMORY. */
enum glint_status glint_y4m_reader_next(struct glint_y4m_reader *reader,
                                        const struct glint_image **frame,
                                        struct glint_error *error);

/* Closes READER, unless it is closed already. */
void glint_y4m_reader_close(struct glint_y4m_reader *reader);

/* Opens PATH ("-": standard output; posix/output.h states what happens to
 * files), which must outlive WRITER, and writes HEADER. On failure WRITER is
 * closed. */
enum glint_status glint_y4m_writer_open(struct glint_y4m_writer *writer,
                                        const char *path,
                                        const struct glint_y4m_header *header,
                                        struct glint_error *error);

/* Writes FRAME, of the format and size of the header, with any strides, and
 * flushes the output. TAGS: "", or as in glint_y4m_reader.frame_tags. Returns
 * GLINT_E_OUTPUT or GLINT_E_CLOSED on failure. */
enum glint_status glint_y4m_writer_put(struct glint_y4m_writer *writer,
                                       const struct glint_image *frame,
                                       const char *tags,
                                       struct glint_error *error);

/* Writes a frame in the stored layout: PLANES are all its planes, BYTES must be
 * glint_y4m_layout_bytes(). */
enum glint_status glint_y4m_writer_put_planes(struct glint_y4m_writer *writer,
                                              const uint8_t *planes,
                                              size_t bytes, const char *tags,
                                              struct glint_error *error);

/* Ends the stream and renames the file over its target. On failure aborts
 * WRITER. */
enum glint_status glint_y4m_writer_commit(struct glint_y4m_writer *writer,
                                          struct glint_error *error);

/* Closes WRITER, unless it is closed already, and removes the file. Bytes
 * written to a pipe cannot be removed. */
void glint_y4m_writer_abort(struct glint_y4m_writer *writer);

/* -------------------------------------------------------------------- light
 *
 * Light on frames of any depth, layout and transfer. Codes are converted to R',
 * G', B' and then to linear light (video/transfer.h). Light is added to the
 * linear light. The codes of the frame are then changed by the difference that
 * this makes; a chroma sample is changed by the mean difference of its pixels.
 * All arithmetic is in integers, so that results are the same on every machine;
 * codes of pixels without added light do not change. */

enum {
    GLINT_Y4M_STEPS = 4096,   /* number of steps of R'G'B' from black to
                                 white */
    GLINT_Y4M_OCTAVES = 30,   /* number of octaves of light, from 2^-24 to 64 */
    GLINT_Y4M_IN_OCTAVE = 128 /* number of table entries per octave */
};

struct glint_y4m_light {
    struct glint_y4m_layout layout;
    int width, height;
    int32_t black, most; /* code of Y' = 0, and the max code */
    /* Number of codes from Y' = 0 to 1, and from Cb = -1/2 to 1/2. */
    int32_t y_span, c_span;
    int32_t kr_q16, kg_q16, kb_q16; /* weights of R', G', B' in Y' */
    /* Factors that replace divisions by y_span and c_span (y4m_divide.h). */
    int64_t y_factor, c_factor;
    int64_t cb_factor, cr_factor,
        /* factors that replace divisions by 1 - kb, 1 - kr and kg */
        g_factor;
    enum glint_primaries primaries;
    /* linear light of each step of R'G'B'; 2^24: white */
    int32_t decode_q24[GLINT_Y4M_STEPS + 1];
    /* R', G' or B' as a function of light: [octave of the light][entry in the
     * octave]; 2^20: white */
    int32_t encode_q20[GLINT_Y4M_OCTAVES][GLINT_Y4M_IN_OCTAVE + 1];
};

/* Computes the tables LIGHT for the frames of a stream with HEADER. */
void glint_y4m_light_init(struct glint_y4m_light *light,
                          const struct glint_y4m_header *header);

/* Sets all colour codes of PLANES to black; alpha does not change. */
void glint_y4m_light_set_black(const struct glint_y4m_light *light,
                               uint8_t *planes);

/* Adds LAYER, [height][width][3], linear light, 1 = white, to PLANES. */
void glint_y4m_light_add(const struct glint_y4m_light *light, uint8_t *planes,
                         const float *layer);

/* Hides the fraction COVER_Q8, [height][width], 0 .. 256, of each pixel, then
 * adds LAYER like glint_y4m_light_add(). */
void glint_y4m_light_cover(const struct glint_y4m_light *light, uint8_t *planes,
                           const float *layer, const uint16_t *cover_q8);

#endif
