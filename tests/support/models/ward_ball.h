/* SPDX-License-Identifier: MIT
 *
 * A ball of brushed metal under an environment map, in an image 32 pixels wide.
 * The camera looks along z; the metal is brushed about the y axis. The ball is
 * drawn twice: by exact sums over all texels of the map, and by the lookups of
 * the run time.
 */
#ifndef GLINT_TESTS_WARD_BALL_H
#define GLINT_TESTS_WARD_BALL_H

#include "bake/environment/sphere.h"
#include "glint/scene/ward.h"

enum { WARD_BALL = 32, WARD_PIXELS = WARD_BALL * WARD_BALL };

typedef double ward_picture[WARD_PIXELS][3];

/* Sets FRAME to the tangent, bitangent and normal of the ball at pixel I.
 * Returns 0 off the ball, and at its rim where the normal is within 6 degrees
 * of perpendicular to the view. */
int ward_build_frame(int i, double frame[3][3]);

/* Returns Ward's lobe for light from IN seen from VIEW, times the cosine of
 * incidence. NORM: the bounded normalisation or that of 1992. As in the run
 * time, the lobe is limited to 8 times its sampling density. */
double ward_evaluate_lobe(const double frame[3][3], const double view[3],
                          const double alpha[2], int norm, const double in[3]);

/* Sets TO to the image of the ball in the environment S by sums over all
 * texels, with the bounded normalisation. */
void ward_render_by_texel_sums(const struct glint_sphere *s,
                               const double alpha[2], ward_picture to);

/* Sets TO to the image of the ball by lookups in the baked environment E. */
void ward_render_by_lookups(const struct glint_environment *e,
                            const struct glint_ward_material *material,
                            const struct glint_ward_options *options,
                            ward_picture to);

/* Return the PSNR of GOT against WANT, dB, in linear light or in sRGB codes.
 * Both are exposed so that the median of WANT is 1/4 of white, and clamped to
 * white. */
double ward_compute_psnr(ward_picture want, ward_picture got);
double ward_compute_psnr_of_codes(ward_picture want, ward_picture got);

#endif
