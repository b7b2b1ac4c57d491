/* SPDX-License-Identifier: MIT
 *
 * hostile_models [--log] - draws a frame of each of a hundred models that mean
 * no good (tests/support/models/hostile.h), and prints by family what it took
 * at most.
 * --log says each on stderr, with processor seconds. Exit code 1: a bound was
 * passed.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "support/models/hostile.h"
#include "support/stage.h"

/* Work may exceed its bound by this factor: what a frame holds to the bound is
 * told from its plan, and a first frame is planned and binned twice, as memory
 * is taken between. */
#define SLACK 2.0

struct row {
    double bytes; /* of the largest file */
    /* the largest of each member, over frames that were drawn */
    struct hostile_result most;
    /* largest shares of the bounds */
    double work, memory;
    int of[HOSTILE_OUTCOMES];
};

static double seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static void run(struct row *row, enum hostile_family family, int number,
                const struct glint_lens *baked, bool log)
{
    struct hostile_scene scene;
    struct hostile_result r;
    double from;

    hostile_make(&scene, family, number, baked);
    from = seconds();
    if (!hostile_draw(&scene, &r)) {
        fprintf(stderr, "%s %d: no frame\n", hostile_name[family], number);
        exit(1);
    }
    if (log)
        fprintf(stderr,
                "%s %d: outcome %d, %.2f s, %.0f Minsn of %.0f, %.1f MiB of "
                "%.0f, %d plans%s%s\n",
                hostile_name[family], number, (int)r.outcome, seconds() - from,
                r.minsn, r.most_minsn, r.bytes / 0x1p20, r.most_bytes / 0x1p20,
                r.plans, r.reason ? ", refused: " : "",
                r.reason ? r.reason : "");
    row->bytes = larger(row->bytes, scene.model.bytes);
    row->of[r.outcome]++;
    if (r.outcome != HOSTILE_REFUSED) {
        row->most.minsn = larger(row->most.minsn, r.minsn);
        row->most.bytes = larger(row->most.bytes, r.bytes);
        row->most.plans = r.plans > row->most.plans ? r.plans : row->most.plans;
        row->work = larger(row->work, r.minsn / r.most_minsn);
        row->memory = larger(row->memory, r.bytes / r.most_bytes);
    }
    free(scene.model.data);
}

static void print(enum hostile_family family, const struct row *row)
{
    printf("| %s | %.0f | %.2f | %.2f | %.1f | %.2f | %d |",
           hostile_name[family], row->bytes / 1024, row->most.minsn / 1e3,
           row->work, row->most.bytes / 0x1p20, row->memory, row->most.plans);
    for (int k = 0; k < HOSTILE_OUTCOMES; k++)
        printf(" %d%s", row->of[k], k < HOSTILE_OUTCOMES - 1 ? "," : " |\n");
    fflush(stdout);
}

int main(int argc, char **argv)
{
    static struct stage stage;
    const bool log = argc > 1 && strcmp(argv[1], "--log") == 0;
    int status = 0;

    if (!stage_open(&stage, "heliar-tronnier", HOSTILE_WIDTH, HOSTILE_HEIGHT))
        return 1;
    puts("| family, 10 of each | file KiB | work, 10^9 | of its bound | MiB | "
         "of its bound | plans | refused, empty, drawn, coarser, less |\n"
         "|---|---|---|---|---|---|---|---|");
    for (int f = 0; f < HOSTILE_FAMILIES; f++) {
        struct row row = {0};

        for (int n = 0; n < HOSTILE_EACH; n++)
            run(&row, (enum hostile_family)f, n, &stage.file.lens, log);
        print((enum hostile_family)f, &row);
        status |= row.work > SLACK || row.memory > 1;
    }
    stage_close(&stage);
    return status;
}
