/* SPDX-License-Identifier: MIT
 *
 * bake_left LENS.lens F - bakes a lens for f-number F on one thread, and prints
 * a row of the time left that a bake says, over the time that then was left, at
 * 10, 25, 50, 75 and 90 % of the time it takes; 1 is right. Times are those of
 * the processor.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "glint/bake.h"
#include "model/table_file.h"

enum { MOST = 1 << 18 };

static double started;
static struct {
    double at, done;
} told[MOST];
static int n_told;

static double seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void note(void *ctx, double done)
{
    (void)ctx;
    if (n_told == MOST)
        return;
    told[n_told].at = seconds() - started;
    told[n_told++].done = done;
}

/* Prints how many times the time left at SHARE of TOOK seconds was said. */
static void print_said(double took, double share)
{
    const double now = share * took;
    double done = 0;

    for (int i = 0; i < n_told && told[i].at <= now; i++)
        done = told[i].done;
    if (done > 0)
        printf(" %.2f |", now * (1 - done) / done / (took - now));
    else
        printf("  |");
}

int main(int argc, char **argv)
{
    static const double shares[] = {0.1, 0.25, 0.5, 0.75, 0.9};
    static struct glint_prescription lens;
    static const struct tool tool = {.name = "bake_left"};
    struct glint_bake_options options;
    struct glint_bake_report report;
    struct glint_error error;
    unsigned char *model;
    size_t bytes;
    double took;

    if (argc != 3 || tool_lens(&tool, argv[1], &lens) != EXIT_OK)
        return 2;
    if (glint_prescription_set_f_number(&lens, strtod(argv[2], NULL), &error) !=
        GLINT_OK)
        return 1;
    glint_bake_defaults(&options);
    options.progress = note;
    started = seconds();
    if (glint_bake(&lens, &options, &model, &bytes, &report, &error) !=
        GLINT_OK)
        return 1;
    took = seconds() - started;
    free(model);
    printf("| %s | f/%g | %.0f |", lens.name, lens.f_number, took);
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++)
        print_said(took, shares[i]);
    printf("\n");
    return 0;
}
