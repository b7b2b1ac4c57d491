/* SPDX-License-Identifier: MIT
 *
 * glint sweep: measures the time and error of frames at many settings of the
 * quality parameters: with one parameter changed, with several changed, and
 * with --quality at several values. A case is a combination of lens, image size
 * and lights.
 */
#ifndef GLINT_TOOLS_LAB_SWEEP_H
#define GLINT_TOOLS_LAB_SWEEP_H

#include "measure/canvas.h"

enum { SWEEP_LENSES = 16, SWEEP_CASES = 128, SWEEP_ROUNDS = 100 };
enum { MAX_PARAMETERS = 12, MAX_VALUES = 10, MAX_TOGETHER = 5 };

/* Max flux error of settings on a Pareto front, as a fraction: brightness must
 * not depend on parameters */
#define MAX_FLUX_ERROR 0.02

/* A parameter that trades accuracy for time. */
struct sweep_parameter {
    const char *name;   /* name in tables and plots */
    const char *option; /* engine option; NULL: the tolerance of a bake */
    double standard;
    bool opens; /* whether a change requires opening the lens again */
    /* whether the parameter has no effect on a single light */
    bool many_lights;
    int n_values, n_together;
    double value[MAX_VALUES]; /* values to measure, the finest first */
    double together[MAX_TOGETHER];
    const char *words[MAX_VALUES]; /* option values as texts; NULL: numbers */
};
extern const struct sweep_parameter sweep_parameter[];
extern const int n_sweep_parameters;

/* how a point's parameters are set: all at their defaults, one changed,
 * several changed, or by --quality */
enum sweep_kind { SWEEP_STANDARD, SWEEP_ALONE, SWEEP_TOGETHER, SWEEP_QUALITY };

struct sweep_setting {
    enum sweep_kind kind;
    int alone;      /* index of the only parameter that is set; -1: no
                       parameter */
    double quality; /* --quality, 0 .. 1; -1: --quality is not set */
    double value[MAX_PARAMETERS];
};

enum sweep_metric {
    SWEEP_MS,
    SWEEP_FLOOR_MS,
    SWEEP_RATIO,
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

/* A setting measured in a case. */
struct sweep_point {
    struct sweep_setting set;
    int of;                       /* index of the point's case */
    double metric[SWEEP_METRICS]; /* measured values; NAN: not measured */
    bool front; /* whether no other point of its case is both cheaper and better
                   (Pareto front) */
};

struct sweep_case {
    int lens;
    int width, height, n_lamps;
    double angle;
    bool together; /* whether combinations of parameters are measured in this
                      case */
    int first, n;  /* the case's points are first .. first + n - 1 */
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
    /* number of timing rounds, 1 .. SWEEP_ROUNDS, and cells per side of the
     * exact picture's ray grid, 4 .. 1024, even */
    int rounds, grid;
    bool small;
};

/* Applies SET to SETTINGS. OPENING: only parameters that affect opening the
 * lens. */
void sweep_apply_setting(struct settings *settings,
                         const struct sweep_setting *set, bool opening);

/* Makes the points of all cases. Returns GLINT_E_MEMORY on failure. */
enum glint_status sweep_plan_points(struct sweep *s);

/* Measures all points of case C. Returns an exit code. */
int sweep_measure_case(struct sweep *s, int c, struct tool_progress *progress);

/* Marks the points on the Pareto front of each case. */
void sweep_mark_fronts(struct sweep *s);

/* ------------------------------------------------------------------- output */

/* Returns the index of the name of P's --quality value (such as "draft"), or -1
 * if that value has no name. */
int sweep_find_quality_name_index(const struct sweep_point *p);

void sweep_write_csv(const struct sweep *s, FILE *file);
void sweep_write_json(const struct sweep *s, FILE *file);

/* Prints a Markdown table of the named qualities. */
void sweep_write_name_table(const struct sweep *s, FILE *file);

#endif
