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
 * This is what ffmpeg -f yuv4mpegpipe speaks. A stream is one header line and
 * then, for each frame, a line FRAME and the planes Y, Cb, Cr without padding;
 * chroma of subsampled formats has (side + 1) / 2 samples, as everywhere in
 * glint. Handled is what video/y4m_layout.h lists (where the chroma samples
 * of 4:2:0 lie makes no difference here). Frames of more than 8 bits, and
 * 4:1:1, are looked at through a copy of 8 bits; they themselves are planes
 * that video/y4m_light.h adds light to and glint_y4m_writer_put_planes
 * writes, and an alpha plane goes with them. Interlaced frames are taken as
 * they come, both fields in one.
 *
 * What the codes mean, unless the caller overrules it in the header after open:
 *   range     limited; full only by the tag XCOLORRANGE=FULL. C420jpeg by
 *             itself speaks of chroma siting and is limited too
 *   matrix    BT.601 below 720 lines, BT.709 from there on; there is no tag.
 *             C420jpeg of full range is what JPEG pictures become, and BT.601
 *             of any size
 *   transfer  BT.709
 *
 * Tags that mean nothing to glint are carried over as they are, those of the
 * stream and those of each frame. Frames are counted from 0.
 */
#ifndef GLINT_PLATFORM_VIDEO_Y4M_H
#define GLINT_PLATFORM_VIDEO_Y4M_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"
#include "video/y4m_layout.h"
#include "posix/input.h"
#include "posix/output.h"

#define GLINT_Y4M_LINE       512  /* bytes of the longest line that is read */
#define GLINT_Y4M_PRINTED    1024 /* bytes that any header line fits in */
#define GLINT_Y4M_FRAME_TAGS 128

/* The first line's parameters. */
struct glint_y4m_header {
    int width, height;              /* 1 .. GLINT_MAX_SIDE */
    enum glint_pixel_format format; /* GLINT_GREY, _I420, _I422 or _I444 */
    struct glint_y4m_layout layout; /* layout of a stored frame */
    enum glint_range range;
    enum glint_matrix matrix;
    int fps_num, fps_den;       /* frames a second; 0, 0: not known */
    char interlace;             /* p t b m or ?; 0: not stated */
    char aspect[24];            /* a pixel's, "1:1"; "": not stated */
    char colour[16];            /* the tag stated, "420mpeg2"; "": not stated */
    bool range_stated;          /* XCOLORRANGE states it */
    char extra[GLINT_Y4M_LINE]; /* the other tags, each after a space */
    char line[GLINT_Y4M_LINE];  /* the line that was read, or ""; it is printed
                                   again while range is line_range */
    enum glint_range line_range;
};

/* A header of one's own: progressive, square pixels, limited range. FORMAT is
 * one of those above. FPS_NUM and FPS_DEN >= 1, or 0 and 0. */
void glint_y4m_header_init(struct glint_y4m_header *header, int width,
                           int height, enum glint_pixel_format format,
                           int fps_num, int fps_den);

/* Reads LINE, without the line feed and shorter than GLINT_Y4M_LINE. NAME is
 * for errors. GLINT_E_FORMAT: malformed. GLINT_E_UNSUPPORTED: another
 * layout, or a side above GLINT_MAX_SIDE. */
enum glint_status glint_y4m_header_parse(struct glint_y4m_header *header,
                                         const char *line, const char *name,
                                         struct glint_error *error);

/* Writes HEADER as a line with its line feed, as it was read or in the order W
 * H F I A C, extra tags, XCOLORRANGE, which is stated where it was or where it
 * is FULL. Returns the bytes. */
size_t glint_y4m_header_print(char line[GLINT_Y4M_PRINTED],
                              const struct glint_y4m_header *header);

/* ----------------------------------------------------------------- reading */

/* Delivers 1 .. BYTES bytes at DST and returns how many; 0: the end; -1: failed
 * with errno set. */
typedef ptrdiff_t glint_y4m_source_fn(void *ctx, void *dst, size_t bytes);

struct glint_y4m_reader {
    struct glint_y4m_header header; /* range and matrix may be overruled */
    char frame_tags[GLINT_Y4M_FRAME_TAGS]; /* last frame's: "" or what follows
                                              FRAME, space included */
    long n_frames;                         /* delivered so far */

    /* Private. */
    const char *name;
    struct glint_input in; /* read from unless there is a source */
    glint_y4m_source_fn *source;
    void *ctx;
    struct glint_image frame;
    uint8_t *planes; /* last frame's, as it was stored */
    uint8_t *mem;    /* memory of the frame and, before it, of its planes */
    uint8_t ahead[4096];
    size_t ahead_at, ahead_end; /* bytes read and not used yet */
};

/* Opens PATH, which is kept ("-": standard input), and reads the header. On
 * failure READER is closed. Errors as of parse, and GLINT_E_IO. */
enum glint_status glint_y4m_reader_open(struct glint_y4m_reader *reader,
                                        const char *path,
                                        struct glint_error *error);

/* The same from anywhere. NAME, SOURCE and CTX are kept. */
enum glint_status glint_y4m_reader_start(struct glint_y4m_reader *reader,
                                         glint_y4m_source_fn *source, void *ctx,
                                         const char *name,
                                         struct glint_error *error);

/* Points *FRAME at the next frame, or at NULL after the last. The frame belongs
 * to READER; its samples may be changed, and the next call overwrites them.
 * GLINT_E_FORMAT: no FRAME line where one must be, or the stream ends inside a
 * frame; ERROR says in which. GLINT_E_IO, GLINT_E_MEMORY. */
enum glint_status glint_y4m_reader_next(struct glint_y4m_reader *reader,
                                        const struct glint_image **frame,
                                        struct glint_error *error);

/* Does nothing when closed already. */
void glint_y4m_reader_close(struct glint_y4m_reader *reader);

/* ----------------------------------------------------------------- writing */

struct glint_y4m_writer {
    struct glint_output out;
    long n_frames; /* written so far */
};

/* Opens PATH, which is kept ("-": standard output; posix/output.h says what
 * happens to files), and writes HEADER. On failure WRITER is closed. */
enum glint_status glint_y4m_writer_open(struct glint_y4m_writer *writer,
                                        const char *path,
                                        const struct glint_y4m_header *header,
                                        struct glint_error *error);

/* Writes FRAME, of the format and size of the header, with any strides, and
 * passes it on at once. TAGS: "", or as in glint_y4m_reader.frame_tags.
 * GLINT_E_OUTPUT, GLINT_E_CLOSED. */
enum glint_status glint_y4m_writer_put(struct glint_y4m_writer *writer,
                                       const struct glint_image *frame,
                                       const char *tags,
                                       struct glint_error *error);

/* Writes a frame as it is stored: all planes, glint_y4m_layout_bytes() of them.
 */
enum glint_status glint_y4m_writer_put_planes(struct glint_y4m_writer *writer,
                                              const uint8_t *planes,
                                              size_t bytes, const char *tags,
                                              struct glint_error *error);

/* Ends the stream and puts the file in place. On failure it is aborted. */
enum glint_status glint_y4m_writer_commit(struct glint_y4m_writer *writer,
                                          struct glint_error *error);

/* Throws away what was written, unless into a pipe. Does nothing when closed.
 */
void glint_y4m_writer_abort(struct glint_y4m_writer *writer);

#endif
