/* SPDX-License-Identifier: MIT */
#include "engine/frame/cost.h"

#include <math.h>

#include "glint/quality.h"
#include "glint/bake.h"

/* cost of adding light to four pixels at half resolution / cost of adding it to
 * one pixel */
#define QUAD 2

/* number of irradiance steps per octave that the cost model assumes if
 * irradiance is not rounded */
#define MOST_STEPS 4096

/* For stops with dust or masks, which subdivide grid cells. MOST_LOG2: log2 of
 * the max number of sub-cells per side of a cell. SAMPLES: number of positions
 * per side of the stop at which sub-cells are counted. */
enum { MOST_LOG2 = 4, SAMPLES = 24 };

/* Weights by make cost-fit: least squares of the relative errors over random
 * frames. callgrind counts the instructions of the second drawing of each
 * frame, so that no frame is binned twice. tests/figures/cost/plans.md
 * has the errors. Column planned: for the counts that glint_cost_of() predicts;
 * column counted: for the counts of a drawn frame. */
/* clang-format off */
const struct glint_cost_weight glint_cost_weight[GLINT_COST_KINDS] = {
    /* begin weights */
    {"looking", 1.32, 1.12},
    {"bundles", 23.4, 46.9},
    {"vertices", 0.468, 0},
    {"edges", 1.29, 1.92},
    {"rows", 0.027, 0.027},
    {"dust", 1.36, 0.556},
    {"lit pixels", 0.0849, 0.0554},
    {"star", 0.32, 0.32},
    {"veil", 0.181, 0.132},
    /* end weights */
};
/* clang-format on */

double glint_cost_convert_to_minsn(const struct glint_cost *cost)
{
    double sum = 0;

    for (int k = 0; k < GLINT_COST_KINDS; k++)
        sum += glint_cost_weight[k].planned * cost->count[k];
    return 1e-3 * sum;
}

/* assumed number of cells per side that a grid of GLINT_LEAST_CELLS, the
 * minimum, would have without the minimum */
enum { LESS_CELLS = 6 };

/* Predicts the number of grid cells per side at FINER times the fineness of the
 * plan. PLANNED is the number at the plan's fineness. */
static double predict_cells_per_side(int planned, double finer)
{
    const double free =
        planned > GLINT_LEAST_CELLS || finer <= 1 ? planned : LESS_CELLS;

    return fmax(GLINT_LEAST_CELLS, fmin(free * finer, GLINT_MAX_CELLS));
}

/* ------------------------------------------------------------------ bundles */

/* The predicted grid and light of a planned ray bundle for other quality
 * parameters. */
struct bundle {
    double cells;  /* per side */
    double light;  /* display white */
    double area;   /* pixels that the ghost covers, on-screen or not */
    double inside; /* fraction of the rays that are not vignetted */
    double view;   /* fraction of the ghost's bounding box that is on-screen */
    double log_bright; /* natural logarithm of (max light / mean light of the
                          ghost), which affects the number of edges */
    double rings;      /* number of nested outlines of a soft edge; 1 for a hard
                          edge */
    double share;      /* expected number of ray bundles drawn per planned
                          bundle; below 1 if dim ghosts share rays */
};

/* Returns the number of steps per octave to which the irradiance of a ghost is
 * rounded. The ghost is OCTAVES fainter than white, the picture has 8-bit
 * codes, and STEPS is the number for white. */
static double compute_steps_per_octave(int steps, double octaves)
{
    return octaves > 0 ? steps * pow(7. / 8, octaves) : steps;
}

/* Predicts the number of nested outlines that draw the soft edge of the stop in
 * the ghost of B (edges/ghost_rings.c). */
static double count_soft_edge_outlines(const struct glint_cost_plan *p,
                                       const struct bundle *b)
{
    const double octaves = fmax(0, -log2(b->light));
    const double soft =
        p->shade ? p->shade->soft_q16 * 0x1p-16 * sqrt(b->area) : 0;
    double most = 4;

    if (p->shade == NULL || p->shade->soft_q16 == 0)
        return 1;
    if (p->code > 0)
        most = fmin(most, 8 - floor(octaves * 5 / 12));
    most = fmin(most, floor(log2(fmax(soft, 1))));
    return exp2(fmax(most, 0));
}

/* Returns how many ray bundles are expected to be drawn per planned bundle B if
 * the wavelengths of ghosts dimmer than DIM codes share rays. B was planned
 * when those of ghosts dimmer than WAS codes shared rays. */
static double estimate_drawn_fraction(const struct glint_cost_plan *p,
                                      const struct glint_planned *b,
                                      double light, double was, double dim)
{
    enum { WAVES = 3, MIDDLE = 1 };
    const double codes = p->code > 0 ? light / p->code : HUGE_VAL;

    if (!p->can_dim)
        return 1;
    if (dim > was && codes < dim && codes >= was)
        return b->wave == MIDDLE ? 1 : 0;
    if (dim < was && codes < was && codes >= dim)
        return b->wave == MIDDLE ? WAVES : 1;
    return 1;
}

/* ------------------------------------------------------------------- counts */

/* This function estimates the number of edges of a ray bundle; the next
 * function estimates the number of pixel rows that these edges cross. Both are
 * products of powers, fitted to the bundles of 48 random frames of four lenses
 * (Poisson regression). Sums over a frame have a median error of 15 percent. */
static double estimate_edge_count(const struct bundle *b, double log_steps)
{
    const double n = log(b->cells);

    return exp(0.85 + 1.5 * n + 0.06 * log_steps + 0.17 * log(b->inside) +
               0.6 * log(b->view) + 0.15 * b->log_bright);
}

static double estimate_edge_row_count(const struct bundle *b, double log_steps,
                                      double height)
{
    return exp(0.55 + 0.91 * log(b->cells) + 0.058 * log_steps +
               0.461 * log1p(b->area) - 0.183 * log(height) -
               0.254 * log(b->inside) + 0.564 * log(b->view) +
               0.293 * b->log_bright);
}

/* Predicts how planned ray bundle B would be drawn with the quality parameters
 * THEN. LARGER is the factor by which the number of pixels changes. */
static struct bundle predict_bundle_at_quality(const struct glint_cost_plan *p,
                                               const struct glint_planned *b,
                                               const struct glint_dials *then,
                                               double larger)
{
    enum { FOLD = 255 };
    const double light = glint_real_value(b->irradiance);
    const double finer = (double)then->fineness / p->dials.fineness;
    struct bundle to = {
        .cells = predict_cells_per_side(b->n_cells, finer),
        .light = light,
        .area = light > 0 ? larger * glint_real_value(b->flux) / light : 0,
        .inside = fmax(b->inside_q8, 1) / 255,
        .view = fmax(b->view_q8, 1) / 255,
        .log_bright = b->contrast_q4 == FOLD ? 4 : b->contrast_q4 / 16.};

    to.rings = count_soft_edge_outlines(p, &to);
    to.share = estimate_drawn_fraction(p, b, light, p->dials.dim_codes,
                                       then->dim_codes);
    return to;
}

/* The grid cells of a ghost, if the stop has dust or masks. */
struct cells {
    double cells;  /* number of the ghost's cells per side */
    double light;  /* display white */
    double area;   /* pixels that the ghost covers */
    double inside; /* fraction of the cells that lie within the stop */
    double view; /* fraction of the cells within the stop that are on-screen */
};

/* Returns (smallest visible difference from LIGHT) / LIGHT. */
static double compute_visible_step(const struct glint_cost_plan *p,
                                   double light)
{
    return p->code > 0
               ? fmax(0.0094 * pow(2. / 3, fmax(0, -log2(light))), 0.0003) /
                     light
               : 1. / 128;
}

static int clamp_int(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* Returns the mean number of sub-cells into which dust or masks divide a cell,
 * over SAMPLES^2 positions in the stop. LEVEL: mip level of the tables of the
 * stop's transmission S; STEP: smallest visible difference; MOST: max log2 of
 * the sub-cells per side; CUT: fraction of the cells that the stop's outline
 * cuts. */
static double compute_mean_subdivisions_per_cell(const struct glint_shade *s,
                                                 int level, double step,
                                                 int most, double cut)
{
    enum {
        CUT_LOG2 = 3, /* max log2_parts of a cell that the outline cuts */
        ALONE = 4 /* factor for such cells, as their sub-cells share no edges */
    };
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
        /* The number of sub-cells per side is d rounded up to a power of 2. */
        for (; d >= 1 && log2_parts < most; log2_parts++)
            d /= 2;
        if (log2_parts)
            sum += (1 - cut) * exp2(2 * log2_parts) +
                   cut * ALONE * exp2(2 * clamp_int(log2_parts, 0, CUT_LOG2));
    }
    return n ? sum / n : 0;
}

/* Estimates the total number of sub-cells into which the dust and masks of PLAN
 * divide the cells G. Only tables with at most 2^LOG2_USED cells per side are
 * used. */
static double
estimate_cell_subdivision_count(const struct glint_cost_plan *plan,
                                const struct cells *g, int log2_used)
{
    const struct glint_shade *s = plan->shade;
    const int skipped =
        s->log2 - clamp_int(log2_used, GLINT_SHADE_LEAST_LOG2, s->log2);
    const double n2 = g->cells * g->cells;
    /* length of a cell's side, in stop radii (side) and in pixels (px) */
    const double side = sqrt(3.14 / (n2 * g->inside));
    const double px = sqrt(g->area / n2);
    const int level = clamp_int((int)floor(log2(side * (1 << (s->log2 - 1)))),
                                skipped, s->log2 - 1);
    int most = clamp_int(level - skipped + 1, 0, MOST_LOG2);

    if (g->light <= 0 || px < 1)
        return 0;
    most = clamp_int((int)floor(log2(px)), 0, most);
    return n2 * g->inside * g->view *
           compute_mean_subdivisions_per_cell(
               s, level, compute_visible_step(plan, g->light), most,
               fmin(1, 4 / sqrt(n2 * g->inside)));
}

static void add_bundle_cost(struct glint_cost *cost,
                            const struct glint_cost_plan *p,
                            const struct glint_dials *then,
                            const struct bundle *b, double height)
{
    const double drawn = b->share * b->rings;
    const double log_steps = log1p(
        then->irradiance_steps
            ? compute_steps_per_octave(then->irradiance_steps, -log2(b->light))
            : MOST_STEPS);
    const double edges = estimate_edge_count(b, log_steps);

    cost->count[GLINT_COST_BUNDLES] += b->share;
    cost->count[GLINT_COST_VERTICES] += drawn * (b->cells + 1) * (b->cells + 1);
    cost->count[GLINT_COST_EDGES] += drawn * edges;
    cost->count[GLINT_COST_ROWS] +=
        drawn * estimate_edge_row_count(b, log_steps, height);
    if (p->shade && p->shade->log2)
        cost->count[GLINT_COST_PARTS] +=
            drawn * estimate_cell_subdivision_count(
                        p,
                        &(struct cells){b->cells, b->light / b->rings, b->area,
                                        b->inside, b->view},
                        then->dust_log2);
}

/* The area that ghosts cover. A ghost counts once for all its wavelengths. */
struct covered {
    int ghost, light;
    double most, all; /* pixels; most: area of the current ghost, max over its
                         wavelengths; all: total area of the earlier ghosts */
};

static void add_ghost_covered_area(struct covered *c,
                                   const struct glint_planned *p,
                                   const struct bundle *b)
{
    const double here = b->share * b->area * b->inside * b->view;

    if (p->ghost != c->ghost || p->light != c->light) {
        c->all += c->most;
        c->most = 0;
    }
    c->ghost = p->ghost;
    c->light = p->light;
    c->most = fmax(c->most, here);
}

struct glint_cost glint_cost_of(const struct glint_cost_plan *p,
                                const struct glint_dials *then)
{
    const bool half = glint_dials_half(then) && p->can_half;
    const bool was_half = glint_dials_half(&p->dials) && p->can_half;
    const double width = p->width / (half ? 2. : 1);
    const double height = p->height / (half ? 2. : 1);
    /* number of pixels with the parameters THEN / number of pixels of the plan
     */
    const double larger = pow(4, was_half - half);
    const int every = p->every > 1 ? p->every : 1;
    struct glint_cost cost = {{p->n_looked_at}};
    struct glint_planned b;
    struct covered covered = {-1, -1, 0, 0};

    for (int i = 0; p->flare && glint_flare_planned(p->flare, i, &b);
         i += every) {
        struct bundle here = predict_bundle_at_quality(p, &b, then, larger);

        here.share *= every;
        if (!(here.light > 0) || !(here.share > 0))
            continue;
        add_bundle_cost(&cost, p, then, &here, height);
        add_ghost_covered_area(&covered, &b, &here);
    }
    covered.all += covered.most;
    cost.count[GLINT_COST_LIT] = width * height *
                                 (1 - exp(-covered.all / (width * height))) *
                                 (half ? QUAD : 1);
    cost.count[GLINT_COST_STAR] = p->n_star;
    cost.count[GLINT_COST_VEIL] =
        then->flags & GLINT_DIAL_NO_VEIL ? 0 : p->n_veil;
    return cost;
}
