/* SPDX-License-Identifier: MIT
 *
 * What glint sweep measures: settings of the dials, each by itself and
 * together, in every case of a lens, a size and some lights.
 */
#ifndef GLINT_TOOLS_LAB_SWEEP_H
#define GLINT_TOOLS_LAB_SWEEP_H

#include "engine/frame/cost.h"
#include "options/dials.h"
#include "engine/frame/quality.h"
#include "formats/pfm.h"
#include "lab/canvas.h"

enum { SWEEP_LENSES = 16, SWEEP_CASES = 128, SWEEP_ROUNDS = 100 };

#define MAX_FLUX_ERROR 0.02 /* brightness must not depend on a dial */

/* What a point measures. */
enum sweep_kind {
    SWEEP_STANDARD,
    SWEEP_ALONE,
    SWEEP_TOGETHER,
    SWEEP_QUALITY, /* the dials as --quality sets them */
    SWEEP_GROWTH   /* standard, without an exact picture */
};

struct sweep_setting {
    enum sweep_kind kind;
    int dial;       /* number of the dial that alone is turned; -1: several */
    double quality; /* --quality, 0 .. 1; -1: not set by it */
    double value[MAX_DIALS];
};

/* One setting in one case. NAN: not measured. */
struct sweep_point {
    struct sweep_setting set;
    int of; /* index of the case it belongs to */
    double ms, floor_ms, ratio, instructions;
    size_t arena_bytes, model_bytes;
    double psnr_db, ssim, p99, flux_error;
    struct glint_frame_report report;
    struct glint_cost cost; /* cost that the plan predicts */
    bool front; /* no other of its case is both cheaper and better */
    int picture;
};

struct sweep_case {
    int lens; /* number */
    int width, height, n_lamps;
    double angle;
    bool growth;
    bool together; /* dials are combined here */
    int first, n;  /* its points */
};

/* A picture for the page: small, sRGB codes, [height][width][3]. */
struct sweep_picture {
    int of, point; /* case; -1: the exact one */
    int width, height;
    double exposure;
    uint8_t *rgb, *difference; /* 16 times, about grey; NULL of the exact one */
};

struct sweep {
    struct tool *tool;
    struct settings base;
    const char *lens[SWEEP_LENSES];
    int n_lenses;
    struct sweep_case scase[SWEEP_CASES];
    int n_cases;
    struct sweep_point *point;
    int n_points, max_points;
    struct sweep_picture *picture;
    int n_pictures, max_pictures;
    /* Rounds of timing, 1 .. SWEEP_ROUNDS; cells a side of the grid of rays
     * that draws the exact picture, 4 .. 1024, even. */
    int rounds, grid;
    bool small, count_only;
    const char *counts; /* file of instructions, or NULL */
    int counter;        /* descriptor that counts instructions, or -1 */
    bool by_instructions;
    struct glint_workers *one;
};

/* Makes all points of the cases. GLINT_E_MEMORY. */
enum glint_status sweep_plan(struct sweep *s);

/* Measures case C. Returns an exit code. */
int sweep_measure(struct sweep *s, int c, struct tool_progress *progress);

/* glint_frame_draw(), in a function of its own that
 * tools/report/sweep-insn counts. */
enum glint_status sweep_frame(struct glint_frame *frame,
                              const struct glint_lamp *lamp, int n,
                              double exposure, const struct glint_image *image,
                              struct glint_frame_report *report);

/* What a frame of POINT costs: times the memory floor, or with
 * by_instructions millions of these. NAN: not measured. */
double sweep_cost(const struct sweep *s, const struct sweep_point *p);

/* Marks the front of each case. */
void sweep_mark_fronts(struct sweep *s);

/* The front of N points by cost, least first, and quality, most wanted: their
 * numbers into FRONT[N]. Returns how many. Points with NAN are none. */
int sweep_front(const double *cost, const double *quality, int n, int *front);

/* A setting over all cases that are swept together: geometric mean of costs
 * over the standard's, mean and least PSNR, worst flux. */
struct sweep_mean {
    const struct sweep_setting *set;
    double cost, psnr_db, least_db, flux_error;
    bool front;
};

/* Returns how many, at most MAX, the cheapest first; those on the front are
 * marked: of flux errors above 2 percent none. */
int sweep_means(const struct sweep *s, struct sweep_mean *mean, int max);

/* Decibels that MEAN[I] lies above what --quality reaches at its cost (or 2
 * percent more, which is noise), by its means among these N, the cheapest
 * first, and between two of them that draw as many pixels. */
double sweep_above(const struct sweep_mean *mean, int n, int i);

/* "grid 32, quantum 2": what differs from the standard. */
void sweep_words(const struct sweep_setting *set, char *text, size_t bytes);

/* ------------------------------------------------------------------- output */

void sweep_csv(const struct sweep *s, FILE *file);
void sweep_json(const struct sweep *s, FILE *file);
void sweep_svg_front(const struct sweep *s, FILE *file);
/* The means alone, with each dial's: small. */
void sweep_svg_trade(const struct sweep *s, FILE *file);
void sweep_svg_dials(const struct sweep *s, FILE *file);
/* Whether there is anything of pixels, lights and ghosts to plot. */
bool sweep_has_growth(const struct sweep *s);
void sweep_svg_growth(const struct sweep *s, FILE *file);
void sweep_page(const struct sweep *s, FILE *file);

/* Rows of the table of named qualities, as Markdown, and which dials by
 * themselves lie above them. */
void sweep_names(const struct sweep *s, FILE *file);

/* RGB[HEIGHT][WIDTH][3] as a data: URI of a PNG. */
void sweep_png(FILE *file, const uint8_t *rgb, int width, int height);

#endif
