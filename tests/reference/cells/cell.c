/* SPDX-License-Identifier: MIT */
#include "reference/cells/cell.h"

void glint_corners_gather(struct glint_corners *corners,
                          const struct glint_vertex *v, const int32_t *vertex,
                          int n)
{
    const struct glint_vertex *at[4] = {v, v, v, v};

    for (int i = 0; i < n; i++)
        at[i] = &v[vertex[i]];
    glint_corners_set(corners, at, n);
}

/* Returns the first pixel whose centre is at X or beyond. */
static int first_centre(int32_t x_q8)
{
    return (x_q8 + 127) >> 8;
}

static int clamp(int x, int max)
{
    return x < 0 ? 0 : x > max ? max : x;
}

/* Returns the bounding box of the corners, pixels _q8. */
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

static struct glint_box corners_box(const struct glint_corners *corners,
                                    int width, int height)
{
    const struct glint_box e = extent_q8(corners);

    return (struct glint_box){clamp(first_centre(e.x0), width),
                              clamp(first_centre(e.y0), height),
                              clamp(first_centre(e.x1 + 1), width),
                              clamp(first_centre(e.y1 + 1), height)};
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
    if (p->flags & GLINT_SAMPLED)
        return glint_corners_reach(corners, width, height);
    return p->flags & GLINT_POINT ? glint_corners_pixel(corners, width, height)
                                  : corners_box(corners, width, height);
}
