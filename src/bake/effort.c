/* SPDX-License-Identifier: MIT */
#include "bake/effort.h"

#include <math.h>

/* Estimated work, in zone fits, for each enum glint_effort_kind. head_work:
 * finding the brightness levels before the first ghost. angle_work: finding the
 * visible angles of one ghost. typical_work: all work for one ghost. */
static const double head_work[] = {32, 32, 90};
static const double angle_work[] = {1.5, 1.5, 25};
static const double typical_work[] = {4, 25, 110};
/* typical_work is averaged with the measured work of the finished ghosts. It
 * has the weight of this number of ghosts. */
#define TRUST 3.0
/* upper limit of the estimated work of a ghost, as a multiple of
 * typical_work */
#define MOST 10.0
/* The work of the current ghost is extrapolated from the fraction of its angles
 * that are done. This value is blended with the mean work per ghost, which has
 * the weight BLUR; the extrapolated value has the weight of the fraction. */
#define BLUR 0.1

void glint_effort_init(struct glint_effort *e, int n_ghosts, int n_workers,
                       enum glint_effort_kind kind)
{
    *e = (struct glint_effort){.n_ghosts = n_ghosts,
                               .n_workers = n_workers,
                               .head = head_work[kind],
                               .look = angle_work[kind],
                               .typical = typical_work[kind],
                               .ghost = -1};
}

void glint_effort_set_estimates(struct glint_effort *e, double head,
                                double typical)
{
    e->head = head;
    e->look = 1;
    e->typical = typical;
    e->expected = e->n_ghosts * typical;
}

void glint_effort_begin_ghost(struct glint_effort *e, int ghost)
{
    e->ghost = ghost > e->ghost ? ghost : e->ghost;
    e->work = e->look;
    e->share = 0;
}

void glint_effort_record_work(struct glint_effort *e, double work, double share)
{
    e->work = e->look + work;
    e->share = fmin(1, share);
}

void glint_effort_end_ghost(struct glint_effort *e)
{
    e->n_ended++;
    e->ended += e->work;
    e->work = 0;
    e->share = 1;
}

/* Estimates the remaining time of worker 0 in zone fits. Assumes that all
 * workers do equal amounts of work. */
static double estimate_remaining_work(const struct glint_effort *e)
{
    const int rest = e->n_ghosts - 1 - e->ghost;
    const int beside = (int)fmin(e->n_workers - 1, rest);
    const double known = TRUST * e->typical + e->ended;
    const double mean = known / (TRUST + e->n_ended);
    double own = 0, all = mean, others;

    if (e->work > 0 && e->share < 1) {
        own = fmax(0, (e->work + BLUR * mean) / (e->share + BLUR) - e->work);
        all = (known + e->work + own) / (TRUST + e->n_ended + 1);
    }
    /* the ghosts that other workers are fitting count as half done */
    others = (rest - 0.5 * beside) * all;
    if (e->expected > 0)
        others =
            fmax(others, fmin(e->expected - e->n_workers * (e->ended + e->work),
                              MOST * e->typical * rest));
    return fmax(own, (own + others) / e->n_workers);
}

double glint_effort_estimate_progress(const struct glint_effort *e)
{
    const double spent = e->head / e->n_workers + e->ended + e->work;

    return spent / (spent + estimate_remaining_work(e));
}
