/* SPDX-License-Identifier: MIT
 *
 * Tools to measure frames, for bench and sweep: a picture to draw on, the cost
 * of touching its memory, lamps, and the exact picture.
 */
#ifndef GLINT_TOOLS_LAB_CANVAS_H
#define GLINT_TOOLS_LAB_CANVAS_H

#include "formats/pnm.h"
#include "model/opened_lens.h"

enum { CANVAS_MAX = 1000 }; /* largest number of rounds, and of medians */

/* A picture to draw on, in mem, and its pixels before drawing, fresh. */
struct canvas {
    struct glint_image image; /* lies in mem */
    uint8_t *fresh, *mem;
    size_t bytes;
    double floor_ms[CANVAS_MAX]; /* by round, as canvas_time_floor() sets it */
};

/* Makes a dim picture of FORMAT and size. GLINT_E_MEMORY. */
enum glint_status canvas_init(struct canvas *canvas,
                              enum glint_pixel_format format, int width,
                              int height);
void canvas_fresh(struct canvas *canvas); /* undoes all drawing */
void canvas_finish(struct canvas *canvas);

/* Measures the memory floor of ROUND: the time of a saturating addition of a
 * small constant layer to a fresh canvas. */
void canvas_time_floor(struct canvas *canvas, int round);

/* Sets LAMP to N lamps, the first ANGLE degrees off the axis, the others on a
 * spiral around the axis. Up to 64 lamps share a power of 1 equally; of more
 * lamps the kth, counted from 1, has 1 / k. */
void canvas_lamps(struct glint_lamp *lamp, int n, double angle);

/* Sets CFG to what an engine of WIDTH x HEIGHT takes that draws lamps by
 * glint_engine_draw_at() and looks for none, as ASKED says, through LENS,
 * which must outlive the engine. */
void canvas_engine(const struct tool *tool, const struct opened_lens *lens,
                   const struct settings *asked, int width, int height,
                   struct glint_engine_config *cfg);

/* Sets EXPOSURE to that at which the 99.9th percentile of the luminance of the
 * flare is white. GLINT_E_MEMORY. */
enum glint_status canvas_exposure(struct glint_engine *engine,
                                  const struct glint_lamp *lamp, int n_lamps,
                                  double *exposure);

/* Draws the flare of LAMP by exact rays in double, GRID cells a side, with the
 * lens, stop and wavelengths of SETTINGS, opened from a table, to TO, whose
 * memory the caller has taken; or loads it where a picture drawn before is
 * cached. GLINT_E_MEMORY. */
enum glint_status canvas_exact(const struct tool *tool,
                               const struct opened_lens *lens,
                               const struct settings *settings,
                               const struct glint_lamp *lamp, int n_lamps,
                               int grid, struct glint_float_image *to);

/* Draws the flare alone, times EXPOSURE, as codes on black,
 * CODES[height][width][3]. An engine draws less for codes than in linear
 * light. */
enum glint_status canvas_codes(struct glint_engine *engine,
                               const struct glint_lamp *lamp, int n_lamps,
                               double exposure, uint8_t *codes,
                               struct glint_engine_report *report);

/* Returns the processor's name, without commas, for tables of figures measured
 * on it; "unknown" if the system does not report it. */
const char *canvas_machine(void);

/* Returns the median of N values, 1 .. CANVAS_MAX, and leaves VALUES as they
 * are. */
double canvas_median(const double *values, int n);

#endif
