/* SPDX-License-Identifier: MIT
 *
 * A scheduler that runs jobs one at a time in random order, each as a random
 * worker. With it, tests detect results that depend on the order of jobs or on
 * the worker.
 */
#ifndef GLINT_TESTS_SHUFFLE_H
#define GLINT_TESTS_SHUFFLE_H

#include <stdint.h>
#include <stdlib.h>

#include "support/rng.h"
#include "glint/workers.h"

struct shuffle {
    struct glint_workers workers;
    uint32_t state;
};

static inline void run_jobs_shuffled(struct glint_workers *workers, int n_jobs,
                                     glint_job_fn *fn, void *ctx)
{
    struct shuffle *s = (struct shuffle *)workers;
    int *order = malloc((size_t)(n_jobs + 1) * sizeof *order);

    for (int i = 0; i < n_jobs; i++)
        order[i] = i;
    for (int i = n_jobs - 1; i > 0; i--) {
        const int j = (int)(rng_xorshift(&s->state) % (uint32_t)(i + 1));
        const int swap = order[i];

        order[i] = order[j];
        order[j] = swap;
    }
    for (int i = 0; i < n_jobs; i++)
        fn(ctx, order[i],
           (int)(rng_xorshift(&s->state) % (uint32_t)workers->n));
    free(order);
}

static inline void init_shuffled_workers(struct shuffle *s, int n,
                                         uint32_t seed)
{
    s->workers.n = n;
    s->workers.run = run_jobs_shuffled;
    s->state = seed ? seed : 1;
}

#endif
