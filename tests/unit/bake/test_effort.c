/* SPDX-License-Identifier: MIT
 *
 * Checks that progress reports of a bake predict the remaining time, by ghosts
 * of known work and a simulated clock.
 */
#include "bake/effort.h"
#include "support/lens_check.h"
#include "support/rng.h"

/* work before the first ghost, in units of one polynomial fit; see effort.c */
enum { HEAD = 32 };

/* Simulates the bake of N ghosts on one worker; ghost i needs WORK[i] fits.
 * EXPECTED is the number of fits announced by glint_effort_set_estimates(), or
 * 0 without it. Sets SAID to the reported / true remaining time after 1/4, 1/2
 * and 3/4 of the bake. */
static void simulate_bake_progress(const double *work, int n, bool wide,
                                   double expected, double said[3])
{
    struct glint_effort e;
    double all = HEAD, now = HEAD;

    for (int g = 0; g < n; g++)
        all += work[g];
    glint_effort_init(&e, n, 1, wide ? GLINT_EFFORT_WIDE : GLINT_EFFORT_NARROW);
    if (expected > 0)
        glint_effort_set_estimates(&e, HEAD, expected);
    for (int g = 0; g < n; g++) {
        glint_effort_begin_ghost(&e, g);
        for (int w = 1; w <= (int)work[g]; w++) {
            double done;

            glint_effort_record_work(&e, w, w / work[g]);
            done = glint_effort_estimate_progress(&e);
            assert_true(done > 0 && done <= 1);
            now++;
            for (int k = 0; k < 3; k++)
                if (now - 1 < 0.25 * (k + 1) * all &&
                    now >= 0.25 * (k + 1) * all)
                    said[k] = now * (1 - done) / done / (all - now);
        }
        glint_effort_end_ghost(&e);
    }
    assert_true(glint_effort_estimate_progress(&e) > 0.999);
}

TEST(equal_ghosts_are_estimated_within_25_percent)
{
    double work[100], said[3];

    for (int g = 0; g < 100; g++)
        work[g] = 20;
    simulate_bake_progress(work, 100, false, 0, said);
    for (int k = 0; k < 3; k++)
        assert_true(said[k] > 0.8 && said[k] < 1.25);
}

/* Checks ghosts in any order whose work differs by factors of up to 100:
 * half-way, the estimated remaining time is nearly always within a factor of
 * three of the true time. Estimates by the number of ghosts alone were wrong by
 * a factor of ten. */
TEST(random_ghosts_are_estimated_within_a_factor_of_3)
{
    uint32_t seed = 7;
    int off = 0;

    for (int round = 0; round < 200; round++) {
        double work[20], said[3] = {0};

        for (int g = 0; g < 20; g++)
            work[g] = ceil(pow(10, 2 * rng_unit(&seed)));
        simulate_bake_progress(work, 20, true, 0, said);
        off += fabs(log(said[1])) > log(3);
    }
    assert_in_range(off, 0, 10);
}

/* Checks a bake whose last ghost takes most of the time: the estimate uses the
 * fraction of that ghost's angles that are done. */
TEST(long_last_ghost_is_estimated_by_its_angles)
{
    double work[20], said[3];

    for (int g = 0; g < 20; g++)
        work[g] = g < 19 ? 5 : 1000;
    simulate_bake_progress(work, 20, true, 0, said);
    assert_true(said[1] > 0.5 && said[1] < 2);
    assert_true(said[2] > 0.5 && said[2] < 2);
}

/* Checks the estimate for several workers: they divide the ghosts that were not
 * begun, but only one of them works on a ghost in progress. */
TEST(workers_share_ghosts)
{
    double done[2];

    for (int k = 0; k < 2; k++) {
        struct glint_effort e;

        glint_effort_init(&e, 50, 1 + 3 * k, GLINT_EFFORT_NARROW);
        glint_effort_begin_ghost(&e, 10 * k);
        glint_effort_record_work(&e, 10, 0.5);
        done[k] = glint_effort_estimate_progress(&e);
    }
    assert_true(done[1] > done[0]);
    for (int k = 0; k < 2; k++) {
        struct glint_effort e;

        glint_effort_init(&e, 1, 1 + 3 * k, GLINT_EFFORT_NARROW);
        glint_effort_begin_ghost(&e, 0);
        glint_effort_record_work(&e, 1000, 0.5);
        done[k] = glint_effort_estimate_progress(&e);
        assert_true(done[k] > 0.4 && done[k] < 0.65);
    }
}

/* Checks a bake whose last ghosts take most of the time, with their work
 * announced by glint_effort_set_estimates(): from the first quarter on, the
 * estimate is within a factor of two of the true time. */
TEST(announced_work_improves_early_estimates)
{
    double work[100], said[3];

    for (int g = 0; g < 100; g++)
        work[g] = g < 70 ? 1 : 70;
    simulate_bake_progress(work, 100, false, 20, said);
    for (int k = 0; k < 3; k++)
        assert_true(said[k] > 0.5 && said[k] < 2);
}

struct log {
    int n;
    double last, most_step;
};

static void record_reported_progress(void *ctx, double done)
{
    struct log *log = ctx;

    assert_true(done > log->last - 0.2 && done <= 1);
    log->most_step = fmax(log->most_step, done - log->last);
    log->last = done;
    log->n++;
}

/* Checks that a real bake reports its progress after each zone (range of
 * angles), and 1 at the end. */
TEST(bake_reports_each_zone)
{
    static struct glint_setup setup;
    static struct glint_prescription heliar;
    struct log log = {0};
    struct glint_bake_options o;
    struct glint_bake_report report;
    struct glint_error error;
    unsigned char *model;
    size_t bytes;

    load_setup(&setup, &heliar, "heliar-tronnier");
    glint_bake_defaults(&o);
    o.tolerance = 5;
    o.max_deg = 12;
    o.progress = record_reported_progress;
    o.progress_ctx = &log;
    assert_ok(glint_bake(&heliar, &o, &model, &bytes, &report, &error));
    free(model);
    assert_true(log.n > 13);
    assert_true(log.last == 1);
    assert_true(log.most_step < 0.75);
}
