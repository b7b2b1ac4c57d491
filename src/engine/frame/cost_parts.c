/* SPDX-License-Identifier: MIT */
#include "engine/frame/cost.h"

#include <math.h>

/* log2 of the most parts a side of a cell */
enum { MOST_LOG2 = 4, SAMPLES = 24 };

/* Returns the light of a step by which parts are told apart over LIGHT. */
static double step_of(const struct glint_cost_plan *p, double light)
{
    return p->code > 0
               ? fmax(0.0094 * pow(2. / 3, fmax(0, -log2(light))), 0.0003) /
                     light
               : 1. / 128;
}

static int within(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* Returns the mean over the stop of the parts of a cell, as LEVEL of the tables
 * is ROUGH there: at SAMPLES^2 places of it. CUT of the cells lie across its
 * outline. */
static double mean_parts(const struct glint_shade *s, int level, double step,
                         int most, double cut)
{
    enum { CUT_LOG2 = 3, ALONE = 4 }; /* parts of cut cells share no edges */
    const int side = (1 << (s->log2 - level)) + 1;
    double sum = 0;
    int n = 0;

    for (int k = 0; k < SAMPLES * SAMPLES; k++) {
        const int column = k % SAMPLES, row = k / SAMPLES;
        const double x = (2 * column + 1.) / SAMPLES - 1;
        const double y = (2 * row + 1.) / SAMPLES - 1;
        const int i = (int)(0.5 * (x + 1) * (side - 1) + 0.5);
        const int j = (int)(0.5 * (y + 1) * (side - 1) + 0.5);
        double d = s->rough_q8[level][j * side + i] / (256 * step);
        int log2_parts = 0;

        if (x * x + y * y > 1)
            continue;
        n++;
        /* bits of how many steps the light differs by */
        for (; d >= 1 && log2_parts < most; log2_parts++)
            d /= 2;
        if (log2_parts)
            sum += (1 - cut) * exp2(2 * log2_parts) +
                   cut * ALONE * exp2(2 * within(log2_parts, 0, CUT_LOG2));
    }
    return n ? sum / n : 0;
}

double glint_cost_parts(const struct glint_cost_plan *plan,
                        const struct glint_cost_cells *g, int log2_used)
{
    const struct glint_shade *s = plan->shade;
    const int skipped =
        s->log2 - within(log2_used, GLINT_SHADE_LEAST_LOG2, s->log2);
    const double n2 = g->cells * g->cells;
    /* side of a cell, stop radii and pixels */
    const double side = sqrt(3.14 / (n2 * g->inside));
    const double px = sqrt(g->area / n2);
    const int level = within((int)floor(log2(side * (1 << (s->log2 - 1)))),
                             skipped, s->log2 - 1);
    int most = within(level - skipped + 1, 0, MOST_LOG2);

    if (g->light <= 0 || px < 1)
        return 0;
    most = within((int)floor(log2(px)), 0, most);
    return n2 * g->inside * g->view *
           mean_parts(s, level, step_of(plan, g->light), most,
                      fmin(1, 4 / sqrt(n2 * g->inside)));
}
