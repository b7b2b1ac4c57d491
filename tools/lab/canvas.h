/* SPDX-License-Identifier: MIT
 *
 * What frames are measured by, for bench and sweep alike: a picture to draw on
 * and what touching its memory costs, lamps, and the exact picture.
 */
#ifndef GLINT_TOOLS_LAB_CANVAS_H
#define GLINT_TOOLS_LAB_CANVAS_H

#include "formats/pfm.h"
#include "options/settings.h"

/* A picture to draw on, as it is before and as it becomes. */
struct canvas {
    struct glint_image image; /* lies in mem */
    uint8_t *fresh, *mem;
    size_t bytes;
};

/* A dim evening of this FORMAT and size. GLINT_E_MEMORY. */
enum glint_status canvas_init(struct canvas *canvas,
                              enum glint_pixel_format format, int width,
                              int height);
void canvas_fresh(struct canvas *canvas); /* undoes what was drawn */
void canvas_finish(struct canvas *canvas);

/* Milliseconds that touching a fresh canvas takes at all: a saturating addition
 * of a small constant layer, the memory floor. */
double canvas_floor_ms(struct canvas *canvas);

/* N lamps, the first ANGLE degrees off the axis, the others on a spiral around
 * it. Equal lights, but of hundreds few are bright: the kth brightest has 1 / k
 * of the power of the first. */
void canvas_lamps(struct glint_lamp *lamp, int n, double angle);

/* The flare of LAMP as every ray in double draws it, of cells GRID a side, with
 * the lens, stop and wavelengths of SETTINGS, opened from a table. TO is
 * allocated. GLINT_E_MEMORY. */
enum glint_status canvas_exact(const struct tool *tool,
                               const struct settings *settings,
                               const struct glint_lamp *lamp, int n_lamps,
                               int grid, struct glint_float_image *to);

/* The flare alone as codes on black, [height][width][3], exposed: what a frame
 * draws for codes is not what it draws in linear light. */
enum glint_status canvas_codes(struct glint_frame *frame,
                               const struct glint_lamp *lamp, int n_lamps,
                               double exposure, uint8_t *codes,
                               struct glint_frame_report *report);

/* The median of N values, which stay as they are; N is 1 to CANVAS_MAX. */
enum { CANVAS_MAX = 1000 };
double canvas_median(const double *values, int n);

#endif
