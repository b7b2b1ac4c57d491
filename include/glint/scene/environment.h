/* SPDX-License-Identifier: MIT
 *
 * glint/scene/environment.h - environment light, baked: its file, used
 * where it lies.
 *
 *     status = glint_environment_open(&environment, data, bytes, &reason);
 *
 * Directions are those of scenes (glint/scene/model.h): x right, y up, z away.
 * They map to a square by the octahedron |x| + |y| + |z| = 1, unfolded around
 * +y: with p, q = -1 .. 1 across and down the square it is x = p, z = q, y = 1
 * - |p| - |q| where that is not negative; elsewhere (p, q) is ((1 - |z|) sign
 * x, (1 - |x|) sign z). The middle of texel (i, j) of a side of n is at p = (2
 * i + 1) / n - 1, q = (2 j + 1) / n - 1.
 *
 * Level l of the Gaussian ones is the light blurred on the sphere by
 * exp((cos - 1) / sigma^2), sigma = 2^l / 2 texels of sqrt(4 pi) / side
 * radians, and has twice the side that a mip of that blur has. Bright lights
 * are not in the levels but in a list, each a disc.
 *
 * Light is linear BT.709, 1 = display white, in units of 2^unit_log2.
 *
 * The file: little-endian 32-bit words; offsets ("_at") are bytes from the
 * start of the file, multiples of 4. Members named zero are 0. */
#ifndef GLINT_SCENE_ENVIRONMENT_H
#define GLINT_SCENE_ENVIRONMENT_H

#include <stddef.h>
#include <stdint.h>

#include "glint/real.h"
#include "glint/scene/lobe.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_ENVIRONMENT_MAGIC   UINT32_C(0x45544e47) /* "GNTE" */
#define GLINT_ENVIRONMENT_VERSION 1

enum {
    GLINT_ENVIRONMENT_LEAST_LOG2 = 4, /* log2 of the smallest side */
    GLINT_ENVIRONMENT_MOST_LOG2 = 10,
    GLINT_ENVIRONMENT_MAX_LEVELS = GLINT_ENVIRONMENT_MOST_LOG2 + 1,
    GLINT_ENVIRONMENT_MAX_LIGHTS = 16,
    GLINT_ENVIRONMENT_IRRADIANCE_LOG2 = 5,
    /* Side of the smallest Gaussian levels. */
    GLINT_ENVIRONMENT_COARSEST_LOG2 = 2,
    GLINT_ENVIRONMENT_BITS = 28 /* texels are below 2^28 units */
};

enum glint_environment_levels {
    GLINT_ENVIRONMENT_GAUSS,
    GLINT_ENVIRONMENT_MIP /* means of 2 x 2 of the level before */
};

enum glint_environment_code {
    /* uint32: R, G, B of 9 bits, R the lower ones, and an exponent e of 5: a
     * mantissa m is m 2^(e - 12) units. */
    GLINT_ENVIRONMENT_9E5 = 1
};

struct glint_environment_level {
    uint32_t side_log2; /* glint_environment_side_log2() */
    uint32_t texel_at;  /* codes, row by row */
    uint32_t zero[2];
};

/* A disc of even light. */
struct glint_environment_light {
    int32_t toward_q30[3]; /* unit vector to its middle */
    int32_t radius_q30;    /* sine of its angular radius, 0 .. 2^29 */
    /* R, G, B of a white surface that faces it, each 0 or more. */
    struct glint_real rgb[3];
};

/* Begins as every baked file does (src/base/blob.h). */
struct glint_environment_header {
    uint32_t magic, version;
    uint32_t bytes;     /* bytes of the whole file */
    uint32_t crc32;     /* checksum of all bytes after this word: polynomial
                           0xedb88320, reflected, begun and ended with all ones */
    uint32_t variant;   /* enum glint_environment_levels */
    uint32_t key[2];    /* key of the picture and the options, low word first */
    char name[64];      /* name of the environment, terminated */
    uint32_t side_log2; /* of level 0: GLINT_ENVIRONMENT_LEAST_LOG2 .. MOST */
    uint32_t code;      /* enum glint_environment_code */
    int32_t unit_log2;  /* -160 .. 100 */
    uint32_t n_levels, level_at; /* side_log2 + 1; struct of that name */
    /* What the levels show a white surface, by its normal: 9e5 codes of a side
     * of 2^GLINT_ENVIRONMENT_IRRADIANCE_LOG2. */
    uint32_t irradiance_at;
    uint32_t n_lights, light_at; /* struct glint_environment_light */
};

/* An opened file; it points into that, which must outlive it. */
struct glint_environment {
    const struct glint_environment_header *header;
    const struct glint_environment_level *level;
    const void *texel[GLINT_ENVIRONMENT_MAX_LEVELS];
    struct glint_texels texels; /* the same, as lookups take them */
    const uint32_t *irradiance;
    const struct glint_environment_light *light;
};

/* Checks DATA[BYTES], aligned to 4 bytes, and points ENVIRONMENT into it. DATA
 * is kept. GLINT_E_FORMAT: *REASON states what is wrong, in static text. */
enum glint_status glint_environment_open(struct glint_environment *environment,
                                         const void *data, size_t bytes,
                                         const char **reason);

/* Returns log2 of the side of level LEVEL of the kind LEVELS over a side of
 * 2^SIDE_LOG2. */
uint32_t glint_environment_side_log2(uint32_t levels, uint32_t side_log2,
                                     uint32_t level);

#ifdef __cplusplus
}
#endif

#endif
