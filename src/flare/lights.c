/* SPDX-License-Identifier: MIT
 *
 * From the regions of a picture to its lights.
 *
 * A region that qualifies becomes a candidate; of these the brightest
 * N_CANDIDATES are held, and only when all are found is anything merged.
 */
#include "glint/lights.h"

#include "base/arena.h"
#include "base/q.h"
#include "flare/bright.h"
#include "flare/regions.h"
#include "flare/score.h"
#include "flare/white.h"

#define N_CANDIDATES 2048 /* at least the 1024 that find may be asked for */
#define MAX_SPOTS    1024
#define RIM          2 /* pixels beside a run that show the colour, too */
#define JOIN_REACH   4 /* what exceeds MAX joins within so many merge radii */

/* Regions of which less than 1 / 2^SEED_LOG2 reaches the upper threshold are
 * lit surfaces, not lights. */
#define SEED_LOG2 3

#define LEVELS    6
#define EV_MIN_Q8 (-20 * 256)

/* A lamp is meant as wide as it is at the thresholds, unless its core by itself
 * is clearly more of a lamp; in the dark of a picture it is one if nothing in
 * it is. */
#define COST_CLIPPED_Q8 64
#define COST_WHITE_Q8   32
#define COST_DARK_Q8    1024
#define DARK_SHARE_Q15  Q_CONST(0.125, 15)

struct glint_lights {
    struct glint_lights_config cfg;
    int64_t max_area;
    int64_t merge2_q16; /* squared merge distance */
    struct glint_bright bright;
    struct glint_white *white;
    struct glint_regions regions[LEVELS];
    struct glint_level level[LEVELS]; /* of rising brightness */
    int n_levels;
    int at;                            /* level that regions are offered of */
    struct glint_candidate *candidate; /* and one on its way out */
    int32_t *order; /* of candidates: a heap, then by falling flux */
    int n;          /* in order, the faint ones last */
    int dropped;
};

/* ------------------------------------------------------------------- memory */

static int is_valid(const struct glint_lights_config *c)
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

/* Runs twice: to measure, and to place. NULL if measuring or full. */
static struct glint_lights *carve(struct glint_arena *a,
                                  const struct glint_lights_config *c)
{
    struct glint_lights *placed = glint_arena_take(a, 1, sizeof *placed);
    struct glint_lights measured;
    struct glint_lights *f = placed ? placed : &measured;

    glint_bright_carve(&f->bright, a, c->width);
    for (int i = 0; i < LEVELS; i++)
        glint_regions_carve(&f->regions[i], a, c->width);
    f->white = glint_arena_take(a, 1, sizeof *f->white);
    f->candidate = glint_arena_take(a, N_CANDIDATES + 1, sizeof *f->candidate);
    f->order = glint_arena_take(a, N_CANDIDATES, sizeof *f->order);
    return a->used <= a->size ? placed : NULL;
}

void glint_lights_defaults(struct glint_lights_config *cfg, int width,
                           int height)
{
    const int pixels = width * height; /* 2^30 at most */

    *cfg = (struct glint_lights_config){.width = width,
                                        .height = height,
                                        .threshold_high_q8 = -26,
                                        .threshold_low_q8 = -38,
                                        .judge = 1,
                                        .min_area =
                                            pixels < 1 << 19 ? 2 : pixels >> 18,
                                        .max_share_q15 = Q_CONST(0.25, 15),
                                        .merge_q15 = Q_CONST(0.01, 15)};
}

size_t glint_lights_bytes(const struct glint_lights_config *cfg)
{
    struct glint_arena measured = glint_arena_measure();

    if (!is_valid(cfg))
        return 0;
    carve(&measured, cfg);
    return measured.used;
}

enum glint_status glint_lights_init(struct glint_lights **finder,
                                    const struct glint_lights_config *cfg,
                                    void *mem, size_t bytes)
{
    struct glint_arena arena = glint_arena_over(mem, bytes);
    struct glint_lights *f;
    int64_t merge_q8;

    if (!is_valid(cfg) || (uintptr_t)mem % GLINT_ALIGN)
        return GLINT_E_ARGUMENT;
    f = carve(&arena, cfg);
    if (!f)
        return GLINT_E_MEMORY;
    f->cfg = *cfg;
    glint_bright_init(&f->bright, cfg->width);
    f->n = f->dropped = 0;
    merge_q8 = q_shift((int64_t)cfg->width * cfg->merge_q15, 7);
    f->merge2_q16 = merge_q8 * merge_q8;
    f->max_area =
        q_shift((int64_t)cfg->width * cfg->height * cfg->max_share_q15, 15);
    *finder = f;
    return GLINT_OK;
}

/* ------------------------------------------------------------------ regions */

/* Adds pixels X0 .. X1 - 1 of row Y, all of the same light, of which those in
 * RUN belong to it and the others are next to it. A colour is known only where
 * no channel is clipped. */
static void add_span(struct glint_region *sum, const struct glint_lights *f,
                     const struct glint_run *run, int x0, int x1, int y)
{
    const int32_t clipped_q20 = f->bright.curve->decode_q20[BRIGHT_CLIPPED];
    const int first = x0 > run->x0 ? x0 : run->x0;
    const int end = x1 < run->x1 ? x1 : run->x1;
    struct glint_region_light light;
    int32_t rgb_q20[3];

    glint_bright_read(&f->bright, x0, rgb_q20);
    light = glint_region_light_of(rgb_q20);
    if (rgb_q20[0] < clipped_q20 && rgb_q20[1] < clipped_q20 &&
        rgb_q20[2] < clipped_q20)
        glint_region_add_rim(sum, &light, x1 - x0);
    if (first < end)
        glint_region_add_pixels(sum, &light, first, end, y);
}

static void count_pixels(struct glint_region *sum, const struct glint_lights *f,
                         const struct glint_run *run)
{
    const struct glint_level *level = &f->level[f->at];
    const uint8_t *value = f->bright.value;

    for (int x = run->x0; x < run->x1; x++) {
        sum->n_seeds += value[x] >= level->seed;
        sum->n_clipped += value[x] >= level->clipped;
    }
}

static void add_run(struct glint_region *sum, const struct glint_lights *f,
                    const struct glint_run *run, int y)
{
    const int first = run->x0 > RIM ? run->x0 - RIM : 0;
    const int end = run->x1 < f->cfg.width - RIM ? run->x1 + RIM : f->cfg.width;

    glint_region_add_run(sum, run->x0, run->x1, y);
    if (sum->area > f->max_area)
        return; /* no light, whatever else it is */
    count_pixels(sum, f, run);
    for (int x = first, next; x < end; x = next) {
        next = glint_bright_same(&f->bright, x, end);
        add_span(sum, f, run, x, next, y);
    }
}

/* --------------------------------------------------------------- candidates */

static int is_brighter(const struct glint_lights *f, int32_t a, int32_t b)
{
    const struct glint_candidate *p = &f->candidate[a], *q = &f->candidate[b];

    if (p->faint != q->faint)
        return q->faint;
    return p->sum.w_q14 != q->sum.w_q14 ? p->sum.w_q14 > q->sum.w_q14
                                        : p->sum.first < q->sum.first;
}

static void swap(int32_t *a, int32_t *b)
{
    const int32_t old = *a;

    *a = *b;
    *b = old;
}

/* Restores the heap order[0 .. n - 1], the faintest first, below AT. */
static void sift_down(struct glint_lights *f, int at, int n)
{
    int32_t *order = f->order;

    for (;;) {
        int child = 2 * at + 1;

        if (child >= n)
            return;
        if (child + 1 < n && is_brighter(f, order[child], order[child + 1]))
            child++;
        if (is_brighter(f, order[child], order[at]))
            return;
        swap(&order[child], &order[at]);
        at = child;
    }
}

static void make_heap(struct glint_lights *f, int n)
{
    for (int i = n / 2 - 1; i >= 0; i--)
        sift_down(f, i, n);
}

static void sort_by_flux(struct glint_lights *f)
{
    make_heap(f, f->n);
    for (int end = f->n - 1; end > 0; end--) {
        swap(&f->order[0], &f->order[end]);
        sift_down(f, 0, end);
    }
}

static int is_light(const struct glint_lights *f,
                    const struct glint_region *sum)
{
    return sum->area >= f->cfg.min_area && sum->n_seeds > 0 &&
           sum->n_seeds >= sum->area >> SEED_LOG2;
}

/* Large enough to be what is left of a light. */
static int is_faint(const struct glint_lights *f,
                    const struct glint_region *sum)
{
    return f->cfg.keep_faint && sum->area >= (f->cfg.min_area + 1) / 2;
}

/* Holds CANDIDATE, at the expense of the last if need be. */
static void hold(struct glint_lights *f,
                 const struct glint_candidate *candidate)
{
    struct glint_candidate *last = &f->candidate[N_CANDIDATES];

    if (f->n < N_CANDIDATES) {
        f->candidate[f->n] = *candidate;
        f->order[f->n] = f->n;
        f->n++;
        if (f->n == N_CANDIDATES)
            make_heap(f, f->n);
        return;
    }
    *last = *candidate;
    if (is_brighter(f, N_CANDIDATES, f->order[0])) {
        const struct glint_candidate out = f->candidate[f->order[0]];

        f->candidate[f->order[0]] = *last;
        *last = out;
        sift_down(f, 0, f->n);
    }
    f->dropped += !last->faint;
}

/* Holds SUM if it qualifies. */
static void offer(void *finder, const struct glint_region *sum)
{
    struct glint_lights *f = finder;
    const int light = is_light(f, sum);

    if (sum->area <= f->max_area && (light || is_faint(f, sum)))
        hold(f, &(struct glint_candidate){.sum = *sum,
                                          .level = (int16_t)f->at,
                                          .faint = (uint8_t)!light});
}

/* Regions at LIGHT times the thresholds. */
static void add_level(struct glint_lights *f, int32_t light_q20)
{
    const struct glint_bright *b = &f->bright;
    struct glint_level *level = &f->level[f->n_levels++];

    level->low = glint_white_code(b, light_q20, f->cfg.threshold_low_q8);
    level->seed = glint_white_code(b, light_q20, f->cfg.threshold_high_q8);
    level->clipped = glint_white_code(b, light_q20, 0);
    level->cost_q8 = 0;
}

/* The same of a picture that is darker than white, unless much of it is as
 * bright. */
static void add_dark_level(struct glint_lights *f)
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

/* Regions of what is clipped, in one channel or in all, LOW and above. */
static void add_core(struct glint_lights *f, int low, int32_t cost_q8)
{
    f->level[f->n_levels++] =
        (struct glint_level){low, BRIGHT_CLIPPED, BRIGHT_CLIPPED, cost_q8};
}

/* A picture that is darker than white has lamps that are, and may have others
 * that are not. */
static void set_levels(struct glint_lights *f)
{
    const int white_code = f->cfg.white_code;
    struct glint_bright *b = &f->bright;

    glint_white_measure(f->white, b, f->cfg.height);
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

static void scan_level(struct glint_lights *f, int greatest, int y)
{
    struct glint_regions *r = &f->regions[f->at];
    const int level = f->level[f->at].low;

    if (greatest < level && r->n_active == 0)
        return;
    if (greatest >= level)
        glint_regions_link_row(r, &f->bright, level, y);
    for (int i = 0; i < r->here.n_runs; i++)
        add_run(glint_regions_of_run(r, i), f, &r->here.run[i], y);
    glint_regions_end_row(r, offer, f, y);
}

static void find_candidates(struct glint_lights *f,
                            const struct glint_image *image)
{
    f->n = f->dropped = 0;
    glint_bright_begin(&f->bright, image);
    set_levels(f);
    for (f->at = 0; f->at < f->n_levels; f->at++)
        glint_regions_begin(&f->regions[f->at]);
    for (int y = 0; y < f->cfg.height; y++) {
        const int greatest = glint_bright_scan(&f->bright, y);

        for (f->at = 0; f->at < f->n_levels; f->at++)
            scan_level(f, greatest, y);
    }
    for (f->at = 0; f->at < f->n_levels; f->at++)
        glint_regions_end_row(&f->regions[f->at], offer, f, f->cfg.height);
}

static void compact(struct glint_lights *f)
{
    const int n_before = f->n;

    f->n = 0;
    for (int i = 0; i < n_before; i++)
        if (!f->candidate[f->order[i]].gone)
            f->order[f->n++] = f->order[i];
}

/* Leaves what looks like a lamp, and what may still be one as faint. */
static void judge(struct glint_lights *f)
{
    const struct glint_score score = {&f->bright, f->white, f->cfg.width,
                                      f->cfg.height, f->level};
    const int n = f->n;
    const int32_t least_q8 = f->cfg.keep_faint ? -SCORE_DOUBT : 0;

    glint_score_all(&score, f->candidate, f->order, n);
    f->n = 0;
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        c->faint |= c->score_q8 < 0;
        if (c->score_q8 >= least_q8)
            f->order[f->n++] = f->order[i];
    }
    glint_score_choose(&score, f->candidate, f->order, f->n);
    compact(f);
}

/* ------------------------------------------------------------------ merging */

static void locate(struct glint_lights *f)
{
    for (int i = 0; i < f->n; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        glint_region_centroid(&c->sum, &c->x_q8, &c->y_q8);
        c->gone = 0;
    }
}

/* Of the sorted candidates these come first. */
static int count_lights(const struct glint_lights *f)
{
    int n = f->n;

    while (n > 0 && f->candidate[f->order[n - 1]].faint)
        n--;
    return n;
}

static int64_t distance2_q16(const struct glint_candidate *a,
                             const struct glint_candidate *b)
{
    const int64_t dx_q8 = a->x_q8 - b->x_q8, dy_q8 = a->y_q8 - b->y_q8;

    return dx_q8 * dx_q8 + dy_q8 * dy_q8;
}

/* Gives CANDIDATE to INTO; positions stay until the next locate. */
static void give(struct glint_candidate *candidate,
                 struct glint_candidate *into)
{
    glint_region_absorb(&into->sum, &candidate->sum);
    candidate->gone = 1;
}

/* Each, the brightest first, takes what lies within the merge distance of where
 * it was. Returns whether anything merged. */
static int merge_once(struct glint_lights *f)
{
    const int n_before = f->n;
    int n_lights;

    sort_by_flux(f);
    locate(f);
    n_lights = count_lights(f);
    for (int i = 0; i < n_lights; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        for (int j = i + 1; j < n_lights && !c->gone; j++) {
            struct glint_candidate *other = &f->candidate[f->order[j]];

            if (!other->gone && distance2_q16(c, other) < f->merge2_q16)
                give(other, c);
        }
    }
    compact(f);
    return f->n < n_before;
}

/* The nearest of the first MAX to candidate C, or NULL if none is in reach. */
static struct glint_candidate *nearest_kept(const struct glint_lights *f,
                                            const struct glint_candidate *c,
                                            int max)
{
    int64_t best_q16 = JOIN_REACH * JOIN_REACH * f->merge2_q16;
    struct glint_candidate *best = NULL;

    for (int i = 0; i < max; i++) {
        struct glint_candidate *kept = &f->candidate[f->order[i]];
        const int64_t d_q16 = distance2_q16(c, kept);

        if (d_q16 < best_q16) {
            best_q16 = d_q16;
            best = kept;
        }
    }
    return best;
}

static void cap(struct glint_lights *f, int max)
{
    const int n_lights = count_lights(f);

    for (int i = max; i < n_lights; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];
        struct glint_candidate *kept = nearest_kept(f, c, max);

        if (kept)
            give(c, kept);
        else
            f->dropped++;
    }
    if (f->n > max)
        f->n = max;
    sort_by_flux(f);
}

/* ------------------------------------------------------------------- result */

/* A spot's origin is the corner of the first pixel, a region's its centre. */
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

int glint_lights_find(struct glint_lights *finder,
                      const struct glint_image *image, struct glint_spot *spots,
                      int max)
{
    find_candidates(finder, image);
    if (finder->cfg.judge)
        judge(finder);
    while (merge_once(finder))
        ;
    cap(finder, max < MAX_SPOTS ? max : MAX_SPOTS);
    for (int i = 0; i < finder->n; i++)
        spots[i] = spot_of(&finder->candidate[finder->order[i]]);
    return finder->n;
}

int glint_lights_dropped(const struct glint_lights *finder)
{
    return finder->dropped;
}
