/* SPDX-License-Identifier: MIT
 *
 * formats/picture.h - reads and writes picture files of any type.
 *
 *     glint_picture_load("x.png", &image, &error);
 *     ...
 *     glint_picture_save("y.ppm", &image, &error);
 *     glint_picture_free(&image);
 *
 * glint reads and writes PPM, PGM and PFM itself, and all other types through
 * its image plug-in (formats/oiio.h). Without the plug-in, PNG and JPEG are
 * read and written by their libraries (formats/stills.h). Loading detects the
 * type by the content of the file, saving by the extension. "-" is a pipe:
 * loading reads PPM, PGM or PFM; saving writes PPM, or PFM for floats.
 *
 * A picture has 8-bit codes or floats. Loading converts between them by the
 * sRGB curve if needed; saving never does:
 *   8 bits sRGB, struct glint_image, for .ppm .png .jpg .tif .bmp .tga .webp
 *   floats linear light, struct glint_float_image, for .pfm .exr .hdr .tif
 *
 * To add light to a file and write it again with all of its content, samples,
 * metadata and profile:
 *
 *     glint_kept_open(&kept, "in.png", &error);
 *     ... change kept.samples: formats/samples.h ...
 *     glint_kept_save(&kept, "out.png", NULL, &options, &error);
 *     glint_kept_close(&kept);
 *
 * If the output has the type of the input, it preserves bit depth, alpha, other
 * channels, parts (pictures), display windows, ICC profile and metadata. An
 * output of another type is upright. It has the colours; bit depth, alpha and
 * profile as far as the type can hold them; Exif and XMP; and other metadata
 * that OpenImageIO translates. */
#ifndef GLINT_PLATFORM_FORMATS_PICTURE_H
#define GLINT_PLATFORM_FORMATS_PICTURE_H

#include "formats/oiio.h"
#include "formats/pnm.h"

enum glint_picture_kind { GLINT_PICTURE_8BIT, GLINT_PICTURE_FLOAT };

enum { GLINT_KEPT_NOTES = 256 }; /* max bytes of a text of notes */

struct glint_kept {
    struct glint_samples samples;
    /* true: the file stores floats, so light above white is not clipped */
    bool is_float;
    /* Text that lists content of the file that glint does not know or cannot
     * preserve, or "". */
    char note[GLINT_KEPT_NOTES];
    /* camera settings, 0: unknown: f-number and focal length, mm, of a lens for
     * 35 mm film with the same field and entrance pupil; of the lens itself if
     * Exif does not relate it to 35 mm film and it is not that of a compact
     * camera or telephone */
    double f_number, focal_mm;

    /* Private. */
    const char *path;
    const struct glint_oiio *oiio; /* NULL: the file is a PNM or PFM */
    /* has_icc: the file states its colours by an ICC profile; has_cicp: by
     * cICP */
    bool has_icc, has_cicp;
    const char *metadata; /* metadata of the file, as in
                             glint_oiio_facts; NULL: none */
    struct glint_oiio_file *file;
    /* all bytes of a PNM or PFM file; of other files the first 12 bytes */
    uint8_t *native;
    size_t native_bytes, header_bytes;
    bool is_pfm, is_little;
    uint8_t *own; /* the file's samples in this machine's order */
};

struct glint_kept_options {
    int quality; /* quality of JPEG and WebP, 1 .. 100; 0: the quality of the
                    input file, or 95 */
    /* Result: a text that lists the content lost when saving, or "". */
    char said[GLINT_KEPT_NOTES];
};

/* Returns the number of frames of the GIF NAME, which it reads; 0 if NAME does
 * not end in .gif, cannot be read or is too large. */
int glint_gif_count_frames(const char *name);

/* Returns whether files of PATH's extension can hold only floats. Returns false
 * for TIFF, which holds floats or integers, and for "-". */
bool glint_picture_is_float(const char *path);

/* Loads PATH as GLINT_RGB24, full range, sRGB. Grey becomes R = G = B, alpha is
 * left out, floats are clipped to 0 .. 1. glint_picture_free() frees IMAGE.
 * Returns GLINT_E_IO if PATH cannot be read; GLINT_E_FORMAT if it is malformed;
 * GLINT_E_UNSUPPORTED if it is not a picture, is too large, or its type needs a
 * plug-in that is missing; or GLINT_E_MEMORY. */
enum glint_status glint_picture_load(const char *path,
                                     struct glint_image *image,
                                     struct glint_error *error);

/* Frees the pixels of IMAGE. Does nothing if all members of IMAGE are 0. */
void glint_picture_free(struct glint_image *image);

/* Loads PATH as linear light; the caller frees floats->rgb. Returns the errors
 * of glint_picture_load(). */
enum glint_status glint_picture_load_float(const char *path,
                                           struct glint_float_image *floats,
                                           struct glint_error *error);

/* Checks, before a picture of KIND is drawn, whether PATH's file type can hold
 * it. Returns GLINT_E_UNSUPPORTED if the extension is unknown or that of files
 * that cannot hold KIND, or its plug-in is missing. */
enum glint_status glint_picture_check(const char *path,
                                      enum glint_picture_kind kind,
                                      struct glint_error *error);

/* Saves IMAGE, GLINT_RGB24 with any strides; the file appears complete or not
 * at all (posix/output.h). Returns the errors of glint_picture_check(),
 * GLINT_E_OUTPUT or GLINT_E_CLOSED. */
enum glint_status glint_picture_save(const char *path,
                                     const struct glint_image *image,
                                     struct glint_error *error);

/* Saves FLOATS, as glint_picture_save() saves 8 bits. */
enum glint_status
glint_picture_save_float(const char *path,
                         const struct glint_float_image *floats,
                         struct glint_error *error);

/* Opens the file PATH with all of its content; the string PATH must outlive
 * KEPT. Returns the errors of glint_picture_load(). On failure KEPT is
 * closed. */
enum glint_status glint_kept_open(struct glint_kept *kept, const char *path,
                                  struct glint_error *error);

/* Frees the memory of KEPT, unless it is closed already. */
void glint_kept_close(struct glint_kept *kept);

/* Writes the file KEPT to PATH. If ALONE is not NULL, writes ALONE, a picture
 * of KEPT's upright size, in place of KEPT's own pixels. Returns
 * GLINT_E_OUTPUT, GLINT_E_UNSUPPORTED, GLINT_E_MEMORY or GLINT_E_CLOSED on
 * failure. */
enum glint_status glint_kept_save(struct glint_kept *kept, const char *path,
                                  const struct glint_samples *alone,
                                  struct glint_kept_options *options,
                                  struct glint_error *error);

/* Returns whether PATH has the file type of KEPT. If it has,
 * glint_kept_copy_file() can save an unchanged picture by copying the file. */
bool glint_kept_is_same_type(const struct glint_kept *kept, const char *path);

enum glint_status glint_kept_copy_file(const struct glint_kept *kept,
                                       const char *path,
                                       struct glint_error *error);

/* Sets BLANK to a black picture of FROM's upright size with the channels R G B,
 * and an alpha of 0 if HAS_ALPHA is set. Its samples have FROM's type; floats
 * replace 32-bit integers. Floats are linear, integers are sRGB. The caller
 * frees blank->mem. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_kept_make_blank(struct glint_samples *blank,
                                        const struct glint_samples *from,
                                        bool has_alpha);

/* Checks, before a long computation, whether glint can write files of PATH's
 * extension. Returns GLINT_E_UNSUPPORTED if the extension is unknown or its
 * plug-in is missing. */
enum glint_status glint_kept_check(const char *path, struct glint_error *error);

#endif
