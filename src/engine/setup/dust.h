/* SPDX-License-Identifier: MIT
 *
 * Random dirt in a stop, generated from a seed: specks of dust, scratches and
 * smudges.
 * */
#ifndef GLINT_ENGINE_SETUP_DUST_H
#define GLINT_ENGINE_SETUP_DUST_H

enum { GLINT_DUST_MOST = 512 };

/* A piece of dirt: a line from end[0] to end[1] with round ends, or a disc if
 * both are equal. Its rim is soft. */
struct glint_speck {
    double end[2][2], radius, rim; /* stop radii; rim: half width of the soft
                                      rim / radius */
    double opacity;                /* blocked fraction of light in the middle, 0
                                      .. 1 */
    double middle[2], reach; /* centre and half side of the bounding square,
                                stop radii */
};

struct glint_dust {
    int n;
    struct glint_speck speck[GLINT_DUST_MOST];
};

/* Fills DUST with specks that together cover the fraction AMOUNT, 0 .. 0.5, of
 * the stop's circle, at most GLINT_DUST_MOST, and with scratches and smudges
 * whose number grows with AMOUNT. The same SEED gives the same dirt. */
void glint_dust_generate_specks(struct glint_dust *dust, double amount,
                                int seed);

/* Returns the fraction of light that DUST transmits at (X, Y), stop radii. */
double glint_dust_compute_transmission(const struct glint_dust *dust, double x,
                                       double y);

#endif
