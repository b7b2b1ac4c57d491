/* SPDX-License-Identifier: MIT */
#include "engine/frame/cost.h"

#include <math.h>

#include "engine/frame/quality.h"
#include "glint/bake.h"

/* Octaves that light typically varies over within a ghost. */
#define VARIATION 0.35

#define QUAD 2 /* number of single pixels that take as long as four at once */

/* Counted: least squares of the relative errors of 35 frames, each drawn a
 * second time under callgrind, so that none is binned twice: heliar-tronnier,
 * double-gauss-angenieux and nikon-zoom-mid at qualities draft, default and
 * high, a lamp at 5, 12 or 25 degrees, RGB of 640x360 and some of 1280x720.
 * They are off by 4 percent in the median, by 8 at most.
 *
 * Planned: the weights of the counts that glint_cost_of() expects. These differ
 * from counted ones: bundles are looked at, not rays, and there are 1 to 2.6
 * times as many edges, 1.4 to 3.5 times as many rows and 1 to 6 times as many
 * lit pixels as are drawn then. Least squares of relative errors over 43 frames
 * of five lenses at both sizes, along an earlier quality table. For the 35
 * frames above they predict 0.78 times the instructions, which calibrating a
 * budget corrects; apart from that they are off by 11 percent in the median, by
 * 32 or less in nine of ten, by 40 at most. 48 frames of RGB, itoh-zoom-long
 * among them, give 0.78 again, and 14, 47 and 57 percent. Weights fitted to
 * these 48 would be off by 12, 43 and 50, and for a lens that was left out of
 * the fit by 17 to 55 in the median: what the counts lack, no weights make
 * good. */
const struct glint_cost_weight glint_cost_weight[GLINT_COST_KINDS] = {
    {"looking", 0.6, 1.35},  {"bundles", 75, 43},
    {"vertices", 0.6, 0.25}, {"edges", 0.03, 1.08},
    {"rows", 0.0275, 0.027}, {"lit pixels", 0.02, 0.069},
    {"star", 0.32, 0.32}};

double glint_cost_minsn(const struct glint_cost *cost)
{
    double sum = 0;

    for (int k = 0; k < GLINT_COST_KINDS; k++)
        sum += glint_cost_weight[k].planned * cost->count[k];
    return 1e-3 * sum;
}

/* cells a side that are taken to be enough for a grid that got
 * GLINT_LEAST_CELLS */
enum { LESS_CELLS = 6 };

/* Returns the cells a side that the plan would have chosen for grids FINER
 * times as fine. */
static double cells_at(int planned, double finer)
{
    const double free =
        planned > GLINT_LEAST_CELLS || finer <= 1 ? planned : LESS_CELLS;

    return fmax(GLINT_LEAST_CELLS, fmin(free * finer, GLINT_MAX_CELLS));
}

/* Returns the steps an octave for a ghost that is OCTAVES below white, in
 * codes. */
static double steps_at(int steps, double octaves)
{
    return octaves > 0 ? steps * pow(7. / 8, octaves) : steps;
}

struct glint_cost glint_cost_of(const struct glint_cost_plan *p,
                                const struct glint_dials *then)
{
    const bool half = glint_dials_half(then) && p->can_half;
    const bool was_half = glint_dials_half(&p->dials) && p->can_half;
    const double width = p->width / (half ? 2. : 1);
    const double height = p->height / (half ? 2. : 1);
    const double finer = (double)then->fineness / p->dials.fineness;
    /* Factor on the number of pixels that were planned for. */
    const double larger = pow(4, was_half - half);
    const int steps = then->irradiance_steps;
    struct glint_cost cost = {{p->n_looked_at, 1}};
    struct glint_planned b;
    double covered = 0;

    for (int i = 0; glint_flare_planned(p->flare, i, &b); i++) {
        const double n = cells_at(b.n_cells, finer);
        const double light = glint_real_value(b.irradiance);
        const double area = larger * glint_real_value(b.flux) / light;
        const double rows = fmin(sqrt(area), height);
        const double levels =
            steps ? 2 + VARIATION * steps_at(steps, -log2(light)) : n;
        const double across = fmin(n, levels);

        cost.count[GLINT_COST_BUNDLES]++;
        cost.count[GLINT_COST_VERTICES] += (n + 1) * (n + 1);
        cost.count[GLINT_COST_EDGES] += n * across;
        cost.count[GLINT_COST_ROWS] += rows * across;
        covered += fmin(1, area / (width * height));
    }
    cost.count[GLINT_COST_LIT] =
        width * height * (1 - exp(-covered)) * (half ? QUAD : 1);
    cost.count[GLINT_COST_STAR] = p->n_star;
    return cost;
}
