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
 * then stays. glint works without it; only its files (*.cc) are in C++.
 */
#ifndef GLINT_PLATFORM_FORMATS_OIIO_H
#define GLINT_PLATFORM_FORMATS_OIIO_H

#include "formats/samples.h"

/* Number of this interface. A plug-in with another number is refused. */
#define GLINT_OIIO_VERSION 5

/* A picture as R G B, rows without padding, the top row first, turned upright
 * where the file states how it was held. Alpha is left out, colours weighted by
 * it; grey is R = G = B. */
struct glint_oiio_pixels {
    int width, height; /* 1 .. GLINT_MAX_SIDE */
    int is_float;      /* linear light in float, else sRGB in unsigned char */
    void *rgb;         /* malloc'ed; the caller frees it */
};

/* A picture file with all that it holds: every channel in its own type, parts,
 * windows, metadata. */
struct glint_oiio_file;

/* The facts of a file beside its pixels. Pointers, and the data behind them,
 * live as long as the file does. */
struct glint_oiio_facts {
    const unsigned char *icc; /* ICC profile, or NULL */
    size_t icc_bytes;
    char colour_space[32]; /* OpenImageIO's name of it, or "" */
    double gamma;          /* gamma that the file states by itself, or 0 */
    double primaries[4][2];
    int has_primaries;
    int cicp[2];    /* primaries and transfer of ITU-T H.273, or 0, 0 */
    int quality;    /* 1 .. 100, guessed from a JPEG's tables; 0: not known */
    char note[160]; /* states what of the file cannot be preserved; "" if
                       nothing */
};

struct glint_oiio_options {
    int quality;  /* JPEG and WebP: 1 .. 100; 0: the file's own, or 95 */
    int drop_icc; /* Leaves out the profile, which does not fit the pixels any
                     more. */
};

/* One layer of light: NAME, and RGB, [height][width][3], linear. */
struct glint_oiio_layer {
    const char *name;
    float *rgb;
};

/* Layers of one size, for a file with a part for each. */
struct glint_oiio_layers {
    int width, height, n;
    int is_half; /* samples are written as half, else as float */
    const struct glint_oiio_layer *layer; /* [n] */
};

struct glint_oiio {
    int version;

    /* Reads PATH: as floats where the file holds floats (EXR, HDR), else as 8
     * bits, whatever its depth. GLINT_E_FORMAT: it cannot be read.
     * GLINT_E_UNSUPPORTED, GLINT_E_MEMORY. */
    enum glint_status (*read)(struct glint_oiio_pixels *pixels,
                              const char *path, struct glint_error *error);

    /* Encodes PIXELS in the file type of PATH's extension, as a malloc'ed block
     * that the caller writes to PATH and frees. STRIDE_BYTES may be negative.
     * GLINT_E_UNSUPPORTED: no such type. GLINT_E_OUTPUT, GLINT_E_MEMORY. */
    enum glint_status (*encode)(void **data, size_t *bytes, const char *path,
                                const struct glint_oiio_pixels *pixels,
                                ptrdiff_t stride_bytes,
                                struct glint_error *error);

    /* Reads PATH with all that it holds into FILE. SAMPLES are its colours, in
     * memory of FILE; the caller sets their meaning, samples->colours, by
     * FACTS. GLINT_E_IO, and the errors of read. */
    enum glint_status (*open)(struct glint_oiio_file **file,
                              struct glint_samples *samples,
                              struct glint_oiio_facts *facts, const char *path,
                              struct glint_error *error);
    void (*close)(struct glint_oiio_file *file); /* FILE may be NULL. */

    /* Returns whether OpenImageIO writes files of PATH's extension. */
    int (*can_write)(const char *path);

    /* Returns whether a file of PATH's extension is of FILE's type, and can be
     * written with the colours of FILE; HEIF cannot. */
    int (*is_same_type)(const struct glint_oiio_file *file, const char *path);

    /* If PIXELS is NULL, encodes FILE, whose samples may have been changed in
     * place, in its own type and with all that it holds. Else encodes PIXELS
     * (upright, without a window, channels R G B A one after the other, all of
     * one kind of sample) in the type of PATH's extension, with FILE's metadata
     * as far as that type takes it; FILE may then be NULL. Errors are those of
     * encode. */
    enum glint_status (*encode_file)(void **data, size_t *bytes,
                                     const char *path,
                                     struct glint_oiio_file *file,
                                     const struct glint_samples *pixels,
                                     const struct glint_oiio_options *options,
                                     struct glint_error *error);

    /* Encodes LAYERS in the file type of PATH's extension, with a part for
     * each if there are several. Errors are those of encode;
     * GLINT_E_UNSUPPORTED also: the type has no parts, or no floats. */
    enum glint_status (*encode_layers)(void **data, size_t *bytes,
                                       const char *path,
                                       const struct glint_oiio_layers *layers,
                                       struct glint_error *error);

    /* While one of these functions runs, writes to standard error that
     * OpenImageIO has aborted on its file, and returns 1; else returns 0.
     * Async-signal-safe, for glint_at_death_in_library(). */
    int (*report_abort)(void);
};

/* Sets OIIO to the functions of the plug-in, which the first call loads. Looks
 * at $GLINT_OIIO, which names the file and then is the only place; beside the
 * executable; in ../lib/glint from there; and in GLINT_PLUGIN_DIR, where that
 * was defined when compiling. GLINT_E_UNSUPPORTED: not found; ERROR has the
 * cause, but not the name of the picture. May be called by any thread. */
enum glint_status glint_oiio_load(const struct glint_oiio **oiio,
                                  struct glint_error *error);

#endif
