/* SPDX-License-Identifier: MIT
 *
 * The list of extremes: each case prints the worst figure that it saw and the
 * bound of this figure, in a line from which "make extremes" makes its
 * table.
 */
#ifndef GLINT_TESTS_EXTREME_H
#define GLINT_TESTS_EXTREME_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Returns whether GLINT_LONG requests long cases: it is set and is not 0. */
static inline bool extreme_long(void)
{
    const char *text = getenv("GLINT_LONG");

    return text && *text && *text != '0';
}

/* Prints WORST, the worst figure of case NAME, and returns whether it is at
 * most BOUND. */
static inline bool extreme_at_most(const char *name, double worst, double bound,
                                   const char *unit)
{
    printf("extreme|%s|%.4g|at most %.4g|%s\n", name, worst, bound, unit);
    fflush(stdout);
    return worst <= bound;
}

/* Prints WORST, the worst figure of case NAME, and returns whether it is at
 * least BOUND. */
static inline bool extreme_at_least(const char *name, double worst,
                                    double bound, const char *unit)
{
    printf("extreme|%s|%.4g|at least %.4g|%s\n", name, worst, bound, unit);
    fflush(stdout);
    return worst >= bound;
}

#define assert_at_most(...)  assert_true(extreme_at_most(__VA_ARGS__))
#define assert_at_least(...) assert_true(extreme_at_least(__VA_ARGS__))

#endif
