/* SPDX-License-Identifier: MIT
 *
 * Makes lamps of the regions of a picture.
 *
 * A region that qualifies becomes a candidate. The brightest LIGHT_CANDIDATES
 * are kept, and none are merged before all have been found. */
#include "glint/lamps.h"

#include "base/arena.h"
#include "base/q.h"
#include "lamps/lamp_finder.h"

#define MAX_SPOTS 1024
#define EV_MIN_Q8 (-20 * 256)

/* ------------------------------------------------------------------- memory */

static int is_valid(const struct glint_lamp_finder_config *c)
{
    return c->width >= 1 && c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->threshold_low_q8 >= EV_MIN_Q8 &&
           c->threshold_low_q8 <= c->threshold_high_q8 &&
           c->threshold_high_q8 <= 0 && c->white_code >= 0 &&
           c->white_code <= 255 && c->judge >= 0 && c->judge <= 1 &&
           c->min_area >= 1 && c->max_share_q15 >= 0 &&
           c->max_share_q15 <= 1 << 15 && c->merge_q15 >= 0 &&
           c->merge_q15 <= 1 << 15 && c->keep_faint >= 0 && c->keep_faint <= 1;
}

/* Takes a finder and its tables from A, once to measure and once to place it.
 * Returns NULL if A measures or is full. */
static struct glint_lamp_finder *carve(struct glint_arena *a,
                                       const struct glint_lamp_finder_config *c)
{
    struct glint_lamp_finder *placed = glint_arena_take(a, 1, sizeof *placed);
    struct glint_lamp_finder measured;
    struct glint_lamp_finder *f = placed ? placed : &measured;

    glint_bright_carve(&f->bright, a, c->width);
    for (int i = 0; i < LIGHT_LEVELS; i++)
        glint_regions_carve(&f->regions[i], a, c->width);
    glint_row_light_carve(&f->row, a, c->width);
    f->white = glint_arena_take(a, 1, sizeof *f->white);
    f->candidate =
        glint_arena_take(a, LIGHT_CANDIDATES + 1, sizeof *f->candidate);
    f->order = glint_arena_take(a, LIGHT_CANDIDATES, sizeof *f->order);
    return a->used <= a->size ? placed : NULL;
}

void glint_lamp_finder_defaults(struct glint_lamp_finder_config *cfg, int width,
                                int height)
{
    const int pixels = width * height; /* 2^30 at most */

    *cfg = (struct glint_lamp_finder_config){
        .width = width,
        .height = height,
        .threshold_high_q8 = -26,
        .threshold_low_q8 = -38,
        .judge = 1,
        .min_area = pixels < 1 << 19 ? 2 : pixels >> 18,
        .max_share_q15 = Q_CONST(0.25, 15),
        .merge_q15 = Q_CONST(0.01, 15)};
}

size_t glint_lamp_finder_bytes(const struct glint_lamp_finder_config *cfg)
{
    struct glint_arena measured = glint_arena_measure();

    if (!is_valid(cfg))
        return 0;
    carve(&measured, cfg);
    return measured.used;
}

enum glint_status
glint_lamp_finder_init(struct glint_lamp_finder **finder,
                       const struct glint_lamp_finder_config *cfg, void *mem,
                       size_t bytes)
{
    struct glint_arena arena = glint_arena_over(mem, bytes);
    struct glint_lamp_finder *f;
    int64_t merge_q8;

    if (!is_valid(cfg) || (uintptr_t)mem % GLINT_ALIGN)
        return GLINT_E_ARGUMENT;
    f = carve(&arena, cfg);
    if (!f)
        return GLINT_E_MEMORY;
    f->cfg = *cfg;
    glint_bright_init(&f->bright, cfg->width);
    f->n = f->dropped = 0;
    f->white->light_q20 = f->least_white_q20 = 0;
    f->alone_q8 = SCORE_ALONE;
    merge_q8 = q_shift((int64_t)cfg->width * cfg->merge_q15, 7);
    f->merge2_q16 = merge_q8 * merge_q8;
    f->max_area =
        q_shift((int64_t)cfg->width * cfg->height * cfg->max_share_q15, 15);
    *finder = f;
    return GLINT_OK;
}

/* -------------------------------------------------------------------- score */

/* Keeps candidates that score as lamps, and with keep_faint, marked faint,
 * those that score a little less. */
static void judge(struct glint_lamp_finder *f)
{
    const struct glint_score score = {&f->bright,    f->white, f->cfg.width,
                                      f->cfg.height, f->level, 1,
                                      f->alone_q8};
    const int n = f->n;
    int32_t least_q8;

    glint_score_all(&score, f->candidate, f->order, n);
    least_q8 = glint_score_least(&score, f->candidate, f->order, n);
    f->n = 0;
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        c->faint |= c->score_q8 < least_q8;
        if (c->score_q8 >= (f->cfg.keep_faint ? -SCORE_DOUBT : least_q8))
            f->order[f->n++] = f->order[i];
    }
    glint_score_choose(&score, f->candidate, f->order, f->n);
    glint_lamps_compact(f);
}

/* ------------------------------------------------------------------- result */

/* Returns the spot of CANDIDATE. Coordinates of spots count from the corner of
 * the first pixel, those of regions from its centre. */
static struct glint_spot spot_of(const struct glint_candidate *candidate)
{
    const struct glint_region *sum = &candidate->sum;
    struct glint_spot s = {.size_q8 = glint_region_radius_q8(sum),
                           .area = sum->area,
                           .n_clipped = sum->n_clipped,
                           .flux_q16 = sum->w_q14 * 4,
                           .faint = candidate->faint,
                           .power_q16 = sum->w_q14 * 4,
                           .cos_q15 = 1 << 15};

    glint_region_centroid(sum, &s.x_q8, &s.y_q8);
    s.x_q8 += 128;
    s.y_q8 += 128;
    glint_region_colour(sum, s.rgb_q15);
    s.axis_q8[0] = s.axis_q8[1] = q_mul(s.size_q8, Q_CONST(0.70711, 15), 15);
    return s;
}

int glint_lamp_finder_find(struct glint_lamp_finder *finder,
                           const struct glint_image *image,
                           struct glint_spot *spots, int max)
{
    glint_lamps_collect(finder, image);
    if (finder->cfg.judge)
        judge(finder);
    finder->alone_q8 = SCORE_ALONE;
    glint_lamps_merge(finder);
    glint_lamps_cap(finder, max < MAX_SPOTS ? max : MAX_SPOTS);
    for (int i = 0; i < finder->n; i++)
        spots[i] = spot_of(&finder->candidate[finder->order[i]]);
    return finder->n;
}

void glint_lamp_finder_keep_white(struct glint_lamp_finder *finder,
                                  int32_t part_q15)
{
    finder->least_white_q20 = q_mul(finder->white->light_q20, part_q15, 15);
    finder->alone_q8 = SCORE_ALONE_VIDEO;
}

int glint_lamp_finder_dropped(const struct glint_lamp_finder *finder)
{
    return finder->dropped;
}
