/* SPDX-License-Identifier: MIT
 *
 * Tools to measure frames, for bench and sweep: a picture to draw on, the cost
 * of touching its memory, lamps, and the exact picture.
 */
#ifndef GLINT_TOOLS_LAB_CANVAS_H
#define GLINT_TOOLS_LAB_CANVAS_H

#include "formats/pnm.h"
#include "model/opened_lens.h"

enum { CANVAS_MAX = 1000 }; /* max rounds, and max values of a median */

/* A picture to draw on; mem holds its pixels, fresh its pixels before
 * drawing. */
struct canvas {
    struct glint_image image; /* its planes lie in mem */
    uint8_t *fresh, *mem;
    size_t bytes;
    double floor_ms[CANVAS_MAX]; /* memory floor of each round, set by
                                    canvas_time_floor() */
};

/* Makes a dim picture of FORMAT and size. Returns GLINT_E_MEMORY on failure. */
enum glint_status canvas_init(struct canvas *canvas,
                              enum glint_pixel_format format, int width,
                              int height);
void canvas_fresh(struct canvas *canvas); /* restores the pixels before
                                             drawing */
void canvas_finish(struct canvas *canvas);

/* Measures the memory floor of ROUND: the time of a saturating addition of a
 * small constant layer to a fresh canvas. */
void canvas_time_floor(struct canvas *canvas, int round);

/* Sets LAMP to N lamps, the first ANGLE degrees off the axis, the others on a
 * spiral around the axis. Up to 64 lamps share a power of 1 equally; of more
 * lamps the kth, counted from 1, has 1 / k. */
void canvas_lamps(struct glint_lamp *lamp, int n, double angle);

/* Sets CFG for an engine of WIDTH x HEIGHT with the settings ASKED that draws
 * lamps by glint_engine_draw_at() and finds none. LENS must outlive the
 * engine. */
void canvas_engine(const struct tool *tool, const struct opened_lens *lens,
                   const struct settings *asked, int width, int height,
                   struct glint_engine_config *cfg);

/* Sets EXPOSURE so that the 99.9th percentile of the flare's luminance is
 * white. Returns GLINT_E_MEMORY on failure. */
enum glint_status canvas_exposure(struct glint_engine *engine,
                                  const struct glint_lamp *lamp, int n_lamps,
                                  double *exposure);

/* Draws the flare of LAMP by exact rays in double, on a grid of GRID x GRID
 * cells, with the lens, stop and wavelengths of SETTINGS, to TO, whose memory
 * the caller allocates. LENS must be opened from a table. Loads the picture if
 * it is cached. Returns GLINT_E_MEMORY on failure. */
enum glint_status canvas_exact(const struct tool *tool,
                               const struct opened_lens *lens,
                               const struct settings *settings,
                               const struct glint_lamp *lamp, int n_lamps,
                               int grid, struct glint_float_image *to);

/* Draws only the flare, times EXPOSURE, on black to sRGB codes
 * CODES[height][width][3]. For codes an engine computes less than for linear
 * light. */
enum glint_status canvas_codes(struct glint_engine *engine,
                               const struct glint_lamp *lamp, int n_lamps,
                               double exposure, uint8_t *codes,
                               struct glint_engine_report *report);

/* Returns the processor's name, without commas, for tables; "unknown" if the
 * system does not report it. */
const char *canvas_machine(void);

/* Returns the median of VALUES[N], N from 1 to CANVAS_MAX; does not reorder
 * them. */
double canvas_median(const double *values, int n);

#endif
