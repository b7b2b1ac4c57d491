/* SPDX-License-Identifier: MIT
 *
 * jpeg/mjpeg.h - decodes frames of Motion JPEG cameras to planes Y, Cb, Cr.
 *
 *     glint_mjpeg_open(&decoder, "/dev/video0", 1280, 720, &error); once
 *     status = glint_mjpeg_decode(decoder, data, bytes, &image, &error);
 *     if (status == GLINT_E_FORMAT)
 *         n_corrupt++; ... and on to the next frame
 *     glint_mjpeg_close(decoder);
 *
 * A frame is one baseline JPEG in one scan, as cameras send it. Its samples are
 * returned as coded, without conversion to RGB and without upsampling of
 * chroma. They are the same bits on every machine (integer transform).
 *
 * Tolerated faults of cameras: missing Huffman tables (the standard tables are
 * used), an AVI1 header, two start-of-image markers, stray bytes between
 * markers, a missing end-of-image marker, and bytes behind this marker. Frames
 * are independent: pixels depend only on the bytes of their frame.
 *
 * Frames are decoded by libjpeg. It allocates and frees some 30 KiB of heap per
 * frame. The blocks are so small that they need no system call after the first
 * frames. In builds without libjpeg, glint_mjpeg_open() returns
 * GLINT_E_UNSUPPORTED. */
#ifndef GLINT_PLATFORM_JPEG_MJPEG_H
#define GLINT_PLATFORM_JPEG_MJPEG_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/image.h"
#include "glint/status.h"
#include "source_sink.h"

struct glint_mjpeg; /* opaque */

/* Returns whether libjpeg is built in. */
bool glint_mjpeg_available(void);

/* Makes a decoder for frames up to MAX_WIDTH x MAX_HEIGHT, 1 ..
 * GLINT_PANEL_SIDE, of any subsampling. NAME is for errors and must outlive
 * DECODER. Returns GLINT_E_ARGUMENT for other sizes, GLINT_E_UNSUPPORTED if
 * glint is built without libjpeg, or GLINT_E_MEMORY. */
enum glint_status glint_mjpeg_open(struct glint_mjpeg **decoder,
                                   const char *name, int max_width,
                                   int max_height, struct glint_error *error);

/* Decodes DATA[BYTES] and points IMAGE at the result: GLINT_GREY, _I420, _I422
 * or _I444, full range, BT.601, sRGB curve. The size may differ from frame to
 * frame. The samples belong to DECODER and may be changed; the next call
 * overwrites them. Returns GLINT_E_FORMAT if the frame is empty, visibly
 * damaged, or ends before its last sample; the caller should drop the frame and
 * continue. Returns GLINT_E_UNSUPPORTED if the frame is too large, progressive,
 * arithmetic-coded, RGB or CMYK, has more than 8 bits, or has an unsupported
 * subsampling; the next frame is probably of the same type. Returns
 * GLINT_E_MEMORY if libjpeg got no memory; decoding the next frame may
 * succeed. */
enum glint_status glint_mjpeg_decode(struct glint_mjpeg *decoder,
                                     const void *data, size_t bytes,
                                     struct glint_image *image,
                                     struct glint_error *error);

/* Frees DECODER, which may be NULL. */
void glint_mjpeg_close(struct glint_mjpeg *decoder);

#endif
