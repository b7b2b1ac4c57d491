/* SPDX-License-Identifier: MIT
 *
 * glint/workers.h - the parallel-for that an application passes to glint.
 *
 * glint starts no threads of its own: a program passes its own workers, or the
 * pool of glint/pool.h. Where a header takes a struct glint_workers, NULL means
 * that the calling thread does all the work. No result depends on the number of
 * workers or on the order of the jobs.
 */
#ifndef GLINT_WORKERS_H
#define GLINT_WORKERS_H

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_WORKERS 64

/* Does job number JOB. WORKER, 0 .. n - 1, is the number of the worker that
 * calls it; no two threads have the same number at the same time. */
typedef void glint_job_fn(void *ctx, int job, int worker);

struct glint_workers {
    int n; /* threads that may run jobs at once, 1 .. GLINT_MAX_WORKERS */

    /* Calls FN once for each job 0 .. n_jobs - 1, in any order, and returns
     * when all jobs are done. Jobs must not call RUN. */
    void (*run)(struct glint_workers *workers, int n_jobs, glint_job_fn *fn,
                void *ctx);
};

/* Runs the jobs on WORKERS, or in the calling thread if WORKERS is NULL. */
void glint_workers_run(struct glint_workers *workers, int n_jobs,
                       glint_job_fn *fn, void *ctx);

/* Returns the number of workers; 1 if WORKERS is NULL. */
int glint_workers_count(const struct glint_workers *workers);

#ifdef __cplusplus
}
#endif

#endif
