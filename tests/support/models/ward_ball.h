/* SPDX-License-Identifier: MIT
 *
 * A brushed ball under an environment, 32 pixels wide, seen along z, brushed
 * about y: by sums over all texels, and by the run time's lookups. */
#ifndef GLINT_TESTS_WARD_BALL_H
#define GLINT_TESTS_WARD_BALL_H

#include "bake/environment/sphere.h"
#include "glint/scene/ward.h"

enum { WARD_BALL = 32, WARD_PIXELS = WARD_BALL * WARD_BALL };

typedef double ward_picture[WARD_PIXELS][3];

/* Sets FRAME to tangent, bitangent and normal at pixel I; returns 0 off the
 * ball, and at its rim, where the normal is within 6 degrees of being at right
 * angles to the view. */
int ward_frame(int i, double frame[3][3]);

/* Returns Ward's lobe towards IN as seen from VIEW, in the norm that is bounded
 * or that of 1992, times n.in; as the run time it counts no more than 8 times
 * its density. */
double ward_lobe(const double frame[3][3], const double view[3],
                 const double alpha[2], int norm, const double in[3]);

/* Sets TO to what S shows, by sums over all texels; bounded. */
void ward_sum(const struct glint_sphere *s, const double alpha[2],
              ward_picture to);

/* Sets TO to what lookups in E show. */
void ward_look(const struct glint_environment *e,
               const struct glint_ward_material *material,
               const struct glint_ward_options *options, ward_picture to);

/* Returns the PSNR of GOT, dB, with the median of WANT at 1/4 of white and all
 * clamped to white: of linear light, or of what a display is sent, codes of
 * sRGB.
 */
double ward_psnr(ward_picture want, ward_picture got);
double ward_psnr_codes(ward_picture want, ward_picture got);

#endif
