/* SPDX-License-Identifier: MIT
 *
 * The camera's picture as the background that mirrors reflect and glass
 * refracts.
 *
 * The picture is stored as the mean light of cells of 2^n x 2^n pixels, at most
 * 321 cells on the longer side. Lookups interpolate linearly between the
 * middles of cells. */
#ifndef GLINT_SCENE_AROUND_H
#define GLINT_SCENE_AROUND_H

#include "base/arena.h"
#include "glint/workers.h"
#include "image/light_sum.h"

struct glint_around {
    int width, height; /* size of the picture, pixels */
    int cell_log2, n_x, n_y;
    int has_picture;
    int has_curve;
    /* transfer function that the table CURVE decodes, if has_curve is set */
    enum glint_tone transfer;
    struct glint_light_curve *curve;
    uint16_t *light_q15; /* mean light of the cells, [n_y][n_x][3]; display
                            white is 32768 */
};

/* Allocates the cells for pictures of WIDTH x HEIGHT pixels from ARENA; no
 * picture is stored yet. */
void glint_background_allocate(struct glint_around *around,
                               struct glint_arena *arena, int width,
                               int height);

/* Stores the mean light of the cells of IMAGE, whose size must be that given to
 * glint_background_allocate(). IMAGE NULL removes the picture. */
void glint_background_store(struct glint_around *around,
                            const struct glint_image *image,
                            struct glint_workers *workers);

/* Sets RGB_Q15, 0 .. 65535, to the light of the stored picture at (X, Y):
 * fractions 0 .. 1 of its width from the left and of its height from the
 * top. */
void glint_background_sample(const struct glint_around *around, int32_t x_q16,
                             int32_t y_q16, int32_t rgb_q15[3]);

#endif
