/* SPDX-License-Identifier: MIT
 *
 * The list of candidates for lamps: the brightest are kept, near ones merged,
 * and their number is limited. */
#include "base/q.h"
#include "base/sort.h"
#include "lamps/lamp_finder.h"

/* merge distances within which a lamp in excess of MAX joins one that is kept
 */
#define JOIN_REACH 4

static int is_brighter(const struct glint_lamp_finder *f, int32_t a, int32_t b)
{
    const struct glint_candidate *p = &f->candidate[a], *q = &f->candidate[b];

    if (p->faint != q->faint)
        return q->faint;
    return p->sum.w_q14 != q->sum.w_q14 ? p->sum.w_q14 > q->sum.w_q14
                                        : p->sum.first < q->sum.first;
}

static int is_before(const void *finder, int a, int b)
{
    const struct glint_lamp_finder *const f = finder;

    return is_brighter(f, f->order[a], f->order[b]);
}

static void swap(void *finder, int a, int b)
{
    const struct glint_lamp_finder *const f = finder;
    const int32_t old = f->order[a];

    f->order[a] = f->order[b];
    f->order[b] = old;
}

/* Returns a heap of the candidates, the faintest first. */
static struct glint_heap heap_of(struct glint_lamp_finder *f)
{
    return (struct glint_heap){is_before, swap, f};
}

static void sort_by_flux(struct glint_lamp_finder *f)
{
    const struct glint_heap heap = heap_of(f);

    glint_heap_sort(&heap, f->n);
}

void glint_lamps_hold(struct glint_lamp_finder *f,
                      const struct glint_candidate *candidate)
{
    const struct glint_heap heap = heap_of(f);
    struct glint_candidate *last = &f->candidate[LIGHT_CANDIDATES];

    if (f->n < LIGHT_CANDIDATES) {
        f->candidate[f->n] = *candidate;
        f->order[f->n] = f->n;
        f->n++;
        if (f->n == LIGHT_CANDIDATES)
            glint_heap_make(&heap, f->n);
        return;
    }
    *last = *candidate;
    if (is_brighter(f, LIGHT_CANDIDATES, f->order[0])) {
        const struct glint_candidate out = f->candidate[f->order[0]];

        f->candidate[f->order[0]] = *last;
        *last = out;
        glint_heap_sift(&heap, 0, f->n);
    }
    f->dropped += !last->faint;
}

void glint_lamps_compact(struct glint_lamp_finder *f)
{
    const int n_before = f->n;

    f->n = 0;
    for (int i = 0; i < n_before; i++)
        if (!f->candidate[f->order[i]].gone)
            f->order[f->n++] = f->order[i];
}

/* ------------------------------------------------------------------ merging */

static void locate(struct glint_lamp_finder *f)
{
    for (int i = 0; i < f->n; i++) {
        struct glint_candidate *c = &f->candidate[f->order[i]];

        glint_region_centroid(&c->sum, &c->x_q8, &c->y_q8);
        c->gone = 0;
    }
}

/* Returns the number of lamps, which come first among the sorted candidates. */
static int count_lights(const struct glint_lamp_finder *f)
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

/* Adds CANDIDATE to INTO, whose place stays until the next locate(). */
static void give(struct glint_candidate *candidate,
                 struct glint_candidate *into)
{
    glint_region_absorb(&into->sum, &candidate->sum);
    candidate->gone = 1;
}

/* Merges once: each lamp, the brightest first, absorbs the lamps within the
 * merge distance of its place. Returns whether any were merged. */
static int merge_once(struct glint_lamp_finder *f)
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
    glint_lamps_compact(f);
    return f->n < n_before;
}

void glint_lamps_merge(struct glint_lamp_finder *f)
{
    while (merge_once(f))
        ;
}

/* Returns that of the first MAX candidates which is nearest to C, or NULL if
 * none is in reach. */
static struct glint_candidate *nearest_kept(const struct glint_lamp_finder *f,
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

void glint_lamps_cap(struct glint_lamp_finder *f, int max)
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
