/* SPDX-License-Identifier: MIT
 *
 * glint/scene/translucent.h - the file of a baked translucent medium, which
 * states how light spreads below its surface. Used in place.
 *
 *     status = glint_translucent_open(&stone, data, bytes, &reason);
 *
 * The medium is a square of texels. Of the light E(x) that enters at texel x,
 *
 *     M(y) = gain, times the sum over planes p of f_p(y), times the sum over
 *            ranks r and texels x of column_pr(v) row_pr(u) in(x) E(x),
 *            (u, v) = y - x
 *
 * leaves at y, for each of R, G, B, clamped to 0 at this point only. A plane is
 * a term of a factored fit; or the texels of one cluster; or all texels, with
 * one kernel scaled by the albedo [Kurt14], [Song09].
 *
 * Light has 15 bits, f and in are codes of 8 bits, taps have up to 12 bits.
 * Sums along rows are rounded to 15 bits after a shift, and sums along columns
 * fit int32; the baker chooses shifts and taps accordingly, and
 * glint_translucent_open() verifies this by adding up all taps.
 *
 * The file: little-endian 32-bit words; offsets ("_at") are bytes from the
 * start of the file, multiples of 4. Members named zero are 0. */
#ifndef GLINT_SCENE_TRANSLUCENT_H
#define GLINT_SCENE_TRANSLUCENT_H

#include <stddef.h>
#include <stdint.h>

#include "glint/real.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_TRANSLUCENT_MAGIC   UINT32_C(0x54544e47) /* "GNTT" */
#define GLINT_TRANSLUCENT_VERSION 1

enum {
    GLINT_TRANSLUCENT_LEAST_LOG2 = 5, /* log2 of the min side */
    GLINT_TRANSLUCENT_MOST_LOG2 = 8,
    GLINT_TRANSLUCENT_MOST_KERNEL = 63, /* max texels per side of a kernel,
                                           odd */
    GLINT_TRANSLUCENT_MOST_PLANES = 20,
    GLINT_TRANSLUCENT_MOST_RANK = 8,
    /* Number of bits of the codes f and in of the formula above. */
    GLINT_TRANSLUCENT_CODE_BITS = 8,
    GLINT_TRANSLUCENT_TAP_BITS = 12, /* the magnitude of every tap is below
                                        2^11 */
    GLINT_TRANSLUCENT_COSINES =
        128, /* number of steps of the cosine in the table of transmittance */
    /* Max sum of the magnitudes of taps: of one row of a kernel, and of the
     * columns of all planes of a channel together. If values are within
     * +-32767, sums stay below 2^31 - 2^20, so that they can still be rounded
     * before they are multiplied by codes. */
    GLINT_TRANSLUCENT_MOST_TAPS = 65504
};

enum glint_translucent_model {
    GLINT_TRANSLUCENT_CLUSTERED,
    GLINT_TRANSLUCENT_FACTORED,
    GLINT_TRANSLUCENT_ALBEDO
};

/* The header of the file. It begins with the members that the headers of all
 * baked files have (src/base/blob.h). */
struct glint_translucent_header {
    uint32_t magic, version;
    uint32_t bytes;     /* bytes of the whole file */
    uint32_t crc32;     /* checksum of all bytes after this word, as in struct
                           glint_model_header */
    uint32_t variant;   /* enum glint_translucent_model */
    uint32_t key[2];    /* key of the text and the files it names, low word
                           first */
    char name[64];      /* name of the translucent medium, terminated */
    uint32_t side_log2; /* log2 of texels per side, GLINT_TRANSLUCENT_LEAST_LOG2
                           .. MOST_LOG2 */
    uint32_t kernel;    /* texels per side of a kernel, odd */
    uint32_t n_planes;  /* number of planes of each channel; 1 for
                           GLINT_TRANSLUCENT_ALBEDO */
    uint32_t rank;      /* rank of each plane */
    uint32_t texel_um;  /* side of a texel, micrometres, 1 .. 10^6 */
    uint32_t index_q16; /* index of refraction, 1 .. 3 */
    uint32_t code_bits; /* must be GLINT_TRANSLUCENT_CODE_BITS */
    uint32_t tap_bits;  /* must be GLINT_TRANSLUCENT_TAP_BITS */
    /* f and in of the formula above, a byte each, padded to whole words.
     * Factored media: f_p = code / 128, signed, [3][n_planes][texels]. Others:
     * code / 256, unsigned: f, [3][texels], and for clustered media then in,
     * [3][texels]. */
    uint32_t code_at;
    /* Offset of the index of each texel's plane, uint8 [texels], for clustered
     * media; else 0. */
    uint32_t cluster_at;
    /* Taps, int16 [3][n_planes][rank][2][kernel]: row, then column. The first
     * tap of each is for y - x = -kernel / 2. Padded to whole words. */
    uint32_t tap_at;
    /* Shifts, uint32 [3][n_planes][rank]: number of bits, 0 .. 16, by which
     * sums along rows are shifted right before rounding. */
    uint32_t shift_at;
    /* Fraction of light that passes the surface. transmit_at: for each cosine
     * of the light's direction, uint16 _q15 [GLINT_TRANSLUCENT_COSINES + 1],
     * padded to whole words. mean_transmit_q15: mean over all directions. */
    uint32_t transmit_at;
    int32_t mean_transmit_q15;
    struct glint_real gain[3]; /* gain in the formula above, 0 .. 1; its
                                  mantissa may be 0 */
};

/* An opened file. Its pointers point into the data of the file, which must
 * outlive it. */
struct glint_translucent {
    const struct glint_translucent_header *header;
    const uint8_t *code;
    const uint8_t *cluster; /* index of each texel's plane; NULL: the medium is
                               not clustered */
    const int16_t *tap;
    const uint32_t *shift;
    const uint16_t *transmit_q15;
};

/* Checks DATA[BYTES], aligned to 4 bytes, and points STONE into DATA, which
 * must outlive STONE. On GLINT_E_FORMAT, *REASON states what is wrong, in
 * static text. */
enum glint_status glint_translucent_open(struct glint_translucent *stone,
                                         const void *data, size_t bytes,
                                         const char **reason);

#ifdef __cplusplus
}
#endif

#endif
