/* SPDX-License-Identifier: MIT
 *
 * glint sweep: frames with each quality parameter set alone, with some of them
 * set together, and along --quality, in cases of a lens, a size and some
 * lights; and the metrics of each.
 */
#ifndef GLINT_TOOLS_LAB_SWEEP_H
#define GLINT_TOOLS_LAB_SWEEP_H

#include "measure/canvas.h"

enum { SWEEP_LENSES = 16, SWEEP_CASES = 128, SWEEP_ROUNDS = 100 };
enum { MAX_PARAMETERS = 12, MAX_VALUES = 10, MAX_TOGETHER = 5 };

/* largest flux error on a front: brightness must not depend on parameters */
#define MAX_FLUX_ERROR 0.02

/* A parameter that trades accuracy for time. */
struct sweep_parameter {
    const char *name;   /* for tables and plots */
    const char *option; /* of the engine; NULL: the tolerance of a bake */
    double standard;    /* value by default */
    bool opens;         /* Settings have to be opened again for it. */
    bool many_lights;   /* has no effect on a single light */
    int n_values, n_together;
    double value[MAX_VALUES]; /* from the finest on */
    double together[MAX_TOGETHER];
    const char *words[MAX_VALUES]; /* VALUE as texts; NULL: numbers */
};
extern const struct sweep_parameter sweep_parameter[];
extern const int n_sweep_parameters;

/* kind of setting that a point measures */
enum sweep_kind { SWEEP_STANDARD, SWEEP_ALONE, SWEEP_TOGETHER, SWEEP_QUALITY };

struct sweep_setting {
    enum sweep_kind kind;
    int alone;      /* index of the only parameter that is set; -1: no
                       parameter */
    double quality; /* --quality, 0 .. 1; -1: not set by it */
    double value[MAX_PARAMETERS];
};

enum sweep_metric {
    SWEEP_MS,
    SWEEP_FLOOR_MS,
    SWEEP_RATIO,
    SWEEP_INSTRUCTIONS,
    SWEEP_ARENA_BYTES,
    SWEEP_MODEL_BYTES,
    SWEEP_PSNR_DB,
    SWEEP_SSIM,
    SWEEP_P99,
    SWEEP_FLUX_ERROR,
    SWEEP_GHOSTS,
    SWEEP_BUNDLES,
    SWEEP_EDGES,
    SWEEP_TILES,
    SWEEP_METRICS
};

/* One setting in one case. */
struct sweep_point {
    struct sweep_setting set;
    int of;                       /* index of the point's case */
    double metric[SWEEP_METRICS]; /* NAN: not measured */
    bool front; /* no other of its case is both cheaper and better */
};

struct sweep_case {
    int lens; /* index of the lens */
    int width, height, n_lamps;
    double angle;
    bool together; /* parameters are combined here */
    int first, n;  /* The case has points first .. first + n - 1. */
};

/* A picture for the page: small, sRGB codes, [height][width][3]. */
struct sweep_picture {
    int of, point; /* indices of case and point; point -1: the exact picture */
    int width, height;
    uint8_t *rgb;
};

struct sweep {
    struct tool *tool;
    struct settings base;
    const char *lens[SWEEP_LENSES];
    int n_lenses;
    struct sweep_case scase[SWEEP_CASES];
    int n_cases;
    struct sweep_point *point;
    int n_points;
    struct sweep_picture *picture;
    int n_pictures;
    /* Rounds of timing, 1 .. SWEEP_ROUNDS; cells per side of the grid of rays
     * that draws the exact picture, 4 .. 1024, even. */
    int rounds, grid;
    bool small;
    int counter; /* descriptor that counts instructions, or -1 */
    struct glint_workers *one;
};

/* Sets in SETTINGS what SET says; OPENING: only what opens them. */
void sweep_set(struct settings *settings, const struct sweep_setting *set,
               bool opening);

/* Makes the points of all cases. GLINT_E_MEMORY. */
enum glint_status sweep_plan(struct sweep *s);

/* Measures case C. Returns an exit code. */
int sweep_measure(struct sweep *s, int c, struct tool_progress *progress);

/* ------------------------------------------------------------------- fronts */

/* Marks the front of each case. */
void sweep_mark_fronts(struct sweep *s);

/* Sets FRONT[N] to the indices of the points that no other is both cheaper and
 * better than, the cheapest first. Returns how many. Points with NAN are left
 * out. */
int sweep_front(const double *cost, const double *quality, int n, int *front);

/* Means of one setting over all cases in which parameters are combined:
 * geometric mean of its cost over that of the standard setting of the same
 * case; mean and least PSNR, dB; largest error of the flux, without its
 * sign. */
struct sweep_mean {
    const struct sweep_setting *set;
    double cost, psnr_db, least_db, flux_error;
    bool front;
};

/* Returns the means of all settings, malloc'ed, the cheapest first, and marks
 * the front, on which are none with a flux error above 2 percent. Sets *N to
 * how many; 0 and NULL without memory. */
struct sweep_mean *sweep_means(const struct sweep *s, int *n);

/* Sorts MEAN[N] by cost, the cheapest first. */
void sweep_sort(struct sweep_mean *mean, int n);

/* Returns by how many dB MEAN[I] lies above the best PSNR that --quality
 * reaches for at most 1.02 times its cost; 2 percent are noise. MEAN[N] is
 * sorted by cost. Between two neighbouring settings of --quality that draw as
 * many pixels the PSNR is interpolated. */
double sweep_above(const struct sweep_mean *mean, int n, int i);

/* ------------------------------------------------------------------- output */

/* Writes SET as words: --quality and the parameters that differ from the
 * standard, as "grid 32, quantum 2", or "default". */
void sweep_words(const struct sweep_setting *set, char text[160]);

/* Returns the index of the name of P's quality, or -1. */
int sweep_named(const struct sweep_point *p);

void sweep_write_csv(const struct sweep *s, FILE *file);
void sweep_write_json(const struct sweep *s, FILE *file);
void sweep_write_front_svg(const struct sweep *s, FILE *file);
void sweep_write_dials_svg(const struct sweep *s, FILE *file);
void sweep_write_page(const struct sweep *s, FILE *file);

/* Prints the table of named qualities, as Markdown, and which settings of one
 * parameter lie above --quality. */
void sweep_names(const struct sweep *s, FILE *file);

#endif
