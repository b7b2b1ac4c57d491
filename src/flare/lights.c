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

#define N_CANDIDATES 2048 /* at least the 1024 that find may be asked for */
#define MAX_SPOTS    1024
#define CLIPPED_CODE 250 /* a channel here or above says nothing of colour */
#define RIM          2   /* pixels beside a run that show the colour, too */
#define JOIN_REACH   4   /* what exceeds MAX joins within so many merge radii */

/* Regions of which less than 1 / 2^SEED_LOG2 reaches the upper threshold are
 * lit surfaces, not lights. */
#define SEED_LOG2 5

struct candidate {
    struct glint_region sum;
    int32_t x_q8, y_q8;
    int faint;
    int gone; /* merged into another */
};

struct glint_lights {
    struct glint_lights_config cfg;
    int64_t max_area;
    int64_t merge2_q16; /* squared merge distance */
    struct glint_bright bright;
    struct glint_regions regions;
    struct candidate *candidate; /* and one on its way out */
    int32_t *order; /* of candidates: a heap, then by falling flux */
    int n;          /* in order, the faint ones last */
    int dropped;
};

/* ------------------------------------------------------------------- memory */

static int is_valid(const struct glint_lights_config *c)
{
    return c->width >= 1 && c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->threshold_low >= 1 &&
           c->threshold_low <= c->threshold_high && c->threshold_high <= 255 &&
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
    glint_regions_carve(&f->regions, a, c->width);
    f->candidate = glint_arena_take(a, N_CANDIDATES + 1, sizeof *f->candidate);
    f->order = glint_arena_take(a, N_CANDIDATES, sizeof *f->order);
    return a->used <= a->size ? placed : NULL;
}

void glint_lights_defaults(struct glint_lights_config *cfg, int width,
                           int height)
{
    const int pixels = width * height; /* 2^26 at most */

    *cfg = (struct glint_lights_config){.width = width,
                                        .height = height,
                                        .threshold_high = 253,
                                        .threshold_low = 240,
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
    const int32_t clipped_q20 = f->bright.curve->decode_q20[CLIPPED_CODE];
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

static int count_clipped(const struct glint_lights *f,
                         const struct glint_run *run)
{
    const uint8_t *luma = f->bright.luma;
    int n = 0;

    for (int x = run->x0; x < run->x1; x++)
        n += luma[x] >= f->cfg.threshold_high;
    return n;
}

static void add_run(struct glint_region *sum, const struct glint_lights *f,
                    const struct glint_run *run, int y)
{
    const int first = run->x0 > RIM ? run->x0 - RIM : 0;
    const int end = run->x1 < f->cfg.width - RIM ? run->x1 + RIM : f->cfg.width;

    sum->area += run->x1 - run->x0;
    if (sum->area > f->max_area)
        return; /* no light, whatever else it is */
    sum->n_clipped += count_clipped(f, run);
    for (int x = first, next; x < end; x = next) {
        next = glint_bright_same(&f->bright, x, end);
        add_span(sum, f, run, x, next, y);
    }
}

/* --------------------------------------------------------------- candidates */

static int is_brighter(const struct glint_lights *f, int32_t a, int32_t b)
{
    const struct candidate *p = &f->candidate[a], *q = &f->candidate[b];

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
    return sum->area >= f->cfg.min_area && sum->n_clipped > 0 &&
           sum->n_clipped >= sum->area >> SEED_LOG2;
}

/* Large enough to be what is left of a light. */
static int is_faint(const struct glint_lights *f,
                    const struct glint_region *sum)
{
    return f->cfg.keep_faint && sum->area >= (f->cfg.min_area + 1) / 2;
}

/* Holds CANDIDATE, at the expense of the last if need be. */
static void hold(struct glint_lights *f, const struct candidate *candidate)
{
    struct candidate *last = &f->candidate[N_CANDIDATES];

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
        const struct candidate out = f->candidate[f->order[0]];

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
        hold(f, &(struct candidate){.sum = *sum, .faint = !light});
}

static void find_candidates(struct glint_lights *f,
                            const struct glint_image *image)
{
    struct glint_regions *r = &f->regions;

    f->n = f->dropped = 0;
    glint_bright_begin(&f->bright, image, f->cfg.threshold_low);
    glint_regions_begin(r);
    for (int y = 0; y < f->cfg.height; y++) {
        const int is_bright = glint_bright_scan(&f->bright, y);

        if (!is_bright && r->n_active == 0)
            continue;
        if (is_bright)
            glint_regions_link_row(r, &f->bright, y);
        for (int i = 0; i < r->here.n_runs; i++)
            add_run(glint_regions_of_run(r, i), f, &r->here.run[i], y);
        glint_regions_end_row(r, offer, f, y);
    }
    glint_regions_end_row(r, offer, f, f->cfg.height);
}

/* ------------------------------------------------------------------ merging */

static void locate(struct glint_lights *f)
{
    for (int i = 0; i < f->n; i++) {
        struct candidate *c = &f->candidate[f->order[i]];

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

static int64_t distance2_q16(const struct candidate *a,
                             const struct candidate *b)
{
    const int64_t dx_q8 = a->x_q8 - b->x_q8, dy_q8 = a->y_q8 - b->y_q8;

    return dx_q8 * dx_q8 + dy_q8 * dy_q8;
}

/* Gives CANDIDATE to INTO; positions stay until the next locate. */
static void give(struct candidate *candidate, struct candidate *into)
{
    glint_region_absorb(&into->sum, &candidate->sum);
    candidate->gone = 1;
}

static void compact(struct glint_lights *f)
{
    const int n_before = f->n;

    f->n = 0;
    for (int i = 0; i < n_before; i++)
        if (!f->candidate[f->order[i]].gone)
            f->order[f->n++] = f->order[i];
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
        struct candidate *c = &f->candidate[f->order[i]];

        for (int j = i + 1; j < n_lights && !c->gone; j++) {
            struct candidate *other = &f->candidate[f->order[j]];

            if (!other->gone && distance2_q16(c, other) < f->merge2_q16)
                give(other, c);
        }
    }
    compact(f);
    return f->n < n_before;
}

/* The nearest of the first MAX to candidate C, or NULL if none is in reach. */
static struct candidate *nearest_kept(const struct glint_lights *f,
                                      const struct candidate *c, int max)
{
    int64_t best_q16 = JOIN_REACH * JOIN_REACH * f->merge2_q16;
    struct candidate *best = NULL;

    for (int i = 0; i < max; i++) {
        struct candidate *kept = &f->candidate[f->order[i]];
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
        struct candidate *c = &f->candidate[f->order[i]];
        struct candidate *kept = nearest_kept(f, c, max);

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
static struct glint_spot spot_of(const struct candidate *candidate)
{
    const struct glint_region *sum = &candidate->sum;
    struct glint_spot s = {.size_q8 = glint_region_radius_q8(sum),
                           .area = sum->area,
                           .n_clipped = sum->n_clipped,
                           .flux_q16 = sum->w_q14 * 4,
                           .faint = candidate->faint};

    glint_region_centroid(sum, &s.x_q8, &s.y_q8);
    s.x_q8 += 128;
    s.y_q8 += 128;
    glint_region_colour(sum, s.rgb_q15);
    return s;
}

int glint_lights_find(struct glint_lights *finder,
                      const struct glint_image *image, struct glint_spot *spots,
                      int max)
{
    find_candidates(finder, image);
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
