/* SPDX-License-Identifier: MIT */
#include "tile/primitive.h"

void glint_corners_gather(struct glint_corners *corners,
                          const struct glint_vertex *v, const int32_t *vertex,
                          int n)
{
    const struct glint_vertex *const *p = corners->at;

    corners->n = n;
    for (int i = 0; i < 4; i++)
        corners->at[i] = &v[vertex[i < n ? i : 0]];
    /* The cross product of the diagonals, or of two sides. */
    if (n == 4)
        corners->area2_q16 =
            (int64_t)(p[2]->x_q8 - p[0]->x_q8) * (p[3]->y_q8 - p[1]->y_q8) -
            (int64_t)(p[2]->y_q8 - p[0]->y_q8) * (p[3]->x_q8 - p[1]->x_q8);
    else
        corners->area2_q16 =
            glint_turn_q16(p[0]->x_q8, p[0]->y_q8, p[1]->x_q8, p[1]->y_q8,
                           p[2]->x_q8, p[2]->y_q8);
}

/* First pixel whose centre is at X or beyond. */
static int first_centre(int32_t x_q8)
{
    return (x_q8 + 127) >> 8;
}

static int clamp(int x, int max)
{
    return x < 0 ? 0 : x > max ? max : x;
}

struct glint_box glint_corners_box(const struct glint_corners *corners,
                                   int width, int height)
{
    int32_t x0 = corners->at[0]->x_q8, x1 = x0;
    int32_t y0 = corners->at[0]->y_q8, y1 = y0;

    for (int i = 1; i < corners->n; i++) {
        const int32_t x = corners->at[i]->x_q8, y = corners->at[i]->y_q8;

        x0 = x < x0 ? x : x0;
        x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0;
        y1 = y > y1 ? y : y1;
    }
    return (struct glint_box){clamp(first_centre(x0), width),
                              clamp(first_centre(y0), height),
                              clamp(first_centre(x1 + 1), width),
                              clamp(first_centre(y1 + 1), height)};
}
