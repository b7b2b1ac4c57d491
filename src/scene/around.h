/* SPDX-License-Identifier: MIT
 *
 * The camera's picture as the background of rays that mirrors reflect or glass
 * refracts.
 *
 * It is stored as means of cells of 2^n x 2^n pixels, at most 320 cells on the
 * longer side, and interpolated linearly between their centres.
 */
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
    /* transfer function of curve, if has_curve is set */
    enum glint_tone transfer;
    struct glint_light_curve *curve;
    uint16_t *light_q15; /* [n_y][n_x][3], display white = 32768 */
};

/* Allocates memory for pictures of WIDTH x HEIGHT, and starts without a
 * picture. */
void glint_around_carve(struct glint_around *around, struct glint_arena *arena,
                        int width, int height);

/* Stores a reduced copy of IMAGE, which must have the size given to
 * glint_around_carve(); NULL: no picture. */
void glint_around_look(struct glint_around *around,
                       const struct glint_image *image,
                       struct glint_workers *workers);

/* Sets RGB_Q15, 0 .. 65535, to the light at (X, Y), fractions 0 .. 1 of the
 * picture's width from the left and of its height from the top. */
void glint_around_at(const struct glint_around *around, int32_t x_q16,
                     int32_t y_q16, int32_t rgb_q15[3]);

#endif
