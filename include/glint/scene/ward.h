/* SPDX-License-Identifier: MIT
 *
 * glint/scene/ward.h - shades brushed metal under a baked environment, in
 * integers.
 *
 *     glint_ward_prepare(&lobe, &environment, &material, &options);
 *     glint_ward_light(&lobe, &environment, frame_q14, view_q14, rgb_q15);
 *
 * Computes the light of an environment that Ward's anisotropic lobe reflects to
 * the eye. The lobe is sampled by stratified half vectors. The light of each is
 * looked up in the mip level whose blur matches the solid angle that the half
 * vector represents. Materials may change in every frame: a lobe costs a few
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
    GLINT_WARD_RATIO = 10,               /* max ratio of the two alphas */
    GLINT_WARD_LEAST_ALPHA_Q24 = 1 << 14 /* min alpha, .001 */
};

enum glint_ward_rule {
    /* Half vectors are contracted, and all read the same mip level. The spread
     * of the half vectors and the blur of the level together give the lobe. */
    GLINT_WARD_CONSTANT,
    /* Each half vector reads the mip level whose texels have the solid angle
     * that the half vector represents. */
    GLINT_WARD_PUBLISHED
};

struct glint_ward_material {
    int32_t specular_q15[3]; /* specular colour, each channel 0 .. 32768 */
    int32_t alpha_q24[2]; /* roughness along tangent and bitangent, .001 .. 1 */
    enum glint_ward_norm norm;
};

struct glint_ward_options {
    int samples; /* number of half vectors, 1 .. GLINT_WARD_SAMPLES */
    enum glint_ward_rule rule;
    /* Offset, -2^12 .. 2^12, that is added to the mip level that the rule
     * selects. */
    int32_t bias_q8;
    unsigned sets; /* instruction sets of kernels, GLINT_SET_ bits
                      (glint/kernels.h) */
};

/* Sets OPTIONS to 8 samples with GLINT_WARD_CONSTANT. */
void glint_ward_defaults(struct glint_ward_options *options);

/* Raises the smaller of the two alphas to a tenth of the larger if it is below
 * that. Returns 1 if it was raised, else 0. */
int glint_ward_hold(int32_t alpha_q24[2]);

/* Computes the reflection lobe LOBE of MATERIAL for ENVIRONMENT. Returns 1 if
 * the smaller alpha was raised to a tenth of the larger, else 0. */
int glint_ward_prepare(struct glint_ward_lobe *lobe,
                       const struct glint_environment *environment,
                       const struct glint_ward_material *material,
                       const struct glint_ward_options *options);

/* Sets RGB_Q15 to the light reflected towards unit vector VIEW_Q14, 0 .. 2^30.
 * Rows of FRAME_Q14 are the orthogonal unit vectors tangent, bitangent and
 * normal, in the axes of ENVIRONMENT. From behind, the surface is black. */
void glint_ward_light(const struct glint_ward_lobe *lobe,
                      const struct glint_environment *environment,
                      const int32_t frame_q14[3][3], const int32_t view_q14[3],
                      int32_t rgb_q15[3]);

/* Sets RGB, in units of ENVIRONMENT, 0 .. 2^28, to the light that a white
 * diffuse surface with normal NORMAL reflects under ENVIRONMENT. NORMAL may
 * have any length up to 2^16. */
void glint_environment_irradiance(const struct glint_environment *environment,
                                  const int32_t normal[3], int32_t rgb[3]);

/* Sets RGB, in units of ENVIRONMENT, 0 .. 2^28, to the light of ENVIRONMENT
 * from direction TOWARD. TOWARD may have any length up to 2^16. The light is
 * read in mip level LEVEL_Q8, which is clamped to the existing levels. */
void glint_environment_look(const struct glint_environment *environment,
                            const int32_t toward[3], int32_t level_q8,
                            int32_t rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
