/* SPDX-License-Identifier: MIT
 *
 * Tests sums of light at their limits: thousands of lights, ray bundles that
 * sum to the max value of an image and above it, and the range checks of
 * CONFIG=qcheck.
 */
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/q.h"
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 96, H = 64, N = 3 * W * H, LIGHTS = 10000 };

static struct stage heliar;
static float test[N], part[N];
static struct glint_lamp lamp[LIGHTS];

TEST_OPEN
{
    assert_true(stage_open_lens(&heliar, "heliar-tronnier", W, H));
}

/* ------------------------------------------------------------------ lights */

/* Checks that 10 000 lights at one position give the image of one light of 10
 * 000 times the power; their powers are summed with 31 bits. */
TEST(ten_thousand_lights_at_one_position_add_up)
{
    const struct glint_lamp sum = stage_make_lamp(7.5, 33, LIGHTS);
    double apart = 0, most = 0;

    for (int i = 0; i < LIGHTS; i++)
        lamp[i] = stage_make_lamp(7.5, 33, 1);
    assert_true(stage_draw_linear(&heliar, lamp, LIGHTS, test));
    assert_true(stage_draw_linear(&heliar, &sum, 1, part));
    assert_int_equal(heliar.drawn.drawn_lights, 1);
    for (int i = 0; i < N; i++) {
        apart = fmax(apart, fabs((double)test[i] - (double)part[i]));
        most = fmax(most, (double)part[i]);
    }
    assert_at_most("sums: 10 000 lights at one place", apart / most, 1e-5,
                   "of the brightest pixel");
}

/* Checks that lights distributed over the frame are merged to 128 without loss
 * of light. 3 % are allowed, as merged lights draw their ghosts in one
 * position, which moves some light out of the frame. */
TEST(spread_lights_are_merged_without_loss)
{
    const int n = extreme_is_long_run() ? LIGHTS : 1000;
    uint64_t r = 11;
    double whole = 0;

    for (int i = 0; i < n; i++)
        lamp[i] = stage_make_lamp(stage_random_uniform(&r, 0, 12),
                                  stage_random_uniform(&r, -180, 180),
                                  exp(stage_random_uniform(&r, -4, 4)));
    heliar.frame.dials.fineness = 16;
    assert_true(stage_draw_linear(&heliar, lamp, n, test));
    assert_int_equal(heliar.drawn.drawn_lights, 128);
    for (int i = 0; i < n; i += 125) {
        assert_true(stage_draw_linear(&heliar, lamp + i,
                                      n - i < 125 ? n - i : 125, part));
        whole += stage_sum_image(&heliar, part);
    }
    heliar.frame.dials.fineness = 64;
    assert_at_most(extreme_is_long_run() ? "sums: 10 000 lights merged, flux"
                                         : "sums: 1000 lights merged, flux",
                   fabs(stage_sum_image(&heliar, test) / whole - 1), 0.03, "");
}

/* Checks that 10 000 suns make every pixel white, which shows that no sum
 * wraps. */
TEST(ten_thousand_suns_give_white)
{
    static uint8_t codes[N];
    uint64_t r = 12;
    int dark = 0;

    for (int i = 0; i < LIGHTS; i++)
        lamp[i] = stage_make_lamp(stage_random_uniform(&r, 0, 10),
                                  stage_random_uniform(&r, -180, 180), 1e9);
    memset(codes, 9, sizeof codes);
    assert_true(stage_draw_codes(&heliar, lamp, LIGHTS, codes));
    for (int i = 0; i < N; i++)
        dark += codes[i] != 255;
    assert_at_most("sums: 10 000 suns, samples that are not white", dark, 0,
                   "samples");
}

/* ------------------------------------------------------------- ray bundles */

enum { SIDE = 64, MANY = 1 << 15 };

/* Draws COUNT ray bundles of 2^LOG2 times white over the whole image, as pixel
 * codes and as linear light. Returns the linear light of the pixels, or -1 if
 * pixels differ or codes are not white. Sets HELD[0] to the number of cells
 * whose light was clamped before it was added, and HELD[1] to the number of
 * clamped samples. */
static double draw_overlapping_bundles(int count, int log2, int held[2])
{
    struct glint_flare_config c = {.width = SIDE,
                                   .height = SIDE,
                                   .tile_log2 = 6,
                                   .max_bundles = count,
                                   .max_vertices = 4 * count,
                                   .max_primitives = 4 * count,
                                   .max_refs = 8 * count};
    const struct glint_bundle b = {.n_cells = 1,
                                   .flux_q31 = 1 << 30,
                                   /* This flux gives the light 1 to each of 64
                                    * x 64 pixels. */
                                   .flux_exponent = 13 + log2,
                                   .rgb_q14 = {16384, 16384, 16384}};
    static int32_t linear[3 * SIDE * SIDE];
    static uint8_t codes[3 * SIDE * SIDE];
    struct glint_image image =
        glint_image_over(linear, GLINT_LINEAR_Q20, SIDE, SIDE);
    const size_t bytes = glint_flare_bytes(&c);
    struct glint_flare_stats stats;
    struct glint_flare *f;
    double value;
    void *mem;

    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_ok(glint_flare_init(&f, &c, mem, bytes));
    for (int i = 0; i < count; i++) {
        struct glint_vertex *v = glint_flare_add(f, &b);

        assert_non_null(v);
        for (int k = 0; k < 4; k++)
            v[k] = (struct glint_vertex){.x_q8 = k % 2 ? SIDE * 256 : 0,
                                         .y_q8 = k / 2 ? 0 : SIDE * 256,
                                         .energy_q16 = 65536};
    }
    memset(linear, 0, sizeof linear);
    memset(codes, 0, sizeof codes);
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &image);
    held[0] = stats.held_cells;
    held[1] = glint_flare_held(f);
    image.format = GLINT_RGB24;
    glint_image_place(&image, codes);
    glint_flare_draw(f, &image);
    /* saturated codes are not counted as clamped */
    assert_int_equal(glint_flare_held(f), 0);
    free(mem);
    value = linear[0] == INT32_MAX ? 2048 : linear[0] / 1048576.0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        if (linear[i] != linear[0] || codes[i] != 255)
            return -1;
    return value;
}

/* Checks that pixels of linear light are exact up to the limit, just under 2048
 * times white, and saturate above. Both clamps must be counted: one cell adds
 * at most 2048 to a pixel, and all cells together at most 2^24; more light is
 * clamped before it is added (by_edges.c). */
TEST(piled_light_saturates)
{
    static const struct {
        int count, log2;
        double holds;
        int held_cells;
    } piles[] = {
        {1, 0, 1, 0},           {1, 10, 1024, 0},       {2047, 0, 2047, 0},
        {1023, 1, 2046, 0},     {2048, 0, 2048, 0},     {2049, 0, 2048, 0},
        {MANY, 0, 2048, 0},     {1, 11, 2048, 0},       {1, 12, 2048, 1},
        {1, 40, 2048, 1},       {8191, 11, 2048, 8191}, {8192, 11, 2048, 8192},
        {8193, 11, 2048, 8193}, {MANY, 11, 2048, MANY}, {MANY, 60, 2048, MANY},
    };
    double worst = 0;
    int miscounted = 0;

    for (int k = 0; k < 15; k++) {
        int held[2];
        const double got =
            draw_overlapping_bundles(piles[k].count, piles[k].log2, held);
        const int samples = piles[k].holds < 2048 ? 0 : 3 * SIDE * SIDE;

        miscounted += held[0] != piles[k].held_cells || held[1] != samples;

        if (fabs(got - piles[k].holds) > 0)
            print_message("  %d x 2^%d: %.6f\n", piles[k].count, piles[k].log2,
                          got);
        worst = fmax(worst, fabs(got - piles[k].holds));
    }
    assert_at_most("sums: piles of light up to 2^75 white, off by", worst, 0,
                   "white");
    assert_at_most("sums: piles whose saturation is miscounted", miscounted, 0,
                   "of 15");
}

/* ------------------------------------------------------------ range checks */

/* Calls F in a child process. Returns whether a trap ended the process. */
static int call_ends_in_trap(void (*f)(void))
{
    const pid_t pid = fork();
    int status = 0;

    if (pid == 0) { /* disables cmocka's handlers */
        signal(SIGILL, SIG_DFL);
        signal(SIGTRAP, SIG_DFL);
        f();
        _exit(0);
    }
    assert_true(pid > 0);
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return WIFSIGNALED(status);
}

static volatile int64_t one = 1;
static volatile int64_t sink;

static void narrow_extreme_values(void)
{
    sink = q_narrow(INT32_MAX * one) + q_narrow(INT32_MIN * one);
}
static void narrow_above_range(void)
{
    sink = q_narrow(INT32_MAX + one);
}
static void narrow_below_range(void)
{
    sink = q_narrow(INT32_MIN - one);
}
static void shift_to_extreme_values(void)
{
    sink = q_shift(one << 62, 1) + q_shift(-(one << 62), 1);
}
static void shift_above_range(void)
{
    sink = q_shift((one << 62) + one, 1);
}
static void multiply_to_extreme_values(void)
{
    sink = q_mul((int32_t)(INT32_MAX * one), 1 << 30, 30);
}
static void multiply_above_range(void)
{
    sink = q_mul((int32_t)(INT32_MAX * one), INT32_MAX, 30);
}

/* Checks that values at the limits of each range pass in every build, and that
 * values one step beyond trap only in builds that check ranges. */
TEST(only_checked_builds_trap_out_of_range)
{
#ifdef GLINT_Q_CHECK
    const int checked = 1;
#else
    const int checked = 0;
#endif
    int wrong = 0;

    wrong += call_ends_in_trap(narrow_extreme_values) +
             call_ends_in_trap(shift_to_extreme_values) +
             call_ends_in_trap(multiply_to_extreme_values);
    wrong += call_ends_in_trap(narrow_above_range) != checked;
    wrong += call_ends_in_trap(narrow_below_range) != checked;
    wrong += call_ends_in_trap(shift_above_range) != checked;
    wrong += call_ends_in_trap(multiply_above_range) != checked;
    assert_at_most(checked ? "sums: bounds of q.h, with traps"
                           : "sums: bounds of q.h, without traps",
                   wrong, 0, "cases");
}

TEST_CLOSE
{
    stage_free(&heliar);
}
