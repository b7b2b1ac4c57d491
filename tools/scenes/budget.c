/* SPDX-License-Identifier: MIT */
#include "scenes/budget.h"

#include <math.h>

/* frames from one look at what there is to do to the next */
#define BETWEEN 8
/* share of an error, in octaves, that one frame teaches; most that it can */
#define LEARNING   0.5
#define MOST_WRONG 1.0

/* Points of light and lookups of metal go first, as edges of shadows are little
 * of a picture and 4 lookups lose less than 2 dB, then places shaded, last the
 * outlines. QUALITY: of --quality, from which on it is drawn; DB: PSNR in the
 * mean of three scenes (scene_sweep at revision e8a4a84c). */
static const struct {
    int points, edge, samples;
    bool half, nearest;
    double quality, db;
} levels[SCENE_BUDGET_LEVELS] = {
    {16, 16, 32, false, false, 1, 48.4},  {4, 4, 8, false, false, 0.5, 46.1},
    {1, 4, 4, false, false, 0.375, 43.8}, {1, 4, 4, true, false, 0.25, 39.2},
    {1, 4, 4, true, true, 0.125, 39},     {1, 1, 4, true, true, 0, 36.5}};

enum { USUAL = 1 }; /* the level of the default quality */

/* Flares by quality: cost over that of the default, and PSNR in dB; means of
 * heliar-tronnier, double-gauss-angenieux and nikon-zoom-mid, 640x360, one
 * light (instructions by tools/report/sweep-insn, glint sweep --exact-grid 320,
 * at revision a3db91ca). */
enum { FLARES = 5 };
static const struct {
    double quality, ratio, db;
} flares[FLARES] = {{0, 0.58, 37.4},
                    {0.25, 0.81, 54.5},
                    {0.5, 1, 57.6},
                    {0.75, 2.4, 62.4},
                    {1, 6.3, 64.1}};

void scene_budget_init(struct scene_budget *budget,
                       const struct scene_dials *asked)
{
    struct scene_dials *const a = &budget->asked;
    struct glint_scene_config usual;

    *budget = (struct scene_budget){.asked = *asked, .ms_per_minsn = 0.1};
    glint_scene_defaults(&usual, asked->width, asked->height);
    a->edge_samples = a->edge_samples ? a->edge_samples : usual.edge_samples;
    a->shadow_points =
        a->shadow_points ? a->shadow_points : usual.shadow_points;
    a->ward_samples = a->ward_samples ? a->ward_samples : usual.ward_samples;
}

void scene_dials_be(struct scene_dials *dials, double quality)
{
    const int i = scene_budget_level(quality);

    if (i == USUAL)
        return;
    if (!dials->shadow_points)
        dials->shadow_points = levels[i].points;
    if (!dials->edge_samples)
        dials->edge_samples = levels[i].edge;
    if (!dials->ward_samples)
        dials->ward_samples = levels[i].samples;
    dials->half_shading |= levels[i].half;
    dials->ward_nearest |= levels[i].nearest;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

struct scene_dials scene_budget_dials(const struct scene_budget *budget,
                                      int level)
{
    struct scene_dials d = budget->asked;

    d.shadow_points = least(d.shadow_points, levels[level].points);
    d.edge_samples = least(d.edge_samples, levels[level].edge);
    d.half_shading = d.half_shading || levels[level].half;
    d.ward_samples = least(d.ward_samples, levels[level].samples);
    d.ward_nearest = d.ward_nearest || levels[level].nearest;
    return d;
}

bool scene_budget_looks(const struct scene_budget *budget)
{
    return budget->n_frames % BETWEEN == 0;
}

static void scale(int64_t *n, double by)
{
    *n = llrint((double)*n * by);
}

/* Returns how many fours of lookups a place on metal takes. */
static int fours_of(const struct scene_dials *dials)
{
    return (dials->ward_samples + 3) / 4;
}

/* Returns what a frame of ACCOUNT, drawn with the dials FROM, is told to cost
 * with the dials TO. */
static double told(const struct scene_account *account,
                   const struct scene_dials *from, const struct scene_dials *to)
{
    static const enum glint_scene_item at_samples[] = {
        GLINT_SCENE_LOOKED, GLINT_SCENE_SAMPLED, GLINT_SCENE_BOUNCED,
        GLINT_SCENE_PASSED};
    static const enum glint_scene_item at_places[] = {
        GLINT_SCENE_SHADED, GLINT_SCENE_MESHED, GLINT_SCENE_LIT,
        GLINT_SCENE_TEXELS, GLINT_SCENE_SKIES,  GLINT_SCENE_METALS,
        GLINT_SCENE_LOBES};
    static const enum glint_scene_item at_points[] = {
        GLINT_SCENE_SHADOWS, GLINT_SCENE_LISTED, GLINT_SCENE_RAYS,
        GLINT_SCENE_AIMED,   GLINT_SCENE_ASKED,  GLINT_SCENE_ENTERED,
        GLINT_SCENE_WALKED,  GLINT_SCENE_TRIED};
    struct scene_account then = *account;
    int64_t *const n = then.all.count;
    /* Two by two pixels at once are a quarter of the places inside, most. */
    const double half =
        (to->half_shading ? 0.3 : 1) / (from->half_shading ? 0.3 : 1);
    const double edge = (double)to->edge_samples / from->edge_samples;
    const double points = (double)to->shadow_points / from->shadow_points;
    const double fours =
        half * (double)fours_of(to) / fours_of(from) *
        (double)(n[GLINT_SCENE_FOURS] + n[GLINT_SCENE_NEAREST]);

    for (size_t i = 0; i < sizeof at_samples / sizeof *at_samples; i++)
        scale(&n[at_samples[i]], edge);
    for (size_t i = 0; i < sizeof at_places / sizeof *at_places; i++)
        scale(&n[at_places[i]], half);
    for (size_t i = 0; i < sizeof at_points / sizeof *at_points; i++)
        scale(&n[at_points[i]], half * points);
    n[GLINT_SCENE_FOURS] = to->ward_nearest ? 0 : llrint(fours);
    n[GLINT_SCENE_NEAREST] = to->ward_nearest ? llrint(fours) : 0;
    return scene_cost_minsn(&then);
}

enum glint_status scene_budget_look(struct scene_budget *budget,
                                    const struct scene_frame *frame)
{
    const struct scene_dials from = scene_budget_dials(budget, budget->level);
    struct scene_account account;
    const enum glint_status status = scene_account_make(&account, frame);

    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < SCENE_BUDGET_LEVELS; i++) {
        const struct scene_dials to = scene_budget_dials(budget, i);

        budget->minsn[i] = told(&account, &from, &to);
    }
    scene_account_free(&account);
    return GLINT_OK;
}

double scene_budget_flare_ms(double ms, double quality)
{
    int i = 0;
    double part;

    while (i < FLARES - 2 && flares[i + 1].quality < quality)
        i++;
    part = (quality - flares[i].quality) /
           (flares[i + 1].quality - flares[i].quality);
    return ms /
           (flares[i].ratio + part * (flares[i + 1].ratio - flares[i].ratio));
}

/* Returns the mean square of the difference that a PSNR of DB stands for. */
static double square_of(double db)
{
    return pow(10, -db / 10);
}

/* Returns the error of what draws with LEFT_MS of MS: of a flare, that takes
 * FLARE_MS at its default quality, or if that is 0 of nothing. What does not
 * fit counts above 1, the less so the less it is over. */
static double rest_error(double left_ms, double flare_ms, double ms)
{
    const double least_ms = flare_ms * flares[0].ratio;
    int i = 0;
    double at, part;

    if (left_ms < least_ms)
        return 1 + (least_ms - left_ms) / ms;
    if (!(flare_ms > 0))
        return 0;
    at = log2(left_ms / flare_ms);
    while (i < FLARES - 2 && log2(flares[i + 1].ratio) < at)
        i++;
    part = (at - log2(flares[i].ratio)) /
           log2(flares[i + 1].ratio / flares[i].ratio);
    return square_of(flares[i].db +
                     fmin(part, 1) * (flares[i + 1].db - flares[i].db));
}

bool scene_budget_choose(struct scene_budget *budget, double ms,
                         double flare_ms)
{
    const int before = budget->level;
    double least = HUGE_VAL;
    int level = SCENE_BUDGET_LEVELS - 1;

    for (int i = level; i >= 0; i--) {
        /* A finer level than now has to leave room, or they would alternate. */
        const double told_ms =
            budget->ms_per_minsn * budget->minsn[i] / (i < before ? 0.85 : 1);
        const double error =
            square_of(levels[i].db) + rest_error(ms - told_ms, flare_ms, ms);

        if (error < least) {
            least = error;
            level = i;
        }
    }
    budget->level = level;
    budget->predicted_ms = budget->ms_per_minsn * budget->minsn[level];
    return level != before;
}

void scene_budget_note(struct scene_budget *budget, double ms)
{
    /* The first frame takes memory. */
    if (budget->n_frames++ > 0 && ms > 0 && budget->predicted_ms > 0) {
        const double wrong = fmax(
            -MOST_WRONG, fmin(MOST_WRONG, log2(ms / budget->predicted_ms)));

        budget->ms_per_minsn *= exp2(LEARNING * wrong);
    }
}

double scene_budget_quality(const struct scene_budget *budget)
{
    const struct scene_dials d = scene_budget_dials(budget, budget->level);
    int i = 0;

    while (i < SCENE_BUDGET_LEVELS - 1 && (levels[i].points > d.shadow_points ||
                                           levels[i].edge > d.edge_samples ||
                                           levels[i].samples > d.ward_samples ||
                                           levels[i].half < d.half_shading ||
                                           levels[i].nearest < d.ward_nearest))
        i++;
    return levels[i].quality;
}

int scene_budget_level(double quality)
{
    int i = 0;

    while (i < SCENE_BUDGET_LEVELS - 1 && levels[i].quality > quality)
        i++;
    return i;
}
