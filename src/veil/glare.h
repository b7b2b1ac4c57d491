/* SPDX-License-Identifier: MIT
 *
 * Veiling glare: a fraction of all light, scattered over the whole picture, in
 * integers.
 *
 *     bytes = glint_veil_bytes(&cfg);                         once
 *     glint_veil_init(&veil, &cfg, mem, bytes);
 *     glint_veil_read_picture(veil, &image, white, workers);          each
 * frame glint_veil_add_lamp(veil, x_q8, y_q8, power, rgb_q14);      light above
 * white glint_veil_spread_light(veil, spreads, n); glint_veil_draw(veil, NULL,
 * flare, &image);   instead of glint_flare_draw()
 *
 * Lens, barrel and camera scatter light far away from its image point. ISO 9358
 * measures the veiling glare index V: the fraction of white light in the image
 * of a small black spot on a wide white background. If the fraction V of all
 * light is scattered, a scene P becomes (1 - V) P + V K P, where K is a kernel
 * with integral 1. With the exposure corrected such that the direct image stays
 * unchanged, the veil adds
 *
 *     V / (1 - V) K P
 *
 * So no pixel gets darker, clipped lamps stay clipped, and the veil has the
 * fraction V of all light. P is the mean light of some 64 x 36 cells of the
 * picture, plus the light of lamps above white. K is a sum of Gaussians,
 * mirrored at the picture's borders, so that no light is lost. Quadratic
 * splines interpolate the light of the cells without visible steps. Light
 * scattered by dirt on the front element has cells of its own; these are
 * multiplied by a table of the covered fraction of the front element for each
 * pixel. [Talvala, Adams, Horowitz, Levoy, Veiling glare in high dynamic range
 * imaging, ACM TOG 26(3), 2007; McCann, Rizzi, Camera and visual veiling glare
 * in HDR images, J. SID 15(9), 2007]
 */
#ifndef GLINT_VEIL_GLARE_H
#define GLINT_VEIL_GLARE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/light.h"
#include "glint/status.h"
#include "glint/workers.h"
#include "tile/pass.h"

enum {
    GLINT_VEIL_CELLS = 64,  /* max cells along the picture's longer side */
    GLINT_VEIL_SPREADS = 8, /* max number of Gaussians */
    GLINT_VEIL_LEAST_PX = 4 /* min side of a cell, pixels */
};

/* A Gaussian over cells, separable in x and y. */
struct glint_veil_spread {
    /* [D]: the fraction of a cell's light that D cells away receive, D = 0
     * .. n, in a row of n cells that mirroring continues with period 2 n.
     * [0] + [n] + 2 times the other entries is 2^30. */
    int32_t across_q30[GLINT_VEIL_CELLS + 1], down_q30[GLINT_VEIL_CELLS + 1];
    /* fraction of all light that is scattered, above 0 */
    struct glint_real share;
};

struct glint_veil_config {
    int n_workers; /* max number of workers of the flares that it is drawn with,
                      1 .. 64 */
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int has_front; /* 1: reserve memory for light that dirt on the front element
                      scatters */
};

/* Distance between nodes of the cover table, pixels; and number of nodes
 * along a side of the picture. */
enum { GLINT_VEIL_FRONT_PX = 4 };
#define GLINT_VEIL_FRONT_NODES(side) \
    (((side) + GLINT_VEIL_FRONT_PX - 1) / GLINT_VEIL_FRONT_PX + 1)

struct glint_veil_row;
struct glint_pass_rows;
typedef void glint_veil_front_fn(const struct glint_veil_row *row,
                                 const struct glint_pass_rows *rows, int k);
glint_veil_front_fn glint_veil_add_front_row;

/* The fraction of the front element that dirt covers, as each pixel sees it.
 * A program links the drawing code only if it refers to
 * glint_veil_add_front_row. */
struct glint_veil_front {
    glint_veil_front_fn *row; /* glint_veil_add_front_row() */
    int n_x, n_y;             /* GLINT_VEIL_FRONT_NODES() of width and height */
    /* [n_y][n_x]: cover / max cover, at the top left corner of every fourth
     * pixel. Must stay valid while the veil is drawn. */
    const uint16_t *part_q16;
};

struct glint_veil; /* opaque, in the caller's memory */
struct glint_flare;

/* Sets CELLS to the numbers of cells across and down of pictures of WIDTH x
 * HEIGHT pixels. */
void glint_veil_count_cells(int width, int height, int cells[2]);

/* Returns the exact number of bytes that glint_veil_init() needs for CFG, or 0
 * if CFG is out of range. */
size_t glint_veil_bytes(const struct glint_veil_config *cfg);

/* Places a veil in MEM[BYTES], which must be aligned to 64 bytes. A veil needs
 * no cleanup. Returns GLINT_E_MEMORY if BYTES is too small. */
enum glint_status glint_veil_init(struct glint_veil **veil,
                                  const struct glint_veil_config *cfg,
                                  void *mem, size_t bytes);

/* Sums the light of IMAGE, whose white is WHITE, in cells. Removes all lamps
 * added before. If IMAGE is NULL, the picture is black. WORKERS may be NULL. */
void glint_veil_read_picture(struct glint_veil *veil,
                             const struct glint_image *image,
                             struct glint_real white,
                             struct glint_workers *workers);

/* Adds a lamp of POWER, white times pixels, and colour RGB, 0 .. 2^14, at
 * (X, Y) pixels from the top left corner. Skips lamps outside the picture. */
void glint_veil_add_lamp(struct glint_veil *veil, int32_t x_q8, int32_t y_q8,
                         struct glint_real power, const int32_t rgb_q14[3]);

/* Computes the veil from N Gaussians, 0 .. GLINT_VEIL_SPREADS. */
void glint_veil_spread_light(struct glint_veil *veil,
                             const struct glint_veil_spread *spreads, int n);

/* Computes the light that dirt on the front element scatters, from N
 * Gaussians whose shares are those at the max cover. FRONT must stay valid
 * while the veil is drawn; NULL, the initial state: the front element
 * scatters nothing. Requires has_front in the configuration. */
void glint_veil_front(struct glint_veil *veil,
                      const struct glint_veil_front *front,
                      const struct glint_veil_spread *spreads, int n);

/* Draws the veil, then the pass OVER unless it is NULL, then the binned
 * ghosts of FLARE. If the flare is drawn at half resolution, veil and OVER
 * are still drawn to all pixels. */
void glint_veil_draw(struct glint_veil *veil, const struct glint_pass *over,
                     struct glint_flare *flare,
                     const struct glint_image *image);

/* Draws the veil without the binned ghosts of FLARE. */
void glint_veil_draw_alone(struct glint_veil *veil, struct glint_flare *flare,
                           const struct glint_image *image);

#endif
