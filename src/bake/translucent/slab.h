/* SPDX-License-Identifier: MIT
 *
 * Light diffusion in a translucent slab, in double precision.
 *
 * The depth z is 0 at the lit face and SLAB at the other. The fluence is 0 at
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

/* One channel of a homogeneous translucent medium. */
struct glint_slab {
    double texel, slab;     /* mm */
    double scatter, absorb; /* 1/mm */
    double diffusion;       /* D, mm */
    double beyond;          /* z_b, mm */
    double depth;           /* depth of the source, mm */
    double albedo; /* single-scattering albedo, the power of the source */
};

/* Sets SLAB to channel C of a mix of the materials of STONE with the
 * fraction SHARE of material 0. z_b is computed from the D of the mix. */
void glint_slab_of(const struct glint_stone *stone, double share, int c,
                   struct glint_slab *slab);

/* Returns the wave number k of mode N, 1 .. GLINT_SLAB_MODES, in 1/mm. */
double glint_slab_wave(const struct glint_slab *slab, int n);
/* Return the source of mode N for incident light of power 1, in 1/mm, and
 * the light that leaves the slab per unit of the mode. */
double glint_slab_source(const struct glint_slab *slab, int n);
double glint_slab_exit(const struct glint_slab *slab, int n);

/* Sets ENTRY[kernel * kernel] to the row of a homogeneous medium of infinite
 * width, in closed form: sources and their images at the faces, integrated
 * over the area of both texels (multipole; its first pair is the dipole). */
void glint_slab_closed(const struct glint_slab *slab, int kernel,
                       double *entry);

/* Sets ENTRY[kernel * kernel] to the same row, computed by modes and finite
 * volumes. Returns false if there is no memory. */
bool glint_slab_lattice(const struct glint_slab *slab, int kernel,
                        double *entry);

/* Sets SHARE[side * side] to the fraction of material 0 of each texel. */
void glint_stone_shares(const struct glint_stone *stone, double *share);

#endif
