/* SPDX-License-Identifier: MIT
 *
 * What glint bench times: cases of a lens, a picture and options, that take
 * turns.
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

/* Drawing is accumulating light, which is timed by itself, and compositing it
 * with the picture, which is the rest. */
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
    double scale, psnr_db; /* NAN: not measured */
    const char *series;    /* growth: name of the series, or NULL */
    /* A lens with some ghosts only, and these; NULL: the whole lens is used. */
    struct glint_lens some;
    struct glint_model_ghost *some_ghosts;
    struct glint_frame_report report;
    double cpu_ms; /* growth: time of all threads, the least of a frame; or 0 */
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
    bool moving; /* the lights move from round to round */
    int n_budgets;
    double budget_ms[MAX_BUDGETS];
};

/* Adds the cases of SETTINGS that are asked for, or the plain one. Returns an
 * exit code, as all here that return int. */
int bench_add(struct bench *b, const struct settings *settings);

/* Adds one of this size, 0 as asked, and so many lights, if there is room. */
int bench_add_one(struct bench *b, const struct settings *settings, int width,
                  int height, int lights);

/* Adds those of b->growth. */
int bench_add_growth(struct bench *b, const struct settings *settings);

/* Puts the light of a case where it is in round ROUND of N, if it moves. */
void bench_move(struct test *t, int round, int n);

/* Times round ROUND of a case. */
enum glint_status bench_run(struct test *t, int round);

/* Compares T with exact rays of the lens's table: t->psnr_db. */
int bench_psnr(struct bench *b, struct test *t);

/* Medians, as a table for people or for programs. */
void bench_print(const struct bench *b);
void bench_print_json(const struct bench *b);

#endif
