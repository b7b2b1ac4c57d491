/* SPDX-License-Identifier: MIT
 *
 * formats/pfm.h - PFM pictures: linear light in floats, without a library.
 *
 *     glint_pfm_read(&floats, data, bytes, "x.pfm", &error);
 *     ...
 *     free(floats.rgb);
 *
 * "PF" holds R G B, "Pf" grey, which is read as R = G = B. The third number of
 * the header gives the byte order by its sign (negative: little end first); its
 * magnitude, which writers do not agree on, is ignored. Values are taken as
 * they are, not-a-numbers and infinities included.
 */
#ifndef GLINT_PLATFORM_FORMATS_PFM_H
#define GLINT_PLATFORM_FORMATS_PFM_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/image.h"
#include "glint/status.h"
#include "posix/output.h"

/* Returns whether DATA begins like a PFM. */
bool glint_pfm_matches(const void *data, size_t bytes);

/* The header of a PFM. Its samples follow, the bottom row first. */
struct glint_pfm_header {
    int width, height; /* 1 .. GLINT_MAX_SIDE */
    int channels;      /* 3: R G B, or 1: grey */
    bool little;       /* The low byte of a sample comes first. */
    size_t bytes;      /* length of the header */
};

/* Reads the header of DATA[BYTES], which must have all samples. Errors are
 * those of glint_pfm_read(). */
enum glint_status glint_pfm_header_read(struct glint_pfm_header *header,
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

#endif
