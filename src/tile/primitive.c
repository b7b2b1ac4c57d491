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
        corners->area2_q16 = glint_turn_q16(p[0]->x_q8, p[0]->y_q8, p[1]->x_q8,
                                            p[1]->y_q8, p[2]->x_q8, p[2]->y_q8);
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

/* The box of the corners, q8. */
static struct glint_box extent_q8(const struct glint_corners *corners)
{
    struct glint_box b = {corners->at[0]->x_q8, corners->at[0]->y_q8,
                          corners->at[0]->x_q8, corners->at[0]->y_q8};

    for (int i = 1; i < corners->n; i++) {
        const int32_t x = corners->at[i]->x_q8, y = corners->at[i]->y_q8;

        b.x0 = x < b.x0 ? x : b.x0;
        b.x1 = x > b.x1 ? x : b.x1;
        b.y0 = y < b.y0 ? y : b.y0;
        b.y1 = y > b.y1 ? y : b.y1;
    }
    return b;
}

struct glint_box glint_corners_box(const struct glint_corners *corners,
                                   int width, int height)
{
    const struct glint_box e = extent_q8(corners);

    return (struct glint_box){clamp(first_centre(e.x0), width),
                              clamp(first_centre(e.y0), height),
                              clamp(first_centre(e.x1 + 1), width),
                              clamp(first_centre(e.y1 + 1), height)};
}

int glint_corners_tiny(const struct glint_corners *corners)
{
    const struct glint_box e = extent_q8(corners);

    return e.x1 - e.x0 <= 128 && e.y1 - e.y0 <= 128;
}

struct glint_box glint_corners_pixel(const struct glint_corners *corners,
                                     int width, int height)
{
    int64_t x_q8 = 0, y_q8 = 0;
    int x, y;

    for (int i = 0; i < corners->n; i++) {
        x_q8 += corners->at[i]->x_q8;
        y_q8 += corners->at[i]->y_q8;
    }
    if (x_q8 < 0 || y_q8 < 0)
        return (struct glint_box){0, 0, 0, 0};
    x = (int)(x_q8 / corners->n) >> 8;
    y = (int)(y_q8 / corners->n) >> 8;
    if (x >= width || y >= height)
        return (struct glint_box){0, 0, 0, 0};
    return (struct glint_box){x, y, x + 1, y + 1};
}

struct glint_box glint_primitive_box(const struct glint_primitive *p,
                                     const struct glint_corners *corners,
                                     int width, int height)
{
    return p->flags & GLINT_POINT ? glint_corners_pixel(corners, width, height)
                                  : glint_corners_box(corners, width, height);
}
