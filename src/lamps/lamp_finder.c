/* SPDX-License-Identifier: MIT
 *
 * Finds lamps among the bright regions of a picture.
 *
 * The picture is read row by row, at several levels of brightness. For each
 * level, the runs of bright pixels in the row are first joined to the regions
 * above it. Then the light of the row's pixels is summed, but only for regions
 * that are still small enough for a lamp. A finished region that qualifies
 * becomes a candidate. Only the brightest LIGHT_CANDIDATES candidates are
 * stored. They are merged after all regions have been found. */
#include "glint/lamps.h"

#include "base/arena.h"
#include "base/bytes.h"
#include "base/q.h"
#include "base/sort.h"
#include "lamps/lamp_finder.h"

#define MAX_SPOTS 1024
#define EV_MIN_Q8 (-20 * 256)

/* Default thresholds of brightness, log2 of light / white in 1/256. */
enum { DEFAULT_HIGH_Q8 = -26, DEFAULT_LOW_Q8 = -38 };

/* -------------------------------------------------------------------- list */

/* Max distance, in merge distances, of a remaining lamp into which a lamp is
 * merged if there are too many. */
#define JOIN_REACH 4

static int is_candidate_brighter(const struct glint_lamp_finder *f, int32_t a,
                                 int32_t b)
{
    const struct glint_candidate *p = &f->candidate[a], *q = &f->candidate[b];

    if (p->faint != q->faint)
        return q->faint;
    return p->sum.w_q14 != q->sum.w_q14 ? p->sum.w_q14 > q->sum.w_q14
                                        : p->sum.first < q->sum.first;
}

static int is_before_in_flux_order(const void *finder, int a, int b)
{
    const struct glint_lamp_finder *const f = finder;

    return is_candidate_brighter(f, f->order[a], f->order[b]);
}

static void swap_candidates(void *finder, int a, int b)
{
    const struct glint_lamp_finder *const f = finder;
    const int32_t old = f->order[a];

    f->order[a] = f->order[b];
    f->order[b] = old;
}

/* Returns a heap of candidates with the faintest candidate at its root. */
static struct glint_heap make_candidate_heap(struct glint_lamp_finder *f)
{
    return (struct glint_heap){is_before_in_flux_order, swap_candidates, f};
}

static void sort_candidates_by_flux(struct glint_lamp_finder *f)
{
    const struct glint_heap heap = make_candidate_heap(f);

    glint_heap_sort(&heap, f->n);
}

/* Adds CANDIDATE. If there are more than LIGHT_CANDIDATES then, removes the
 * faintest. */
static void add_candidate(struct glint_lamp_finder *f,
                          const struct glint_candidate *candidate)
{
    const struct glint_heap heap = make_candidate_heap(f);
    struct glint_candidate *last = &f->candidate[LIGHT_CANDIDATES];

    if (f->n < LIGHT_CANDIDATES) {
        f->candidate[f->n] = *candidate;
        f->order[f->n] = f->n;
        f->n++;
        if (f->n == LIGHT_CANDIDATES)
            glint_heap_build(&heap, f->n);
        return;
    }
    *last = *candidate;
    if (is_candidate_brighter(f, LIGHT_CANDIDATES, f->order[0])) {
        const struct glint_candidate out = f->candidate[f->order[0]];

        f->candidate[f->order[0]] = *last;
        *last = out;
        glint_heap_restore_order(&heap, 0, f->n);
    }
    f->dropped += !last->faint;
}

/* Removes the candidates whose member gone is set from f->order. */
static void remove_gone_candidates(struct glint_lamp_finder *f)
{
    const int n_before = f->n;

    f->n = 0;
    for (int i = 0; i < n_before; i++)
        if (!f->candidate[f->order[i]].gone)
            f->order[f->n++] = f->order[i];
}

/* ------------------------------------------------------------------ merging */

static void compute_candidate_positions(struct glint_lamp_finder *f)
{
    for (int i = 0; i < f->n; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        glint_region_compute_centroid(&c->sum, &c->x_q8, &c->y_q8);
        c->gone = 0;
    }
}

/* Returns the number of candidates that are not faint; they come first, as
 * candidates are sorted. */
static int count_certain_lamps(const struct glint_lamp_finder *f)
{
    int n = f->n;

    while (n > 0 && f->candidate[f->order[n - 1]].faint)
        n--;
    return n;
}

static int64_t compute_squared_distance_q16(const struct glint_candidate *a,
                                            const struct glint_candidate *b)
{
    const int64_t dx_q8 = a->x_q8 - b->x_q8, dy_q8 = a->y_q8 - b->y_q8;

    return dx_q8 * dx_q8 + dy_q8 * dy_q8;
}

/* Merges CANDIDATE into INTO. The position of INTO is then outdated, and
 * compute_candidate_positions() must be called. */
static void merge_candidate(struct glint_candidate *candidate,
                            struct glint_candidate *into)
{
    glint_region_add_region(&into->sum, &candidate->sum);
    candidate->gone = 1;
}

/* Merges each lamp, the brightest first, with the fainter lamps within the
 * merge distance. Returns whether any lamps were merged. */
static int merge_near_lamps_once(struct glint_lamp_finder *f)
{
    const int n_before = f->n;
    int n_lights;

    sort_candidates_by_flux(f);
    compute_candidate_positions(f);
    n_lights = count_certain_lamps(f);
    for (int i = 0; i < n_lights; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        for (int j = i + 1; j < n_lights && !c->gone; j++) {
            struct glint_candidate *other = &f->candidate[f->order[j]];

            if (!other->gone &&
                compute_squared_distance_q16(c, other) < f->merge2_q16)
                merge_candidate(other, c);
        }
    }
    remove_gone_candidates(f);
    return f->n < n_before;
}

/* Sorts the candidates by descending flux, and merges lamps until no two are
 * within the merge distance of each other. Faint candidates are not merged. */
static void merge_all_near_lamps(struct glint_lamp_finder *f)
{
    while (merge_near_lamps_once(f))
        ;
}

/* Returns the candidate nearest to C among the first MAX candidates. Returns
 * NULL if it is not within JOIN_REACH merge distances. */
static struct glint_candidate *
find_nearest_kept_lamp(const struct glint_lamp_finder *f,
                       const struct glint_candidate *c, int max)
{
    int64_t best_q16 = JOIN_REACH * JOIN_REACH * f->merge2_q16;
    struct glint_candidate *best = NULL;

    for (int i = 0; i < max; i++) {
        struct glint_candidate *kept = &f->candidate[f->order[i]];
        const int64_t d_q16 = compute_squared_distance_q16(c, kept);

        if (d_q16 < best_q16) {
            best_q16 = d_q16;
            best = kept;
        }
    }
    return best;
}

/* Reduces the candidates to the first MAX. Each excess lamp is merged into the
 * nearest of these within JOIN_REACH merge distances. If there is none, it is
 * dropped, as are excess faint candidates. */
static void reduce_lamps_to_max(struct glint_lamp_finder *f, int max)
{
    const int n_lights = count_certain_lamps(f);

    for (int i = max; i < n_lights; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];
        struct glint_candidate *kept = find_nearest_kept_lamp(f, c, max);

        if (kept)
            merge_candidate(c, kept);
        else
            f->dropped++;
    }
    if (f->n > max)
        f->n = max;
    sort_candidates_by_flux(f);
}

/* ------------------------------------------------------------------- levels */

/* log2 of (area of a region / min number of its pixels at the upper brightness
 * threshold); a region with fewer such pixels is a lit surface, not a lamp */
#define SEED_LOG2 3

/* Costs of brightness levels. Of nested regions, the finder chooses the one
 * with the highest score minus the cost of its level. Regions at the configured
 * thresholds, which have the lamp's full width, are thus preferred to the
 * lamp's clipped core unless the score of the core is clearly higher. Regions
 * of a level whose white is below clipping, or whose thresholds are below the
 * defaults, are chosen only if they contain no other lamp. DARK_SHARE: max
 * fraction of the picture at or above the lower threshold for which levels with
 * a white below clipping are used. */
#define COST_CLIPPED_Q8 64
#define COST_WHITE_Q8   32
#define COST_DARK_Q8    1024
#define COST_LOWER_Q8   4096
#define DARK_SHARE_Q15  Q_CONST(0.125, 15)

/* Thresholds of brightness, log2 of light / white in 1/256. */
struct thresholds {
    int32_t high_q8, low_q8;
};

static int is_threshold_below_default(const struct glint_lamp_finder_config *c)
{
    return c->judge && (c->threshold_high_q8 < DEFAULT_HIGH_Q8 ||
                        c->threshold_low_q8 < DEFAULT_LOW_Q8);
}

/* Adds a brightness level, whose regions consist of pixels above the thresholds
 * T, relative to the white LIGHT. */
static void add_threshold_level(struct glint_lamp_finder *f, int32_t light_q20,
                                struct thresholds t, int32_t cost_q8)
{
    const struct glint_bright *b = &f->bright;
    struct glint_level *level = &f->level[f->n_levels++];

    level->low = glint_white_find_code(b, light_q20, t.low_q8);
    level->seed = glint_white_find_code(b, light_q20, t.high_q8);
    level->clipped = glint_white_find_code(b, light_q20, 0);
    level->cost_q8 = cost_q8;
}

/* Adds two brightness levels for a picture whose white is below clipping:
 * pixels above the lower, and above the upper threshold. Adds none if regions
 * are not scored (judge is 0), or more than DARK_SHARE of the picture reaches
 * the lower threshold. */
static void add_dark_picture_levels(struct glint_lamp_finder *f,
                                    struct thresholds t, int32_t cost_q8)
{
    struct glint_level *level = &f->level[f->n_levels];

    if (!f->cfg.judge || f->white->light_q20 >= LINEAR_WHITE_Q20)
        return;
    add_threshold_level(f, f->white->light_q20, t, cost_q8 + COST_DARK_Q8);
    level[1] = level[0];
    level[1].low = level[1].seed;
    level[1].cost_q8 += COST_CLIPPED_Q8;
    f->n_levels++;
    if (glint_white_compute_fraction_q15(f->white, level->low) > DARK_SHARE_Q15)
        f->n_levels -= 2;
}

/* Adds the levels for the thresholds T relative to the light at which codes
 * clip. If the picture's white is below clipping, also adds levels relative to
 * that white, as the lamps of such a picture may or may not be clipped. */
static void add_all_threshold_levels(struct glint_lamp_finder *f,
                                     struct thresholds t, int32_t cost_q8)
{
    const int white_code = f->cfg.white_code;

    if (white_code) {
        add_threshold_level(f, f->bright.curve->decode_q20[white_code], t,
                            cost_q8);
    } else {
        add_dark_picture_levels(f, t, cost_q8);
        add_threshold_level(f, LINEAR_WHITE_Q20, t, cost_q8);
    }
}

/* Adds a brightness level of clipped pixels of brightness LOW or more. */
static void add_clipped_level(struct glint_lamp_finder *f, int low,
                              int32_t cost_q8)
{
    f->level[f->n_levels++] =
        (struct glint_level){low, BRIGHT_CLIPPED, BRIGHT_CLIPPED, cost_q8};
}

static void sort_levels_by_brightness(struct glint_lamp_finder *f)
{
    for (int i = 1; i < f->n_levels; i++)
        for (int j = i; j > 0 && f->level[j].low < f->level[j - 1].low; j--) {
            const struct glint_level old = f->level[j];

            f->level[j] = f->level[j - 1];
            f->level[j - 1] = old;
        }
}

/* Measures the picture's white, and sets the brightness levels at which regions
 * are searched. Thresholds below the defaults add levels to the default ones,
 * so that every lamp that the defaults find is also found with lower
 * thresholds. */
static void choose_brightness_levels(struct glint_lamp_finder *f)
{
    const struct thresholds t = {f->cfg.threshold_high_q8,
                                 f->cfg.threshold_low_q8};
    struct thresholds held = t;
    struct glint_bright *b = &f->bright;

    glint_white_measure_picture(f->white, b, f->cfg.height);
    if (f->white->light_q20 < f->least_white_q20)
        f->white->light_q20 = f->least_white_q20;
    f->least_white_q20 = 0;
    f->n_levels = 0;
    if (is_threshold_below_default(&f->cfg)) {
        held.high_q8 = q_larger(t.high_q8, DEFAULT_HIGH_Q8);
        held.low_q8 = q_larger(t.low_q8, DEFAULT_LOW_Q8);
        add_all_threshold_levels(f, t, COST_LOWER_Q8);
    }
    add_all_threshold_levels(f, held, 0);
    if (f->cfg.judge) {
        add_clipped_level(f, BRIGHT_CLIPPED, COST_CLIPPED_Q8);
        add_clipped_level(f, BRIGHT_WHITE, COST_WHITE_Q8);
        add_clipped_level(f, BRIGHT_HOT, 0);
    }
    if (is_threshold_below_default(&f->cfg))
        sort_levels_by_brightness(f);
    glint_bright_set_min_brightness(b, f->level[0].low);
}

/* --------------------------------------------------------------- candidates */

static int is_region_bright_enough(const struct glint_lamp_finder *f,
                                   const struct glint_region *sum)
{
    return sum->area >= f->cfg.min_area && sum->n_seeds > 0 &&
           sum->n_seeds >= sum->area >> SEED_LOG2;
}

/* Returns whether keep_faint is set and region SUM is large enough to be a lamp
 * of an earlier frame that has faded. */
static int can_region_be_faded_lamp(const struct glint_lamp_finder *f,
                                    const struct glint_region *sum)
{
    return f->cfg.keep_faint && sum->area >= (f->cfg.min_area + 1) / 2;
}

/* Adds the finished region SUM to the candidates if it may be a lamp, or a lamp
 * of an earlier frame that has faded. */
static void add_region_if_qualified(void *finder,
                                    const struct glint_region *sum)
{
    struct glint_lamp_finder *f = finder;
    const int light = is_region_bright_enough(f, sum);

    if (sum->area <= f->max_area && (light || can_region_be_faded_lamp(f, sum)))
        add_candidate(f,
                      &(struct glint_candidate){
                          .sum = *sum,
                          .level = (int16_t)f->at,
                          .faint = (uint8_t)!light,
                          .doubt = light ? GLINT_DOUBT_NONE : GLINT_DOUBT_DIM});
}

/* --------------------------------------------------------------------- rows */

/* Returns how many of the first N values in VALUE are CODE or more. */
static WHOLLY_INLINE int count_codes_at_least(const uint8_t *value, int n,
                                              int code, int is_above_128)
{
    uint32_t found = 0;

    for (; n >= 8; value += 8, n -= 8)
        found += bytes_count_high_bits(
            bytes_find_at_or_above(bytes_load(value), code, is_above_128));
    for (int i = 0; i < n; i++)
        found += value[i] >= code;
    return (int)found;
}

/* Returns how many pixels of RUN have a brightness of CODE or more. All pixels
 * of RUN have at least LEAST. */
static int count_run_pixels_at_least(const uint8_t *value,
                                     const struct glint_run *run, int least,
                                     int code)
{
    const int all = run->x1 - run->x0;

    if (code <= least)
        return all;
    return code > 128 ? count_codes_at_least(value + run->x0, all, code, 1)
                      : count_codes_at_least(value + run->x0, all, code, 0);
}

/* Adds RUN of row Y to SUM's area, bounding box and pixel counts, but not its
 * light. */
static void add_run_to_region_counts(struct glint_region *sum,
                                     const struct glint_lamp_finder *f,
                                     const struct glint_run *run, int y)
{
    const struct glint_level *level = &f->level[f->at];
    const uint8_t *value = f->bright.value;

    glint_region_add_run(sum, run->x0, run->x1, y);
    sum->n_seeds +=
        count_run_pixels_at_least(value, run, level->low, level->seed);
    sum->n_clipped +=
        count_run_pixels_at_least(value, run, level->low, level->clipped);
}

/* Marks the pixels of RUN, as their light is needed for sums. The mark is
 * stored in the run of the darkest level that contains RUN, which is *OUTER or
 * a later run of the row. Sets *OUTER to it. */
static void mark_needed_pixels(struct glint_run **outer,
                               const struct glint_run *run)
{
    while ((*outer)->x1 <= run->x0)
        ++*outer;
    if ((*outer)->want1 == 0 || run->x0 < (*outer)->want0)
        (*outer)->want0 = run->x0;
    if (run->x1 > (*outer)->want1)
        (*outer)->want1 = run->x1;
}

static int is_region_small_enough(const struct glint_lamp_finder *f,
                                  const struct glint_region *sum)
{
    return sum->area <= f->max_area;
}

static void link_row_regions_of_level(struct glint_lamp_finder *f, int greatest,
                                      int y)
{
    struct glint_regions *r = &f->regions[f->at];
    const int low = f->level[f->at].low;
    struct glint_run *outer = f->regions[0].here.run;

    if (greatest < low)
        return;
    glint_regions_link_row(r, &f->bright, low, y);
    for (int i = 0; i < r->here.n_runs; i++) {
        struct glint_region *sum = glint_regions_find_region_of_run(r, i);

        add_run_to_region_counts(sum, f, &r->here.run[i], y);
        if (is_region_small_enough(f, sum))
            mark_needed_pixels(&outer, &r->here.run[i]);
    }
}

/* Computes the prefix sums of light over the marked pixels of the row. */
static void sum_needed_row_light(struct glint_lamp_finder *f)
{
    const struct glint_run_row *row = &f->regions[0].here;
    const int last = f->cfg.width - ROW_LIGHT_RIM;

    glint_row_light_begin_row(&f->row);
    for (int i = 0; i < row->n_runs; i++) {
        const struct glint_run *run = &row->run[i];
        const int x0 = run->want0, x1 = run->want1;

        if (x1 > 0)
            glint_row_light_sum_pixels(
                &f->row, &f->bright,
                x0 > ROW_LIGHT_RIM ? x0 - ROW_LIGHT_RIM : 0,
                x1 < last ? x1 + ROW_LIGHT_RIM : f->cfg.width);
    }
}

static void add_row_light_to_level_regions(struct glint_lamp_finder *f, int y)
{
    struct glint_regions *r = &f->regions[f->at];

    for (int i = 0; i < r->here.n_runs; i++) {
        struct glint_region *sum = glint_regions_find_region_of_run(r, i);
        const struct glint_run *run = &r->here.run[i];

        if (is_region_small_enough(f, sum))
            glint_row_light_add_run_to_region(&f->row, sum, run->x0, run->x1,
                                              f->cfg.width, y);
    }
    if (r->n_active > 0)
        glint_regions_report_finished(r, add_region_if_qualified, f, y);
}

static void add_picture_row(struct glint_lamp_finder *f, int y)
{
    const int greatest = glint_bright_scan_row(&f->bright, y);

    for (f->at = 0; f->at < f->n_levels; f->at++)
        link_row_regions_of_level(f, greatest, y);
    sum_needed_row_light(f);
    for (f->at = 0; f->at < f->n_levels; f->at++)
        add_row_light_to_level_regions(f, y);
}

void glint_lamps_collect_candidates(struct glint_lamp_finder *f,
                                    const struct glint_image *image)
{
    f->n = f->dropped = 0;
    glint_bright_begin_picture(&f->bright, image);
    choose_brightness_levels(f);
    for (f->at = 0; f->at < f->n_levels; f->at++)
        glint_regions_begin_picture(&f->regions[f->at]);
    for (int y = 0; y < f->cfg.height; y++)
        add_picture_row(f, y);
    for (f->at = 0; f->at < f->n_levels; f->at++)
        glint_regions_report_finished(
            &f->regions[f->at], add_region_if_qualified, f, f->cfg.height);
}

/* ------------------------------------------------------------------- memory */

static int is_valid_config(const struct glint_lamp_finder_config *c)
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

/* Allocates a finder and its tables from A. Returns NULL if A only measures or
 * has too little memory. */
static struct glint_lamp_finder *
allocate_finder(struct glint_arena *a, const struct glint_lamp_finder_config *c)
{
    struct glint_lamp_finder *placed =
        glint_arena_allocate(a, 1, sizeof *placed);
    struct glint_lamp_finder measured;
    struct glint_regions measured_level;
    struct glint_lamp_finder *f = placed ? placed : &measured;
    const int n_levels = is_threshold_below_default(c)
                             ? LIGHT_LEVELS
                             : LIGHT_LEVELS - LIGHT_LEVELS_LOWER;

    glint_bright_allocate(&f->bright, a, c->width);
    f->regions = glint_arena_allocate(a, (size_t)n_levels, sizeof *f->regions);
    for (int i = 0; i < n_levels; i++)
        glint_regions_allocate(f->regions ? &f->regions[i] : &measured_level, a,
                               c->width);
    glint_row_light_allocate(&f->row, a, c->width);
    f->white = glint_arena_allocate(a, 1, sizeof *f->white);
    f->candidate =
        glint_arena_allocate(a, LIGHT_CANDIDATES + 1, sizeof *f->candidate);
    f->order = glint_arena_allocate(a, LIGHT_CANDIDATES, sizeof *f->order);
    return a->used <= a->size ? placed : NULL;
}

void glint_lamp_finder_defaults(struct glint_lamp_finder_config *cfg, int width,
                                int height)
{
    const int pixels = width * height; /* at most 2^30 */

    *cfg = (struct glint_lamp_finder_config){
        .width = width,
        .height = height,
        .threshold_high_q8 = DEFAULT_HIGH_Q8,
        .threshold_low_q8 = DEFAULT_LOW_Q8,
        .judge = 1,
        .min_area = pixels < 1 << 19 ? 2 : pixels >> 18,
        .max_share_q15 = Q_CONST(0.25, 15),
        .merge_q15 = Q_CONST(0.01, 15)};
}

size_t glint_lamp_finder_bytes(const struct glint_lamp_finder_config *cfg)
{
    struct glint_arena measured = glint_arena_begin_measuring();

    if (!is_valid_config(cfg))
        return 0;
    allocate_finder(&measured, cfg);
    return measured.used;
}

enum glint_status
glint_lamp_finder_init(struct glint_lamp_finder **finder,
                       const struct glint_lamp_finder_config *cfg, void *mem,
                       size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_lamp_finder *f;
    int64_t merge_q8;

    if (!is_valid_config(cfg) || (uintptr_t)mem % GLINT_ALIGN)
        return GLINT_E_ARGUMENT;
    f = allocate_finder(&arena, cfg);
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

/* Returns the min score of a lamp. Regions of thresholds below the defaults can
 * lower it, but not raise it. */
static int32_t find_min_lamp_score(struct glint_lamp_finder *f,
                                   const struct glint_score *score)
{
    int32_t least_q8, default_q8;
    int n = 0;

    for (int i = 0; i < f->n; i++) {
        const int32_t at = f->order[i];

        if (f->level[f->candidate[at].level].cost_q8 < COST_LOWER_Q8) {
            f->order[i] = f->order[n];
            f->order[n++] = at;
        }
    }
    default_q8 =
        glint_score_find_min_lamp_score(score, f->candidate, f->order, n);
    if (n == f->n)
        return default_q8;
    least_q8 =
        glint_score_find_min_lamp_score(score, f->candidate, f->order, f->n);
    return q_smaller(least_q8, default_q8);
}

/* Scores the candidates, and removes candidates whose score is too low for a
 * lamp. If keep_faint is set, candidates with a slightly lower score remain and
 * are marked as faint. */
static void score_and_select_candidates(struct glint_lamp_finder *f)
{
    const struct glint_score score = {&f->bright,    f->white, f->cfg.width,
                                      f->cfg.height, f->level, 1,
                                      f->alone_q8};
    const int n = f->n;
    int32_t least_q8;

    glint_score_score_candidates(&score, f->candidate, f->order, n);
    least_q8 = find_min_lamp_score(f, &score);
    f->n = 0;
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        if (c->score_q8 < least_q8)
            c->doubt = (uint8_t)glint_score_choose_doubt(c);
        c->faint |= c->score_q8 < least_q8;
        if (c->score_q8 >= (f->cfg.keep_faint ? -SCORE_DOUBT : least_q8))
            f->order[f->n++] = f->order[i];
    }
    glint_score_choose_among_nested(&score, f->candidate, f->order, f->n);
    remove_gone_candidates(f);
}

/* ------------------------------------------------------------------- result */

/* Converts CANDIDATE to a spot. Positions of spots are relative to the corner
 * of the picture's first pixel, positions of regions to the centre of that
 * pixel. */
static struct glint_spot
convert_candidate_to_spot(const struct glint_candidate *candidate)
{
    const struct glint_region *sum = &candidate->sum;
    struct glint_spot s = {.size_q8 = glint_region_compute_rms_radius_q8(sum),
                           .area = sum->area,
                           .n_clipped = sum->n_clipped,
                           .flux_q16 = sum->w_q14 * 4,
                           .faint = candidate->faint,
                           .doubt = (enum glint_doubt)candidate->doubt,
                           .power_q16 = sum->w_q14 * 4,
                           .cos_q15 = 1 << 15};

    glint_region_compute_centroid(sum, &s.x_q8, &s.y_q8);
    s.x_q8 += 128;
    s.y_q8 += 128;
    glint_region_compute_colour(sum, s.rgb_q15);
    s.axis_q8[0] = s.axis_q8[1] = q_mul(s.size_q8, Q_CONST(0.70711, 15), 15);
    return s;
}

int glint_lamp_finder_find(struct glint_lamp_finder *finder,
                           const struct glint_image *image,
                           struct glint_spot *spots, int max)
{
    glint_lamps_collect_candidates(finder, image);
    if (finder->cfg.judge)
        score_and_select_candidates(finder);
    finder->alone_q8 = SCORE_ALONE;
    merge_all_near_lamps(finder);
    reduce_lamps_to_max(finder, max < MAX_SPOTS ? max : MAX_SPOTS);
    for (int i = 0; i < finder->n; i++)
        spots[i] =
            convert_candidate_to_spot(&finder->candidate[finder->order[i]]);
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
