/* SPDX-License-Identifier: MIT
 *
 * Sums the linear light of pixels, for pictures of any format.
 *
 *     glint_light_curve_init(&curve, image->transfer);
 *     glint_light_sum_init(&sum, image, &curve);
 *     glint_light_sum_read_pixels(&sum, &codes, x, y, n_x, n_y); some rows
 *     glint_light_sum_add_row(&sum, &codes, 0, from, to, rgb_q20); */
#ifndef GLINT_IMAGE_LIGHT_SUM_H
#define GLINT_IMAGE_LIGHT_SUM_H

#include "image/codes.h"
#include "image/curve.h"

/* Range of codes of a table. R', G', B' before clamping are -293 .. 551. */
enum { GLINT_LIGHT_BELOW = 296, GLINT_LIGHT_CODES = GLINT_LIGHT_BELOW + 560 };

/* A table from codes to linear light, also for codes outside 0 .. 255. Entry I
 * is for code I - GLINT_LIGHT_BELOW, clamped to 0 .. 255. It holds the light of
 * that code and the difference to the light of the next code. */
struct glint_light_curve {
    struct glint_curve curve;
    struct glint_light_code {
        int32_t light_q20, rise_q20;
    } code[GLINT_LIGHT_CODES];
};

struct glint_light_sum {
    const struct glint_image *image;
    const struct glint_layout *layout;
    const struct glint_light_curve *curve; /* curve of the image's transfer */
    struct glint_ycc ycc;
    int x, y; /* position in the image of the first of the pixels that were read
                 last */
};

void glint_light_curve_init(struct glint_light_curve *curve,
                            enum glint_tone transfer);

void glint_light_sum_init(struct glint_light_sum *sum,
                          const struct glint_image *image,
                          const struct glint_light_curve *curve);

/* Reads pixels X .. X + N_X - 1 of rows Y .. Y + N_Y - 1. X must be even; if
 * N_Y is 2, Y must be even, too. Linear pictures and pictures with separate R,
 * G, B samples are not copied to CODES; glint_light_sum_add_row() reads them
 * directly. */
void glint_light_sum_read_pixels(struct glint_light_sum *sum,
                                 struct glint_codes *codes, int x, int y,
                                 int n_x, int n_y);

/* Adds the light of pixels FROM .. TO - 1, in row ROW (0 or 1) of the rows that
 * were read last, to RGB_Q20. FROM and TO are columns of the image. Negative
 * light counts as 0. */
void glint_light_sum_add_row(const struct glint_light_sum *sum,
                             const struct glint_codes *codes, int row, int from,
                             int to, int64_t rgb_q20[3]);

#endif
