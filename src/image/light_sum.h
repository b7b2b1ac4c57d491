/* SPDX-License-Identifier: MIT
 *
 * Sums of the linear light of pixels, of pictures of every format.
 *
 *     glint_light_curve_init(&curve, image->transfer);
 *     glint_light_sum_init(&sum, image, &curve);
 *     glint_light_sum_read(&sum, &codes, x, y, n_x, n_y);   a stretch of rows
 *     glint_light_sum_add(&sum, &codes, 0, from, to, rgb_q20);
 */
#ifndef GLINT_IMAGE_LIGHT_SUM_H
#define GLINT_IMAGE_LIGHT_SUM_H

#include "image/codes.h"
#include "image/curve.h"

/* Codes that Y, Cb and Cr give, -296 .. 559, see ycc_to_rgb(). */
enum { GLINT_LIGHT_BELOW = 296, GLINT_LIGHT_CODES = GLINT_LIGHT_BELOW + 560 };

/* A curve, and the same for codes that are not clamped: light of code I -
 * BELOW, and how much that rises to the next code. */
struct glint_light_curve {
    struct glint_curve curve;
    struct glint_light_code {
        int32_t light_q20, rise_q20;
    } code[GLINT_LIGHT_CODES];
};

struct glint_light_sum {
    const struct glint_image *image;
    const struct glint_layout *layout;
    const struct glint_light_curve *curve; /* of the image's transfer */
    struct glint_ycc ycc;
    int x, y; /* where the stretch begins that was read last */
};

void glint_light_curve_init(struct glint_light_curve *curve,
                            enum glint_tone transfer);

void glint_light_sum_init(struct glint_light_sum *sum,
                          const struct glint_image *image,
                          const struct glint_light_curve *curve);

/* Reads pixels X .. X + N_X - 1 of rows Y .. Y + N_Y - 1, as glint_codes_read()
 * does, and at most as many; linear pictures and those of whole R, G, B are not
 * copied to CODES but read as they are added. */
void glint_light_sum_read(struct glint_light_sum *sum,
                          struct glint_codes *codes, int x, int y, int n_x,
                          int n_y);

/* Adds to RGB_Q20 the light of pixels FROM .. TO - 1 of row ROW, 0 or 1, of
 * what was read, counted from the picture's left. Negative light counts as 0.
 */
void glint_light_sum_add(const struct glint_light_sum *sum,
                         const struct glint_codes *codes, int row, int from,
                         int to, int64_t rgb_q20[3]);

#endif
