/* SPDX-License-Identifier: MIT
 *
 * formats/kept.h - a picture file that is opened, lit and written with all that
 * it holds: samples, metadata, profile.
 *
 *     glint_kept_open(&kept, "in.png", &error);
 *     ... change kept.samples: formats/samples.h ...
 *     glint_kept_save(&kept, "out.png", NULL, &options, &error);
 *     glint_kept_close(&kept);
 *
 * A file of the same type gets depth, alpha, other channels, parts, windows,
 * profile and metadata as they came. glint itself writes PPM, PGM and PFM,
 * other types go through the image plug-in (formats/oiio.h). A file of another
 * type gets the colours, upright, with as much depth and alpha as it takes, and
 * the metadata that OpenImageIO translates.
 */
#ifndef GLINT_PLATFORM_FORMATS_KEPT_H
#define GLINT_PLATFORM_FORMATS_KEPT_H

#include "formats/oiio.h"

enum { GLINT_KEPT_NOTES = 256 }; /* bytes */

struct glint_kept {
    struct glint_samples samples;
    /* The file holds floats: light above white is not clipped. */
    bool is_float;
    char note[GLINT_KEPT_NOTES]; /* says what of the file glint cannot keep or
                                    does not know; "" if nothing */

    /* Private. */
    const char *path;
    const struct glint_oiio *oiio; /* NULL: PNM or PFM */
    struct glint_oiio_file *file;
    /* all bytes of a PNM or PFM; of other files the first 12 */
    uint8_t *native;
    size_t native_bytes, header_bytes;
    bool is_pfm, is_little;
    uint8_t *own; /* the file's samples in this machine's order */
};

/* Opens the file PATH; the string must outlive KEPT. Errors are those of
 * glint_picture_load(). On failure KEPT is closed. */
enum glint_status glint_kept_open(struct glint_kept *kept, const char *path,
                                  struct glint_error *error);

/* Closes KEPT, unless it is closed already. */
void glint_kept_close(struct glint_kept *kept);

struct glint_kept_options {
    int quality; /* quality of JPEG and WebP, 1 .. 100; 0: the input's own, or
                    95 */
    char said[GLINT_KEPT_NOTES]; /* out: what was lost, "" if nothing */
};

/* Writes to PATH the picture ALONE, which has KEPT's upright size, or if ALONE
 * is NULL the picture of KEPT. GLINT_E_OUTPUT, GLINT_E_UNSUPPORTED,
 * GLINT_E_MEMORY, GLINT_E_CLOSED. */
enum glint_status glint_kept_save(struct glint_kept *kept, const char *path,
                                  const struct glint_samples *alone,
                                  struct glint_kept_options *options,
                                  struct glint_error *error);

/* Checks whether PATH has the file type of KEPT. If so, a picture that was not
 * changed can be saved by copying its file, as glint_kept_copy() does. */
bool glint_kept_is_same_type(const struct glint_kept *kept, const char *path);
enum glint_status glint_kept_copy(const struct glint_kept *kept,
                                  const char *path, struct glint_error *error);

/* Makes BLANK, a picture of zeros of FROM's upright size, with R G B, and alpha
 * if HAS_ALPHA. Its samples are of FROM's type, but floats for integers of 32
 * bits; floats are linear, codes sRGB. The caller frees blank->mem.
 * GLINT_E_MEMORY. */
enum glint_status glint_kept_blank(struct glint_samples *blank,
                                   const struct glint_samples *from,
                                   bool has_alpha);

/* Checks, before long work is done for it, whether PATH has an extension that
 * glint can write. GLINT_E_UNSUPPORTED: unknown, or its plug-in is missing. */
enum glint_status glint_kept_check(const char *path, struct glint_error *error);

#endif
