/* SPDX-License-Identifier: MIT
 *
 * glint/pool.h - a pool of POSIX threads behind struct glint_workers.
 *
 *     glint_pool_create(&cfg.workers, 0);
 *     ...
 *     glint_pool_destroy(cfg.workers);
 *
 * The pool is part of libglint-engine.a, except for WebAssembly. Only programs
 * that call it link it. A static program needs -pthread (pkg-config --static).
 *
 * The calling thread works as worker 0, so a pool of n creates n - 1 threads,
 * with stacks large enough for baking (GLINT_BAKE_STACK_BYTES). Workers get
 * jobs from an atomic counter; they share nothing else while jobs run. The end
 * of a run does not wait for threads that woke up after the last job had begun.
 * The threads of the pool block all signals, which go to the application's
 * threads instead, except for signals of a thread's own faults. */
#ifndef GLINT_POOL_H
#define GLINT_POOL_H

#include "glint/status.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Creates a pool of N_THREADS, 1 .. GLINT_MAX_WORKERS, including the calling
 * thread; 0: one per processor that is online. workers->n is lower if the
 * system permits no more threads. Returns GLINT_E_ARGUMENT if N_THREADS is out
 * of range, or GLINT_E_MEMORY. */
enum glint_status glint_pool_create(struct glint_workers **workers,
                                    int n_threads);

/* Ends the threads and frees WORKERS, which may be NULL. No jobs may be
 * running. */
void glint_pool_destroy(struct glint_workers *workers);

#ifdef __cplusplus
}
#endif

#endif
