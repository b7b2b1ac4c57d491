/* SPDX-License-Identifier: MIT
 *
 * Draws starbursts into an image, with its own memory and workers.
 */
#ifndef GLINT_TESTS_STARS_CANVAS_H
#define GLINT_TESTS_STARS_CANVAS_H

#include <math.h>

#include "star/starburst.h"
#include "support/stars/bare_flare.h"

enum { STAR_CANVAS_LIGHTS = 16 }; /* max number of lights */

struct star_canvas {
    int width, height;
    struct bare_flare bare;
    struct glint_star *star;
    void *mem; /* memory of the starburst renderer */
};

/* Makes a canvas of WIDTH x HEIGHT pixels in tiles of 2^TILE_LOG2 pixels, with
 * N_WORKERS workers. ORDER: seed of the random order in which jobs run. Checks
 * that one byte of memory less is rejected. */
void star_canvas_open(struct star_canvas *canvas, int width, int height,
                      int tile_log2, int n_workers, uint32_t order);
void star_canvas_close(struct star_canvas *canvas);

/* Draws the starbursts of N lights onto a black image of FORMAT in MEM, leaving
 * out light below FAINTEST. Returns the reported number of lit pixels. */
int64_t star_canvas_draw_light(struct star_canvas *canvas,
                               const struct glint_star_tables *tables,
                               const struct glint_star_light *lights, int n,
                               struct glint_real faintest,
                               enum glint_pixel_format format, void *mem);

/* Returns the star tables of a stop. AIRY_PX: wavelength times f-number,
 * pixels. */
struct glint_star_tables *
star_canvas_make_tables(int n_blades, double rotation_deg, double airy_px);

/* Returns a white light at (X, Y), pixels. Its power, 2^POWER_LOG2, includes
 * the core of the light. */
struct glint_star_light star_canvas_make_light(double x, double y,
                                               double power_log2);

/* Returns the green light of LINEAR_Q20, an image of WIDTH pixels per row, at
 * (X, Y), interpolated between pixels. */
static inline double star_canvas_green(const int32_t *linear_q20, int width,
                                       double x, double y)
{
    const int i = (int)floor(x - 0.5), k = (int)floor(y - 0.5);
    const double a = x - 0.5 - i, b = y - 0.5 - k;
    const int32_t *p = linear_q20 + 3 * (k * width + i) + 1;
    const int32_t *below = p + 3 * width;

    return (1 - b) * ((1 - a) * p[0] + a * p[3]) +
           b * ((1 - a) * below[0] + a * below[3]);
}

#endif
