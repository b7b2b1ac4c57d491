/* SPDX-License-Identifier: MIT
 *
 * Diffusion in a translucent slab, in double precision.
 *
 * The depth z is 0 at the face that is lit and slab at the other. Fluence is 0
 * at z_b = 2 A D outside either, so it is a sum of modes sin(k (z + z_b)), k
 * = n pi / (slab + 2 z_b). Light that falls on a texel is a source at the depth
 * 1 / (scatter + absorb) below it, and what leaves is D times the gradient
 * [Jensen01]. Each mode is diffusion in the plane,
 *
 *     -div(D grad phi) + (D k^2 + absorb) phi = source,
 *
 * with finite volumes of a texel. Where texels differ, z_b follows the mean D:
 * it has to be one for the modes to be apart. */
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
    double depth;           /* of the source, mm */
    double albedo;          /* of single scattering: power of the source */
};

/* Sets SLAB to channel C of a mix of the materials of STONE, with the fraction
 * SHARE of material 0; z_b is computed from the D of the mix. */
void glint_slab_of(const struct glint_stone *stone, double share, int c,
                   struct glint_slab *slab);

/* Mode N, 1 .. GLINT_SLAB_MODES, of a slab. */
double glint_slab_wave(const struct glint_slab *slab, int n); /* k, 1/mm */
/* Return the source of mode N for incident light of power 1, in 1/mm, and the
 * light that leaves per unit of the mode. */
double glint_slab_source(const struct glint_slab *slab, int n);
double glint_slab_exit(const struct glint_slab *slab, int n);

/* Sets ENTRY[kernel * kernel] to the row of a laterally infinite translucent
 * medium, in closed form: the sources and their images at the faces, integrated
 * over the area of both texels. This is the multipole, whose first pair is the
 * dipole. */
void glint_slab_closed(const struct glint_slab *slab, int kernel,
                       double *entry);

/* Sets ENTRY[kernel * kernel] to the same by modes and finite volumes. Returns
 * false without memory. */
bool glint_slab_lattice(const struct glint_slab *slab, int kernel,
                        double *entry);

/* The fraction of material 0 by texel, [side * side]. */
void glint_stone_shares(const struct glint_stone *stone, double *share);

#endif
