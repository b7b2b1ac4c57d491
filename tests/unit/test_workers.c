/* SPDX-License-Identifier: MIT
 *
 * The pool runs every job exactly once, whatever the number of threads.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "posix/workers.h"

#define MAX_JOBS 1000

struct tally {
    int runs[MAX_JOBS];          /* of each job; a job is one thread's alone */
    int busy[GLINT_MAX_WORKERS]; /* atomic: threads inside as that worker */
    int n_workers;
    int clashes; /* atomic */
};

static void count(void *ctx, int job, int worker)
{
    struct tally *const t = ctx;

    if (worker < 0 || worker >= t->n_workers ||
        __atomic_fetch_add(&t->busy[worker], 1, __ATOMIC_RELAXED) != 0)
        __atomic_fetch_add(&t->clashes, 1, __ATOMIC_RELAXED);
    t->runs[job]++;
    for (volatile int spin = 0; spin < job % 7 * 50; spin++)
        ;
    __atomic_fetch_sub(&t->busy[worker], 1, __ATOMIC_RELAXED);
}

static void check_rounds(int n_threads)
{
    static const int n_jobs[] = {0, 1, 2, 3, 7, 64, MAX_JOBS};
    struct glint_workers *workers;

    assert_int_equal(glint_pool_create(&workers, n_threads), GLINT_OK);
    assert_int_equal(workers->n, n_threads);
    for (int round = 0; round < 300; round++) {
        const int n = n_jobs[round % 7];
        static struct tally tally;

        memset(&tally, 0, sizeof tally);
        tally.n_workers = n_threads;
        glint_workers_run(workers, n, count, &tally);
        assert_int_equal(tally.clashes, 0);
        for (int job = 0; job < MAX_JOBS; job++)
            assert_int_equal(tally.runs[job], job < n);
    }
    glint_pool_destroy(workers);
}

static void test_every_job_once(void **state)
{
    static const int n_threads[] = {1, 2, 3, 8, GLINT_MAX_WORKERS};

    (void)state;
    for (size_t i = 0; i < sizeof n_threads / sizeof *n_threads; i++)
        check_rounds(n_threads[i]);
}

static void add(void *ctx, int job, int worker)
{
    uint64_t *const sums = ctx;

    sums[worker] += (uint64_t)job;
}

/* What the jobs wrote is there when run returns, round after round. */
static void test_results_are_visible(void **state)
{
    struct glint_workers *workers;

    (void)state;
    assert_int_equal(glint_pool_create(&workers, 4), GLINT_OK);
    for (int round = 0; round < 2000; round++) {
        uint64_t sums[4] = {0, 0, 0, 0};

        workers->run(workers, 100, add, sums);
        assert_int_equal(sums[0] + sums[1] + sums[2] + sums[3], 4950);
    }
    glint_pool_destroy(workers);
}

static void test_idle_pools(void **state)
{
    struct glint_workers *workers;

    (void)state;
    for (int i = 0; i < 50; i++) {
        assert_int_equal(glint_pool_create(&workers, 1 + i % 8), GLINT_OK);
        glint_pool_destroy(workers);
    }
    glint_pool_destroy(NULL);
}

static void test_refuses(void **state)
{
    struct glint_workers *workers = NULL;

    (void)state;
    assert_int_equal(glint_pool_create(&workers, 0), GLINT_E_ARGUMENT);
    assert_int_equal(glint_pool_create(&workers, GLINT_MAX_WORKERS + 1),
                     GLINT_E_ARGUMENT);
    assert_null(workers);
}

static void test_cpu_count(void **state)
{
    (void)state;
    assert_in_range(glint_cpu_count(), 1, GLINT_MAX_WORKERS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_job_once),
        cmocka_unit_test(test_results_are_visible),
        cmocka_unit_test(test_idle_pools),
        cmocka_unit_test(test_refuses),
        cmocka_unit_test(test_cpu_count),
    };

    return cmocka_run_group_tests_name("workers", tests, NULL, NULL);
}
