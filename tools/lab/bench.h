/* SPDX-License-Identifier: MIT
 *
 * The cases that glint bench times in turn: each a lens, a picture and options.
 */
#ifndef GLINT_TOOLS_LAB_BENCH_H
#define GLINT_TOOLS_LAB_BENCH_H

#include "lab/canvas.h"

enum {
    MAX_CASES = 256,
    MAX_ROUNDS = CANVAS_MAX,
    MAX_LENSES = 16,
    MAX_BUDGETS = 16
};

/* DRAW has two parts: ACCUMULATE, which sums up the light of all pixels and is
 * timed by itself, and COMPOSITE, which adds that light to the picture and is
 * the difference. */
enum stage { PLAN, TRANSFER, BIN, DRAW, ACCUMULATE, COMPOSITE, WHOLE, STAGES };

struct bench_canvas {
    struct canvas of;
    double floor_ms[MAX_ROUNDS];
};

struct test {
    const struct settings *settings;
    struct bench_canvas *canvas;
    struct glint_frame frame;
    struct glint_lamp *lamp;
    int n_lamps, threads;
    const char *kernels;
    double scale, psnr_db; /* psnr_db: NAN if not measured */
    const char *series;    /* growth: name of the series, or NULL */
    /* growth: a lens with some of the ghosts only, and the memory of these;
     * NULL: the whole lens is used. */
    struct glint_lens some;
    struct glint_model_ghost *some_ghosts;
    struct glint_engine_report report;
    double cpu_ms; /* growth: least time of a frame, of all threads; else 0 */
    double ms[STAGES][MAX_ROUNDS];
    double wrong[MAX_ROUNDS]; /* budgets: predicted over measured - 1 */
};

struct bench {
    struct tool *tool;
    struct settings base, settings[MAX_LENSES];
    int n_settings, n_canvases, n_tests, rounds;
    struct bench_canvas canvas[8];
    struct test *test;
    struct glint_workers *one, *two;
    enum glint_pixel_format format;
    const char *format_word;
    int width, height;
    bool all, sizes, growth, psnr;
    bool moving; /* The first light moves from round to round. */
    int n_budgets;
    double budget_ms[MAX_BUDGETS];
};

/* Adds the requested cases of SETTINGS but those of --growth, or the plain one.
 * Like all functions here that return int, it returns an exit code. */
int bench_add(struct bench *b, const struct settings *settings);

/* Adds a case of WIDTH x HEIGHT (0: as asked for) and LIGHTS lights, if there
 * is room for one. */
int bench_add_one(struct bench *b, const struct settings *settings, int width,
                  int height, int lights);

/* Adds the cases of --growth. */
int bench_add_growth(struct bench *b, const struct settings *settings);

/* Moves the first light of T to its place in round ROUND of N. */
void bench_move(struct test *t, int round, int n);

/* Draws a frame of T and notes its times as those of round ROUND. */
enum glint_status bench_run(struct test *t, int round);

/* Sets t->psnr_db: T's flare alone against exact rays of the lens's table. */
int bench_psnr(struct bench *b, struct test *t);

/* Print the medians of all cases, as a table or as JSON. */
void bench_print(const struct bench *b);
void bench_print_json(const struct bench *b);

#endif
