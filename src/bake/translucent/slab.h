/* SPDX-License-Identifier: MIT
 *
 * Light diffusion in a translucent slab, in double precision.
 *
 * The depth z is 0 at the lit face and slab at the other. The fluence is 0 at
 * the distance z_b = 2 A D outside both faces, so it is a sum of modes sin(k (z
 * + z_b)) with k = n pi / (slab + 2 z_b). Light that enters a texel acts as a
 * source at depth 1 / (scatter + absorb); the light that leaves is D times the
 * gradient [Jensen01]. Each mode obeys diffusion in the plane,
 *
 *     -div(D grad phi) + (D k^2 + absorb) phi = source,
 *
 * discretised by finite volumes of one texel. In heterogeneous media z_b is
 * computed from the mean D, as modes are independent only with a single z_b.
 */
#ifndef GLINT_BAKE_TRANSLUCENT_SLAB_H
#define GLINT_BAKE_TRANSLUCENT_SLAB_H

#include "bake/translucent/rows.h"

enum { GLINT_SLAB_MODES = 8 };

/* one colour channel of a homogeneous translucent medium */
struct glint_slab {
    double texel, slab;     /* size of a texel, thickness of the slab, mm */
    double scatter, absorb; /* 1/mm */
    double diffusion;       /* D, mm */
    /* z_b, distance outside the faces at which the fluence is 0, mm */
    double beyond;
    double depth; /* depth of the source, mm */
    /* single-scattering albedo = power of the source for incident light of
     * power 1 */
    double albedo;
};

/* Sets SLAB to channel C of a mix of the two materials of STONE, with the
 * fraction SHARE of material 0. z_b is computed from the mix's D. */
void glint_slab_init_mix(const struct glint_stone *stone, double share, int c,
                         struct glint_slab *slab);

/* Returns the wave number k of mode N (1 .. GLINT_SLAB_MODES), 1/mm. */
double glint_slab_compute_wave_number(const struct glint_slab *slab, int n);
/* glint_slab_compute_source() returns the source of mode N for incident light
 * of power 1, 1/mm. glint_slab_compute_exit() returns the light that leaves the
 * slab per unit of mode N. */
double glint_slab_compute_source(const struct glint_slab *slab, int n);
double glint_slab_compute_exit(const struct glint_slab *slab, int n);

/* Sets ENTRY[kernel * kernel] to the row of an infinitely wide homogeneous
 * medium in closed form (multipole). Sources and their images at the faces are
 * integrated over the area of source and target texel. */
void glint_slab_compute_closed_form(const struct glint_slab *slab, int kernel,
                                    double *entry);

/* Sets ENTRY[kernel * kernel] to the row of an infinitely wide homogeneous
 * medium, computed by modes and finite volumes. Returns false if there is no
 * memory. */
bool glint_slab_compute_by_modes(const struct glint_slab *slab, int kernel,
                                 double *entry);

/* Sets SHARE[side * side] to the fraction of material 0 in each texel. */
void glint_stone_compute_fractions(const struct glint_stone *stone,
                                   double *share);

#endif
