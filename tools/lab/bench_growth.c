/* SPDX-License-Identifier: MIT
 *
 * glint bench --growth: cases that differ from the plain one in one thing each,
 * to see how the time of a frame grows with it.
 */
#include <stdlib.h>
#include <string.h>

#include "lab/bench.h"

/* Adds a case of SERIES. */
static int add(struct bench *b, const struct settings *settings,
               const char *series, int width, int height, int lights)
{
    const int n = b->n_tests,
              code = bench_add_one(b, settings, width, height, lights);

    if (b->n_tests > n)
        b->test[n].series = series;
    return code;
}

/* ------------------------------------------------------------------ ghosts */

/* Has T draw N_KEPT ghosts only: those of LIST[N] from FIRST on, then from its
 * start. All other ghosts lose their polynomials and are not seen. */
static enum glint_status keep_ghosts(struct test *t, const int *list, int n,
                                     int first, int n_kept)
{
    const struct glint_lens *whole = t->frame.lens;
    const size_t n_ghosts = whole->header->n_ghosts;
    struct glint_model_ghost *ghost = malloc(n_ghosts * sizeof *ghost);

    if (!ghost)
        return GLINT_E_MEMORY;
    for (size_t k = 0; k < n_ghosts; k++) {
        int kept = 0;

        for (int i = 0; i < n_kept; i++) {
            const struct glint_model_ghost *g =
                &whole->ghost[list[(first + i) % n]];

            kept |= g->i == whole->ghost[k].i && g->j == whole->ghost[k].j;
        }
        ghost[k] = whole->ghost[k];
        if (!kept)
            ghost[k].n_systems = 0;
    }
    t->some_ghosts = ghost;
    t->some = *whole;
    t->some.ghost = ghost;
    t->frame.lens = &t->some;
    return GLINT_OK;
}

/* Lists the ghosts that a frame of T shows. Returns how many. */
static int list_seen(struct test *t, int *list)
{
    int n = 0;

    if (bench_run(t, 0) != GLINT_OK)
        return 0;
    for (int k = 0; k < t->frame.setup->n_ghosts; k++)
        if (t->frame.seen[k])
            list[n++] = k;
    return n;
}

/* Adds cases of all ghosts that are seen, and of half of them, a quarter ...
 * each taken from four places of the list, as some ghosts are large and some
 * are small. */
static int add_ghosts(struct bench *b, const struct settings *settings,
                      struct test *plain)
{
    static int list[GLINT_MAX_GHOSTS];
    const int n = plain->frame.lens ? list_seen(plain, list) : 0;
    int code = EXIT_OK;

    for (int part = n, depth = 0; part > 0 && depth < 5; part /= 2, depth++)
        for (int k = 0; k < (part < n ? 4 : 1) && code == EXIT_OK; k++) {
            const int at = b->n_tests;

            code = add(b, settings, "ghosts", 0, 0, 1);
            if (b->n_tests > at &&
                keep_ghosts(&b->test[at], list, n, k * n / 4, part) != GLINT_OK)
                code = tool_fail(b->tool, GLINT_E_MEMORY, NULL);
        }
    return code;
}

/* ------------------------------------------------------------------ others */

static int add_lights(struct bench *b, const struct settings *settings)
{
    int code = EXIT_OK;

    for (int n = 1; n <= 64 && code == EXIT_OK; n *= 2)
        code = add(b, settings, "lights", 0, 0, n);
    return code;
}

static int add_sizes(struct bench *b, const struct settings *settings)
{
    static const int size[][2] = {{640, 360},   {960, 540},   {1280, 720},
                                  {1920, 1080}, {2560, 1440}, {3840, 2160}};
    int code = EXIT_OK;

    for (size_t i = 0; i < sizeof size / sizeof *size && code == EXIT_OK; i++)
        code = add(b, settings, "pixels", size[i][0], size[i][1], 1);
    return code;
}

/* Adds cases of the same rays and fewer edges: steps of irradiance of 1/4 to 10
 * percent. */
static int add_quanta(struct bench *b, const struct settings *settings)
{
    static const int steps[] = {277, 139, 69, 35, 14, 7};
    int code = EXIT_OK;

    for (size_t i = 0; i < sizeof steps / sizeof *steps && code == EXIT_OK;
         i++) {
        struct glint_frame *f = &b->test[b->n_tests].frame;
        const int at = b->n_tests;

        code = add(b, settings, "quantum", 0, 0, 1);
        if (b->n_tests == at)
            break;
        f->dials.irradiance_steps = steps[i];
    }
    return code;
}

static int add_grids(struct bench *b, const struct settings *settings)
{
    int code = EXIT_OK;

    for (int cells = 16; cells <= 256 && code == EXIT_OK; cells *= 2) {
        const int at = b->n_tests;

        code = add(b, settings, "grid", 0, 0, 1);
        if (b->n_tests > at)
            b->test[at].frame.dials.fineness = cells;
    }
    return code;
}

int bench_add_growth(struct bench *b, const struct settings *settings)
{
    const int plain = b->n_tests;
    int code = add_lights(b, settings);

    if (code == EXIT_OK)
        code = add_sizes(b, settings);
    if (code == EXIT_OK && b->n_tests > plain)
        code = add_ghosts(b, settings, &b->test[plain]);
    if (code == EXIT_OK)
        code = add_quanta(b, settings);
    if (code == EXIT_OK)
        code = add_grids(b, settings);
    return code;
}
