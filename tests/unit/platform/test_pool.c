/* SPDX-License-Identifier: MIT
 *
 * Tests the thread pool: every job runs exactly once, with any number of
 * threads.
 */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "glint/bake.h"
#include "glint/pool.h"
#include "posix/at_death.h"
#include "posix/process.h"
#include "support/test.h"

#define MAX_JOBS 1000

struct tally {
    int runs[MAX_JOBS]; /* number of runs of each job */
    /* number of threads that now use each worker index; atomic */
    int busy[GLINT_MAX_WORKERS];
    int n_workers;
    /* atomic; number of times that two threads used the same worker index */
    int clashes;
};

static void count_job_run(void *ctx, int job, int worker)
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

static void check_jobs_run_once(int n_threads)
{
    static const int n_jobs[] = {0, 1, 2, 3, 7, 64, MAX_JOBS};
    struct glint_workers *workers;

    assert_ok(glint_pool_create(&workers, n_threads));
    assert_int_equal(workers->n, n_threads);
    for (int round = 0; round < 300; round++) {
        const int n = n_jobs[round % 7];
        static struct tally tally;

        memset(&tally, 0, sizeof tally);
        tally.n_workers = n_threads;
        glint_workers_run(workers, n, count_job_run, &tally);
        assert_int_equal(tally.clashes, 0);
        for (int job = 0; job < MAX_JOBS; job++)
            assert_int_equal(tally.runs[job], job < n);
    }
    glint_pool_destroy(workers);
}

TEST(every_job_runs_once)
{
    static const int n_threads[] = {1, 2, 3, 8, GLINT_MAX_WORKERS};

    for (size_t i = 0; i < sizeof n_threads / sizeof *n_threads; i++)
        check_jobs_run_once(n_threads[i]);
}

static void add_job_number(void *ctx, int job, int worker)
{
    uint64_t *const sums = ctx;

    sums[worker] += (uint64_t)job;
}

/* Checks, in many rounds, that the results of all jobs are visible when run()
 * returns. */
TEST(results_are_visible)
{
    struct glint_workers *workers;

    assert_ok(glint_pool_create(&workers, 4));
    for (int round = 0; round < 2000; round++) {
        uint64_t sums[4] = {0, 0, 0, 0};

        workers->run(workers, 100, add_job_number, sums);
        assert_int_equal(sums[0] + sums[1] + sums[2] + sums[3], 4950);
    }
    glint_pool_destroy(workers);
}

TEST(idle_pools_can_be_destroyed)
{
    struct glint_workers *workers;

    for (int i = 0; i < 50; i++) {
        assert_ok(glint_pool_create(&workers, 1 + i % 8));
        glint_pool_destroy(workers);
    }
    glint_pool_destroy(NULL);
}

TEST(rejects_invalid_numbers_of_workers)
{
    struct glint_workers *workers = NULL;

    assert_int_equal(glint_pool_create(&workers, -1), GLINT_E_ARGUMENT);
    assert_int_equal(glint_pool_create(&workers, GLINT_MAX_WORKERS + 1),
                     GLINT_E_ARGUMENT);
    assert_null(workers);
}

TEST(default_pool_has_a_worker_per_processor)
{
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    struct glint_workers *workers;

    assert_ok(glint_pool_create(&workers, 0));
    assert_int_equal(workers->n, n > GLINT_MAX_WORKERS ? GLINT_MAX_WORKERS : n);
    glint_pool_destroy(workers);
}

/* --------------------------------------------------------- missing threads */

/* number of threads that pthread_create() can still start; -1: no limit */
static int threads_left = -1;

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attr,
                          void *(*start)(void *), void *arg);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr,
                          void *(*start)(void *), void *arg);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr,
                          void *(*start)(void *), void *arg)
{
    if (threads_left == 0)
        return EAGAIN;
    threads_left -= threads_left > 0;
    return __real_pthread_create(thread, attr, start, arg);
}

TEST(missing_threads_do_not_lose_jobs)
{
    for (int left = 0; left < 4; left++) {
        struct glint_workers *workers;
        uint64_t sums[8] = {0}, sum = 0;

        threads_left = left;
        assert_ok(glint_pool_create(&workers, 8));
        threads_left = -1;
        assert_int_equal(workers->n, left + 1);
        workers->run(workers, 100, add_job_number, sums);
        for (int i = 0; i < 8; i++) {
            assert_true(i <= left || sums[i] == 0);
            sum += sums[i];
        }
        assert_int_equal(sum, 4950);
        glint_pool_destroy(workers);
    }
}

/* -------------------------------------------------------------- stack size */

/* Uses as much stack as a bake may need. The function is not inlined, as its
 * callers would then need as much stack themselves. */
__attribute__((noinline)) static int use_stack(void *ctx)
{
    volatile char hole[GLINT_BAKE_STACK_BYTES];

    for (size_t i = 0; i < sizeof hole; i += 512)
        hole[i] = 1;
    return *(int *)ctx + hole[512];
}

/* Runs use_stack() in the helper thread, on the stack of that thread. The
 * calling thread only waits. */
static void use_stack_in_helper(void *ctx, int job, int worker)
{
    int *const dug = ctx;

    (void)job;
    if (worker > 0)
        __atomic_store_n(dug, use_stack(&worker), __ATOMIC_SEQ_CST);
    while (!__atomic_load_n(dug, __ATOMIC_SEQ_CST))
        sched_yield();
}

/* Runs WORK in a child process whose threads have 256 KiB of stack by
 * default. */
static void run_with_small_stack(int (*work)(void))
{
    const struct rlimit little = {256 << 10, 256 << 10};
    const pid_t child = fork();
    int how;

    if (child == 0) {
        setrlimit(RLIMIT_STACK, &little);
        _exit(work());
    }
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_true(WIFEXITED(how));
    assert_int_equal(WEXITSTATUS(how), 0);
}

static int use_stack_in_pool_thread(void)
{
    struct glint_workers *workers;
    int dug = 0;

    if (glint_pool_create(&workers, 2) != GLINT_OK)
        return 1;
    workers->run(workers, 2, use_stack_in_helper, &dug);
    return dug != 2;
}

static int use_stack_in_large_thread(void)
{
    int two = 2;

    return glint_process_run_with_stack(GLINT_WORKER_STACK_BYTES, use_stack,
                                        &two) != 3;
}

TEST(threads_have_enough_stack)
{
    run_with_small_stack(use_stack_in_pool_thread);
    run_with_small_stack(use_stack_in_large_thread);
    /* if no thread can start, the calling thread runs use_stack() */
    threads_left = 0;
    assert_int_equal(
        glint_process_run_with_stack(SIZE_MAX / 4, use_stack, &(int){4}), 5);
    threads_left = -1;
}

/* ------------------------------------------------------------------- faults */

static int child_pipe[2]; /* pipe from the child to the test */

static void write_child_pipe(void)
{
    if (write(child_pipe[1], "x", 1) != 1)
        _exit(98);
}

/* Causes a fault in the helper thread, while the calling thread waits. */
static void fault_in_helper_thread(void *ctx, int job, int worker)
{
    volatile char *const nowhere = ctx;

    (void)job;
    while (worker == 0)
        pause();
    *nowhere = 1;
}

/* Checks that a fault in a helper thread runs the functions that are registered
 * for the end of the process. */
TEST(fault_in_a_helper_runs_functions)
{
    const size_t bytes = (size_t)sysconf(_SC_PAGESIZE);
    void *const nowhere =
        mmap(NULL, bytes, PROT_NONE, MAP_SHARED, open("/dev/zero", O_RDWR), 0);
    const struct rlimit no_core = {0, 0};
    struct glint_workers *workers;
    char text[4];
    pid_t child;
    int how;

    assert_int_equal(pipe(child_pipe), 0);
    child = fork();
    if (child == 0) {
        signal(SIGSEGV, SIG_DFL); /* replaces cmocka's handler */
        signal(SIGBUS, SIG_DFL);
        setrlimit(RLIMIT_CORE, &no_core);
        if (!glint_at_death_register(write_child_pipe) ||
            glint_pool_create(&workers, 2))
            _exit(97);
        workers->run(workers, 2, fault_in_helper_thread, nowhere);
        _exit(96);
    }
    close(child_pipe[1]);
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_true(WIFSIGNALED(how));
    assert_int_equal(WTERMSIG(how), SIGSEGV);
    assert_int_equal(read(child_pipe[0], text, sizeof text), 1);
    close(child_pipe[0]);
    munmap(nowhere, bytes);
}
