/* SPDX-License-Identifier: MIT
 *
 * glint/scene/lobe.h - data that the kernels for Ward's reflection lobe read:
 * the lobe, and the texels of an environment. Functions of glint/scene/ward.h
 * compute lobes; glint/scene/environment.h provides the texels. */
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
    /* Normalisation by which the lobe reflects no more light than it receives
     * [Geisler10]. */
    GLINT_WARD_BOUNDED,
    /* Normalisation as published in [Ward92]. */
    GLINT_WARD_1992
};

/* A mip level: a square with a side of 2^side_log2 texel codes, row by row. */
struct glint_texels_level {
    int32_t side_log2;
    uint32_t at; /* index of the level's first code */
};

struct glint_texels {
    const uint32_t *code; /* texels of all levels, RGB9E5 */
    int32_t last;         /* index of the last (coarsest) level */
    /* the mip levels; the last level is stored twice, so that each level has a
     * successor */
    struct glint_texels_level level[GLINT_TEXELS_LEVELS + 1];
};

struct glint_ward_lobe;
struct glint_ward_place;

/* Sets SUM_Q12 to a weighted sum of light over the samples of LOBE. The light
 * of a sample is looked up in TEXELS and is in their unit; its weight is 0 ..
 * 8. The sum is below 2^48. */
typedef void glint_ward_sum_fn(const struct glint_ward_lobe *lobe,
                               const struct glint_texels *texels,
                               const struct glint_ward_place *place,
                               uint64_t sum_q12[3]);

/* A reflection lobe: a set of sampled half vectors. Half vectors from index N
 * on face away from the eye and add no light. Each sample reads mip level l,
 * with 4^l = (variance of the blur of level l) / (variance of level 0) =
 * SPAN_Q14 * 2^span_log2 * (cosine between half vector and direction to the
 * eye). */
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
 * of the environment. OUT is the direction to the eye in the axes tangent,
 * bitangent and normal; OUT_Q14[2] is at least 1. For GLINT_WARD_1992, 1 /
 * sqrt(OUT[2]) = ROOT_Q14 * 2^root_log2, with ROOT_Q14 in 1 .. 2. */
struct glint_ward_place {
    int32_t frame_q14[3][3], out_q14[3];
    int32_t root_q14, root_log2;
};

#ifdef __cplusplus
}
#endif

#endif
