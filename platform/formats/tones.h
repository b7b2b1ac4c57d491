/* SPDX-License-Identifier: MIT
 *
 * formats/tones.h - from the codes of a picture file to linear light, whatever
 * its profile says, and between its primaries and BT.709.
 *
 *     glint_tone_curve_set(&transfer, GLINT_TONE_IS_SRGB, 0);      or
 *     glint_icc_read(&colours, profile, bytes);
 *     light = glint_tone_curve_decode(&transfer, code / 65535.0);
 *
 * A code is 0 .. 1; floats go beyond, where a curve is continued by its own
 * formula and mirrored below 0. In double, for pictures that are edited once;
 * frames of a video have tables of integers.
 */
#ifndef GLINT_PLATFORM_FORMATS_TONES_H
#define GLINT_PLATFORM_FORMATS_TONES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum glint_tone_kind {
    GLINT_TONE_IS_LINEAR,
    GLINT_TONE_IS_SRGB,
    GLINT_TONE_IS_BT709,
    GLINT_TONE_IS_GAMMA
};

#define GLINT_TONE_ENTRIES 1024

/* light = (a code + b)^gamma + e from code = d on, c code + f below, unless
 * there is a table: then entries at even distances with straight lines between
 * them. */
struct glint_tone_curve {
    double gamma, a, b, c, d, e, f;
    int n_entries; /* 0: no table */
    uint16_t entry[GLINT_TONE_ENTRIES];
};

/* The meaning of the codes of a file's three colours. */
struct glint_colours {
    struct glint_tone_curve transfer[3];
    double to_bt709[3][3];   /* linear light of the file's primaries, and */
    double from_bt709[3][3]; /* back */
    bool is_srgb; /* the 8-bit path's own: sRGB curve, BT.709 primaries */
    char name[48];
};

/* GAMMA is for GLINT_TONE_IS_GAMMA alone. */
void glint_tone_curve_set(struct glint_tone_curve *transfer,
                          enum glint_tone_kind kind, double gamma);
double glint_tone_curve_decode(const struct glint_tone_curve *transfer,
                               double code);
double glint_tone_curve_encode(const struct glint_tone_curve *transfer,
                               double light);

/* The same curve for all three, primaries of BT.709. */
void glint_colours_set(struct glint_colours *colours, enum glint_tone_kind kind,
                       double gamma, const char *name);

/* Primaries by chromaticities x, y of red, green, blue and white. False, and
 * nothing changed: they span nothing. */
bool glint_colours_primaries(struct glint_colours *colours,
                             const double xy[4][2]);

/* Reads an ICC profile of a grey or RGB picture that consists of curves and a
 * matrix. False: it is malformed, or of another kind. */
bool glint_icc_read(struct glint_colours *colours, const uint8_t *profile,
                    size_t bytes);

#endif
