/* SPDX-License-Identifier: MIT
 *
 * formats/pnm.h - PPM, PGM and PFM pictures without a library.
 *
 *     glint_pnm_read(&image, data, bytes, "x.ppm", &error);
 *     glint_pfm_read(&floats, data, bytes, "x.pfm", &error);
 *     ...
 *     free(image.plane[0]);
 *     free(floats.rgb);
 *
 * PNM: the binary kinds only: P6 (colour) and P5 (grey), maximum value 1 ..
 * 65535, comments anywhere in the header. Samples are scaled to 8 bits, to
 * nearest; those above the stated maximum count as the maximum. Bytes after the
 * first picture are ignored, as PNM files may hold several.
 *
 * PFM, linear light in floats: "PF" holds R G B, "Pf" grey, which is read as R
 * = G = B. The third number of the header gives the byte order by its sign
 * (negative: little end first); its magnitude, which writers do not agree on,
 * is ignored. Values are taken as they are, not-a-numbers and infinities
 * included.
 */
#ifndef GLINT_PLATFORM_FORMATS_PNM_H
#define GLINT_PLATFORM_FORMATS_PNM_H

#include <stdbool.h>

#include "glint/image.h"
#include "posix/output.h"

/* The header of a PNM or PFM. Its samples follow; of a PFM the bottom row comes
 * first. */
struct glint_pnm_header {
    int width, height; /* 1 .. GLINT_MAX_SIDE */
    int channels;      /* 3: R G B, or 1: grey */
    int maximum;  /* 1 .. 65535; above 255 samples have two bytes, the high one
                     first; 0: floats */
    bool little;  /* The low byte of a float comes first. */
    size_t bytes; /* length of the header */
};

/* Returns whether DATA begins like a P5 or P6, or like a PFM. */
bool glint_pnm_matches(const void *data, size_t bytes);
bool glint_pfm_matches(const void *data, size_t bytes);

/* Reads the header of DATA[BYTES], a PNM or PFM, which must have all samples.
 * Errors are those of glint_pnm_read(). */
enum glint_status glint_pnm_header_read(struct glint_pnm_header *header,
                                        const void *data, size_t bytes,
                                        const char *name,
                                        struct glint_error *error);

/* Reads the PFM in DATA[BYTES]; the caller frees floats->rgb. NAME is for
 * errors. GLINT_E_FORMAT: malformed or cut short. GLINT_E_UNSUPPORTED: not a
 * PFM, or a side above GLINT_MAX_SIDE. GLINT_E_MEMORY. */
enum glint_status glint_pfm_read(struct glint_float_image *floats,
                                 const void *data, size_t bytes,
                                 const char *name, struct glint_error *error);

/* Writes FLOATS to OUT as a "PF", the low byte of each sample first. */
enum glint_status glint_pfm_write(struct glint_output *out,
                                  const struct glint_float_image *floats,
                                  struct glint_error *error);

/* Reads DATA[BYTES] into IMAGE: GLINT_RGB24 for P6, GLINT_GREY for P5, full
 * range, sRGB transfer. plane[0] is one malloc'ed block without padding, which
 * the caller frees. NAME is for errors.
 * GLINT_E_FORMAT: malformed or cut short. GLINT_E_UNSUPPORTED: another kind, or
 * a side above GLINT_MAX_SIDE. GLINT_E_MEMORY. */
enum glint_status glint_pnm_read(struct glint_image *image, const void *data,
                                 size_t bytes, const char *name,
                                 struct glint_error *error);

/* Writes IMAGE, GLINT_RGB24 with any strides, to OUT as a P6 with maximum
 * 255. */
enum glint_status glint_pnm_write(struct glint_output *out,
                                  const struct glint_image *image,
                                  struct glint_error *error);

#endif
