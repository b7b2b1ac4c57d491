/* SPDX-License-Identifier: MIT */
#include "ladder.h"

#include <math.h>

/* What it takes to be so good, the coarsest first, qualities evenly apart. */
static const struct rung {
    double grid, quantum, cull, tolerance;
    bool narrow;
} rung[] = {
    {16, 16, 0.125, 4, false},         {24, 8, 0.125, 4, false},
    {32, 4, 0.125, 4, false},          {48, 2, 0.125, 1, false},
    {64, 1, 0.125, 1, false},          {96, 0.5, 0.125, 1, false},
    {128, 0.25, 0.125, 0.25, false},   {192, 0.125, 0.125, 0.25, false},
    {256, 0.0625, 0.125, 0.25, false},
};

enum { STEPS = sizeof rung / sizeof *rung - 1 };

const char *const ladder_name[LADDER_NAMES + 1] = {"least", "draft", "default",
                                                   "high",  "exact", NULL};

double ladder_named(int name)
{
    return (double)name / (LADDER_NAMES - 1);
}

/* PART of the way from A to B, in equal ratios. */
static double between(double a, double b, double part)
{
    return a > 0 && b > 0 ? a * pow(b / a, part) : a + part * (b - a);
}

void ladder_set(struct scene *s, double quality)
{
    const double at = quality * STEPS;
    const int below = at < STEPS ? (int)at : STEPS - 1;
    const struct rung *a = &rung[below], *b = &rung[below + 1];
    const struct rung *near = at - below < 0.5 ? a : b;
    const double part = at - below;

    s->grid = (int)lrint(between(a->grid, b->grid, part) / 4) * 4;
    s->quantum = between(a->quantum, b->quantum, part);
    s->cull = between(a->cull, b->cull, part);
    s->tolerance = near->tolerance;
    s->narrow = near->narrow;
}

bool ladder_take(struct scene *s, const char *text)
{
    const int name = tool_word(text, ladder_name);
    double quality = ladder_named(name);

    if (name < 0 &&
        (!tool_number(text, &quality) || quality < 0 || quality > 1))
        return false;
    ladder_set(s, quality);
    if (name == LADDER_NAMES - 1)
        s->rays = SCENE_RAYS_EXACT;
    return true;
}
