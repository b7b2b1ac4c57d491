/* SPDX-License-Identifier: MIT */
#include "engine/ladder.h"

#include <math.h>
#include <string.h>

#include "engine/area.h"

/* Along the front that glint sweep measures over five lenses at 1280x720
 * (tests/figures/trade.md), the coarsest first. What is not on it: coarser
 * models, which save nothing and cost 6 dB. Finer models cost next to nothing
 * but bytes and their baking, which is why the default has none and all above
 * it do. Dispersion has a front of its own (make colour-table): what is for
 * small boards draws three wavelengths. */
/* clang-format off */
static const struct rung {
    double quality, grid, quantum, whole, cull, tolerance, dispersion, points;
    bool half;
} rung[] = {
    {0,      16, 8,      32,  1,     1, 0, 1, true},
    {0.0625, 64, 1,      4,   1,     1, 0, 1, true},
    {0.125,  20, 3,      8,   0.5,   1, 0, 1, false},
    {0.25,   32, 1,      4,   0.5,   1, 0, 1, false},
    {0.375,  40, 1,      4,   0.5,   1, 2, 4, false},
    {0.5,    64, 1,      4,   FRAME_CULL_CODES, 1, FRAME_DISPERSION_PX, AREA_SAMPLES, false},
    {0.625,  96, 0.5,    2,   0.125, 0.25, 1, 12, false},
    {0.75,  160, 0.25,   1,   0.125, 0.25, 0.5, 19, false},
    {0.875, 192, 0.125,  0.5, 0.125, 0.25, 0.5, 37, false},
    {1,     256, 0.0625, 0,   0.125, 0.25, 0.25, 61, false},
};
/* clang-format on */

typedef char
    glint_rungs_fit[sizeof rung / sizeof *rung == LADDER_RUNGS ? 1 : -1];

const char *const ladder_name[LADDER_NAMES + 1] = {"least", "draft",  "default",
                                                   "high",  "finest", NULL};

double ladder_named(int name)
{
    return (double)name / (LADDER_NAMES - 1);
}

/* PART of the way from A to B, in equal ratios. */
static double between(double a, double b, double part)
{
    return a > 0 && b > 0 ? a * pow(b / a, part) : a + part * (b - a);
}

double ladder_place(double quality)
{
    int i = 0;
    double part;

    while (i < LADDER_RUNGS - 2 && rung[i + 1].quality <= quality)
        i++;
    part =
        (quality - rung[i].quality) / (rung[i + 1].quality - rung[i].quality);
    part = fmin(fmax(part, 0), 1);
    return rung[i].half == rung[i + 1].half ? i + part : i + (part >= 0.5);
}

/* Between the rungs of QUALITY; what has no between is of the nearer one, but
 * models, of which the finer one costs no time. */
static struct rung rung_at(double quality)
{
    const double at = ladder_place(quality);
    const int below = at < LADDER_RUNGS - 1 ? (int)at : LADDER_RUNGS - 2;
    const struct rung *a = &rung[below], *b = &rung[below + 1];
    struct rung r = at - below < 0.5 ? *a : *b;

    r.tolerance = at > below ? b->tolerance : a->tolerance;
    r.grid = between(a->grid, b->grid, at - below);
    r.quantum = between(a->quantum, b->quantum, at - below);
    r.whole = between(a->whole, b->whole, at - below);
    r.cull = between(a->cull, b->cull, at - below);
    r.points = between(a->points, b->points, at - below);
    if (a->dispersion > 0 && b->dispersion > 0)
        r.dispersion = between(a->dispersion, b->dispersion, at - below);
    return r;
}

/* Grids go by fours. */
static int cells_of(const struct rung *r)
{
    return 4 * (int)lrint(r->grid / 4);
}

void ladder_set(struct scene *s, double quality)
{
    const struct rung r = rung_at(quality);

    s->quality = quality;
    s->grid = cells_of(&r);
    s->quantum = r.quantum;
    s->whole_codes = r.whole;
    s->cull = r.cull;
    s->dispersion_px = r.dispersion;
    s->area_samples = r.points;
    s->tolerance = r.tolerance;
    s->half = r.half;
}

void ladder_frame(struct frame *frame, double quality)
{
    const struct rung r = rung_at(quality);

    frame->max_cells = cells_of(&r);
    frame->cfg.irradiance_steps = scene_steps(r.quantum);
    frame->whole_codes = r.whole;
    frame->faintest_codes = r.cull;
    /* No cost model covers sets of wavelengths, so a budget draws with three.
     */
    frame->dispersion_px = frame->budget.ms > 0 ? 0 : r.dispersion;
    frame->area_samples = r.points;
    frame->half = r.half || frame->always_half;
}

/* Outlines, a tenth of a pixel at fineness 64, and by the square of it. */
double ladder_for_error(double px)
{
    const double grid = 64 * sqrt(0.1 / px);
    int i = 0;

    while (i < 256 && (rung_at(i / 256.).half || rung_at(i / 256.).grid < grid))
        i++;
    return i / 256.;
}

bool ladder_take(struct scene *s, const char *text)
{
    const bool exact = strcmp(text, "exact") == 0;
    const int name = tool_word(text, ladder_name);
    double quality = exact ? 1 : ladder_named(name);

    if (!exact && name < 0 &&
        (!tool_number(text, &quality) || quality < 0 || quality > 1))
        return false;
    ladder_set(s, quality);
    if (exact)
        s->rays = SCENE_RAYS_EXACT;
    return true;
}
