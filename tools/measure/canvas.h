/* SPDX-License-Identifier: MIT
 *
 * Support for glint bench and sweep: an image to draw on, the time to access
 * its memory, test lamps, and the reference image by exact rays.
 */
#ifndef GLINT_TOOLS_LAB_CANVAS_H
#define GLINT_TOOLS_LAB_CANVAS_H

#include "formats/pnm.h"
#include "model/opened_lens.h"

/* max number of rounds, and of values of which a median is computed */
enum { CANVAS_MAX = 1000 };

/* An image to draw on. mem: its pixels; fresh: a copy of the background, from
 * which they are restored. */
struct canvas {
    struct glint_image image; /* the image; its planes point into mem */
    uint8_t *fresh, *mem;
    size_t bytes;
    /* memory floor of each round, ms: the time to touch the pixels; set by
     * canvas_time_memory_floor() */
    double floor_ms[CANVAS_MAX];
};

/* Allocates an image of FORMAT and size with a dark background. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status canvas_init(struct canvas *canvas,
                              enum glint_pixel_format format, int width,
                              int height);

void canvas_restore_background(struct canvas *canvas);

void canvas_free(struct canvas *canvas);

/* Measures the memory floor of ROUND: the time of adding a small constant
 * layer, with saturation, to a restored canvas. */
void canvas_time_memory_floor(struct canvas *canvas, int round);

/* Sets LAMP[N]: the first lamp at ANGLE degrees off the axis, the others on a
 * spiral around the axis. Up to 64 lamps have power 1 / N each; of more lamps,
 * lamp k = 1 .. N has power 1 / k. */
void canvas_set_lamps(struct glint_lamp *lamp, int n, double angle);

/* Sets CFG to the configuration of an engine that draws the flare of given
 * lamps (glint_engine_draw_at()), without detection of lamps. The image has
 * WIDTH x HEIGHT pixels; ASKED: the settings. LENS must outlive the engine. */
void canvas_open_engine(const struct tool *tool, const struct opened_lens *lens,
                        const struct settings *asked, int width, int height,
                        struct glint_engine_config *cfg);

/* Sets EXPOSURE so that the 99.9th percentile of the flare's luminance is
 * white. Returns GLINT_E_MEMORY on failure. */
enum glint_status canvas_compute_exposure(struct glint_engine *engine,
                                          const struct glint_lamp *lamp,
                                          int n_lamps, double *exposure);

/* Draws the flare of LAMP by exact rays in double precision to TO, whose pixels
 * the caller allocates. GRID: cells per side of the grid of rays. Lens, stop
 * and wavelengths are those of SETTINGS; LENS must be a table. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status canvas_draw_exact(const struct tool *tool,
                                    const struct opened_lens *lens,
                                    const struct settings *s,
                                    const struct glint_lamp *lamp, int n_lamps,
                                    int grid, struct glint_float_image *to);

/* Draws the flare alone, on black, scaled by EXPOSURE, to the sRGB codes
 * CODES[height][width][3]. Uses the engine's plan for 8-bit codes, because it
 * is cheaper than the plan for linear light. */
enum glint_status canvas_draw_flare_codes(struct glint_engine *engine,
                                          const struct glint_lamp *lamp,
                                          int n_lamps, double exposure,
                                          uint8_t *codes,
                                          struct glint_engine_report *report);

/* Returns the processor's name, without commas, for tables; "unknown" if the
 * system does not report it. */
const char *canvas_describe_machine(void);

/* Returns the median of VALUES[N], N = 1 .. CANVAS_MAX. VALUES are not
 * reordered. */
double canvas_find_median(const double *values, int n);

#endif
