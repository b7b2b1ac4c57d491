/* SPDX-License-Identifier: MIT
 *
 * formats/pnm.h - reads and writes PPM, PGM and PFM pictures without a library.
 *
 *     glint_pnm_read(&image, data, bytes, "x.ppm", &error);
 *     glint_pfm_read(&floats, data, bytes, "x.pfm", &error);
 *     ...
 *     free(image.plane[0]);
 *     free(floats.rgb);
 *
 * PNM: only the binary types P6 (colour) and P5 (grey) are supported. The
 * maximum value may be 1 .. 65535, and comments may be anywhere in the header.
 * Samples are scaled to 8 bits and rounded; samples above the stated maximum
 * are clamped to it. Bytes after the first picture are ignored, because PNM
 * files may hold several pictures.
 *
 * PFM stores linear light as floats. "PF" files hold R G B, "Pf" files grey,
 * which is read as R = G = B. The sign of the third number in the header gives
 * the byte order (negative: little-endian). The magnitude of this number is
 * ignored, because writers disagree on its meaning. Values are read unchanged,
 * including NaN and infinity. */
#ifndef GLINT_PLATFORM_FORMATS_PNM_H
#define GLINT_PLATFORM_FORMATS_PNM_H

#include <stdbool.h>

#include "glint/image.h"
#include "posix/output.h"

/* The header of a PNM or PFM. The samples follow the header; those of a PFM
 * begin with the bottom row. */
struct glint_pnm_header {
    int width, height; /* 1 .. GLINT_MAX_SIDE */
    int channels;      /* 3: R G B, or 1: grey */
    int maximum;       /* code of white, 1 .. 65535; above 255 samples have two
                          bytes, big-endian; 0: samples are floats */
    bool little;       /* floats are little-endian */
    size_t bytes;      /* length of the header, bytes */
};

/* glint_pnm_has_signature() returns whether DATA begins like a P5 or P6,
 * glint_pfm_has_signature() whether it begins like a PFM. */
bool glint_pnm_has_signature(const void *data, size_t bytes);
bool glint_pfm_has_signature(const void *data, size_t bytes);

/* Reads the header of DATA[BYTES], a complete PNM or PFM. Returns the errors of
 * glint_pnm_read(). */
enum glint_status glint_pnm_header_read(struct glint_pnm_header *header,
                                        const void *data, size_t bytes,
                                        const char *name,
                                        struct glint_error *error);

/* Reads the PFM in DATA[BYTES]; the caller frees floats->rgb. NAME is for
 * errors. Returns GLINT_E_FORMAT if the data are malformed or cut short,
 * GLINT_E_UNSUPPORTED if they are not a PFM or a side is above GLINT_MAX_SIDE,
 * or GLINT_E_MEMORY. */
enum glint_status glint_pfm_read(struct glint_float_image *floats,
                                 const void *data, size_t bytes,
                                 const char *name, struct glint_error *error);

/* Writes FLOATS to OUT as a PFM with R G B ("PF"), little-endian. */
enum glint_status glint_pfm_write(struct glint_output *out,
                                  const struct glint_float_image *floats,
                                  struct glint_error *error);

/* Reads DATA[BYTES] into IMAGE: GLINT_RGB24 for P6, GLINT_GREY for P5, full
 * range, sRGB transfer. plane[0] is one malloc'ed block without padding, which
 * the caller frees. NAME is for errors. Returns GLINT_E_FORMAT if the data are
 * malformed or cut short, GLINT_E_UNSUPPORTED if they are not a P5 or P6 or a
 * side is above GLINT_MAX_SIDE, or GLINT_E_MEMORY. */
enum glint_status glint_pnm_read(struct glint_image *image, const void *data,
                                 size_t bytes, const char *name,
                                 struct glint_error *error);

/* Writes IMAGE, GLINT_RGB24 with any strides, to OUT as a P6 with maximum
 * 255. */
enum glint_status glint_pnm_write(struct glint_output *out,
                                  const struct glint_image *image,
                                  struct glint_error *error);

#endif
