/* SPDX-License-Identifier: MIT
 *
 * Chooses which regions are lamps, by their scores, and which one of regions
 * that lie within each other stands for the lamp.
 */
#include "base/sort.h"
#include "lamps/score.h"

enum { SURE_Q8 = 384 }; /* higher scores count as this one */

static int by_rank(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_candidate *p = (const struct glint_candidate *)ctx + a;
    const struct glint_candidate *q = (const struct glint_candidate *)ctx + b;

    if (p->rank_q8 != q->rank_q8)
        return p->rank_q8 > q->rank_q8;
    if (p->level != q->level)
        return p->level < q->level;
    return p->sum.first < q->sum.first;
}

/* Returns whether INNER, of a higher level, lies in the box of OUTER. */
static int is_within(const struct glint_candidate *inner,
                     const struct glint_candidate *outer)
{
    const struct glint_region *in = &inner->sum, *out = &outer->sum;

    return inner->level > outer->level && in->x0 >= out->x0 &&
           in->x1 <= out->x1 && in->y0 >= out->y0 && in->y1 <= out->y1;
}

void glint_score_choose(const struct glint_score *score,
                        struct glint_candidate *candidate, int32_t *order,
                        int n)
{
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &candidate[order[i]];

        c->rank_q8 = (c->score_q8 < SURE_Q8 ? c->score_q8 : SURE_Q8) -
                     score->level[c->level].cost_q8;
    }
    glint_sort(order, n, by_rank, candidate);
    for (int i = 0; i < n; i++) {
        const struct glint_candidate *c = &candidate[order[i]];

        for (int j = i + 1; j < n && !c->gone; j++) {
            struct glint_candidate *other = &candidate[order[j]];

            other->gone |=
                (uint8_t)(is_within(other, c) || is_within(c, other));
        }
    }
}

int32_t glint_score_least(const struct glint_score *score,
                          struct glint_candidate *candidate, int32_t *order,
                          int n)
{
    int32_t best_q8 = INT32_MIN;
    int n_over = 0, n_lamps = 0;

    for (int i = 0; i < n; i++) {
        const struct glint_candidate *c = &candidate[order[i]];

        if (!c->faint && c->score_q8 > best_q8)
            best_q8 = c->score_q8;
        if (c->score_q8 >= 0 && !c->faint) {
            const int32_t old = order[n_over];

            order[n_over++] = order[i];
            order[i] = old;
        }
    }
    if (n_over == 0)
        return best_q8 >= -score->alone_q8 ? best_q8 : 0;
    glint_score_choose(score, candidate, order, n_over);
    for (int i = 0; i < n_over; i++) {
        n_lamps += !candidate[order[i]].gone;
        candidate[order[i]].gone = 0;
    }
    return n_lamps >= SCORE_SEVERAL ? -SCORE_COMPANY : 0;
}
