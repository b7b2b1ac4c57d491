/* SPDX-License-Identifier: MIT
 *
 * glint/scene/lobe.h - Ward's lobe and the texels that it reads, as its kernels
 * take them. glint/scene/ward.h makes lobes, glint/scene/environment.h texels.
 */
#ifndef GLINT_SCENE_LOBE_H
#define GLINT_SCENE_LOBE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_WARD_SAMPLES = 32,
    GLINT_TEXELS_LEVELS = 11 /* at most */
};

enum glint_ward_norm {
    GLINT_WARD_BOUNDED, /* reflects no more than it receives [Geisler10] */
    GLINT_WARD_1992     /* as published [Ward92] */
};

/* A level: a square of 2^side_log2 codes, row by row. */
struct glint_texels_level {
    int32_t side_log2;
    uint32_t at; /* of the first code, counted in codes */
};

struct glint_texels {
    const uint32_t *code; /* RGB9E5 */
    int32_t last;         /* level */
    /* The last one stands there twice: each has a next. */
    struct glint_texels_level level[GLINT_TEXELS_LEVELS + 1];
};

struct glint_ward_lobe;
struct glint_ward_place;

/* Sets SUM_Q12 to the light that LOBE's samples find in TEXELS, units, each
 * times its weight, 0 .. 8: below 2^48. */
typedef void glint_ward_sum_fn(const struct glint_ward_lobe *lobe,
                               const struct glint_texels *texels,
                               const struct glint_ward_place *place,
                               uint64_t sum_q12[3]);

/* Half vectors of a lobe; those from N on are turned away from the eye. A
 * sample reads the level l whose light has a variance of 4^l times that of
 * level 0: SPAN_Q14 2^span_log2 times the cosine from half vector to eye. */
struct glint_ward_lobe {
    glint_ward_sum_fn *sum;
    int n; /* samples */
    enum glint_ward_norm norm;
    int32_t share_q16; /* 1 / n, times what codes count */
    int unit_log2;     /* of the light of its environment */
    int32_t specular_q15[3];
    int32_t half_q14[3][GLINT_WARD_SAMPLES]; /* tangent, bitangent, normal */
    int32_t factor_q14[GLINT_WARD_SAMPLES];  /* 1992: third power of the last */
    int32_t span_q14[GLINT_WARD_SAMPLES];    /* 1 .. 2 */
    int32_t span_log2[GLINT_WARD_SAMPLES];
};

/* How the eye sees a place: rows of FRAME are tangent, bitangent and normal in
 * the directions of the environment, OUT is the way to the eye along them,
 * OUT_Q14[2] from 1 on. For the norm of 1992 1 / sqrt(OUT[2]) is ROOT_Q14
 * 2^root_log2, ROOT_Q14 1 .. 2. */
struct glint_ward_place {
    int32_t frame_q14[3][3], out_q14[3];
    int32_t root_q14, root_log2;
};

#ifdef __cplusplus
}
#endif

#endif
