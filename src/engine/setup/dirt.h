/* SPDX-License-Identifier: MIT
 *
 * Computes the light that a stop with a soft edge, dust or masks transmits: in
 * doubles for exact pictures, and as a table (shade) for the integer
 * renderer. */
#ifndef GLINT_ENGINE_SETUP_DIRT_H
#define GLINT_ENGINE_SETUP_DIRT_H

#include "engine/setup/dust.h"
#include "engine/setup/iris.h"

enum {
    GLINT_DIRT_LOG2 = 9
}; /* log2 of the number of cells per side of the
      table */

struct glint_dirt {
    struct glint_shade shade;
    struct glint_iris_sides sides;
    struct glint_dust dust;
    struct glint_iris iris;
    double cos_turn, sin_turn; /* cosine and sine of the rotation of the blades,
                                  mask and dust */
    uint64_t mark; /* digest of the transmission table; a changed digest means
                      changed dirt */
    /* mean transmission over the stop; 1 if that is at most 1e-4, as it is a
     * divisor */
    double mean;
    /* Returns the fraction of light that is transmitted at (X, Y), stop radii,
     * inside the outline. */
    double (*through)(const struct glint_dirt *dirt, double x, double y);
    uint16_t *node_q15; /* transmission at the nodes of all levels of the table,
                           the finest level first */
    uint8_t *rough_q8;
};

/* Returns the fraction of light that the stop of SETUP transmits at (X, Y),
 * stop radii, inside its outline. */
static inline double
glint_dirt_compute_transmission(const struct glint_setup *setup, double x,
                                double y)
{
    return setup->dirt ? setup->dirt->through(setup->dirt, x, y) : 1;
}

#endif
