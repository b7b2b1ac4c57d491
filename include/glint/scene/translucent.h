/* SPDX-License-Identifier: MIT
 *
 * glint/scene/translucent.h - a baked translucent medium, which spreads light
 * below its surface: its file, used where it lies.
 *
 *     status = glint_translucent_open(&stone, data, bytes,
 * &reason);
 *
 * The medium is a square of texels. Of the light E(x) that enters at texel x,
 *
 *     M(y) = gain, times the sum over planes p of f_p(y), times the sum over
 *            ranks r and texels x of column_pr(v) row_pr(u) in(x) E(x),
 *            (u, v) = y - x
 *
 * leaves at y, for each of R, G, B, clamped to 0 at this point only. A plane is
 * a term of a factored fit; the texels of a cluster; or all texels, where one
 * kernel is scaled by the albedo [Kurt14], [Song09].
 *
 * Light is 15 bits, f and in are codes of 4 to 16 bits, taps of 6 to 16 bits:
 * rows are rounded to 15 bits again after a shift that the sum of their taps
 * allows, and no sum of columns leaves int32. The baker chooses shifts and taps
 * so; glint_translucent_open() adds all taps up again.
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
    GLINT_TRANSLUCENT_LEAST_LOG2 = 5, /* log2 of the smallest side */
    GLINT_TRANSLUCENT_MOST_LOG2 = 8,
    GLINT_TRANSLUCENT_MOST_KERNEL = 63, /* texels, odd */
    GLINT_TRANSLUCENT_MOST_PLANES = 20,
    GLINT_TRANSLUCENT_MOST_RANK = 8,
    GLINT_TRANSLUCENT_CODE_BITS = 8, /* of f and in */
    GLINT_TRANSLUCENT_TAP_BITS = 12, /* no tap is 2^11 or more */
    GLINT_TRANSLUCENT_COSINES = 128, /* steps of the table of transmittance */
    /* Magnitudes of a kernel's taps sum to this at most: along a row; and down
     * the columns of all planes of a channel together. With values within
     * +-32767 sums stay below 2^31 - 2^20, which leaves room for their rounding
     * before they are multiplied by codes. */
    GLINT_TRANSLUCENT_MOST_TAPS = 65504
};

enum glint_translucent_model {
    GLINT_TRANSLUCENT_CLUSTERED,
    GLINT_TRANSLUCENT_FACTORED,
    GLINT_TRANSLUCENT_ALBEDO
};

/* Begins as every baked file does (src/base/blob.h). */
struct glint_translucent_header {
    uint32_t magic, version;
    uint32_t bytes;     /* bytes of the whole file */
    uint32_t crc32;     /* checksum of all bytes after this word: polynomial
                           0xedb88320, reflected, begun and ended with all ones */
    uint32_t variant;   /* enum glint_translucent_model */
    uint32_t key[2];    /* key of the text and the files it names, low word
                           first */
    char name[64];      /* name of the translucent medium, terminated */
    uint32_t side_log2; /* GLINT_TRANSLUCENT_LEAST_LOG2 .. MOST */
    uint32_t kernel;    /* texels each way, odd */
    uint32_t n_planes;  /* of each channel; of albedo 1 */
    uint32_t rank;      /* of each plane */
    uint32_t texel_um;  /* side of a texel, micrometres, 1 .. 10^6 */
    uint32_t index_q16; /* of refraction, 1 .. 3 */
    uint32_t code_bits; /* GLINT_TRANSLUCENT_CODE_BITS */
    uint32_t tap_bits;  /* GLINT_TRANSLUCENT_TAP_BITS */
    /* A byte each. Factored: f_p = code / 128, signed, [3][n_planes][texels].
     * Else unsigned, code / 256: f [3][texels], and clustered then in
     * [3][texels]. Padded to whole words. */
    uint32_t code_at;
    uint32_t cluster_at; /* clustered: uint8 [texels], the plane that a texel is
                            in; else 0 */
    /* int16 [3][n_planes][rank][2][kernel]: row, then column, each from
     * y - x = -kernel / 2 on; padded to whole words. */
    uint32_t tap_at;
    /* uint32 [3][n_planes][rank]: rows are rounded after a shift by as many
     * bits, 0 .. 16. */
    uint32_t shift_at;
    /* Fraction of light that passes the surface: uint16 q15 by cosine, COSINES
     * + 1 of them, padded to whole words; and in the mean of all directions. */
    uint32_t transmit_at;
    int32_t mean_transmit_q15;
    struct glint_real gain[3]; /* M is this times the sum, 0 .. 1, or a
                                  mantissa of 0 */
};

/* An opened file: points into the file's data, which must outlive it. */
struct glint_translucent {
    const struct glint_translucent_header *header;
    const uint8_t *code;
    const uint8_t *cluster; /* NULL: it is not clustered */
    const int16_t *tap;
    const uint32_t *shift;
    const uint16_t *transmit_q15;
};

/* Checks DATA[BYTES], aligned to 4 bytes, and points STONE into DATA, which
 * must outlive STONE. GLINT_E_FORMAT: *REASON states what is wrong, in static
 * text. */
enum glint_status glint_translucent_open(struct glint_translucent *stone,
                                         const void *data, size_t bytes,
                                         const char **reason);

#ifdef __cplusplus
}
#endif

#endif
