/* SPDX-License-Identifier: MIT */
#include "follow/match.h"

#include "base/arena.h"
#include "base/sort.h"

enum {
    NEAREST_SPOTS = 8,
    /* log2 of the factor on the squared distance of a faint spot, and of the
     * factor on that of any spot if the lamp is lost */
    FAR_LOG2 = 2,
    PIXEL2_Q16 = 1 << 16
};

struct glint_pair {
    int64_t cost_q16; /* squared pixels */
    int32_t seeker, spot;
    int32_t rank; /* index of the spot in by_x */
};

void glint_match_allocate(struct glint_match *m, struct glint_arena *arena,
                          int max_seekers, int max_spots)
{
    const size_t n_pairs = (size_t)max_seekers * NEAREST_SPOTS;

    m->seeker =
        glint_arena_allocate(arena, (size_t)max_seekers, sizeof *m->seeker);
    m->by_x = glint_arena_allocate(arena, (size_t)max_spots, sizeof *m->by_x);
    m->taken = glint_arena_allocate(arena, (size_t)max_spots, sizeof *m->taken);
    m->pair = glint_arena_allocate(arena, n_pairs, sizeof *m->pair);
    m->order = glint_arena_allocate(arena, n_pairs, sizeof *m->order);
}

/* ------------------------------------------------------------------- orders */

enum { SPOT_NUMBERS = 15 };

static void list_spot_members(const struct glint_spot *s,
                              int64_t v[SPOT_NUMBERS])
{
    v[0] = s->x_q8;
    v[1] = s->y_q8;
    v[2] = s->flux_q16;
    v[3] = s->area;
    v[4] = s->n_clipped;
    v[5] = s->size_q8;
    for (int i = 0; i < 3; i++)
        v[6 + i] = s->rgb_q15[i];
    v[9] = s->faint;
    v[10] = s->power_q16;
    for (int i = 0; i < 2; i++)
        v[11 + i] = s->axis_q8[i];
    v[13] = s->cos_q15;
    v[14] = s->sin_q15;
}

/* Sort order of spots: by x, then by all other members, so that only equal
 * spots are interchangeable. */
static int is_spot_before(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_spot *spots = ctx;
    int64_t p[SPOT_NUMBERS], q[SPOT_NUMBERS];

    if (spots[a].x_q8 != spots[b].x_q8)
        return spots[a].x_q8 < spots[b].x_q8;
    list_spot_members(&spots[a], p);
    list_spot_members(&spots[b], q);
    for (int i = 0; i < SPOT_NUMBERS; i++)
        if (p[i] != q[i])
            return p[i] < q[i];
    return 0;
}

static int is_pair_before(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_match *m = ctx;
    const struct glint_pair *p = &m->pair[a], *q = &m->pair[b];

    if (p->cost_q16 != q->cost_q16)
        return p->cost_q16 < q->cost_q16;
    if (p->seeker != q->seeker)
        return m->seeker[p->seeker].id < m->seeker[q->seeker].id;
    return p->rank < q->rank;
}

/* -------------------------------------------------------------------- pairs */

/* Returns the cost of assigning SPOT to lamp S: their squared distance,
 * pixels^2. If the spot is faint or the lamp is lost, 1 is added and the sum
 * multiplied by 2^FAR_LOG2; if both, by 4^FAR_LOG2. Returns -1 if SPOT cannot
 * be assigned, as it lies outside the search radius of S, or is faint and too
 * large. */
static int64_t compute_match_cost_q16(const struct glint_seeker *s,
                                      const struct glint_spot *spot)
{
    const int64_t reach_q8 = s->reach_q8;
    const int64_t dx_q8 = (int64_t)spot->x_q8 - s->x_q8;
    const int64_t dy_q8 = (int64_t)spot->y_q8 - s->y_q8;
    const int is_far = (spot->faint != 0) + (s->is_lost != 0);
    int64_t d2_q16;

    if (dy_q8 > reach_q8 || dy_q8 < -reach_q8 ||
        (spot->faint && spot->area > s->max_faint_area))
        return -1;
    d2_q16 = dx_q8 * dx_q8 + dy_q8 * dy_q8;
    if (d2_q16 > reach_q8 * reach_q8)
        return -1;
    return is_far ? (d2_q16 + PIXEL2_Q16) << (is_far * FAR_LOG2) : d2_q16;
}

/* Returns the index in by_x of the first spot with x >= X_Q8, by binary search.
 */
static int find_first_spot_from_x(const struct glint_match *m,
                                  const struct glint_spot *spots, int n,
                                  int64_t x_q8)
{
    int low = 0, high = n;

    while (low < high) {
        const int middle = (low + high) / 2;

        if (spots[m->by_x[middle]].x_q8 < x_q8)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Inserts PAIR into the list of pairs of its seeker, which begins at index
 * FIRST and is sorted by cost. Pairs of equal cost have the order of by_x. Only
 * the NEAREST_SPOTS pairs of lowest cost are stored. */
static void insert_pair_if_among_nearest(struct glint_match *m, int first,
                                         struct glint_pair pair)
{
    int at = m->n_pairs;

    if (at - first == NEAREST_SPOTS) {
        if (m->pair[at - 1].cost_q16 <= pair.cost_q16)
            return;
        at--;
    } else {
        m->n_pairs++;
    }
    for (; at > first && m->pair[at - 1].cost_q16 > pair.cost_q16; at--)
        m->pair[at] = m->pair[at - 1];
    m->pair[at] = pair;
}

static void find_near_spots(struct glint_match *m, int seeker,
                            const struct glint_spot *spots, int n)
{
    const struct glint_seeker *s = &m->seeker[seeker];
    const int64_t right_q8 = (int64_t)s->x_q8 + s->reach_q8;
    const int first = m->n_pairs;

    for (int i = find_first_spot_from_x(m, spots, n,
                                        (int64_t)s->x_q8 - s->reach_q8);
         i < n && spots[m->by_x[i]].x_q8 <= right_q8; i++) {
        const int32_t spot = m->by_x[i];
        const int64_t cost = compute_match_cost_q16(s, &spots[spot]);

        if (cost >= 0)
            insert_pair_if_among_nearest(
                m, first, (struct glint_pair){cost, seeker, spot, i});
    }
}

void glint_match_assign_spots(struct glint_match *m,
                              const struct glint_spot *spots, int n)
{
    for (int i = 0; i < n; i++) {
        m->by_x[i] = i;
        m->taken[i] = 0;
    }
    glint_sort(m->by_x, n, is_spot_before, spots);
    m->n_pairs = 0;
    for (int i = 0; i < m->n_seekers; i++) {
        m->seeker[i].spot = -1;
        find_near_spots(m, i, spots, n);
    }
    for (int i = 0; i < m->n_pairs; i++)
        m->order[i] = i;
    glint_sort(m->order, m->n_pairs, is_pair_before, m);
    for (int i = 0; i < m->n_pairs; i++) {
        const struct glint_pair *p = &m->pair[m->order[i]];

        if (m->seeker[p->seeker].spot >= 0 || m->taken[p->spot])
            continue;
        m->seeker[p->seeker].spot = p->spot;
        m->taken[p->spot] = 1;
    }
}
