/* SPDX-License-Identifier: MIT
 *
 * Tools to measure frames, for bench and sweep: a picture to draw on, the cost
 * of touching its memory, lamps, and the exact picture.
 */
#ifndef GLINT_TOOLS_LAB_CANVAS_H
#define GLINT_TOOLS_LAB_CANVAS_H

#include "formats/pfm.h"
#include "lab/settings_frame.h"

/* A picture to draw on, in mem, and its pixels before drawing, fresh. */
struct canvas {
    struct glint_image image; /* lies in mem */
    uint8_t *fresh, *mem;
    size_t bytes;
};

/* Makes a dim picture of FORMAT and size. GLINT_E_MEMORY. */
enum glint_status canvas_init(struct canvas *canvas,
                              enum glint_pixel_format format, int width,
                              int height);
void canvas_fresh(struct canvas *canvas); /* undoes all drawing */
void canvas_finish(struct canvas *canvas);

/* Returns the memory floor, in ms: the time of a saturating addition of a small
 * constant layer to a fresh canvas. */
double canvas_floor_ms(struct canvas *canvas);

/* Sets LAMP to N lamps, the first ANGLE degrees off the axis, the others on a
 * spiral around the axis. Up to 64 lamps share a power of 1 equally; of more
 * lamps the kth, counted from 1, has 1 / k. */
void canvas_lamps(struct glint_lamp *lamp, int n, double angle);

/* Draws the flare of LAMP by exact rays in double, GRID cells a side, with the
 * lens, stop and wavelengths of SETTINGS, opened from a table, to TO, whose
 * memory the caller has taken. GLINT_E_MEMORY. */
enum glint_status canvas_exact(const struct tool *tool,
                               const struct settings *settings,
                               const struct glint_lamp *lamp, int n_lamps,
                               int grid, struct glint_float_image *to);

/* Draws the flare alone, times EXPOSURE, as codes on black,
 * CODES[height][width][3]. A frame draws less for codes than in linear
 * light. */
enum glint_status canvas_codes(struct glint_frame *frame,
                               const struct glint_lamp *lamp, int n_lamps,
                               double exposure, uint8_t *codes,
                               struct glint_engine_report *report);

/* Returns the median of N values, 1 .. CANVAS_MAX, and leaves VALUES as they
 * are. */
enum { CANVAS_MAX = 1000 };
double canvas_median(const double *values, int n);

#endif
