/* SPDX-License-Identifier: MIT
 *
 * glint/scene/lobe.h - data of the kernels for Ward's reflection lobe: the
 * lobe, and the environment's texels that it reads. Functions of
 * glint/scene/ward.h compute lobes; glint/scene/environment.h provides the
 * texels. */
#ifndef GLINT_SCENE_LOBE_H
#define GLINT_SCENE_LOBE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_WARD_SAMPLES = 32,
    GLINT_TEXELS_LEVELS = 11 /* max number of mip levels */
};

enum glint_ward_norm {
    GLINT_WARD_BOUNDED, /* normalised so that it reflects no more light than it
                           receives [Geisler10] */
    GLINT_WARD_1992     /* normalised as published in [Ward92] */
};

/* A mip level: a square with a side of 2^side_log2 texel codes, row by row. */
struct glint_texels_level {
    int32_t side_log2;
    uint32_t at; /* index of the level's first code */
};

struct glint_texels {
    const uint32_t *code; /* texels of all levels, RGB9E5 */
    int32_t last;         /* index of the last (coarsest) level */
    /* The last level is stored twice, so that there is a level after each. */
    struct glint_texels_level level[GLINT_TEXELS_LEVELS + 1];
};

struct glint_ward_lobe;
struct glint_ward_place;

/* Sets SUM_Q12 to the sum over the samples of LOBE of the light that TEXELS (in
 * their unit) have at each sample, multiplied by the sample's weight, 0 .. 8.
 * The sum is below 2^48. */
typedef void glint_ward_sum_fn(const struct glint_ward_lobe *lobe,
                               const struct glint_texels *texels,
                               const struct glint_ward_place *place,
                               uint64_t sum_q12[3]);

/* A reflection lobe, as a set of sampled half vectors. Those from index N on
 * face away from the eye, so they add no light. Each sample reads mip level l
 * with 4^l = (variance of its blur) / (variance of level 0) = SPAN_Q14 *
 * 2^span_log2 * (cosine between half vector and direction to the eye). */
struct glint_ward_lobe {
    glint_ward_sum_fn *sum;
    int n; /* number of samples */
    enum glint_ward_norm norm;
    int32_t share_q16; /* 1 / n */
    int unit_log2;     /* log2 of the unit of light of the environment */
    int32_t specular_q15[3];
    /* Components of the half vectors along tangent, bitangent and normal. */
    int32_t half_q14[3][GLINT_WARD_SAMPLES];
    int32_t factor_q14[GLINT_WARD_SAMPLES]; /* GLINT_WARD_1992: cube of the
                                               normal component of each half
                                               vector */
    int32_t span_q14[GLINT_WARD_SAMPLES];   /* mantissa of each sample's span,
                                               1 .. 2 */
    int32_t span_log2[GLINT_WARD_SAMPLES];
};

/* A shaded point. Rows of FRAME are tangent, bitangent and normal in the axes
 * of the environment; OUT is the direction to the eye in that frame, with
 * OUT_Q14[2] at least 1. For GLINT_WARD_1992, 1 / sqrt(OUT[2]) = ROOT_Q14
 * 2^root_log2, with ROOT_Q14 in 1 .. 2. */
struct glint_ward_place {
    int32_t frame_q14[3][3], out_q14[3];
    int32_t root_q14, root_log2;
};

#ifdef __cplusplus
}
#endif

#endif
