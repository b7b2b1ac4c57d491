/* SPDX-License-Identifier: MIT
 *
 * glint bench: draws frames of several cases alternately and measures the time
 * of each stage of a frame. A case draws flares (bench_flare.c) or a scene
 * (bench_scene.c).
 */
#ifndef GLINT_TOOLS_LAB_BENCH_H
#define GLINT_TOOLS_LAB_BENCH_H

#include "measure/canvas.h"

enum {
    BENCH_ROUNDS = CANVAS_MAX,
    BENCH_STAGES = 7,
    BENCH_LENSES = 16 /* max number of cases, one per lens */
};

/* A timed case; the first member of struct flare_case and struct scene_case */
struct bench_case {
    const char *name; /* name of the lens or scene */
    double ms[BENCH_STAGES][BENCH_ROUNDS];
};

struct bench;
struct json_writer;

struct bench_subject {
    const char *word; /* name of the subject (flare or scene) in JSON */
    const char *help;
    const struct option *own;
    /* option groups that the subject supports, one bit per GLINT_OPTIONS
     * group */
    unsigned groups;
    int max_rounds;
    /* Names of the stages; the last stage is the whole frame. */
    int n_stages;
    const char *stage[BENCH_STAGES];
    /* headings of the columns that print_case() prints, in front of the
     * times */
    const char *heads;
    const char *tail;
    size_t case_bytes;

    /* Parses option C of the subject. Returns 1 if VALUE is valid, 0 if
     * invalid, -2 if C is not an option of the subject. */
    int (*take)(struct bench *bench, int c, const char *value);
    /* Opens the lenses or scenes NAME[N] and adds all cases. Returns an exit
     * code. */
    int (*open)(struct bench *bench, int n, const char *const *name);
    enum glint_status (*draw)(struct bench *bench, struct bench_case *c,
                              int round);
    /* print_case() prints the columns of C in front of the times,
     * print_result() those behind the times. */
    void (*print_case)(const struct bench *bench, const struct bench_case *c);
    void (*print_result)(const struct bench *bench, const struct bench_case *c);
    /* Writes all members of C's JSON object except the name, using
     * bench_write_json_format() and bench_write_json_times(). */
    void (*json)(struct json_writer *json, const struct bench *bench,
                 const struct bench_case *c);
    void (*close_case)(struct bench_case *c);
    void (*close)(struct bench *bench);
};
extern const struct bench_subject bench_flare, bench_scene;

struct bench {
    const struct bench_subject *subject;
    struct tool *tool;
    struct settings base; /* settings from the command line */
    /* word: index of the pixel format in bench_format */
    int width, height, rounds, word;
    bool moving; /* true: the first light is at another angle in each round */
    struct canvas canvas;
    struct bench_case *cases[BENCH_LENSES];
    int n_cases;
    void *opened; /* opened lenses or scenes of the subject */
};

extern const char *const bench_format[]; /* option values of the pixel formats,
                                            ends with NULL */

/* Opens the lenses or scenes NAME[N], measures and prints all cases. Returns an
 * exit code. */
int bench_run_all(struct bench *bench, int n, const char *const *name);

void bench_close(struct bench *bench);

/* Adds a case of NAME. Returns NULL if there is no memory or there are
 * BENCH_LENSES cases. */
struct bench_case *bench_add_case(struct bench *bench, const char *name);

/* Returns the number of threads that draw. */
int bench_get_threads(const struct bench *bench);

void bench_write_json_format(struct json_writer *json,
                             const struct bench *bench);
void bench_write_json_times(struct json_writer *json, const struct bench *bench,
                            const struct bench_case *c);

/* Returns the median time of STAGE of case C, ms. */
double bench_compute_median_ms(const struct bench *bench,
                               const struct bench_case *c, int stage);

/* code of the first option that is specific to one subject (flare or scene) */
enum { BENCH_OWN = 'A' };
#define BENCH_OPTIONS                             \
    {"size", required_argument, NULL, 's'},       \
        {"repeat", required_argument, NULL, 'r'}, \
        {"format", required_argument, NULL, 'F'}, \
    {                                             \
        NULL, 0, NULL, 0                          \
    }

#endif
