/* SPDX-License-Identifier: MIT
 *
 * The measurements of glint sweep: settings of the dials, each dial by itself
 * and together, in cases of a lens, a size and some lights.
 */
#ifndef GLINT_TOOLS_LAB_SWEEP_H
#define GLINT_TOOLS_LAB_SWEEP_H

#include "engine/frame/cost.h"
#include "lab/dials.h"
#include "glint/quality.h"
#include "formats/pfm.h"
#include "lab/canvas.h"

enum { SWEEP_LENSES = 16, SWEEP_CASES = 128, SWEEP_ROUNDS = 100 };
enum { SWEEP_STAR_LAMPS = 3, SWEEP_STAR_CULLS = 10, SWEEP_PARTS = 10 };

/* largest flux error on a front: brightness must not depend on dials */
#define MAX_FLUX_ERROR 0.02

/* kind of setting that a point measures */
enum sweep_kind {
    SWEEP_STANDARD,
    SWEEP_ALONE,
    SWEEP_TOGETHER,
    SWEEP_QUALITY, /* the dials as --quality sets them */
    SWEEP_GROWTH   /* standard, without an exact picture */
};

struct sweep_setting {
    enum sweep_kind kind;
    int dial; /* number of the dial that alone is turned; -1: none or several */
    double quality; /* --quality, 0 .. 1; -1: not set by it */
    double value[MAX_DIALS];
};

/* One setting in one case. NAN: not measured. */
struct sweep_point {
    struct sweep_setting set;
    int of; /* index of the point's case */
    double ms, floor_ms, ratio, instructions;
    size_t arena_bytes, model_bytes;
    double psnr_db, ssim, p99, flux_error;
    struct glint_engine_report report;
    struct glint_cost cost; /* cost that the plan predicts */
    bool front; /* no other of its case is both cheaper and better */
    int picture;
};

struct sweep_case {
    int lens; /* index of the lens */
    int width, height, n_lamps;
    double angle;
    bool growth;
    bool together; /* dials are combined here */
    int first, n;  /* The case has points first .. first + n - 1. */
};

/* A picture for the page: small, sRGB codes, [height][width][3]. */
struct sweep_picture {
    int of, point; /* indices of case and point; point -1: the exact picture */
    int width, height;
    double exposure;
    /* difference: 16 times that to the exact picture, about grey; NULL for the
     * exact picture */
    uint8_t *rgb, *difference;
};

/* A frame against all of its light, in codes that are not rounded. */
struct sweep_shot {
    double psnr_db, most_codes, instructions, ms;
    struct glint_engine_report report;
};

/* The stars of some lamps, drawn alone with one value of the dial star_cull. */
struct sweep_star {
    const char *words;
    double cull, pixels, minsn_told;
    struct sweep_shot shot;
    size_t bytes;
};

/* A frame with dust or a veil, with one value of its dial. */
struct sweep_part {
    const char *words, *dial;
    int value;
    double minsn_told;
    struct sweep_shot shot;
    size_t bytes; /* bytes that the frame used, with tables */
    bool front;   /* no other value is both cheaper and better */
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
    struct sweep_star star[SWEEP_STAR_LAMPS * SWEEP_STAR_CULLS];
    int n_stars;
    struct sweep_part part[SWEEP_PARTS];
    int n_parts;
    /* Rounds of timing, 1 .. SWEEP_ROUNDS; cells a side of the grid of rays
     * that draws the exact picture, 4 .. 1024, even. */
    int rounds, grid;
    bool small, count_only;
    const char *counts; /* file of instructions, or NULL */
    int counter;        /* descriptor that counts instructions, or -1 */
    bool by_instructions;
    struct glint_workers *one;
};

/* Makes the points of all cases. GLINT_E_MEMORY. */
enum glint_status sweep_plan(struct sweep *s);

/* Measures case C. Returns an exit code. */
int sweep_measure(struct sweep *s, int c, struct tool_progress *progress);

/* Measures stars through LENS for each value of the dial star_cull. Returns an
 * exit code. */
int sweep_stars(struct sweep *s, const char *lens);

/* Measures dust and veil through LENS for each value of their dials. Returns an
 * exit code. */
int sweep_parts(struct sweep *s, const char *lens);

/* Calls glint_frame_draw(), as a function of its own, whose instructions
 * tools/report/sweep-insn counts. */
enum glint_status sweep_frame(struct glint_frame *frame,
                              const struct glint_lamp *lamp, int n,
                              double exposure, const struct glint_image *image,
                              struct glint_engine_report *report);

/* Returns the cost of a frame of P: in memory floors, or with by_instructions
 * in millions of instructions; NAN if it was not measured. */
double sweep_cost(const struct sweep *s, const struct sweep_point *p);

/* Marks the front of each case. */
void sweep_mark_fronts(struct sweep *s);

/* Sets FRONT[N] to the indices of the points that no other is both cheaper and
 * better than, the cheapest first. Returns how many. Points with NAN are left
 * out. */
int sweep_front(const double *cost, const double *quality, int n, int *front);

/* Means of one setting over all cases in which dials are combined: geometric
 * mean of its cost over that of the standard setting of the same case; mean and
 * least PSNR, dB; largest error of the flux, without its sign. */
struct sweep_mean {
    const struct sweep_setting *set;
    double cost, psnr_db, least_db, flux_error;
    bool front;
};

/* Sets MEAN to the means of all settings, at most MAX, the cheapest first, and
 * marks the front, on which are none with a flux error above 2 percent. Returns
 * how many. */
int sweep_means(const struct sweep *s, struct sweep_mean *mean, int max);

/* Returns by how many dB MEAN[I] lies above the best PSNR that --quality
 * reaches for at most 1.02 times its cost; 2 percent are noise. MEAN[N] is
 * sorted by cost. Between two neighbouring settings of --quality that draw as
 * many pixels the PSNR is interpolated. */
double sweep_above(const struct sweep_mean *mean, int n, int i);

/* Writes SET as words: --quality and the dials that differ from the standard,
 * as "grid 32, quantum 2", or "default". */
void sweep_words(const struct sweep_setting *set, char *text, size_t bytes);

/* ------------------------------------------------------------------- output */

/* Reads INSTRUCTIONS[N_POINTS] from PATH, the file of --counts, whose lines are
 * "POINT INSTRUCTIONS"; points without one stay. Returns an exit code. */
int sweep_read_counts(const char *path, int n_points, double *instructions);

void sweep_csv(const struct sweep *s, FILE *file);
void sweep_json(const struct sweep *s, FILE *file);
void sweep_svg_front(const struct sweep *s, FILE *file);
/* Plots the means only, and the means of each dial by itself; small. */
void sweep_svg_trade(const struct sweep *s, FILE *file);
void sweep_svg_dials(const struct sweep *s, FILE *file);
/* Returns whether there are points for plots against pixels, lights and
 * ghosts. */
bool sweep_has_growth(const struct sweep *s);
void sweep_svg_growth(const struct sweep *s, FILE *file);
void sweep_star_csv(const struct sweep *s, FILE *file);
void sweep_star_svg(const struct sweep *s, FILE *file);
void sweep_parts_csv(const struct sweep *s, FILE *file);
void sweep_page(const struct sweep *s, FILE *file);

/* Prints the table of named qualities, as Markdown, and which settings of one
 * dial lie above --quality. */
void sweep_names(const struct sweep *s, FILE *file);

#endif
