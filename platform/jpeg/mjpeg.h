/* SPDX-License-Identifier: MIT
 *
 * jpeg/mjpeg.h - frames of Motion JPEG cameras as planes Y, Cb, Cr.
 *
 *     glint_mjpeg_open(&decoder, "/dev/video0", 1280, 720, &error);  once
 *     status = glint_mjpeg_decode(decoder, data, bytes, &image, &error);
 *     if (status == GLINT_E_FORMAT)
 *         n_corrupt++;                    ... and on to the next frame
 *     glint_mjpeg_close(decoder);
 *
 * A frame is one baseline JPEG in one scan, as cameras send it. Its samples
 * are taken as they were coded: no conversion to RGB and no enlarging of
 * chroma. They are exact to the bit on every machine (integer transform).
 *
 * Faults of cameras that are put up with: no Huffman tables (the standard ones
 * are meant), an AVI1 header, two starts of image, bytes where none belong
 * between markers, no end of image, anything after it. Nothing of a frame is
 * remembered for the next: pixels depend on the bytes of their frame alone.
 *
 * libjpeg decodes, and takes and returns some 30 KiB of heap for each frame,
 * in blocks so small that they need no system call once the heap is warm.
 * Built without libjpeg, open fails with GLINT_E_UNSUPPORTED.
 */
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
 * GLINT_PANEL_SIDE, with room for any subsampling. NAME is for errors and must
 * outlive DECODER.
 * GLINT_E_UNSUPPORTED: built without libjpeg. GLINT_E_MEMORY. */
enum glint_status glint_mjpeg_open(struct glint_mjpeg **decoder,
                                   const char *name, int max_width,
                                   int max_height, struct glint_error *error);

/* Decodes DATA[BYTES] and points IMAGE at the result: GLINT_GREY, _I420, _I422
 * or _I444, full range, BT.601, sRGB curve. Its size is the frame's own and may
 * differ from the last one's. Its samples belong to DECODER and may be changed;
 * the next call overwrites them.
 * GLINT_E_FORMAT: the frame is empty, garbage, damaged where that can be seen,
 * or ends before its last sample; drop it and continue.
 * GLINT_E_UNSUPPORTED: it is larger than the maximum, progressive, RGB or CMYK,
 * of another subsampling, or has more than 8 bits. The next frame will be, too,
 * unless this one is damaged.
 * GLINT_E_MEMORY: libjpeg got no memory; the next frame may work. */
enum glint_status glint_mjpeg_decode(struct glint_mjpeg *decoder,
                                     const void *data, size_t bytes,
                                     struct glint_image *image,
                                     struct glint_error *error);

/* Frees DECODER, which may be NULL. */
void glint_mjpeg_close(struct glint_mjpeg *decoder);

#endif
