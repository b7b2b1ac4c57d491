/* SPDX-License-Identifier: MIT
 *
 * Dirt in a stop, generated from a seed: specks of dust, scratches and smudges.
 * */
#ifndef GLINT_ENGINE_SETUP_DUST_H
#define GLINT_ENGINE_SETUP_DUST_H

enum { GLINT_DUST_MOST = 512 };

/* A line from end to end with round ends, or a disc if both ends are at one
 * point; its rim is soft. */
struct glint_speck {
    double end[2][2], radius, rim; /* stop radii */
    double opacity;                /* 0 .. 1, in its middle */
    double middle[2], reach; /* centre and half side of the bounding square */
};

struct glint_dust {
    int n;
    struct glint_speck speck[GLINT_DUST_MOST];
};

/* Sets DUST to specks that together cover the fraction AMOUNT, 0 .. 0.5, of
 * the stop's circle, limited to GLINT_DUST_MOST specks, and to scratches and
 * smudges whose number grows with AMOUNT. The same SEED gives the same
 * positions. */
void glint_dust_generate_specks(struct glint_dust *dust, double amount,
                                int seed);

/* Returns the fraction of light that passes the dust at (X, Y). */
double glint_dust_compute_transmission(const struct glint_dust *dust, double x,
                                       double y);

#endif
