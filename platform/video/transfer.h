/* SPDX-License-Identifier: MIT
 *
 * video/transfer.h - the transfer curves and primaries that tags of a video
 * name [ITU-T H.273], in integers, so that results are the same on every CPU.
 *
 * Light 1 is diffuse white, which most curves encode as the code 1. PQ encodes
 * it as 203 cd/m2, and HLG as 0.265 of the peak of the scene light [ITU-R
 * BT.2408]. PQ can therefore represent light up to 49.3, and HLG up to 3.77. */
#ifndef GLINT_PLATFORM_VIDEO_TRANSFER_H
#define GLINT_PLATFORM_VIDEO_TRANSFER_H

#include <stdint.h>

enum glint_transfer_curve {
    GLINT_TRANSFER_BT709, /* also BT.601 and BT.2020, which have the same curve
                           */
    GLINT_TRANSFER_SRGB,
    GLINT_TRANSFER_LINEAR,
    GLINT_TRANSFER_GAMMA22,
    GLINT_TRANSFER_GAMMA28,
    GLINT_TRANSFER_240M,
    GLINT_TRANSFER_PQ,
    GLINT_TRANSFER_HLG,
    GLINT_TRANSFER_LOG100,
    GLINT_TRANSFER_LOG316,
    GLINT_TRANSFERS
};

enum glint_primaries {
    GLINT_PRIMARIES_BT709, /* also BT.601, whose differences from BT.709 are
                              ignored */
    GLINT_PRIMARIES_BT2020,
    GLINT_PRIMARIES_P3,
    GLINT_PRIMARIES
};

/* Names of the curves as values of options, in the order of the enum; NULL is
 * the last. */
extern const char *const glint_transfer_words[];

/* Return the curve, or the primaries, for which ffmpeg has the name TAG; -1 if
 * TAG is unknown. */
int glint_transfer_from_tag(const char *tag);
int glint_primaries_from_tag(const char *tag);

/* Returns the light of code v = STEP / STEPS, where 0 <= STEP <= STEPS <= 2^16.
 * 2^24 stands for white. Light rises with STEP; light below 2^-24 of white is
 * 0. The relative error is below 1e-5 plus rounding. */
int32_t glint_transfer_decode_q24(enum glint_transfer_curve curve, int step,
                                  int steps);

/* Matrices from linear light of BT.709's primaries to other primaries, and
 * back; 65536 is 1. Rows sum up to 65536, so white stays white. */
extern const int32_t glint_primaries_from_bt709_q16[GLINT_PRIMARIES][3][3];
extern const int32_t glint_primaries_to_bt709_q16[GLINT_PRIMARIES][3][3];

#endif
