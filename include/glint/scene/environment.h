/* SPDX-License-Identifier: MIT
 *
 * glint/scene/environment.h - the file of baked environment light, used in
 * place.
 *
 *     status = glint_environment_open(&environment, data, bytes, &reason);
 *
 * Directions are those of scenes (glint/scene/model.h): x right, y up, z away.
 * They map to a square by the octahedron |x| + |y| + |z| = 1, unfolded around
 * +y. Let p, q = -1 .. 1 run across and down the square. Where y = 1 - |p| -
 * |q| is not negative, x is p and z is q. Elsewhere (p, q) is ((1 - |z|) sign
 * x, (1 - |x|) sign z). The middle of texel (i, j) of a side of n is at p = (2
 * i + 1) / n - 1, q = (2 j + 1) / n - 1.
 *
 * Gaussian level l is the light blurred on the sphere by exp((cos - 1) /
 * sigma^2), sigma = 2^l / 2 texels of sqrt(4 pi) / side radians; its side is
 * twice the side of a mip level with the same blur. Bright lights are removed
 * from the levels and listed as discs.
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
    GLINT_ENVIRONMENT_LEAST_LOG2 = 4, /* log2 of the min side */
    GLINT_ENVIRONMENT_MOST_LOG2 = 10,
    GLINT_ENVIRONMENT_MAX_LEVELS = GLINT_ENVIRONMENT_MOST_LOG2 + 1,
    GLINT_ENVIRONMENT_MAX_LIGHTS = 16,
    GLINT_ENVIRONMENT_IRRADIANCE_LOG2 = 5,
    /* log2 of the side of the coarsest Gaussian levels. */
    GLINT_ENVIRONMENT_COARSEST_LOG2 = 2,
    GLINT_ENVIRONMENT_BITS = 28 /* texels are below 2^28 units */
};

enum glint_environment_levels {
    GLINT_ENVIRONMENT_GAUSS,
    GLINT_ENVIRONMENT_MIP /* texels are means of 2 x 2 texels of the level
                             before */
};

enum glint_environment_code {
    /* A texel is a uint32 with the mantissas of R (lowest bits), G and B, of 9
     * bits each, and an exponent e of 5 bits. A mantissa m stands for m 2^(e -
     * 12) units. */
    GLINT_ENVIRONMENT_9E5 = 1
};

struct glint_environment_level {
    /* Log2 of the side of the level, as returned by
     * glint_environment_side_log2(). */
    uint32_t side_log2;
    uint32_t texel_at; /* offset of the codes of all texels, row by row */
    uint32_t zero[2];
};

/* A light: a disc of uniform radiance. */
struct glint_environment_light {
    int32_t toward_q30[3]; /* unit vector to its middle */
    int32_t radius_q30;    /* sine of its angular radius, 0 .. 2^29 */
    /* Light of the disc: R, G, B of a white surface that faces it; each is 0 or
     * more. */
    struct glint_real rgb[3];
};

/* The header of the file. It begins with the members that the headers of all
 * baked files have (src/base/blob.h). */
struct glint_environment_header {
    uint32_t magic, version;
    uint32_t bytes;     /* bytes of the whole file */
    uint32_t crc32;     /* checksum of all bytes after this word, as in struct
                           glint_model_header */
    uint32_t variant;   /* enum glint_environment_levels: type of levels */
    uint32_t key[2];    /* key of the picture and the options, low word first */
    char name[64];      /* name of the environment, terminated */
    uint32_t side_log2; /* log2 of the side of level 0,
                           GLINT_ENVIRONMENT_LEAST_LOG2 .. MOST_LOG2 */
    uint32_t code;      /* enum glint_environment_code: encoding of texels */
    int32_t unit_log2;  /* log2 of the unit of light, -160 .. 100 */
    uint32_t n_levels, level_at; /* side_log2 + 1 entries of struct
                                    glint_environment_level */
    /* Irradiance map: for each normal of a surface, the value of a white
     * surface that the levels light. Texels are 9e5 codes; the side is
     * 2^GLINT_ENVIRONMENT_IRRADIANCE_LOG2. */
    uint32_t irradiance_at;
    uint32_t n_lights, light_at; /* array of struct glint_environment_light */
};

/* An opened file: points into the data of the file, which must outlive it. */
struct glint_environment {
    const struct glint_environment_header *header;
    const struct glint_environment_level *level;
    const void *texel[GLINT_ENVIRONMENT_MAX_LEVELS];
    struct glint_texels texels; /* the levels, for lookups */
    const uint32_t *irradiance;
    const struct glint_environment_light *light;
};

/* Checks DATA[BYTES], aligned to 4 bytes, and points ENVIRONMENT into DATA,
 * which must outlive ENVIRONMENT. On GLINT_E_FORMAT, *REASON states what is
 * wrong, in static text. */
enum glint_status glint_environment_open(struct glint_environment *environment,
                                         const void *data, size_t bytes,
                                         const char **reason);

/* Returns log2 of the side of level LEVEL, where LEVELS is an enum
 * glint_environment_levels and level 0 has a side of 2^SIDE_LOG2. */
uint32_t glint_environment_side_log2(uint32_t levels, uint32_t side_log2,
                                     uint32_t level);

#ifdef __cplusplus
}
#endif

#endif
