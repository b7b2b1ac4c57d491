/* SPDX-License-Identifier: MIT */
#include "scenes/budget.h"

#include <math.h>

/* Number of frames that are drawn with a level before a finer level is tried.
 * Each failed trial doubles this number, up to MAX_HOLD. */
#define HOLD     8
#define MAX_HOLD 512
/* Fraction of the time limit below which a finer level is tried. A level takes
 * at least 1.3 times as long as the next coarser one. */
#define SPARE 0.75
/* Fraction of the frame time that the scene gets while the flare is drawn below
 * its default quality, and the min fraction while the flare is drawn at its
 * lowest quality */
#define FRACTION     0.6
#define MIN_FRACTION 0.1

/* Quality levels, from fine to coarse; level 1 is the default. Level 2 reduces
 * shadow points and lookups in brushed metal, because penumbrae cover little of
 * an image and 4 lookups lose less than 2 dB. Level 3 reduces the number of
 * shaded points, level 4 the edge samples. QUALITY is the min --quality that
 * uses the level. PSNR falls from 48 dB to 36 dB (mean of three scenes at
 * revision e8a4a84c). */
static const struct {
    int points, edge, samples;
    bool half;
    double quality;
} levels[SCENE_BUDGET_LEVELS] = {{16, 16, 32, false, 1},
                                 {4, 4, 8, false, 0.5},
                                 {1, 4, 4, false, 0.375},
                                 {1, 4, 4, true, 0.125},
                                 {1, 1, 4, true, 0}};

enum { USUAL = 1 }; /* level of the default quality */

void scene_budget_init(struct scene_budget *budget,
                       const struct scene_dials *asked)
{
    struct scene_dials *const a = &budget->asked;
    struct glint_scene_config usual;

    *budget = (struct scene_budget){.asked = *asked, .hold = HOLD};
    glint_scene_defaults(&usual, asked->width, asked->height);
    a->edge_samples = a->edge_samples ? a->edge_samples : usual.edge_samples;
    a->shadow_points =
        a->shadow_points ? a->shadow_points : usual.shadow_points;
    a->ward_samples = a->ward_samples ? a->ward_samples : usual.ward_samples;
}

void scene_dials_set_quality(struct scene_dials *dials, double quality)
{
    const int i = scene_budget_find_level_of_quality(quality);

    if (i == USUAL)
        return;
    if (!dials->shadow_points)
        dials->shadow_points = levels[i].points;
    if (!dials->edge_samples)
        dials->edge_samples = levels[i].edge;
    if (!dials->ward_samples)
        dials->ward_samples = levels[i].samples;
    dials->half_shading |= levels[i].half;
}

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

struct scene_dials
scene_budget_get_parameters(const struct scene_budget *budget, int level)
{
    struct scene_dials d = budget->asked;

    d.shadow_points = min_int(d.shadow_points, levels[level].points);
    d.edge_samples = min_int(d.edge_samples, levels[level].edge);
    d.half_shading = d.half_shading || levels[level].half;
    d.ward_samples = min_int(d.ward_samples, levels[level].samples);
    return d;
}

/* Returns the nearest level in direction BY (1 or -1) whose parameters
 * differ from those of budget->level, or budget->level if there is none. */
static int find_next_quality_level(const struct scene_budget *budget, int by)
{
    const struct scene_dials from =
        scene_budget_get_parameters(budget, budget->level);

    for (int i = budget->level + by; i >= 0 && i < SCENE_BUDGET_LEVELS;
         i += by) {
        const struct scene_dials to = scene_budget_get_parameters(budget, i);

        if (to.shadow_points != from.shadow_points ||
            to.edge_samples != from.edge_samples ||
            to.ward_samples != from.ward_samples ||
            to.half_shading != from.half_shading)
            return i;
    }
    return budget->level;
}

bool scene_budget_update_level(struct scene_budget *budget, double ms,
                               double limit_ms)
{
    /* The lower one of two times, because another program may slow down a
     * single frame. */
    const double low_ms = fmin(ms, budget->last_ms);
    const int before = budget->level;

    budget->last_ms = ms;
    /* The first frame of a level is not timed: it allocates memory. */
    if (!(ms > 0) || ++budget->n_frames < 2)
        return false;
    if (low_ms > limit_ms) {
        budget->level = find_next_quality_level(budget, 1);
        if (budget->is_try)
            budget->hold = min_int(MAX_HOLD, 2 * budget->hold);
        budget->is_try = false;
    } else if (budget->n_frames >= budget->hold) {
        if (budget->is_try)
            budget->hold = HOLD;
        if (low_ms < SPARE * limit_ms)
            budget->level = find_next_quality_level(budget, -1);
        budget->is_try = budget->level < before;
    }
    if (budget->level == before)
        return false;
    budget->n_frames = 0;
    return true;
}

/* The time of the flare does not show whether the flare needs more time,
 * because the flare uses all the time that the scene leaves. The quality of the
 * flare shows the need. */
double scene_budget_limit_flare(double all_ms, double flare_ms, double quality)
{
    const double rest_ms = all_ms - flare_ms, part_ms = FRACTION * all_ms;

    if (!(quality > 0))
        return fmax(MIN_FRACTION * all_ms, fmin(part_ms, rest_ms));
    return quality < levels[USUAL].quality ? part_ms : fmax(part_ms, rest_ms);
}

double scene_budget_get_flare_quality(const struct scene_budget *budget)
{
    const struct scene_dials d =
        scene_budget_get_parameters(budget, budget->level);
    int i = 0;

    while (i < SCENE_BUDGET_LEVELS - 1 && (levels[i].points > d.shadow_points ||
                                           levels[i].edge > d.edge_samples ||
                                           levels[i].samples > d.ward_samples ||
                                           levels[i].half < d.half_shading))
        i++;
    return levels[i].quality;
}

int scene_budget_find_level_of_quality(double quality)
{
    int i = 0;

    while (i < SCENE_BUDGET_LEVELS - 1 && levels[i].quality > quality)
        i++;
    return i;
}
