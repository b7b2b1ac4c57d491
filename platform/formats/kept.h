/* SPDX-License-Identifier: MIT
 *
 * formats/kept.h - a picture file that is opened, lit and written with all that
 * it holds.
 *
 *     glint_kept_open(&kept, "in.png", &error);
 *     ... change kept.samples: formats/samples.h ...
 *     glint_kept_save(&kept, "out.png", NULL, &options, &error);
 *     glint_kept_close(&kept);
 *
 * Into a file of the same type go depth, alpha, other channels, parts, windows,
 * profile and metadata as they came; PPM, PGM and PFM by glint itself, the rest
 * through the image plug-in (oiio/oiio.h). Into another type go the colours,
 * upright, with as much depth and as much alpha as it takes, and the metadata
 * that OpenImageIO translates.
 */
#ifndef GLINT_PLATFORM_FORMATS_KEPT_H
#define GLINT_PLATFORM_FORMATS_KEPT_H

#include <stdbool.h>

#include "glint/status.h"
#include "oiio/oiio.h"
#include "formats/samples.h"

enum { GLINT_KEPT_NOTES = 256 }; /* bytes */

struct glint_kept {
    struct glint_samples samples;
    bool is_float; /* light beyond white is what it is, not clipped */
    char note[GLINT_KEPT_NOTES]; /* words on what glint takes otherwise than the
                                    file means it */

    /* Private. */
    const char *path;
    const struct glint_oiio *oiio; /* NULL: PNM or PFM */
    struct glint_oiio_file *file;
    bool has_icc;
    uint8_t *native; /* the whole of a PNM or PFM */
    size_t native_bytes, header_bytes;
    bool is_pfm, is_little;
    uint8_t *own; /* the file's samples in this machine's order */
};

/* Opens PATH, which is kept. Errors as of glint_picture_load. On failure KEPT
 * is closed. */
enum glint_status glint_kept_open(struct glint_kept *kept, const char *path,
                                  struct glint_error *error);

/* Does nothing when closed. */
void glint_kept_close(struct glint_kept *kept);

struct glint_kept_options {
    int quality; /* quality of JPEG and WebP, 1 .. 100; 0: the input's own, or
                    95 */
    bool quiet;  /* do not say what is lost */
    char said[GLINT_KEPT_NOTES]; /* out: what was lost, "" if nothing */
};

/* Writes KEPT, or unless NULL the picture ALONE, which has the size of KEPT
 * as it is seen, to PATH. GLINT_E_OUTPUT, GLINT_E_UNSUPPORTED, GLINT_E_MEMORY,
 * GLINT_E_CLOSED. */
enum glint_status glint_kept_save(struct glint_kept *kept, const char *path,
                                  const struct glint_samples *alone,
                                  struct glint_kept_options *options,
                                  struct glint_error *error);

/* Returns whether KEPT can be written to PATH as what it is; then copying the
 * file gives the same. */
bool glint_kept_is_same_type(const struct glint_kept *kept, const char *path);
enum glint_status glint_kept_copy(const struct glint_kept *kept,
                                  const char *path, struct glint_error *error);

/* A picture WIDTH x HEIGHT of zeros with as much depth as FROM has: R G B, and
 * alpha if HAS_ALPHA. FLOATS: linear, else sRGB. Its memory is the caller's to
 * free. */
enum glint_status glint_kept_blank(struct glint_samples *blank,
                                   const struct glint_samples *from,
                                   bool has_alpha);

/* Checks whether PATH can be saved to at all, before long work is done for it.
 */
enum glint_status glint_kept_check(const char *path, struct glint_error *error);

#endif
