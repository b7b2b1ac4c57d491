/* SPDX-License-Identifier: MIT
 *
 * Veiling glare (the veil): a fraction of all light, scattered over the whole
 * picture. Run-time half, integers only.
 *
 *     bytes = glint_veil_count_bytes(&cfg);                         once
 *     glint_veil_init(&veil, &cfg, mem, bytes);
 *     glint_veil_read_picture(veil, &image, white, workers);  each frame
 *     glint_veil_add_lamp(veil, x_q8, y_q8, power, rgb_q14);  light above white
 *     glint_veil_spread_light(veil, spreads, n);
 *     glint_veil_draw(veil, NULL, flare, &image);  not glint_flare_draw()
 *
 * Lens, barrel and camera body scatter light far away from its image point. ISO
 * 9358 measures the veiling glare index V: the fraction of white light in the
 * image of a small black spot on a wide white background. If the fraction V of
 * all light is scattered, a scene P becomes (1 - V) P + V K P, where K is a
 * convolution with a kernel of integral 1. The exposure is corrected so that
 * the direct image stays unchanged. The veil then adds
 *
 *     V / (1 - V) K P
 *
 * So no pixel gets darker, clipped lamps stay clipped, and the veil contains
 * the fraction V of all light. P is the mean light of some 64 x 36 cells of the
 * picture, plus the light of lamps above white. K is a sum of Gaussians,
 * mirrored at the picture's borders, so that no light is lost. Quadratic
 * splines interpolate the light of the cells without visible steps. Light
 * scattered by dirt on the front element has cells of its own. They are
 * multiplied by the fraction of the front element that dirt covers, from a
 * table over the pixels. [Talvala, Adams, Horowitz, Levoy, Veiling glare in
 * high dynamic range imaging, ACM TOG 26(3), 2007; McCann, Rizzi, Camera and
 * visual veiling glare in HDR images, J. SID 15(9), 2007] */
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
    GLINT_VEIL_CELLS = 64,  /* max number of cells along the picture's longer
                               side */
    GLINT_VEIL_SPREADS = 8, /* max number of Gaussian kernels */
    GLINT_VEIL_LEAST_PX = 4 /* min side of a cell, pixels */
};

/* A Gaussian kernel by which the light of cells is scattered, separable in x
 * and y. */
struct glint_veil_spread {
    /* Kernel for a row of n cells, which is continued by mirroring with period
     * 2 n. Entry D, D = 0 .. n, is the fraction of its light that a cell
     * scatters to a cell at a distance of D cells. Entry 0 plus entry n plus
     * twice all others is 2^30. */
    int32_t across_q30[GLINT_VEIL_CELLS + 1], down_q30[GLINT_VEIL_CELLS + 1];
    /* fraction of all light that this kernel scatters, above 0 */
    struct glint_real share;
};

struct glint_veil_config {
    int n_workers; /* max number of workers of the flare with which the veil is
                      drawn, 1 .. 64 */
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int has_front; /* 1: reserve memory for light that dirt on the front element
                      scatters */
};

/* Distance in pixels between the nodes of the cover table of the front element.
 * GLINT_VEIL_FRONT_NODES(side) is the number of nodes along SIDE pixels. */
enum { GLINT_VEIL_FRONT_PX = 4 };
#define GLINT_VEIL_FRONT_NODES(side) \
    (((side) + GLINT_VEIL_FRONT_PX - 1) / GLINT_VEIL_FRONT_PX + 1)

struct glint_veil_row;
struct glint_pass_rows;
typedef void glint_veil_front_fn(const struct glint_veil_row *row,
                                 const struct glint_pass_rows *rows, int k);
glint_veil_front_fn glint_veil_add_front_row;

/* Cover table of the front element: for each pixel, the fraction of its beam of
 * light that dirt covers. A program links the drawing code only if it refers to
 * glint_veil_add_front_row. */
struct glint_veil_front {
    glint_veil_front_fn *row; /* draws: glint_veil_add_front_row() */
    int n_x, n_y;             /* GLINT_VEIL_FRONT_NODES() of width and height */
    /* Cover / max cover, [n_y][n_x], at the top left corner of every fourth
     * pixel in every fourth row. Must stay valid while the veil is drawn. */
    const uint16_t *part_q16;
};

struct glint_veil; /* opaque, in the caller's memory */
struct glint_flare;

/* Sets CELLS to the number of cells across and down that a picture of WIDTH x
 * HEIGHT pixels has. */
void glint_veil_count_cells(int width, int height, int cells[2]);

/* Returns the exact number of bytes that glint_veil_init() needs for CFG, or 0
 * if CFG is out of range. */
size_t glint_veil_count_bytes(const struct glint_veil_config *cfg);

/* Initialises a veil in MEM[BYTES], which must be aligned to 64 bytes; nothing
 * has to be freed. Returns GLINT_E_MEMORY if BYTES is too small,
 * GLINT_E_ARGUMENT if CFG is out of range. */
enum glint_status glint_veil_init(struct glint_veil **veil,
                                  const struct glint_veil_config *cfg,
                                  void *mem, size_t bytes);

/* Sets the light of each cell to the sum over its pixels of IMAGE. WHITE is the
 * linear light of the white of IMAGE. Removes the lamps of earlier frames.
 * IMAGE may be NULL for a black picture, WORKERS NULL for a single thread. */
void glint_veil_read_picture(struct glint_veil *veil,
                             const struct glint_image *image,
                             struct glint_real white,
                             struct glint_workers *workers);

/* Adds a lamp to the light of the cells. POWER: light above white, in white
 * times pixels; RGB: colour, 0 .. 2^14; (X, Y): position in pixels from the top
 * left corner. Skips lamps outside the picture. */
void glint_veil_add_lamp(struct glint_veil *veil, int32_t x_q8, int32_t y_q8,
                         struct glint_real power, const int32_t rgb_q14[3]);

/* Computes the veil: convolves the light of the cells with the sum of N
 * Gaussians, 0 .. GLINT_VEIL_SPREADS. */
void glint_veil_spread_light(struct glint_veil *veil,
                             const struct glint_veil_spread *spreads, int n);

/* Computes the light that dirt on the front element scatters, by convolving the
 * light of the cells with N Gaussians. Their shares are the scattered fractions
 * of light where dirt covers the beam of a pixel most. FRONT must stay valid
 * while the veil is drawn; NULL, the initial state: no dirt. Requires has_front
 * in the configuration. */
void glint_veil_front(struct glint_veil *veil,
                      const struct glint_veil_front *front,
                      const struct glint_veil_spread *spreads, int n);

/* Draws the veil, then the pass OVER unless it is NULL, then the binned ghosts
 * of FLARE. Veil and OVER have full resolution even if the flare is drawn at
 * half resolution. */
void glint_veil_draw(struct glint_veil *veil, const struct glint_pass *over,
                     struct glint_flare *flare,
                     const struct glint_image *image);

/* Draws the veil onto IMAGE, with the workers and tiles of FLARE but without
 * its ghosts. */
void glint_veil_draw_alone(struct glint_veil *veil, struct glint_flare *flare,
                           const struct glint_image *image);

#endif
