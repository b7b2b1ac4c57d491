/* SPDX-License-Identifier: MIT
 *
 * pixels.h - ffmpeg's names of pixel formats, such as "yuv422p10le".
 */
#ifndef GLINT_TOOLS_FFMPEG_PIXELS_H
#define GLINT_TOOLS_FFMPEG_PIXELS_H

#include <stdbool.h>

/* Returns the bits of a sample of PIXELS: 8, 10, 12 or 16. */
int pixels_bits(const char *pixels);

bool pixels_are_rgb(const char *pixels);
bool pixels_have_alpha(const char *pixels);

/* Returns the chroma of PIXELS: "444" also of RGB, "422", "440", "420", "411",
 * "410", or "gray" for none. */
const char *pixels_chroma(const char *pixels);

/* Returns the format of planes with CHROMA, "420", "422", "444" or "gray", and
 * BITS. */
const char *pixels_named(const char *chroma, int bits);

/* Returns the y4m format that keeps all samples of PIXELS but alpha, of chroma
 * that has no such format the nearest. */
const char *pixels_of_y4m(const char *pixels);

#endif
