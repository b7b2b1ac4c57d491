/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* for SIGSYS */
#include "glint/pool.h"

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#include "posix/process.h"

struct pool;

struct helper {
    struct pool *pool;
    int worker; /* number of this worker, 1 .. n - 1 */
    pthread_t thread;
};

struct pool {
    /* first member, so that a pool can be used as a glint_workers */
    struct glint_workers base;
    pthread_mutex_t lock; /* guards round, open, quit and busy */
    pthread_cond_t wake;  /* signals that a round was opened, or that quit was
                             set */
    pthread_cond_t idle;  /* signals that busy became 0 */
    unsigned round;       /* number of rounds opened so far; a round runs one
                             set of jobs */
    bool open;            /* true: more helper threads may join the round */
    bool quit;
    int busy; /* number of helper threads that run jobs of the round */

    /* The members below are constant while a round is open or a helper is
     * busy. */
    glint_job_fn *fn;
    void *ctx;
    unsigned n_jobs;

    /* Index of the next job; atomic. It is unsigned because every worker
     * increments it once more after the last job. */
    unsigned next;
    int n_helpers;
    struct helper helper[GLINT_MAX_WORKERS - 1];
};

static void run_remaining_jobs(struct pool *p, int worker)
{
    unsigned job;

    while ((job = __atomic_fetch_add(&p->next, 1, __ATOMIC_RELAXED)) <
           p->n_jobs)
        p->fn(p->ctx, (int)job, worker);
}

static void *run_helper_thread(void *arg)
{
    const struct helper *const h = arg;
    struct pool *const p = h->pool;
    unsigned seen = 0;

    pthread_mutex_lock(&p->lock);
    for (;;) {
        while (!p->quit && (!p->open || p->round == seen))
            pthread_cond_wait(&p->wake, &p->lock);
        if (p->quit)
            break;
        seen = p->round;
        p->busy++;
        pthread_mutex_unlock(&p->lock);
        run_remaining_jobs(p, h->worker);
        pthread_mutex_lock(&p->lock);
        if (--p->busy == 0)
            pthread_cond_signal(&p->idle);
    }
    pthread_mutex_unlock(&p->lock);
    return NULL;
}

static void run_jobs(struct glint_workers *workers, int n_jobs,
                     glint_job_fn *fn, void *ctx)
{
    struct pool *const p = (struct pool *)workers;

    if (n_jobs <= 1 || p->n_helpers == 0) {
        for (int job = 0; job < n_jobs; job++)
            fn(ctx, job, 0);
        return;
    }
    pthread_mutex_lock(&p->lock);
    p->fn = fn;
    p->ctx = ctx;
    p->n_jobs = (unsigned)n_jobs;
    p->next = 0;
    p->round++;
    p->open = true;
    pthread_cond_broadcast(&p->wake);
    pthread_mutex_unlock(&p->lock);

    run_remaining_jobs(p, 0);

    pthread_mutex_lock(&p->lock);
    /* Helper threads that have not woken up yet must not join: no job is
     * left. */
    p->open = false;
    while (p->busy > 0)
        pthread_cond_wait(&p->idle, &p->lock);
    pthread_mutex_unlock(&p->lock);
}

/* Blocks all signals except those of faults of the thread itself (SIGSEGV ...).
 * If these were blocked, a fault would kill the process without running the
 * functions of posix/at_death.h. */
static void block_signals(sigset_t *old)
{
    static const int faults[] = {SIGSEGV, SIGBUS,  SIGILL, SIGFPE,
                                 SIGABRT, SIGTRAP, SIGSYS};
    sigset_t held;

    sigfillset(&held);
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
        sigdelset(&held, faults[i]);
    pthread_sigmask(SIG_SETMASK, &held, old);
}

/* Starts N helper threads, or as many as the system permits. */
static void start_helpers(struct pool *p, int n)
{
    pthread_attr_t attr;
    sigset_t old;

    if (pthread_attr_init(&attr))
        return;
    block_signals(&old);
    pthread_attr_setstacksize(&attr, GLINT_WORKER_STACK_BYTES);
    while (p->n_helpers < n) {
        struct helper *const h = &p->helper[p->n_helpers];

        h->pool = p;
        h->worker = p->n_helpers + 1;
        if (pthread_create(&h->thread, &attr, run_helper_thread, h))
            break;
        p->n_helpers++;
    }
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    pthread_attr_destroy(&attr);
}

/* Returns the number of processors online, 1 .. GLINT_MAX_WORKERS. */
static int count_processors(void)
{
    const long n = sysconf(_SC_NPROCESSORS_ONLN);

    return n < 1 ? 1 : n > GLINT_MAX_WORKERS ? GLINT_MAX_WORKERS : (int)n;
}

enum glint_status glint_pool_create(struct glint_workers **workers,
                                    int n_threads)
{
    struct pool *p;

    if (n_threads < 0 || n_threads > GLINT_MAX_WORKERS)
        return GLINT_E_ARGUMENT;
    p = calloc(1, sizeof *p);
    if (!p)
        return GLINT_E_MEMORY;
    p->base.run = run_jobs;
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->wake, NULL);
    pthread_cond_init(&p->idle, NULL);
    start_helpers(p, (n_threads ? n_threads : count_processors()) - 1);
    p->base.n = p->n_helpers + 1;
    *workers = &p->base;
    return GLINT_OK;
}

void glint_pool_destroy(struct glint_workers *workers)
{
    struct pool *const p = (struct pool *)workers;

    if (!p)
        return;
    pthread_mutex_lock(&p->lock);
    p->quit = true;
    pthread_cond_broadcast(&p->wake);
    pthread_mutex_unlock(&p->lock);
    for (int i = 0; i < p->n_helpers; i++)
        pthread_join(p->helper[i].thread, NULL);
    pthread_cond_destroy(&p->idle);
    pthread_cond_destroy(&p->wake);
    pthread_mutex_destroy(&p->lock);
    free(p);
}
