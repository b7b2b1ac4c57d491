/* SPDX-License-Identifier: MIT
 *
 * Worst-case tests: each prints its worst value and the bound in one line,
 * which "make extremes" collects into a table.
 */
#ifndef GLINT_TESTS_EXTREME_H
#define GLINT_TESTS_EXTREME_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Returns whether long tests are requested: the variable GLINT_LONG is set and
 * not 0. */
static inline bool extreme_is_long_run(void)
{
    const char *text = getenv("GLINT_LONG");

    return text && *text && *text != '0';
}

/* Prints the worst value WORST of case NAME and its upper bound BOUND. Returns
 * whether WORST <= BOUND. */
static inline bool extreme_check_at_most(const char *name, double worst,
                                         double bound, const char *unit)
{
    printf("extreme|%s|%.4g|at most %.4g|%s\n", name, worst, bound, unit);
    fflush(stdout);
    return worst <= bound;
}

/* Prints the worst value WORST of case NAME and its lower bound BOUND. Returns
 * whether WORST >= BOUND. */
static inline bool extreme_check_at_least(const char *name, double worst,
                                          double bound, const char *unit)
{
    printf("extreme|%s|%.4g|at least %.4g|%s\n", name, worst, bound, unit);
    fflush(stdout);
    return worst >= bound;
}

#define assert_at_most(...)  assert_true(extreme_check_at_most(__VA_ARGS__))
#define assert_at_least(...) assert_true(extreme_check_at_least(__VA_ARGS__))

#endif
