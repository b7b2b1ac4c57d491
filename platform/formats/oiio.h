/* SPDX-License-Identifier: MIT
 *
 * formats/oiio.h - reads and writes PNG, JPEG, EXR and other pictures through
 * OpenImageIO.
 *
 *     const struct glint_oiio *oiio;
 *     if (!glint_oiio_load(&oiio, &error))
 *         status = oiio->read(&pixels, "x.png", &error);
 *
 * OpenImageIO depends on some 260 shared libraries. It is therefore in a
 * plug-in, glint-oiio.so, which is loaded when a picture first needs it and is
 * never unloaded. glint works without the plug-in. Only the plug-in's source
 * files (*.cc) are in C++. */
#ifndef GLINT_PLATFORM_FORMATS_OIIO_H
#define GLINT_PLATFORM_FORMATS_OIIO_H

#include "formats/samples.h"

/* Version of this interface. glint rejects plug-ins of other versions. */
#define GLINT_OIIO_VERSION 8

/* A picture as R G B, rows without padding, the top row first, rotated by the
 * orientation that the file states. Colours are multiplied by alpha, and alpha
 * is dropped; grey is stored as R = G = B. */
struct glint_oiio_pixels {
    int width, height; /* 1 .. GLINT_MAX_SIDE */
    int is_float;      /* true: rgb has linear light in float; false: sRGB codes
                          in unsigned char */
    void *rgb;         /* malloc'ed; the caller frees it */
};

/* A picture file in memory with all of its content: every channel in the type
 * in which the file stores it, all parts (pictures of the file), display
 * windows and metadata. */
struct glint_oiio_file;

/* Colour space, quality and metadata of a file. Pointers are valid until the
 * file is closed. */
struct glint_oiio_facts {
    const unsigned char *icc; /* ICC profile, or NULL */
    size_t icc_bytes;
    char colour_space[32]; /* OpenImageIO's name of the colour space, or "" */
    double gamma;          /* gamma that the file states, or 0 */
    double primaries[4][2];
    int has_primaries;
    int cicp[2]; /* codes of primaries and transfer [ITU-T H.273]; 0, 0: none */
    int quality; /* quality of a JPEG, 1 .. 100, estimated from its quantisation
                    tables; 0: unknown */
    const char *metadata; /* metadata that the file has, for messages: "Exif",
                             "Exif and XMP" ..., or "" */
    /* camera settings as Exif states them, 0: unknown: focal length, mm, of
     * the lens, and of a lens for 35 mm film with the same field */
    double f_number, focal_mm, film_focal_mm;
    /* Text that lists content that glint cannot preserve, or "". */
    char note[160];
};

struct glint_oiio_options {
    int quality; /* quality of JPEG and WebP, 1 .. 100; 0: the quality of the
                    input file, or 95 */
    /* true: ICC profile and cICP are not written, because they no longer
     * describe the pixels */
    int drop_colours;
    /* Result: a text that lists content of the input file that the output's
     * file type cannot hold, or "". */
    char said[160];
};

/* One layer of light: a name, and RGB, [height][width][3], linear. */
struct glint_oiio_layer {
    const char *name;
    float *rgb;
};

/* Layers of equal size; each becomes a part (picture) of the file. */
struct glint_oiio_layers {
    int width, height, n;
    int is_half; /* true: samples are written as half, else as float */
    const struct glint_oiio_layer *layer; /* [n] */
};

struct glint_oiio {
    int version;

    /* Reads the file PATH. The pixels are floats if the file stores floats
     * (EXR, HDR), else 8 bits, also if the file has more bits. Returns
     * GLINT_E_FORMAT if PATH cannot be read, GLINT_E_UNSUPPORTED or
     * GLINT_E_MEMORY. */
    enum glint_status (*read)(struct glint_oiio_pixels *pixels,
                              const char *path, struct glint_error *error);

    /* Encodes PIXELS in the file type of PATH's extension. Sets DATA to a
     * malloc'ed block, which the caller writes to PATH and frees. STRIDE_BYTES
     * may be negative. Returns GLINT_E_UNSUPPORTED if OpenImageIO does not know
     * the type, GLINT_E_OUTPUT or GLINT_E_MEMORY. */
    enum glint_status (*encode)(void **data, size_t *bytes, const char *path,
                                const struct glint_oiio_pixels *pixels,
                                ptrdiff_t stride_bytes,
                                struct glint_error *error);

    /* Reads the file PATH with all of its content into FILE. Points SAMPLES to
     * the pixels in FILE's memory; the caller then sets samples->colours from
     * FACTS. Returns GLINT_E_IO or the errors of read(). */
    enum glint_status (*open)(struct glint_oiio_file **file,
                              struct glint_samples *samples,
                              struct glint_oiio_facts *facts, const char *path,
                              struct glint_error *error);
    void (*close)(struct glint_oiio_file *file); /* FILE may be NULL. */

    /* Returns whether OpenImageIO writes files of PATH's extension. */
    int (*can_write)(const char *path);

    /* Returns whether PATH's extension is that of FILE's type, which glint
     * detects by content, not by name. */
    int (*is_same_type)(const struct glint_oiio_file *file, const char *path);

    /* If PIXELS is NULL, encodes FILE in its own type with all of its content;
     * the caller may have changed its samples in place. Otherwise encodes
     * PIXELS in the type of PATH's extension, with the metadata of FILE that
     * this type can hold. PIXELS must be upright, without a display window,
     * with interleaved R G B A samples of one type; FILE may then be NULL.
     * Returns the errors of encode(). */
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

    /* Must be async-signal-safe, for glint_at_death_set_library_report(). If
     * one of these functions is running, prints to standard error that
     * OpenImageIO has aborted on the file, and returns 1; else returns 0. */
    int (*report_abort)(void);
};

/* Sets OIIO to the functions of the plug-in, which the first call loads. If the
 * environment variable GLINT_OIIO is set, it names the plug-in's file, and no
 * folder is searched. Otherwise searches three folders: the executable's
 * folder, ../lib/glint relative to it, and GLINT_PLUGIN_DIR, if that was
 * defined when compiling. Returns GLINT_E_UNSUPPORTED if the plug-in is not
 * found, GLINT_E_FORMAT if it is found but cannot be loaded or is of another
 * version. ERROR then has the cause, but not the name of the picture.
 * Thread-safe. */
enum glint_status glint_oiio_load(const struct glint_oiio **oiio,
                                  struct glint_error *error);

#endif
