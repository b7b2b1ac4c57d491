/* SPDX-License-Identifier: MIT */
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/arena.h"
#include "base/compiler.h"
#include "base/q.h"
#include "glint/image.h"
#include "glint/workers.h"
#include "support/test.h"

TEST(allocates_what_it_has_measured)
{
    /* glint_arena_init_in_memory() leaves the alignment of the memory to the
     * caller. */
    static uint8_t mem[256];
    struct glint_arena m = glint_arena_begin_measuring(), p;

    assert_null(glint_arena_allocate(&m, 3, 4));  /* 64 bytes */
    assert_null(glint_arena_allocate(&m, 0, 4));  /* 0 bytes */
    assert_null(glint_arena_allocate(&m, 65, 1)); /* 128 bytes */
    assert_int_equal(m.used, 192);
    p = glint_arena_init_in_memory(mem, 192);
    assert_ptr_equal(glint_arena_allocate(&p, 3, 4), mem);
    assert_ptr_equal(glint_arena_allocate(&p, 0, 4), mem + 64);
    assert_ptr_equal(glint_arena_allocate(&p, 65, 1), mem + 64);
    assert_null(glint_arena_allocate(&p, 1, 1));
    assert_true(p.used > p.size);
}

TEST(overflowing_size_fills_the_arena)
{
    struct glint_arena m = glint_arena_begin_measuring();

    assert_null(glint_arena_allocate(&m, SIZE_MAX / 2, 4));
    assert_null(glint_arena_allocate(&m, 1, 1));
    assert_true(m.used > SIZE_MAX - 256);
}

/* Ties are rounded up, also for negative numbers. */
TEST(rounds_to_nearest_ties_up)
{
    assert_int_equal(q_shift(5, 1), 3);
    assert_int_equal(q_shift(-5, 1), -2);
    assert_int_equal(q_shift(-6, 2), -1);
    assert_int_equal(q_shift(7, 0), 7);
    assert_int_equal(q_mul(3 << 8, 5 << 8, 8), 15 << 8);
    assert_int_equal(q_mul(-1, 1, 1), 0);
    assert_int_equal(q_clamp_sat(1000, -5, 5), 5);
    assert_int_equal(Q_CONST(-0.5, 3), -4);
    assert_int_equal(q_root(0), 0);
    assert_int_equal(q_root(24), 4);
    assert_int_equal(q_root(25), 5);
    assert_true(q_root(UINT64_MAX) == UINT32_MAX);
    assert_int_equal(bit_length(0), 0);
    assert_int_equal(bit_length(UINT64_MAX), 64);
    assert_int_equal(bit_length(1 << 8), 9);
}

/* Checks that a build with CONFIG=qcheck traps if a result does not fit.
 * Skipped in other builds, where the result may wrap. */
TEST(qcheck_traps_on_overflow)
{
#ifdef GLINT_Q_CHECK
    {
        const pid_t child = fork();
        int status;

        if (child == 0) {
            volatile int64_t big = INT64_C(1) << 40;

            signal(SIGILL, SIG_DFL); /* cmocka handles SIGILL */
            signal(SIGTRAP, SIG_DFL);
            _exit(q_narrow(big) == 0);
        }
        assert_true(child > 0 && waitpid(child, &status, 0) == child);
        assert_true(WIFSIGNALED(status));
    }
#else
    skip();
#endif
}

TEST(image_sizes_match_their_layout)
{
    struct glint_image image = {.format = GLINT_I420, .width = 5, .height = 3};
    uint8_t mem[27];

    assert_int_equal(glint_image_bytes(GLINT_I420, 5, 3), 15 + 2 * 6);
    assert_int_equal(glint_image_bytes(GLINT_I422, 5, 3), 15 + 2 * 9);
    assert_int_equal(glint_image_bytes(GLINT_RGB24, 5, 3), 45);
    assert_int_equal(glint_image_bytes(GLINT_LINEAR_Q20, 5, 3), 180);
    assert_int_equal(glint_image_bytes(GLINT_GREY, 0, 3), 0);
    assert_int_equal(glint_image_bytes(GLINT_GREY, GLINT_MAX_SIDE + 1, 3), 0);
    glint_image_place(&image, mem);
    assert_ptr_equal(image.plane[1], mem + 15);
    assert_ptr_equal(image.plane[2], mem + 21);
    assert_int_equal(image.stride_bytes[1], 3);
}

static void add_job_number(void *ctx, int job, int worker)
{
    int *sum = ctx;

    assert_int_equal(worker, 0);
    *sum += job;
}

TEST(null_workers_run_jobs_serially)
{
    int sum = 0;

    glint_workers_run(NULL, 5, add_job_number, &sum);
    assert_int_equal(sum, 10);
    assert_int_equal(glint_workers_count(NULL), 1);
}
