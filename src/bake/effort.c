/* SPDX-License-Identifier: MIT */
#include "bake/effort.h"

#include <math.h>

/* Work in units of zone fits, per enum glint_effort_kind: finding the
 * brightness before ghosts are fitted; finding the angles of a ghost; a
 * typical ghost. */
static const double heads[] = {32, 32, 90};
static const double looks[] = {1.5, 1.5, 25};
static const double typicals[] = {4, 25, 110};
/* Weight of the typical work in the mean work of ghosts, in ghosts. */
#define TRUST 3.0
/* Max work of a ghost, as a multiple of the typical work. */
#define MOST 10.0
/* Weight of the mean of other ghosts when the work of the current ghost is
 * extrapolated, as a fraction of its angles. */
#define BLUR 0.1

void glint_effort_init(struct glint_effort *e, int n_ghosts, int n_workers,
                       enum glint_effort_kind kind)
{
    *e = (struct glint_effort){.n_ghosts = n_ghosts,
                               .n_workers = n_workers,
                               .head = heads[kind],
                               .look = looks[kind],
                               .typical = typicals[kind],
                               .ghost = -1};
}

void glint_effort_expect(struct glint_effort *e, double head, double typical)
{
    e->head = head;
    e->look = 1;
    e->typical = typical;
    e->expected = e->n_ghosts * typical;
}

void glint_effort_begin(struct glint_effort *e, int ghost)
{
    e->ghost = ghost > e->ghost ? ghost : e->ghost;
    e->work = e->look;
    e->share = 0;
}

void glint_effort_spend(struct glint_effort *e, double work, double share)
{
    e->work = e->look + work;
    e->share = fmin(1, share);
}

void glint_effort_end(struct glint_effort *e)
{
    e->n_ended++;
    e->ended += e->work;
    e->work = 0;
    e->share = 1;
}

/* Estimates the remaining time in fits of worker 0, assuming that all
 * workers do equal amounts of work. */
static double estimate_rest(const struct glint_effort *e)
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
    /* The ghosts of the other workers are assumed to be half done. */
    others = (rest - 0.5 * beside) * all;
    if (e->expected > 0)
        others =
            fmax(others, fmin(e->expected - e->n_workers * (e->ended + e->work),
                              MOST * e->typical * rest));
    return fmax(own, (own + others) / e->n_workers);
}

double glint_effort_done(const struct glint_effort *e)
{
    const double spent = e->head / e->n_workers + e->ended + e->work;

    return spent / (spent + estimate_rest(e));
}
