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
 * its image plug-in (oiio/oiio.h). Files are told apart by content when
 * loading, by extension when saving. "-" is a pipe: PPM, PGM or PFM come in;
 * PPM goes out, or PFM where floats are saved.
 *
 * Two kinds of picture. Loading turns one into the other where it has to, by
 * the sRGB curve; saving never does:
 *   8 bits   sRGB, struct glint_image, for .ppm .png .jpg .tif .bmp .tga .webp
 *   floats   linear light, struct glint_float_image, for .pfm .exr .hdr .tif
 */
#ifndef GLINT_PLATFORM_FORMATS_PICTURE_H
#define GLINT_PLATFORM_FORMATS_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"
#include "formats/pfm.h"

enum glint_picture_kind { GLINT_PICTURE_8BIT, GLINT_PICTURE_FLOAT };

/* Returns whether the extension of PATH is one of those that hold nothing but
 * floats. TIFF, which takes both, and "-" count as 8 bits. */
bool glint_picture_is_float(const char *path);

/* Loads PATH as GLINT_RGB24, full range, sRGB; grey becomes R = G = B, alpha is
 * left out, floats are clamped to 0 .. 1. To be freed.
 * GLINT_E_IO: it cannot be read. GLINT_E_FORMAT: it is malformed.
 * GLINT_E_UNSUPPORTED: no picture, too large, or it needs the plug-in, which is
 * not there. GLINT_E_MEMORY. */
enum glint_status glint_picture_load(const char *path,
                                     struct glint_image *image,
                                     struct glint_error *error);

/* Frees an image that was loaded; fine with an image of zeros. */
void glint_picture_free(struct glint_image *image);

/* Loads PATH as linear light; floats->rgb is the caller's to free(). Errors as
 * above. */
enum glint_status glint_picture_load_float(const char *path,
                                           struct glint_float_image *floats,
                                           struct glint_error *error);

/* Functions for formats/kept.h: the type that the first bytes of a file tell,
 * and the refusal of one that needs the plug-in, ERROR saying why it is not
 * there. */
const char *glint_picture_type(const uint8_t *head, size_t bytes);
enum glint_status glint_picture_needs_plugin(const char *path, const char *type,
                                             struct glint_error *error);

/* Checks whether a picture of KIND can be saved to PATH, as far as that is
 * known before there is one. GLINT_E_UNSUPPORTED: the extension is unknown or
 * of the other kind, or the plug-in is not there. */
enum glint_status glint_picture_check(const char *path,
                                      enum glint_picture_kind kind,
                                      struct glint_error *error);

/* Saves IMAGE, GLINT_RGB24 with any strides; the file is whole or not there,
 * see posix/output.h. Errors as of check, GLINT_E_OUTPUT, GLINT_E_CLOSED. */
enum glint_status glint_picture_save(const char *path,
                                     const struct glint_image *image,
                                     struct glint_error *error);

/* Saves FLOATS in the same way. */
enum glint_status
glint_picture_save_float(const char *path,
                         const struct glint_float_image *floats,
                         struct glint_error *error);

#endif
