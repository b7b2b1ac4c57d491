/* SPDX-License-Identifier: MIT
 *
 * formats/oiio.h - PNG, JPEG, EXR and other pictures, through OpenImageIO.
 *
 *     const struct glint_oiio *oiio;
 *     if (!glint_oiio_load(&oiio, &error))
 *         status = oiio->read(&pixels, "x.png", &error);
 *
 * OpenImageIO brings some 260 shared libraries with it, so it lives in a
 * plug-in, glint-oiio.so, which is loaded when a picture first needs it and
 * then stays loaded. glint works without it; only its files (*.cc) are in
 * C++.
 */
#ifndef GLINT_PLATFORM_FORMATS_OIIO_H
#define GLINT_PLATFORM_FORMATS_OIIO_H

#include "formats/samples.h"

/* Version of this interface. A plug-in of another version is refused. */
#define GLINT_OIIO_VERSION 6

/* A picture as R G B, rows without padding, the top row first, turned upright
 * if the file states an orientation. Colours are multiplied by alpha, which is
 * dropped; grey is R = G = B. */
struct glint_oiio_pixels {
    int width, height; /* 1 .. GLINT_MAX_SIDE */
    int is_float;      /* linear light in float, else sRGB in unsigned char */
    void *rgb;         /* malloc'ed; the caller frees it */
};

/* A picture file in memory with all of its content: every channel in its own
 * type, parts, windows, metadata. */
struct glint_oiio_file;

/* Colour space and quality of a file. Its pointers are valid until the file is
 * closed. */
struct glint_oiio_facts {
    const unsigned char *icc; /* ICC profile, or NULL */
    size_t icc_bytes;
    char colour_space[32]; /* OpenImageIO's name of the colour space, or "" */
    double gamma;          /* gamma that the file states, or 0 */
    double primaries[4][2];
    int has_primaries;
    int cicp[2]; /* codes of primaries and transfer [ITU-T H.273], or 0, 0 */
    int quality; /* 1 .. 100, estimated from a JPEG's quantisation tables; 0:
                    not known */
    const char *metadata; /* "Exif", "XMP", "Exif and XMP" or "" */
    char note[160]; /* lists the content that cannot be preserved; "" if there
                       is no such content */
};

struct glint_oiio_options {
    int quality; /* for JPEG and WebP, 1 .. 100; 0: the quality of the file, or
                    95 */
    int drop_colours; /* true: ICC profile and cICP are not written, as they no
                         longer describe the pixels */
    char said[160];   /* output: lists what the file type does not hold of the
                         input; "" if it holds all */
};

/* One layer of light: NAME, and RGB, [height][width][3], linear. */
struct glint_oiio_layer {
    const char *name;
    float *rgb;
};

/* Layers of the same size, for a file with one part per layer. */
struct glint_oiio_layers {
    int width, height, n;
    int is_half; /* true: samples are written as half, else as float */
    const struct glint_oiio_layer *layer; /* [n] */
};

struct glint_oiio {
    int version;

    /* Reads PATH into floats if the file holds floats (EXR, HDR), else into 8
     * bits, whatever its depth. Returns GLINT_E_FORMAT if PATH cannot be read,
     * GLINT_E_UNSUPPORTED or GLINT_E_MEMORY. */
    enum glint_status (*read)(struct glint_oiio_pixels *pixels,
                              const char *path, struct glint_error *error);

    /* Encodes PIXELS in the file type of PATH's extension, as a malloc'ed block
     * that the caller writes to PATH and frees. STRIDE_BYTES may be negative.
     * Returns GLINT_E_UNSUPPORTED if OpenImageIO knows no such type,
     * GLINT_E_OUTPUT or GLINT_E_MEMORY. */
    enum glint_status (*encode)(void **data, size_t *bytes, const char *path,
                                const struct glint_oiio_pixels *pixels,
                                ptrdiff_t stride_bytes,
                                struct glint_error *error);

    /* Reads PATH with all of its content into FILE. Points SAMPLES to the
     * pixels in FILE's memory; the caller then sets samples->colours by FACTS.
     * Returns GLINT_E_IO or the errors of read(). */
    enum glint_status (*open)(struct glint_oiio_file **file,
                              struct glint_samples *samples,
                              struct glint_oiio_facts *facts, const char *path,
                              struct glint_error *error);
    void (*close)(struct glint_oiio_file *file); /* FILE may be NULL. */

    /* Returns whether OpenImageIO writes files of PATH's extension. */
    int (*can_write)(const char *path);

    /* Returns whether PATH's extension stands for FILE's type, by the content
     * of FILE and not by its name. */
    int (*is_same_type)(const struct glint_oiio_file *file, const char *path);

    /* If PIXELS is NULL, encodes FILE, whose samples may have been changed in
     * place, in its own type with all of its content. Else encodes PIXELS
     * (upright, without a window, interleaved R G B A samples of one type) in
     * the type of PATH's extension, with the metadata of FILE that this type
     * can hold; FILE may then be NULL. Returns the errors of encode(). */
    enum glint_status (*encode_file)(void **data, size_t *bytes,
                                     const char *path,
                                     struct glint_oiio_file *file,
                                     const struct glint_samples *pixels,
                                     struct glint_oiio_options *options,
                                     struct glint_error *error);

    /* Encodes LAYERS in the file type of PATH's extension, several layers as
     * one part per layer. Returns the errors of encode(), and
     * GLINT_E_UNSUPPORTED also if the type has no parts or no floats. */
    enum glint_status (*encode_layers)(void **data, size_t *bytes,
                                       const char *path,
                                       const struct glint_oiio_layers *layers,
                                       struct glint_error *error);

    /* If one of these functions is running, prints to standard error that
     * OpenImageIO has aborted on its file, and returns 1; else returns 0.
     * Async-signal-safe, for glint_at_death_in_library(). */
    int (*report_abort)(void);
};

/* Sets OIIO to the functions of the plug-in, which the first call loads. If
 * $GLINT_OIIO is set, it names the file, and no folder is searched. Else
 * searches the executable's folder, ../lib/glint from there, and
 * GLINT_PLUGIN_DIR, if that was defined when compiling. Returns
 * GLINT_E_UNSUPPORTED if the plug-in is not found; ERROR has the cause, but not
 * the name of the picture. May be called by any thread. */
enum glint_status glint_oiio_load(const struct glint_oiio **oiio,
                                  struct glint_error *error);

#endif
