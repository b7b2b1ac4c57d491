/* SPDX-License-Identifier: MIT
 *
 * formats/tones.h - converts the codes of a picture file to linear light and
 * back by the file's colour profile. Converts colours between the file's
 * primaries and BT.709.
 *
 *     glint_tone_curve_set(&transfer, GLINT_TONE_IS_SRGB, 0); or
 *     glint_icc_read_colours(&colours, profile, bytes);
 *     light = glint_tone_curve_decode(&transfer, code / 65535.0);
 *
 * A code is 0 .. 1. Codes of float files may be outside this range: above 1 a
 * curve continues by its own formula, and below 0 it is mirrored. Computation
 * is in double, because a picture is converted only once; video frames use
 * tables of integers instead (video/transfer.h). */
#ifndef GLINT_PLATFORM_FORMATS_TONES_H
#define GLINT_PLATFORM_FORMATS_TONES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum glint_tone_kind {
    GLINT_TONE_IS_LINEAR,
    GLINT_TONE_IS_SRGB,
    GLINT_TONE_IS_BT709,
    GLINT_TONE_IS_GAMMA,
    GLINT_TONE_IS_PQ, /* PQ; light 1 is 203 cd/m2 [ITU-R BT.2408], code 1 is
                         light 49.26 */
    GLINT_TONE_IS_HLG /* HLG; light 1 is code 0.75, scene light; code 1 is light
                         3.774 */
};

#define GLINT_TONE_ENTRIES 1024

/* A transfer curve: light = (a code + b)^gamma + e for codes of d and more,
 * light = c code + f for codes below d. If there is a table, it replaces the
 * formula. Its entries are at equal steps of the code, an entry of 65535 is
 * light 1, and values between entries are interpolated linearly. */
struct glint_tone_curve {
    double gamma, a, b, c, d, e, f;
    bool is_pq, is_hlg; /* true: the curve of PQ or HLG replaces the formula */
    int n_entries;      /* number of entries of the table; 0: no table */
    uint16_t entry[GLINT_TONE_ENTRIES];
};

/* Transfer curves and primaries of a file's three colours. */
struct glint_colours {
    struct glint_tone_curve transfer[3];
    double to_bt709[3][3]; /* matrix from light in the file's primaries to
                              BT.709 */
    /* matrix from light in BT.709 primaries to the file's */
    double from_bt709[3][3];
    /* true: sRGB curve and BT.709 primaries, as in most 8-bit pictures */
    bool is_srgb;
    char name[48];
};

/* glint_tone_curve_set() uses GAMMA only for GLINT_TONE_IS_GAMMA. The others
 * convert a code to linear light, and back. */
void glint_tone_curve_set(struct glint_tone_curve *transfer,
                          enum glint_tone_kind kind, double gamma);
double glint_tone_curve_decode(const struct glint_tone_curve *transfer,
                               double code);
double glint_tone_curve_encode(const struct glint_tone_curve *transfer,
                               double light);

/* Returns whether codes of TRANSFER up to 1 stand for light above 1. */
bool glint_tone_curve_is_hdr(const struct glint_tone_curve *transfer);

/* Sets COLOURS to BT.709 primaries, with the curve KIND for all three
 * colours. */
void glint_colours_set_bt709(struct glint_colours *colours,
                             enum glint_tone_kind kind, double gamma,
                             const char *name);

/* Sets the primaries of COLOURS from the chromaticities x, y of red, green,
 * blue and white. Returns false and changes nothing if no matrix has these
 * chromaticities. */
bool glint_colours_set_primaries(struct glint_colours *colours,
                                 const double xy[4][2]);

/* Sets COLOURS from the ICC profile of a grey or RGB picture. Returns false if
 * the profile is malformed, or does not consist of curves and a matrix. */
bool glint_icc_read_colours(struct glint_colours *colours,
                            const uint8_t *profile, size_t bytes);

#endif
