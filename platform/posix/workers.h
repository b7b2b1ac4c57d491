/* SPDX-License-Identifier: MIT
 *
 * posix/workers.h - a pool of POSIX threads behind struct glint_workers.
 *
 *     glint_pool_create(&workers, glint_cpu_count());
 *     cfg.workers = workers;
 *     ...
 *     glint_pool_destroy(workers);
 *
 * The calling thread works as worker 0, so a pool of n creates n - 1 threads.
 * Workers get jobs from an atomic counter; they share nothing else while jobs
 * run. The end of a run does not wait for threads that woke up after the last
 * job had begun. Signals are blocked in the threads of the pool and go to those
 * of the application, except for signals of a thread's own faults.
 */
#ifndef GLINT_PLATFORM_POSIX_WORKERS_H
#define GLINT_PLATFORM_POSIX_WORKERS_H

#include "glint/status.h"
#include "glint/workers.h"

#define GLINT_MAX_WORKERS 64

/* Bytes of each thread's stack, whatever the system's default: enough for
 * baking (GLINT_BAKE_STACK_BYTES), which needs several times more under a
 * sanitizer. */
#ifdef GLINT_SANITIZED
#define GLINT_WORKER_STACK_BYTES (16 << 20)
#else
#define GLINT_WORKER_STACK_BYTES (2 << 20)
#endif

/* Makes a pool of N_THREADS, 1 .. GLINT_MAX_WORKERS, including the caller.
 * workers->n is lower if the system permits no more threads. Returns
 * GLINT_E_ARGUMENT if N_THREADS is out of range, or GLINT_E_MEMORY. */
enum glint_status glint_pool_create(struct glint_workers **workers,
                                    int n_threads);

/* Ends the threads and frees WORKERS, which may be NULL, but must not be
 * running. */
void glint_pool_destroy(struct glint_workers *workers);

/* Returns the number of processors online, 1 .. GLINT_MAX_WORKERS. */
int glint_cpu_count(void);

#endif
