/* SPDX-License-Identifier: MIT
 *
 * Makes candidates for lamps from the rows of a picture.
 *
 * Regions of all levels are linked first, by brightness alone. Then the light
 * of a row is summed, only where it belongs to a region that may still be a
 * lamp. */
#include "base/bytes.h"
#include "base/q.h"
#include "lamps/lamp_finder.h"

/* Regions are lit surfaces, not lamps, if less than 1 / 2^SEED_LOG2 of their
 * pixels reach the upper threshold. */
#define SEED_LOG2 3

/* Costs of levels, subtracted from the scores of their regions to choose among
 * regions that lie within each other. A lamp is taken to be as wide as it is at
 * the thresholds, unless its clipped core looks clearly more like a lamp. A
 * region of a white that is darker than codes clip counts only if nothing in it
 * is a lamp. DARK_SHARE: share of the picture above which such regions are not
 * sought. */
#define COST_CLIPPED_Q8 64
#define COST_WHITE_Q8   32
#define COST_DARK_Q8    1024
#define DARK_SHARE_Q15  Q_CONST(0.125, 15)

/* ------------------------------------------------------------------- levels */

/* Adds the level of regions at the thresholds, counted from LIGHT as white. */
static void add_level(struct glint_lamp_finder *f, int32_t light_q20)
{
    const struct glint_bright *b = &f->bright;
    struct glint_level *level = &f->level[f->n_levels++];

    level->low = glint_white_code(b, light_q20, f->cfg.threshold_low_q8);
    level->seed = glint_white_code(b, light_q20, f->cfg.threshold_high_q8);
    level->clipped = glint_white_code(b, light_q20, 0);
    level->cost_q8 = 0;
}

/* Adds two levels for a picture that is darker than white: regions at both
 * thresholds, and at the upper one alone. Adds none if more than DARK_SHARE of
 * the picture reaches the lower threshold. */
static void add_dark_level(struct glint_lamp_finder *f)
{
    if (!f->cfg.judge || f->white->light_q20 >= LINEAR_WHITE_Q20)
        return;
    add_level(f, f->white->light_q20);
    f->level[0].cost_q8 = COST_DARK_Q8;
    f->level[1] = f->level[0];
    f->level[1].low = f->level[1].seed;
    f->level[1].cost_q8 += COST_CLIPPED_Q8;
    f->n_levels = 2;
    if (glint_white_share_q15(f->white, f->level[0].low) > DARK_SHARE_Q15)
        f->n_levels = 0;
}

/* Adds the level of regions of brightness LOW and above, which are clipped in
 * one channel or in all. */
static void add_core(struct glint_lamp_finder *f, int low, int32_t cost_q8)
{
    f->level[f->n_levels++] =
        (struct glint_level){low, BRIGHT_CLIPPED, BRIGHT_CLIPPED, cost_q8};
}

/* Measures white and sets the levels. In a picture that is darker than where
 * codes clip, lamps may be darker than that or clipped: regions of both kinds
 * are sought. */
static void set_levels(struct glint_lamp_finder *f)
{
    const int white_code = f->cfg.white_code;
    struct glint_bright *b = &f->bright;

    glint_white_measure(f->white, b, f->cfg.height);
    if (f->white->light_q20 < f->least_white_q20)
        f->white->light_q20 = f->least_white_q20;
    f->least_white_q20 = 0;
    f->n_levels = 0;
    if (white_code) {
        add_level(f, b->curve->decode_q20[white_code]);
    } else {
        add_dark_level(f);
        add_level(f, LINEAR_WHITE_Q20);
    }
    if (f->cfg.judge) {
        add_core(f, BRIGHT_CLIPPED, COST_CLIPPED_Q8);
        add_core(f, BRIGHT_WHITE, COST_WHITE_Q8);
        add_core(f, BRIGHT_HOT, 0);
    }
    glint_bright_set_low(b, f->level[0].low);
}

/* --------------------------------------------------------------- candidates */

static int is_light(const struct glint_lamp_finder *f,
                    const struct glint_region *sum)
{
    return sum->area >= f->cfg.min_area && sum->n_seeds > 0 &&
           sum->n_seeds >= sum->area >> SEED_LOG2;
}

/* Returns whether SUM is large enough to be the remains of a lamp. */
static int is_faint(const struct glint_lamp_finder *f,
                    const struct glint_region *sum)
{
    return f->cfg.keep_faint && sum->area >= (f->cfg.min_area + 1) / 2;
}

/* Keeps SUM as a candidate if it qualifies. */
static void offer(void *finder, const struct glint_region *sum)
{
    struct glint_lamp_finder *f = finder;
    const int light = is_light(f, sum);

    if (sum->area <= f->max_area && (light || is_faint(f, sum)))
        glint_lamps_hold(f,
                         &(struct glint_candidate){.sum = *sum,
                                                   .level = (int16_t)f->at,
                                                   .faint = (uint8_t)!light});
}

/* --------------------------------------------------------------------- rows */

/* Returns how many of N values are CODE or more. */
static WHOLLY_INLINE int count_from(const uint8_t *value, int n, int code,
                                    int is_above_128)
{
    uint32_t found = 0;

    for (; n >= 8; value += 8, n -= 8)
        found +=
            bytes_count(bytes_reach(bytes_load(value), code, is_above_128));
    for (int i = 0; i < n; i++)
        found += value[i] >= code;
    return (int)found;
}

/* Returns how many pixels of RUN, all of which are LEAST or more, are CODE or
 * more. */
static int count_of_run(const uint8_t *value, const struct glint_run *run,
                        int least, int code)
{
    const int all = run->x1 - run->x0;

    if (code <= least)
        return all;
    return code > 128 ? count_from(value + run->x0, all, code, 1)
                      : count_from(value + run->x0, all, code, 0);
}

/* Adds RUN of row Y to the area, the box and the counts of SUM, without its
 * light. */
static void count_run(struct glint_region *sum,
                      const struct glint_lamp_finder *f,
                      const struct glint_run *run, int y)
{
    const struct glint_level *level = &f->level[f->at];
    const uint8_t *value = f->bright.value;

    glint_region_add_run(sum, run->x0, run->x1, y);
    sum->n_seeds += count_of_run(value, run, level->low, level->seed);
    sum->n_clipped += count_of_run(value, run, level->low, level->clipped);
}

/* Notes that the light of RUN is needed, in the run of the first level that
 * contains it: *OUTER or a later one. */
static void want(struct glint_run **outer, const struct glint_run *run)
{
    while ((*outer)->x1 <= run->x0)
        ++*outer;
    if ((*outer)->want1 == 0 || run->x0 < (*outer)->want0)
        (*outer)->want0 = run->x0;
    if (run->x1 > (*outer)->want1)
        (*outer)->want1 = run->x1;
}

/* Returns whether the region may be a lamp, which is not larger than max_area.
 */
static int may_be_light(const struct glint_lamp_finder *f,
                        const struct glint_region *sum)
{
    return sum->area <= f->max_area;
}

static void link_level(struct glint_lamp_finder *f, int greatest, int y)
{
    struct glint_regions *r = &f->regions[f->at];
    const int low = f->level[f->at].low;
    struct glint_run *outer = f->regions[0].here.run;

    if (greatest < low)
        return;
    glint_regions_link_row(r, &f->bright, low, y);
    for (int i = 0; i < r->here.n_runs; i++) {
        struct glint_region *sum = glint_regions_of_run(r, i);

        count_run(sum, f, &r->here.run[i], y);
        if (may_be_light(f, sum))
            want(&outer, &r->here.run[i]);
    }
}

/* Sums the light of the row where a region of any level needs it. */
static void sum_row(struct glint_lamp_finder *f)
{
    const struct glint_run_row *row = &f->regions[0].here;
    const int last = f->cfg.width - ROW_LIGHT_RIM;

    glint_row_light_begin(&f->row);
    for (int i = 0; i < row->n_runs; i++) {
        const struct glint_run *run = &row->run[i];
        const int x0 = run->want0, x1 = run->want1;

        if (x1 > 0)
            glint_row_light_extend(&f->row, &f->bright,
                                   x0 > ROW_LIGHT_RIM ? x0 - ROW_LIGHT_RIM : 0,
                                   x1 < last ? x1 + ROW_LIGHT_RIM
                                             : f->cfg.width);
    }
}

static void light_level(struct glint_lamp_finder *f, int y)
{
    struct glint_regions *r = &f->regions[f->at];

    for (int i = 0; i < r->here.n_runs; i++) {
        struct glint_region *sum = glint_regions_of_run(r, i);
        const struct glint_run *run = &r->here.run[i];

        if (may_be_light(f, sum))
            glint_row_light_add(&f->row, sum, run->x0, run->x1, f->cfg.width,
                                y);
    }
    if (r->n_active > 0)
        glint_regions_end_row(r, offer, f, y);
}

static void take_row(struct glint_lamp_finder *f, int y)
{
    const int greatest = glint_bright_scan(&f->bright, y);

    for (f->at = 0; f->at < f->n_levels; f->at++)
        link_level(f, greatest, y);
    sum_row(f);
    for (f->at = 0; f->at < f->n_levels; f->at++)
        light_level(f, y);
}

void glint_lamps_collect(struct glint_lamp_finder *f,
                         const struct glint_image *image)
{
    f->n = f->dropped = 0;
    glint_bright_begin(&f->bright, image);
    set_levels(f);
    for (f->at = 0; f->at < f->n_levels; f->at++)
        glint_regions_begin(&f->regions[f->at]);
    for (int y = 0; y < f->cfg.height; y++)
        take_row(f, y);
    for (f->at = 0; f->at < f->n_levels; f->at++)
        glint_regions_end_row(&f->regions[f->at], offer, f, f->cfg.height);
}
