/* SPDX-License-Identifier: MIT
 *
 * posix/workers.h - a pool of POSIX threads behind struct glint_workers.
 *
 *     glint_pool_create(&workers, glint_cpu_count());
 *     cfg.workers = workers;
 *     ...
 *     glint_pool_destroy(workers);
 *
 * The calling thread takes part as worker 0, so a pool of n makes n - 1
 * threads and a pool of one makes none. Jobs are handed out by one counter;
 * nothing else is shared while they run. A thread that has not woken up before
 * the last job was handed out is not waited for. Signals are blocked in the
 * threads of the pool and go to those of the application, except for signals of
 * a thread's own faults.
 */
#ifndef GLINT_PLATFORM_POSIX_WORKERS_H
#define GLINT_PLATFORM_POSIX_WORKERS_H

#include "glint/status.h"
#include "glint/workers.h"

#define GLINT_MAX_WORKERS 64

/* Bytes of each thread's stack, whatever the system's default: those that
 * baking takes (GLINT_BAKE_STACK_BYTES), and with a sanitizer several times as
 * many. */
#ifdef GLINT_SANITIZED
#define GLINT_WORKER_STACK_BYTES (16 << 20)
#else
#define GLINT_WORKER_STACK_BYTES (2 << 20)
#endif

/* Makes a pool of N_THREADS, 1 .. GLINT_MAX_WORKERS, the caller among them; of
 * fewer if the system gives no more threads, as workers->n says.
 * GLINT_E_ARGUMENT: N_THREADS is out of range. GLINT_E_MEMORY. */
enum glint_status glint_pool_create(struct glint_workers **workers,
                                    int n_threads);

/* Ends the threads and frees WORKERS, which may be NULL, but must not be
 * running. */
void glint_pool_destroy(struct glint_workers *workers);

/* Returns the number of processors online, 1 .. GLINT_MAX_WORKERS. */
int glint_cpu_count(void);

#endif
