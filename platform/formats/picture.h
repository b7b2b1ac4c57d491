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
 */
#ifndef GLINT_PLATFORM_FORMATS_PICTURE_H
#define GLINT_PLATFORM_FORMATS_PICTURE_H

#include "formats/pnm.h"
#include "posix/input.h"

enum glint_type_alpha {
    GLINT_ALPHA_NONE,
    GLINT_ALPHA_STRAIGHT,
    GLINT_ALPHA_PREMULTIPLIED
};

struct glint_file_type {
    const char *extension;
    bool is_native; /* written by glint itself */
    bool is_grey;   /* holds no colours */
    enum glint_type_alpha alpha;
    bool takes_u8, takes_u16, takes_half, takes_float;
};

enum glint_picture_kind { GLINT_PICTURE_8BIT, GLINT_PICTURE_FLOAT };

/* Returns the number of frames of the GIF NAME, which it reads; 0 if NAME is no
 * GIF. */
int glint_gif_frames(const char *name);

/* Returns the type that PATH's extension stands for, or NULL if it is
 * unknown. */
const struct glint_file_type *glint_file_type_of(const char *path);

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

/* For formats/kept.c: reads of IN a PNM or PFM whole, of other files the first
 * 12 bytes, into *DATA, which the caller frees also on failure. NAME is for
 * errors. GLINT_E_FORMAT: it is empty. GLINT_E_UNSUPPORTED: a video, or too
 * large. GLINT_E_IO, GLINT_E_MEMORY. */
enum glint_status glint_picture_read(struct glint_input *in, const char *name,
                                     uint8_t **data, size_t *bytes,
                                     struct glint_error *error);

/* For formats/kept.c: returns the name of the file type that HEAD, the first
 * BYTES of a file, shows; reports in ERROR that a file of TYPE needs the
 * plug-in, with the reason that ERROR gives for its absence. */
const char *glint_picture_type(const uint8_t *head, size_t bytes);

enum glint_status glint_picture_needs_plugin(const char *path, const char *type,
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

#endif
