/* SPDX-License-Identifier: MIT
 *
 * Tests the display of progress on standard error with a fake clock.
 */
#include <unistd.h>

#include "options/tool.h"
#include "support/test.h"

static double now_s;

static double read_fake_clock_s(void)
{
    return now_s;
}

static struct tool_progress start_fake_progress(bool quiet, bool is_terminal)
{
    const struct tool tool = {.name = "bake", .quiet = quiet};
    struct tool_progress p;

    tool_progress_start(&p, &tool, "bake");
    p.clock = read_fake_clock_s;
    p.started = 0;
    p.is_terminal = is_terminal;
    return p;
}

/* Returns what P prints when the fraction DONE (0 .. 1) is reported at the time
 * AT_S, seconds. */
static const char *print_progress_at(struct tool_progress *p, double at_s,
                                     double done)
{
    static char text[400];
    FILE *const file = tmpfile();
    const int err = dup(STDERR_FILENO);

    assert_non_null(file);
    now_s = at_s;
    fflush(stderr);
    dup2(fileno(file), STDERR_FILENO);
    tool_progress_show(p, done);
    fflush(stderr);
    dup2(err, STDERR_FILENO);
    close(err);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

TEST(short_work_prints_nothing)
{
    struct tool_progress p = start_fake_progress(false, false);

    for (int k = 0; k <= 99; k++)
        assert_string_equal(print_progress_at(&p, 0.1 * k, k / 100.), "");
    assert_string_equal(print_progress_at(&p, 500, 1),
                        ""); /* at the end of the work nothing is printed */
}

TEST(line_every_ten_seconds)
{
    struct tool_progress p = start_fake_progress(false, false);

    assert_string_equal(print_progress_at(&p, 5, 0.1),
                        "bake: will take about 45 s\n");
    assert_string_equal(print_progress_at(&p, 9.9, 0.2), "");
    assert_string_equal(print_progress_at(&p, 10, 0.25),
                        "bake: 25 % in 10 s, about 30 s left\n");
    assert_string_equal(print_progress_at(&p, 19.9, 0.4), "");
    /* The reported fraction decreases, but the displayed progress does not. */
    assert_string_equal(print_progress_at(&p, 20, 0.2),
                        "bake: 40 % in 20 s, about 80 s left\n");
}

/* Checks work that consists of two parts: the progress of the second part
 * continues where the first part ended. */
TEST(second_part_continues_the_first)
{
    struct tool_progress p = start_fake_progress(false, false);

    tool_progress_set_part(&p, 0, 0.6);
    assert_string_equal(print_progress_at(&p, 5, 0.5), "");
    tool_progress_set_part(&p, 0.6, 0.4);
    assert_string_equal(print_progress_at(&p, 20, 0.5),
                        "bake: 80 % in 20 s, about 5 s left\n");
}

/* Checks that the estimated time is printed once, after 5 s, if the work takes
 * 20 s or more. */
TEST(long_work_prints_an_estimate_once)
{
    struct tool_progress p = start_fake_progress(false, false);

    assert_string_equal(print_progress_at(&p, 5, 0), "");
    assert_string_equal(print_progress_at(&p, 4.9, 0.1), "");
    assert_string_equal(print_progress_at(&p, 5, 0.1),
                        "bake: will take about 45 s\n");
    assert_string_equal(print_progress_at(&p, 6, 0.02), "");
    p = start_fake_progress(false, false);
    p.less = "a larger --tolerance";
    p.besides = ", and reports";
    assert_string_equal(print_progress_at(&p, 6, 0.01),
                        "bake: will take about 10 minutes, and reports; less "
                        "with a larger --tolerance\n");
}

/* Checks an estimate whose clock starts at the first report, so that it does
 * not include the time before. On request, it must be printed for short work,
 * too. */
TEST(clock_starts_at_the_first_report)
{
    struct tool_progress p = start_fake_progress(false, false);

    p.waits = true;
    p.least_s = 3;
    assert_string_equal(print_progress_at(&p, 50, 0.01), "");
    assert_string_equal(print_progress_at(&p, 50.7, 0.2), "");
    assert_string_equal(print_progress_at(&p, 51, 0.25),
                        "bake: will take about 3 s\n");
}

TEST(quiet_prints_nothing)
{
    for (int is_terminal = 0; is_terminal < 2; is_terminal++) {
        struct tool_progress p = start_fake_progress(true, is_terminal);

        assert_string_equal(print_progress_at(&p, 1, 0.01), "");
        assert_string_equal(print_progress_at(&p, 100, 0.5), "");
    }
}

/* Checks that a terminal shows a progress bar that is updated ten times per
 * second, and at the end. */
TEST(terminal_gets_a_bar)
{
    struct tool_progress p = start_fake_progress(false, true);

    assert_string_equal(print_progress_at(&p, 5, 0.5),
                        "\rbake [###############...............]  50 %  "
                        "5 s left \033[K");
    assert_string_equal(print_progress_at(&p, 5.05, 0.6), "");
    assert_non_null(strstr(print_progress_at(&p, 5.2, 0.6), " 60 %  3 s left"));
    assert_non_null(strstr(print_progress_at(&p, 5.15, 1), "100 %  0 s left"));
}
