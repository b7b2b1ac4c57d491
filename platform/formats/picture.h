/* SPDX-License-Identifier: MIT
 *
 * formats/picture.h - any picture file, in and out.
 *
 *     glint_picture_load("x.png", &image, &error);
 *     ...
 *     glint_picture_save("y.ppm", &image, &error);
 *     glint_picture_free(&image);
 *
 * PPM, PGM and PFM are read and written by glint itself, everything else by
 * its image plug-in (formats/oiio.h). Loading detects the format by
 * content, saving by extension. "-" is a pipe: PPM, PGM or PFM come in;
 * PPM goes out, or PFM where floats are saved.
 *
 * Two kinds of picture. Loading turns one into the other where it has to, by
 * the sRGB curve; saving never does:
 *   8 bits   sRGB, struct glint_image, for .ppm .png .jpg .tif .bmp .tga .webp
 *   floats   linear light, struct glint_float_image, for .pfm .exr .hdr .tif
 *
 * A file that is lit and written with all that it holds, samples, metadata and
 * profile:
 *
 *     glint_kept_open(&kept, "in.png", &error);
 *     ... change kept.samples: formats/samples.h ...
 *     glint_kept_save(&kept, "out.png", NULL, &options, &error);
 *     glint_kept_close(&kept);
 *
 * A file of the same type gets depth, alpha, other channels, parts, windows,
 * profile and metadata as they came. A file of another type gets the colours,
 * upright, with as much depth and alpha as it takes, and the metadata that
 * OpenImageIO translates.
 */
#ifndef GLINT_PLATFORM_FORMATS_PICTURE_H
#define GLINT_PLATFORM_FORMATS_PICTURE_H

#include "formats/oiio.h"
#include "formats/pnm.h"

enum glint_picture_kind { GLINT_PICTURE_8BIT, GLINT_PICTURE_FLOAT };

enum { GLINT_KEPT_NOTES = 256 }; /* bytes */

struct glint_kept {
    struct glint_samples samples;
    /* The file holds floats: light above white is not clipped. */
    bool is_float;
    char note[GLINT_KEPT_NOTES]; /* states what of the file glint cannot keep or
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

struct glint_kept_options {
    int quality; /* quality of JPEG and WebP, 1 .. 100; 0: the input's own, or
                    95 */
    char said[GLINT_KEPT_NOTES]; /* out: what was lost, "" if nothing */
};

/* Returns the number of frames of the GIF NAME, which it reads; 0 if NAME is
 * not a GIF. */
int glint_gif_frames(const char *name);

/* Checks whether the extension of PATH is of a type that holds floats only.
 * TIFF, which takes floats and codes, and "-" count as 8 bits. */
bool glint_picture_is_float(const char *path);

/* Loads PATH as GLINT_RGB24, full range, sRGB; grey becomes R = G = B, alpha is
 * left out, floats are clipped to 0 .. 1. glint_picture_free() frees IMAGE.
 * GLINT_E_IO: PATH cannot be read. GLINT_E_FORMAT: it is malformed.
 * GLINT_E_UNSUPPORTED: no picture, too large, or of a type whose plug-in is
 * missing. GLINT_E_MEMORY. */
enum glint_status glint_picture_load(const char *path,
                                     struct glint_image *image,
                                     struct glint_error *error);

/* Frees the pixels of IMAGE; does nothing to an image of zeros. */
void glint_picture_free(struct glint_image *image);

/* Loads PATH as linear light; the caller frees floats->rgb. Errors are those of
 * glint_picture_load(). */
enum glint_status glint_picture_load_float(const char *path,
                                           struct glint_float_image *floats,
                                           struct glint_error *error);

/* Checks whether a picture of KIND can be saved to PATH, as far as that is
 * known before it is drawn. GLINT_E_UNSUPPORTED: the extension is unknown or of
 * the other kind, or its plug-in is missing. */
enum glint_status glint_picture_check(const char *path,
                                      enum glint_picture_kind kind,
                                      struct glint_error *error);

/* Saves IMAGE, GLINT_RGB24 with any strides; the file appears whole or not at
 * all (posix/output.h). Errors of glint_picture_check(), GLINT_E_OUTPUT,
 * GLINT_E_CLOSED. */
enum glint_status glint_picture_save(const char *path,
                                     const struct glint_image *image,
                                     struct glint_error *error);

/* Saves FLOATS, as glint_picture_save() saves 8 bits. */
enum glint_status
glint_picture_save_float(const char *path,
                         const struct glint_float_image *floats,
                         struct glint_error *error);

/* Opens the file PATH; the string must outlive KEPT. Errors are those of
 * glint_picture_load(). On failure KEPT is closed. */
enum glint_status glint_kept_open(struct glint_kept *kept, const char *path,
                                  struct glint_error *error);

/* Closes KEPT, unless it is closed already. */
void glint_kept_close(struct glint_kept *kept);

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
