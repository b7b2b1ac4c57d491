/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "measure/bench.h"
#include "options/json_writer.h"

const char *const bench_format[] = {"yuyv",     "i420",   "nv12", "rgb24",
                                    "xrgb8888", "rgb565", NULL};
static const enum glint_pixel_format formats[] = {GLINT_YUYV,     GLINT_I420,
                                                  GLINT_NV12,     GLINT_RGB24,
                                                  GLINT_XRGB8888, GLINT_RGB565};

/* ------------------------------------------------------------------- cases */

struct bench_case *bench_add_case(struct bench *b, const char *name)
{
    struct bench_case *c;

    if (b->n_cases == BENCH_LENSES || !(c = calloc(1, b->subject->case_bytes)))
        return NULL;
    c->name = name;
    b->cases[b->n_cases] = c;
    return b->cases[b->n_cases++];
}

int bench_get_threads(const struct bench *b)
{
    return b->tool->n_threads ? b->tool->n_threads : 1;
}

static int run_timed_rounds(struct bench *b)
{
    const int warm = b->moving ? b->rounds : 1;
    struct tool_progress progress;
    enum glint_status status = GLINT_OK;

    tool_progress_start(&progress, b->tool, "bench");
    /* Rounds with a negative number warm up the caches and are not recorded. A
     * moving light needs one such round per position, else one is
     * sufficient. */
    for (int round = -warm; round < b->rounds && status == GLINT_OK; round++) {
        const int at = round < 0 ? round + warm : round;

        canvas_time_memory_floor(&b->canvas, at);
        for (int i = 0; i < b->n_cases && status == GLINT_OK; i++) {
            canvas_restore_background(&b->canvas);
            status = b->subject->draw(b, b->cases[i], at);
        }
        tool_progress_show(&progress,
                           (round + warm + 1.0) / (b->rounds + warm));
    }
    tool_progress_end(&progress);
    return status == GLINT_OK ? EXIT_OK : tool_fail(b->tool, status, NULL);
}

/* ------------------------------------------------------------------ output */

double bench_compute_median_ms(const struct bench *b,
                               const struct bench_case *c, int stage)
{
    return canvas_find_median(c->ms[stage], b->rounds);
}

static double compute_median_floor_ms(const struct bench *b)
{
    return canvas_find_median(b->canvas.floor_ms, b->rounds);
}

static int compute_stage_column_width(const char *stage)
{
    const int n = (int)strlen(stage);

    return n > 7 ? n : 7;
}

static void print_bench_table(const struct bench *b)
{
    const struct bench_subject *const s = b->subject;
    const int whole = s->n_stages - 1;
    const double floor_ms = compute_median_floor_ms(b);

    printf("memory floor %.3f ms (%dx%d %s, %d rounds); stages are multiples "
           "of it\n",
           floor_ms, b->width, b->height, bench_format[b->word], b->rounds);
    printf("%s %8s %7s ", s->heads, "ms", "ratio");
    for (int k = 0; k < whole; k++)
        printf(" %*s", compute_stage_column_width(s->stage[k]), s->stage[k]);
    printf("  %s\n", s->tail);
    for (int i = 0; i < b->n_cases; i++) {
        const struct bench_case *const c = b->cases[i];

        s->print_case(b, c);
        printf(" %8.3f %7.1f ", bench_compute_median_ms(b, c, whole),
               bench_compute_median_ms(b, c, whole) / floor_ms);
        for (int k = 0; k < whole; k++)
            printf(" %*.2f", compute_stage_column_width(s->stage[k]),
                   bench_compute_median_ms(b, c, k) / floor_ms);
        printf("  ");
        s->print_result(b, c);
        printf("\n");
    }
}

void bench_write_json_format(struct json_writer *json, const struct bench *b)
{
    json_write(json, "width: %d, height: %d, format: %s", b->width, b->height,
               bench_format[b->word]);
}

void bench_write_json_times(struct json_writer *json, const struct bench *b,
                            const struct bench_case *c)
{
    const struct bench_subject *const s = b->subject;
    const int whole = s->n_stages - 1;
    const double ms = bench_compute_median_ms(b, c, whole);

    json_write(json, "ms: %.4f, ratio: %.3f", ms,
               ms / compute_median_floor_ms(b));
    for (int k = 0; k < whole; k++)
        json_write(json, "%s_ms: %.4f", s->stage[k],
                   bench_compute_median_ms(b, c, k));
}

static void print_bench_json(const struct bench *b)
{
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{floor_ms: %.5f, rounds: %d, version: %s, machine: %s, "
               "cases: [",
               compute_median_floor_ms(b), b->rounds, GLINT_VERSION,
               canvas_describe_machine());
    for (int i = 0; i < b->n_cases; i++) {
        json_write(&json, "\n{%s: %s", b->subject->word, b->cases[i]->name);
        b->subject->json(&json, b, b->cases[i]);
        json_write(&json, "}");
    }
    json_write(&json, "\n]}\n");
}

/* ----------------------------------------------------------------- running */

int bench_run_all(struct bench *b, int n_names, const char *const *names)
{
    int code;

    if (canvas_init(&b->canvas, formats[b->word], b->width, b->height) !=
        GLINT_OK)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    code = b->subject->open(b, n_names, names);
    if (code == EXIT_OK)
        code = run_timed_rounds(b);
    if (code == EXIT_OK)
        (b->tool->json ? print_bench_json : print_bench_table)(b);
    return code;
}

void bench_close(struct bench *b)
{
    for (int i = 0; i < b->n_cases; i++) {
        b->subject->close_case(b->cases[i]);
        free(b->cases[i]);
    }
    canvas_free(&b->canvas);
    b->subject->close(b);
    free(b);
}
