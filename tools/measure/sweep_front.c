/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/sweep.h"

/* ------------------------------------------------------------------- front */

static bool is_flux_error_small(double flux_error)
{
    return fabs(flux_error) <= MAX_FLUX_ERROR;
}

struct entry {
    double cost, quality;
    int number;
};

/* Orders entries by rising cost, at equal cost by falling quality. */
static int compare_entry_cost(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;

    if (x->cost != y->cost)
        return x->cost < y->cost ? -1 : 1;
    if (x->quality != y->quality)
        return x->quality > y->quality ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

int sweep_find_front(const double *cost, const double *quality, int n,
                     int *front)
{
    struct entry *all = malloc((size_t)(n + 1) * sizeof *all);
    int n_all = 0, n_front = 0;

    if (!all)
        return 0;
    for (int i = 0; i < n; i++)
        if (isfinite(cost[i]) && isfinite(quality[i]))
            all[n_all++] = (struct entry){cost[i], quality[i], i};
    qsort(all, (size_t)n_all, sizeof *all, compare_entry_cost);
    for (int i = 0; i < n_all; i++)
        if (n_front == 0 || all[i].quality > quality[front[n_front - 1]])
            front[n_front++] = all[i].number;
    free(all);
    return n_front;
}

void sweep_mark_fronts(struct sweep *s)
{
    for (int c = 0; c < s->n_cases; c++) {
        const struct sweep_case *const k = &s->scase[c];
        struct sweep_point *const point = s->point + k->first;
        double *const cost = malloc((size_t)k->n * sizeof *cost);
        double *const quality = malloc((size_t)k->n * sizeof *quality);
        int *const front = malloc((size_t)k->n * sizeof *front), n = 0;

        for (int i = 0; i < k->n && cost && quality; i++) {
            cost[i] = is_flux_error_small(point[i].metric[SWEEP_FLUX_ERROR])
                          ? point[i].metric[SWEEP_RATIO]
                          : (double)NAN;
            quality[i] = point[i].metric[SWEEP_PSNR_DB];
        }
        if (cost && quality && front)
            n = sweep_find_front(cost, quality, k->n, front);
        for (int i = 0; i < n; i++)
            point[front[i]].front = true;
        free(cost);
        free(quality);
        free(front);
    }
}

/* ------------------------------------------------------------------- means */

/* Sets M to the means of setting I over all cases with combined parameters,
 * which all have the same settings. Returns false if a case has not measured
 * this setting. */
static bool compute_means_of_setting(const struct sweep *s, int i,
                                     struct sweep_mean *m)
{
    int n = 0;

    *m = (struct sweep_mean){.least_db = 999};
    for (int k = 0; k < s->n_cases; k++) {
        const struct sweep_case *c = &s->scase[k];
        const struct sweep_point *const p =
            c->together ? &s->point[c->first + i] : NULL;
        const double db = p ? p->metric[SWEEP_PSNR_DB] : 0;

        if (isnan(db))
            return false;
        if (!p)
            continue;
        m->set = &p->set;
        m->cost += log(p->metric[SWEEP_RATIO] /
                       s->point[c->first].metric[SWEEP_RATIO]);
        m->psnr_db += db;
        m->least_db = fmin(m->least_db, db);
        m->flux_error = fmax(m->flux_error, fabs(p->metric[SWEEP_FLUX_ERROR]));
        n++;
    }
    m->cost = exp(m->cost / n);
    m->psnr_db /= n;
    return n > 0 && isfinite(m->cost);
}

/* Orders means by rising cost, at equal cost by falling PSNR. */
static int compare_mean_cost(const void *a, const void *b)
{
    const struct sweep_mean *x = a, *y = b;

    if (x->cost != y->cost)
        return x->cost < y->cost ? -1 : 1;
    return (x->psnr_db < y->psnr_db) - (x->psnr_db > y->psnr_db);
}

void sweep_sort_means(struct sweep_mean *mean, int n)
{
    if (n > 0)
        qsort(mean, (size_t)n, sizeof *mean, compare_mean_cost);
}

/* Marks the Pareto front of MEAN[N], which must be sorted by cost. */
static void mark_front_of_means(struct sweep_mean *mean, int n)
{
    double best = -HUGE_VAL;

    for (int i = 0; i < n; i++) {
        mean[i].front =
            is_flux_error_small(mean[i].flux_error) && mean[i].psnr_db > best;
        if (mean[i].front)
            best = mean[i].psnr_db;
    }
}

struct sweep_mean *sweep_compute_means(const struct sweep *s, int *n)
{
    struct sweep_mean *mean = malloc(((size_t)s->n_points + 1) * sizeof *mean);
    int first = 0;

    *n = 0;
    while (first < s->n_cases && !s->scase[first].together)
        first++;
    for (int i = 0; mean && first < s->n_cases && i < s->scase[first].n; i++)
        *n += compute_means_of_setting(s, i, &mean[*n]);
    sweep_sort_means(mean, *n);
    mark_front_of_means(mean, *n);
    return mean;
}

/* ----------------------------------------------------------------- quality */

static bool have_cases_same_pixels(const struct sweep_mean *a,
                                   const struct sweep_mean *b)
{
    for (int d = 0; d < n_sweep_parameters; d++)
        if (strcmp(sweep_parameter[d].name, "half") == 0)
            return a->set->value[d] == b->set->value[d];
    return true;
}

/* Returns the PSNR at COST, interpolated between A and B linearly in
 * log(cost). */
static double interpolate_psnr(const struct sweep_mean *a,
                               const struct sweep_mean *b, double cost)
{
    return a->psnr_db + (b->psnr_db - a->psnr_db) * log(cost / a->cost) /
                            log(b->cost / a->cost);
}

double sweep_compute_gain_above_front(const struct sweep_mean *mean, int n,
                                      int i)
{
    const double cost = 1.02 * mean[i].cost;
    const struct sweep_mean *last = NULL;
    double best = -HUGE_VAL;

    for (int k = 0; k < n; k++) {
        const struct sweep_mean *m = &mean[k];

        if (m->set->kind != SWEEP_QUALITY)
            continue;
        if (m->cost <= cost)
            best = fmax(best, m->psnr_db);
        else if (last && last->cost <= cost && have_cases_same_pixels(last, m))
            best = fmax(best, interpolate_psnr(last, m, cost));
        last = m;
    }
    return mean[i].psnr_db - best;
}
