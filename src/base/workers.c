/* SPDX-License-Identifier: MIT */
#include "glint/workers.h"

#include <stddef.h>

void glint_workers_run(struct glint_workers *workers, int n_jobs,
                       glint_job_fn *fn, void *ctx)
{
    if (workers) {
        workers->run(workers, n_jobs, fn, ctx);
        return;
    }
    for (int job = 0; job < n_jobs; job++)
        fn(ctx, job, 0);
}

int glint_workers_count(const struct glint_workers *workers)
{
    return workers ? workers->n : 1;
}
