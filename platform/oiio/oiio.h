/* SPDX-License-Identifier: MIT
 *
 * oiio/oiio.h - PNG, JPEG, EXR and the rest, through OpenImageIO.
 *
 *     const struct glint_oiio *oiio;
 *     if (!glint_oiio_load(&oiio, &error))
 *         status = oiio->read(&pixels, "x.png", &error);
 *
 * OpenImageIO brings some 260 shared libraries with it, so it lives in a
 * plug-in, glint-oiio.so, which is loaded when a picture first needs it and
 * then stays. glint works without; oiio.cc is its only file in C++.
 */
#ifndef GLINT_OIIO_OIIO_H
#define GLINT_OIIO_OIIO_H

#include <stddef.h>

#include "glint/status.h"

/* Changes with struct glint_oiio; a plug-in of another number is refused. */
#define GLINT_OIIO_VERSION 1

/* A picture as R G B, rows without padding, the top row first, turned upright
 * where the file says how it was held. Alpha is left out, colours weighted by
 * it; grey is R = G = B. */
struct glint_oiio_pixels {
    int width, height; /* 1 .. GLINT_MAX_SIDE */
    int is_float;      /* linear light in float, else sRGB in unsigned char */
    void *rgb;         /* malloc'ed; the caller frees it */
};

struct glint_oiio {
    int version;

    /* Reads PATH: as floats where the file holds floats (EXR, HDR), else as 8
     * bits, whatever its depth. GLINT_E_IO: not there. GLINT_E_FORMAT,
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
};

/* Finds the plug-in, at the first call, and returns its functions. Looks at
 * $GLINT_OIIO, which names the file and then is the only place; beside the
 * executable; and in GLINT_PLUGIN_DIR, where that was defined when compiling.
 * GLINT_E_UNSUPPORTED: ERROR has the cause, and no file name yet. Any thread.
 */
enum glint_status glint_oiio_load(const struct glint_oiio **oiio,
                                  struct glint_error *error);

#endif
