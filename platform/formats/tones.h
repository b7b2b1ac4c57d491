/* SPDX-License-Identifier: MIT
 *
 * formats/tones.h - from the codes of a picture file to linear light, as its
 * profile says, and between its primaries and BT.709.
 *
 *     glint_tone_curve_set(&transfer, GLINT_TONE_IS_SRGB, 0);      or
 *     glint_icc_read(&colours, profile, bytes);
 *     light = glint_tone_curve_decode(&transfer, code / 65535.0);
 *
 * A code is 0 .. 1; floats go beyond, where a curve is continued by its own
 * formula and mirrored below 0. All is double, for pictures that are edited
 * once; frames of a video have tables of integers.
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
    GLINT_TONE_IS_GAMMA,
    GLINT_TONE_IS_PQ, /* light 1 is 203 cd/m2 [ITU-R BT.2408], 49.26 is code 1
                       */
    GLINT_TONE_IS_HLG /* light 1 is code 0.75, scene light; 3.774 is code 1 */
};

#define GLINT_TONE_ENTRIES 1024

/* light = (a code + b)^gamma + e from code = d on, c code + f below d. A table
 * replaces the formula: it is interpolated linearly between entries at equal
 * steps of code; an entry of 65535 is light 1. */
struct glint_tone_curve {
    double gamma, a, b, c, d, e, f;
    bool is_pq, is_hlg; /* their curves replace the formula, too */
    int n_entries;      /* 0: no table */
    uint16_t entry[GLINT_TONE_ENTRIES];
};

/* Transfer curves and primaries of a file's three colours. */
struct glint_colours {
    struct glint_tone_curve transfer[3];
    double to_bt709[3][3]; /* from light of the file's primaries to BT.709's */
    /* from light of BT.709's primaries to the file's */
    double from_bt709[3][3];
    bool is_srgb; /* sRGB curve and BT.709 primaries, as 8-bit pictures have */
    char name[48];
};

/* Sets TRANSFER to the curve KIND; GAMMA is used only by GLINT_TONE_IS_GAMMA.
 * The next two functions convert a code to linear light and back. */
void glint_tone_curve_set(struct glint_tone_curve *transfer,
                          enum glint_tone_kind kind, double gamma);
double glint_tone_curve_decode(const struct glint_tone_curve *transfer,
                               double code);
double glint_tone_curve_encode(const struct glint_tone_curve *transfer,
                               double light);

/* Returns whether codes up to 1 hold light above 1. */
bool glint_tone_curve_is_hdr(const struct glint_tone_curve *transfer);

/* Sets COLOURS to BT.709 primaries, with one curve for all three colours. */
void glint_colours_set(struct glint_colours *colours, enum glint_tone_kind kind,
                       double gamma, const char *name);

/* Sets the primaries of COLOURS by the chromaticities x, y of red, green, blue
 * and white. Returns false and changes nothing if no matrix has these
 * chromaticities. */
bool glint_colours_primaries(struct glint_colours *colours,
                             const double xy[4][2]);

/* Sets COLOURS by an ICC profile of a grey or RGB picture that consists of
 * curves and a matrix. Returns false if the profile is malformed or of another
 * kind. */
bool glint_icc_read(struct glint_colours *colours, const uint8_t *profile,
                    size_t bytes);

#endif
