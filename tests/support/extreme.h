/* SPDX-License-Identifier: MIT
 *
 * The list of extremes: each case says the worst figure it saw and the bound it
 * must keep, in a line that "make extremes" makes its table of.
 */
#ifndef GLINT_TESTS_EXTREME_H
#define GLINT_TESTS_EXTREME_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Whether long cases were asked for (GLINT_LONG). */
static inline bool extreme_long(void)
{
    const char *text = getenv("GLINT_LONG");

    return text && *text && *text != '0';
}

/* What random cases start from (GLINT_SEED, else 1). */
static inline uint64_t extreme_seed(void)
{
    const char *text = getenv("GLINT_SEED");

    return text && *text ? strtoull(text, NULL, 10) : 1;
}

/* Reports WORST of CASE, of which at most BOUND is right. */
static inline bool extreme_at_most(const char *name, double worst, double bound,
                                   const char *unit)
{
    printf("extreme|%s|%.4g|at most %.4g|%s\n", name, worst, bound, unit);
    fflush(stdout);
    return worst <= bound;
}

/* The same where BOUND is the least that is right. */
static inline bool extreme_at_least(const char *name, double worst,
                                    double bound, const char *unit)
{
    printf("extreme|%s|%.4g|at least %.4g|%s\n", name, worst, bound, unit);
    fflush(stdout);
    return worst >= bound;
}

#endif
