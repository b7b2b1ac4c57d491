/* SPDX-License-Identifier: MIT
 *
 * formats/samples.h - a picture's pixels as its file holds them, to be looked
 * at and lit without losing anything.
 *
 *     glint_samples_proxy(&samples, &proxy, &white);     what is seen, 8 bits
 *     glint_samples_light(&samples, x, y, rgb);          of a pixel
 *     glint_samples_add(&samples, layer);                light on top
 *     glint_samples_convert(&to, &from);                 for another file type
 *
 * "Upright" places are those of the picture as it is seen: its display window,
 * turned as its orientation says. The pixels themselves stay as stored. Samples
 * that light does not change, other channels, alpha among them, and what lies
 * outside of the display window stay as they are, bit for bit.
 */
#ifndef GLINT_PLATFORM_FORMATS_SAMPLES_H
#define GLINT_PLATFORM_FORMATS_SAMPLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"
#include "formats/tones.h"

enum glint_sample {
    GLINT_SAMPLE_U8,
    GLINT_SAMPLE_U16,
    GLINT_SAMPLE_U32,
    GLINT_SAMPLE_HALF,
    GLINT_SAMPLE_FLOAT,
    GLINT_SAMPLE_DOUBLE
};

struct glint_sample_place {
    enum glint_sample sample;
    size_t offset; /* bytes, in a pixel */
};

struct glint_samples {
    int width, height; /* size of the pixels that are there */
    int x, y;          /* place of the first of them in the window */
    int window_width, window_height;  /* size of what is seen, as stored */
    int orientation;                  /* 1 .. 8, as of EXIF */
    size_t pixel_bytes;               /* bytes of all channels of a pixel */
    int n_colours;                    /* 3, or 1: grey */
    bool has_alpha, is_premultiplied; /* the latter also without alpha */
    struct glint_sample_place colour[3], alpha; /* grey: three times the same */
    uint32_t maximum; /* code of white, unless floats */
    struct glint_colours colours;
    uint8_t *mem; /* [height][width] pixels, in the machine's byte order */
};

/* Bytes of a sample, and whether it is a float. */
size_t glint_sample_bytes(enum glint_sample sample);
bool glint_sample_is_float(enum glint_sample sample);

/* Size of the picture as it is seen. */
int glint_samples_width(const struct glint_samples *samples);
int glint_samples_height(const struct glint_samples *samples);

/* Returns whether the pixels are those of a GLINT_RGB24, which IMAGE then
 * points to: opaque sRGB of 8 bits, upright, nothing beside the three channels.
 */
bool glint_samples_image(const struct glint_samples *samples,
                         struct glint_image *image);

/* Linear light of the upright pixel X, Y, BT.709 primaries, weighted by alpha;
 * black where there is none. What is no number counts as black, infinity as
 * 65504. */
void glint_samples_light(const struct glint_samples *samples, int x, int y,
                         float rgb[3]);

/* Makes what is seen: GLINT_RGB24, sRGB, malloc'ed plane[0] to be freed by the
 * caller. WHITE: light of code 255: 1, or that of the brightest hundredth of a
 * picture in floats if that is more. GLINT_E_MEMORY. */
enum glint_status glint_samples_proxy(const struct glint_samples *samples,
                                      struct glint_image *proxy, double *white);

/* Adds LAYER, upright R G B, linear light with BT.709 primaries, to the
 * colours; to straight ones as they are, so that alpha weights it, too. Codes
 * end at the maximum. */
void glint_samples_add(struct glint_samples *samples, const float *layer);

/* Puts the upright pixels of the GLINT_RGB24 DRAWN that differ from BEFORE, its
 * codes without padding, as they are seen and opaque. */
void glint_samples_put(struct glint_samples *samples,
                       const struct glint_image *drawn, const uint8_t *before);

/* Makes TO of FROM, of the same size: channels, samples, colours, alpha and
 * memory are set by the caller. With no alpha TO is what is seen over black.
 */
void glint_samples_convert(struct glint_samples *to,
                           const struct glint_samples *from);

#endif
