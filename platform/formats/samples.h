/* SPDX-License-Identifier: MIT
 *
 * formats/samples.h - the pixels of a picture file in the types in which the
 * file stores them. Reads their light, and adds light without loss.
 *
 *     glint_samples_make_proxy(&samples, &proxy, &white); as seen, in 8 bits
 *     glint_samples_get_light(&samples, x, y, rgb); light of a pixel
 *     glint_samples_add_light(&samples, layer); adds light
 *     glint_samples_convert(&to, &from); for another file type
 *
 * "Upright" positions are positions in the picture that a viewer shows: its
 * display window, rotated by the file's orientation. The pixels in memory are
 * not rotated. Adding light changes only colour samples whose value changes.
 * All bits of other samples, of other channels (such as alpha) and of pixels
 * outside the display window are preserved. */
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
    size_t offset; /* position of the sample in its pixel, bytes */
};

struct glint_samples {
    int width, height; /* size of the stored picture, pixels */
    int x, y;          /* position of the first pixel in the display window */
    /* size of the display window, pixels, before orientation is applied */
    int window_width, window_height;
    int orientation;    /* EXIF orientation, 1 .. 8 */
    size_t pixel_bytes; /* bytes of one pixel with all channels */
    int n_colours;      /* number of colours: 3, or 1 for grey */
    /* is_premultiplied: colours are multiplied by alpha; no effect unless
     * has_alpha is set */
    bool has_alpha, is_premultiplied;
    /* Positions of the samples of R, G, B, and of alpha. In grey pictures all
     * three colours are the same sample. */
    struct glint_sample_place colour[3], alpha;
    uint32_t maximum; /* code of white; not used if samples are floats */
    struct glint_colours colours;
    uint8_t *mem; /* [height][width] pixels, in the machine's byte order */
};

float glint_half_decode(uint16_t half);

/* Returns the half nearest to VALUE, ties to even; 65520 and more become
 * infinity. */
uint16_t glint_half_encode(float value);

size_t glint_sample_get_bytes(enum glint_sample sample);

bool glint_sample_is_float(enum glint_sample sample);

/* Return the width and height, pixels, of the picture as a viewer shows it. */
int glint_samples_get_width(const struct glint_samples *samples);

int glint_samples_get_height(const struct glint_samples *samples);

/* Returns whether the pixels have the layout of GLINT_RGB24: opaque 8-bit sRGB,
 * upright, with three channels. If so, points IMAGE to them. */
bool glint_samples_get_image(const struct glint_samples *samples,
                             struct glint_image *image);

/* Sets RGB to the linear light of the upright pixel (X, Y), BT.709 primaries,
 * multiplied by alpha. If the file has no pixel there, RGB is black. NaN
 * becomes black, infinity 65504. */
void glint_samples_get_light(const struct glint_samples *samples, int x, int y,
                             float rgb[3]);

/* Sets PROXY to an upright sRGB copy of the picture, GLINT_RGB24; the caller
 * frees plane[0]. Sets WHITE to the light of code 255. This is 1, except for
 * floats: there it is the light that 1 % of the pixels exceed, at least 1.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_samples_make_proxy(const struct glint_samples *samples,
                                           struct glint_image *proxy,
                                           double *white);

/* Adds LAYER, upright R G B, linear light with BT.709 primaries, to the
 * colours. If colours are not multiplied by alpha (straight), the layer is not
 * divided by alpha; compositing then multiplies the light by alpha. Integer
 * codes are clipped at the maximum. */
void glint_samples_add_light(struct glint_samples *samples, const float *layer);

/* Sets the upright pixel (X, Y) to RGB after an object covers the fraction
 * COVER, 0 .. 1, of it. RGB is the linear light of the pixel over black, BT.709
 * primaries. Alpha becomes 1 - (1 - alpha)(1 - COVER). Straight (unmultiplied)
 * colours become RGB divided by the new alpha. Does nothing if the file has no
 * pixel there. */
void glint_samples_set_pixel(struct glint_samples *samples, int x, int y,
                             const double rgb[3], double cover);

/* Copies the pixels of FROM to TO, upright and converted. The caller must have
 * set size, channels, samples, colours, alpha and memory of TO. If TO has no
 * alpha, FROM is composited over black. */
void glint_samples_convert(struct glint_samples *to,
                           const struct glint_samples *from);

#endif
