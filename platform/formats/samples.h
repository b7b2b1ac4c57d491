/* SPDX-License-Identifier: MIT
 *
 * formats/samples.h - a picture's pixels as its file holds them, to be looked
 * at and lit without loss.
 *
 *     glint_samples_proxy(&samples, &proxy, &white);     as seen, in 8 bits
 *     glint_samples_light(&samples, x, y, rgb);          light of a pixel
 *     glint_samples_add(&samples, layer);                adds light
 *     glint_samples_convert(&to, &from);                 for another file type
 *
 * "Upright" places are those of the picture as it is seen: its display window,
 * turned as its orientation says. The pixels themselves stay as stored. Adding
 * light keeps every bit of samples that it does not change, of other channels
 * (alpha, too) and of pixels outside the display window.
 */
#ifndef GLINT_PLATFORM_FORMATS_SAMPLES_H
#define GLINT_PLATFORM_FORMATS_SAMPLES_H

#include "formats/tones.h"
#include "glint/image.h"
#include "glint/status.h"

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
    size_t offset; /* bytes from the start of a pixel */
};

struct glint_samples {
    int width, height; /* size of the file's pixels */
    int x, y;          /* place of the first pixel in the window */
    /* size of the display window, not turned */
    int window_width, window_height;
    int orientation;    /* 1 .. 8, as of EXIF */
    size_t pixel_bytes; /* bytes of all channels of a pixel */
    int n_colours;      /* 3, or 1: grey */
    /* is_premultiplied has no effect without alpha. */
    bool has_alpha, is_premultiplied;
    struct glint_sample_place colour[3], alpha; /* grey: all colours alike */
    uint32_t maximum; /* code of white, unless floats */
    struct glint_colours colours;
    uint8_t *mem; /* [height][width] pixels, in the machine's byte order */
};

/* Decodes HALF without rounding. */
float glint_half_decode(uint16_t half);

/* Encodes VALUE to the nearest half, ties to even; from 65520 on to
 * infinity. */
uint16_t glint_half_encode(float value);

/* Return the bytes of a sample, and whether it is a float. */
size_t glint_sample_bytes(enum glint_sample sample);

bool glint_sample_is_float(enum glint_sample sample);

/* Return the size of the picture as it is seen, in pixels. */
int glint_samples_width(const struct glint_samples *samples);

int glint_samples_height(const struct glint_samples *samples);

/* Checks whether the pixels are those of a GLINT_RGB24: opaque sRGB of 8 bits,
 * upright, with no more than three channels. If so, points IMAGE to them. */
bool glint_samples_image(const struct glint_samples *samples,
                         struct glint_image *image);

/* Sets RGB to the linear light of the upright pixel X, Y, BT.709 primaries,
 * weighted by alpha; black where the file has no pixel. Not-a-number counts as
 * black, infinity as 65504. */
void glint_samples_light(const struct glint_samples *samples, int x, int y,
                         float rgb[3]);

/* Makes PROXY, the picture as it is seen, GLINT_RGB24 in sRGB; the caller frees
 * plane[0]. Sets WHITE to the light of code 255: 1, or for floats the light
 * that a hundredth of the picture exceeds if that is more. GLINT_E_MEMORY. */
enum glint_status glint_samples_proxy(const struct glint_samples *samples,
                                      struct glint_image *proxy, double *white);

/* Adds LAYER, upright R G B, linear light with BT.709 primaries, to the
 * colours. Straight colours get it unweighted, so that alpha weights it when it
 * is seen. Codes are clipped at the maximum. */
void glint_samples_add(struct glint_samples *samples, const float *layer);

/* Sets the upright pixel X, Y to its appearance over black, RGB, linear light
 * of BT.709 primaries, once the fraction COVER, 0 .. 1, of what is behind it is
 * hidden: alpha becomes 1 - (1 - alpha)(1 - COVER), and straight colours RGB
 * over that. Nothing where the file has no pixel. */
void glint_samples_set(struct glint_samples *samples, int x, int y,
                       const double rgb[3], double cover);

/* Sets the pixels of TO to those of FROM, upright and converted. The caller has
 * set size, channels, samples, colours, alpha and memory of TO. Without alpha
 * TO gets what is seen over black. */
void glint_samples_convert(struct glint_samples *to,
                           const struct glint_samples *from);

#endif
