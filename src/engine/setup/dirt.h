/* SPDX-License-Identifier: MIT
 *
 * Dust and masks inside the outline of a stop: in doubles, for exact pictures,
 * and as a table, for flares. */
#ifndef GLINT_ENGINE_SETUP_DIRT_H
#define GLINT_ENGINE_SETUP_DIRT_H

#include "engine/setup/dust.h"
#include "engine/setup/iris.h"

enum { GLINT_DIRT_LOG2 = 9 }; /* log2 of the cells per side of the table */

struct glint_dirt {
    struct glint_shade shade;
    struct glint_iris_sides sides;
    struct glint_dust dust;
    struct glint_iris iris;
    double cos_turn, sin_turn; /* rotation of mask and dust with the blades */
    uint64_t mark;             /* digest of the shade; changes if it changes */
    double mean;               /* mean light over the stop; 1 if it is 0 */
    /* Returns the fraction of light that passes at (X, Y) inside the
     * outline. */
    double (*through)(const struct glint_dirt *dirt, double x, double y);
    uint16_t *node_q15; /* nodes of all levels, consecutive */
    uint8_t *rough_q8;
};

/* Returns the fraction of light that passes the stop of SETUP at (X, Y)
 * inside its outline. */
static inline double glint_dirt_through(const struct glint_setup *setup,
                                        double x, double y)
{
    return setup->dirt ? setup->dirt->through(setup->dirt, x, y) : 1;
}

#endif
