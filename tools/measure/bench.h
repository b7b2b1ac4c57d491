/* SPDX-License-Identifier: MIT
 *
 * glint bench: cases that are drawn in turns and timed by stage. What is drawn
 * is the bench's subject: flares (bench_flare.c) or a scene (bench_scene.c).
 */
#ifndef GLINT_TOOLS_LAB_BENCH_H
#define GLINT_TOOLS_LAB_BENCH_H

#include "measure/canvas.h"

enum {
    BENCH_CASES = 256, /* more than 16 lenses have with --all */
    BENCH_ROUNDS = CANVAS_MAX,
    BENCH_STAGES = 7,
    BENCH_CANVASES = 8,
    BENCH_LENSES = 16
};

/* A case. Each subject has a struct of its own that begins with one. */
struct bench_case {
    const char *name; /* of the lens or scene */
    struct canvas *canvas;
    struct glint_workers *workers;
    int threads;
    const char *kernels;
    double ms[BENCH_STAGES][BENCH_ROUNDS];
};

/* How a case differs from the plain one; 0 or NULL: in nothing. */
struct bench_variation {
    int width, height;
    bool two_threads;
    const char *kernels;
    unsigned sets;      /* instruction sets that KERNELS may use */
    const char *option; /* of the engine, and its value */
    double value;
    int lights;
    double angle;      /* degrees off the axis; 0: 12 */
    double star_stops; /* stars alone, of lamps of so many stops over white */
};

struct bench;
struct json_writer;

struct bench_subject {
    const char *word; /* of it in JSON */
    const char *help;
    const struct option *own;
    unsigned groups; /* of the engine's options that it has */
    int max_rounds;
    /* Stages by name. The last one is the whole frame. */
    int n_stages;
    const char *stage[BENCH_STAGES];
    const char *heads; /* of the columns before and behind the times */
    const char *tail;
    size_t case_bytes;

    /* Takes an option of its own. Returns 1; 0: not that value; -2: another
     * option. */
    int (*take)(struct bench *bench, int c, const char *value);
    /* Opens NAME[N] and adds all cases. Returns an exit code. */
    int (*open)(struct bench *bench, int n, const char *const *name);
    enum glint_status (*draw)(struct bench *bench, struct bench_case *c,
                              int round);
    /* Print the columns before and behind the times of C. */
    void (*print_case)(const struct bench *bench, const struct bench_case *c);
    void (*print_result)(const struct bench *bench, const struct bench_case *c);
    /* Writes all members of C's object but the name, by bench_json_format() and
     * bench_json_times(). */
    void (*json)(struct json_writer *json, const struct bench *bench,
                 const struct bench_case *c);
    void (*close_case)(struct bench_case *c);
    void (*close)(struct bench *bench);
};
extern const struct bench_subject bench_flare, bench_scene;

struct bench {
    const struct bench_subject *subject;
    struct tool *tool;
    struct settings base;            /* as the line says */
    int width, height, rounds, word; /* word: index of the format */
    bool all;
    bool moving; /* The first light moves from round to round. */
    struct glint_workers *one, *two;
    struct canvas canvas[BENCH_CANVASES];
    int n_canvases;
    struct bench_case *cases[BENCH_CASES];
    int n_cases;
    void *opened; /* private to the subject */
};

extern const char *const bench_format[]; /* words; the last is NULL */

/* Opens NAME[N] and measures and prints all cases. Returns an exit code. */
int bench_run_all(struct bench *bench, int n, const char *const *name);

/* Frees BENCH and what it has opened. */
void bench_close(struct bench *bench);

/* Adds a case of V, with its canvas, threads and kernels. Returns NULL without
 * memory, or if there are too many. */
struct bench_case *bench_add(struct bench *bench, const char *name,
                             const struct bench_variation *v);

/* Returns whether this processor has what V needs. */
bool bench_is_possible(const struct bench_variation *v);

void bench_json_format(struct json_writer *json, const struct bench *bench,
                       const struct bench_case *c);
void bench_json_times(struct json_writer *json, const struct bench *bench,
                      const struct bench_case *c);

/* Returns the median time of STAGE of C, or of the memory floor, ms. */
double bench_ms(const struct bench *bench, const struct bench_case *c,
                int stage);
double bench_floor_ms(const struct bench *bench, const struct bench_case *c);

/* Options of both subjects. */
enum { BENCH_OWN = 'A' }; /* subjects number their own from here on */
#define BENCH_OPTIONS                                                        \
    {"all", no_argument, NULL, 'a'}, {"size", required_argument, NULL, 's'}, \
        {"repeat", required_argument, NULL, 'r'},                            \
        {"format", required_argument, NULL, 'F'},                            \
    {                                                                        \
        NULL, 0, NULL, 0                                                     \
    }

#endif
