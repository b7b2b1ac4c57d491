/* SPDX-License-Identifier: MIT
 *
 * Generates random dirt in a stop from a seed: specks of dust, scratches and
 * smudges. */
#ifndef GLINT_ENGINE_SETUP_DUST_H
#define GLINT_ENGINE_SETUP_DUST_H

enum { GLINT_DUST_MOST = 512 };

/* A piece of dirt: a line from end[0] to end[1] with round ends, or a disc if
 * both are equal. Its rim is soft. */
struct glint_speck {
    double end[2][2], radius, rim; /* end: ends of the line, stop radii; radius:
                                      half its width, stop radii; rim: half
                                      width of the soft rim / radius */
    double opacity;                /* fraction of light that the middle of the
                                      speck blocks, 0 .. 1 */
    double middle[2], reach;       /* centre (middle) and half side (reach) of
                                      the bounding square, stop radii */
};

struct glint_dust {
    int n;
    struct glint_speck speck[GLINT_DUST_MOST];
};

/* Fills DUST with random dirt. Specks of dust together cover the fraction
 * AMOUNT, 0 .. 0.5, of the stop's circle; there are at most GLINT_DUST_MOST.
 * The numbers of scratches and smudges grow with AMOUNT. The same SEED gives
 * the same dirt. */
void glint_dust_generate_specks(struct glint_dust *dust, double amount,
                                int seed);

/* Returns the fraction of light that DUST transmits at (X, Y), stop radii. */
double glint_dust_compute_transmission(const struct glint_dust *dust, double x,
                                       double y);

#endif
