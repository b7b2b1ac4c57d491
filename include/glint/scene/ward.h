/* SPDX-License-Identifier: MIT
 *
 * glint/scene/ward.h - brushed metal under a baked environment, in integers.
 *
 *     glint_ward_prepare(&lobe, &environment, &material, &options);
 *     glint_ward_light(&lobe, &environment, frame_q14, view_q14, rgb_q15);
 *
 * Light of an environment that Ward's anisotropic lobe reflects to the eye:
 * stratified half vectors, each looked up in the level as wide as the solid
 * angle it represents. Materials may change in every frame: a lobe costs a few
 * thousand instructions. [Ward92], [Krivanek08], [Toral14] */
#ifndef GLINT_SCENE_WARD_H
#define GLINT_SCENE_WARD_H

#include <stdint.h>

#include "glint/scene/environment.h"
#include "glint/scene/lobe.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_WARD_RATIO = 10,               /* of alphas, at most */
    GLINT_WARD_LEAST_ALPHA_Q24 = 1 << 14 /* .001 */
};

enum glint_ward_rule {
    /* Half vectors are drawn together and all read one level, so that their
     * spread and its blur are the lobe. */
    GLINT_WARD_CONSTANT,
    /* Each reads the level of the solid angle that it stands for. */
    GLINT_WARD_PUBLISHED
};

struct glint_ward_material {
    int32_t specular_q15[3]; /* 0 .. 32768 */
    int32_t alpha_q24[2];    /* along tangent and bitangent: .001 .. 1 */
    enum glint_ward_norm norm;
};

struct glint_ward_options {
    int samples; /* 1 .. GLINT_WARD_SAMPLES */
    enum glint_ward_rule rule;
    int32_t bias_q8; /* levels; added to that of the rule, -2^12 .. 2^12 */
    unsigned sets;   /* of kernels, GLINT_SET_ bits (glint/kernels.h) */
};

/* Sets OPTIONS to 8 samples with constant footprints. */
void glint_ward_defaults(struct glint_ward_options *options);

/* Raises the smaller alpha to a tenth of the other; returns 1 if it was less.
 */
int glint_ward_hold(int32_t alpha_q24[2]);

/* Makes LOBE for ENVIRONMENT. Returns 1 if the smaller alpha was raised to a
 * tenth of the other, else 0. */
int glint_ward_prepare(struct glint_ward_lobe *lobe,
                       const struct glint_environment *environment,
                       const struct glint_ward_material *material,
                       const struct glint_ward_options *options);

/* Sets RGB_Q15 to the light towards unit vector VIEW_Q14, 0 .. 2^30. Rows of
 * FRAME_Q14 are unit vectors at right angles, tangent, bitangent and normal, in
 * the directions of ENVIRONMENT. It is black from behind. */
void glint_ward_light(const struct glint_ward_lobe *lobe,
                      const struct glint_environment *environment,
                      const int32_t frame_q14[3][3], const int32_t view_q14[3],
                      int32_t rgb_q15[3]);

/* Sets RGB, in units of ENVIRONMENT, 0 .. 2^28, to what its levels show a white
 * surface whose normal is NORMAL, of any length up to 2^16. */
void glint_environment_irradiance(const struct glint_environment *environment,
                                  const int32_t normal[3], int32_t rgb[3]);

/* Sets RGB, in units of ENVIRONMENT, 0 .. 2^28, to its light from TOWARD, of
 * any length up to 2^16, at LEVEL_Q8, clamped to what there is. */
void glint_environment_look(const struct glint_environment *environment,
                            const int32_t toward[3], int32_t level_q8,
                            int32_t rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
