/* SPDX-License-Identifier: MIT */
#include "reference/cells/raster.h"

#include "base/compiler.h"
#include "base/q.h"

enum { HALF_Q8 = 128 };

/* The edges of a primitive: edge I runs from corner I to corner I + 1. A
 * triangle has a fourth edge that everything is inside. */
struct edges {
    int n;
    int64_t at[4];        /* value at the pixel, >= 0 inside */
    int64_t row[4];       /* value at the first pixel of the row */
    int64_t dx[4], dy[4]; /* change to the next pixel, next row */
    int bias[4];     /* -1 where a pixel on the edge belongs to the neighbour */
    int shift;       /* bits to drop so that 24 are left of a value */
    uint64_t fan[4]; /* Wachspress: area at each corner, 12 bits; else 1 */
};

static void edges_init(struct edges *e, const struct glint_corners *c,
                       enum cells_weights weights, int px, int py)
{
    const int wide = bit_length((uint64_t)c->area2_q16);
    const int32_t x_q8 = px * 256 + HALF_Q8, y_q8 = py * 256 + HALF_Q8;

    *e = (struct edges){.n = c->n};
    e->shift = wide > 24 ? wide - 24 : 0;
    for (int i = 0; i < c->n; i++) {
        const struct glint_vertex *a = c->at[i];
        const struct glint_vertex *b = c->at[i + 1 < c->n ? i + 1 : 0];
        const struct glint_vertex *before = c->at[i > 0 ? i - 1 : c->n - 1];
        const int32_t ex = b->x_q8 - a->x_q8, ey = b->y_q8 - a->y_q8;

        e->row[i] =
            glint_turn_q16(a->x_q8, a->y_q8, b->x_q8, b->y_q8, x_q8, y_q8);
        e->dx[i] = -(int64_t)ey * 256;
        e->dy[i] = (int64_t)ex * 256;
        e->bias[i] = ey < 0 || (ey == 0 && ex > 0) ? 0 : -1;
        e->fan[i] = 1;
        if (c->n == 4 && weights == CELLS_WACHSPRESS)
            e->fan[i] =
                (uint64_t)((glint_turn_q16(before->x_q8, before->y_q8, a->x_q8,
                                           a->y_q8, b->x_q8, b->y_q8) >>
                            (wide > 12 ? wide - 12 : 0)) +
                           1);
    }
}

static int inside(const struct edges *e)
{
    int64_t outside = 0; /* negative if any edge has the pixel outside */

    for (int i = 0; i < 4; i++)
        outside |= e->at[i] + e->bias[i];
    return outside >= 0;
}

/* Sets W to the unnormalised weights of the corners and returns their sum. Each
 * factor is below 2^24 (2^12 for the fans), products below 2^60, sums below
 * 2^62. */
static uint64_t raw_weights(const struct edges *e, uint64_t *w)
{
    uint64_t a[4];

    for (int i = 0; i < 4; i++)
        a[i] = (uint64_t)(e->at[i] >> e->shift);
    if (e->n == 3) {
        w[0] = a[1], w[1] = a[2], w[2] = a[0], w[3] = 0;
    } else {
        w[0] = a[1] * a[2] * e->fan[0];
        w[1] = a[2] * a[3] * e->fan[1];
        w[2] = a[3] * a[0] * e->fan[2];
        w[3] = a[0] * a[1] * e->fan[3];
    }
    return w[0] + w[1] + w[2] + w[3];
}

/* Sets the barycentric weights of the corners, q16. */
static void corner_weights(const struct edges *e, int32_t *weight_q16)
{
    uint64_t w[4], scale, sum = raw_weights(e, w);
    int wide, drop;

    if (sum == 0) /* a sliver of a few units: any corner will do */
        w[0] = sum = 1;
    wide = bit_length(sum);
    drop = wide > 31 ? wide - 31 : 0;
    wide -= drop;
    scale = (UINT64_C(1) << (wide + 31)) / (sum >> drop); /* 2^31 .. 2^32 */
    for (int i = 0; i < 4; i++)
        weight_q16[i] =
            (int32_t)(((w[i] >> drop) * scale + (UINT64_C(1) << (wide + 14))) >>
                      (wide + 15));
}

/* Returns the fraction, q16, that the clips leave of a pixel, or of one of its
 * PLACES parts across. Distances in pixels become cover over half a pixel on
 * either side of the cut, or without antialiasing at once. */
static int32_t cover_of(const struct glint_cell_raster *r,
                        const struct glint_clip *clip,
                        const struct glint_corners *c, const int32_t *w_q16,
                        int places)
{
    int64_t cover_q16 = 1 << 16;

    for (int k = 0; k < clip->n + clip->field; k++) {
        int64_t d_q8 = 0;

        if (k < clip->n) {
            for (int i = 0; i < 4; i++)
                d_q8 += (int64_t)w_q16[i] * clip->at_q8[k][i];
            d_q8 = q_shift(d_q8, 16);
        } else {
            int64_t x = 0, y = 0;

            for (int i = 0; i < 4; i++) {
                x += (int64_t)w_q16[i] * c->at[i]->stop_x_q16;
                y += (int64_t)w_q16[i] * c->at[i]->stop_y_q16;
            }
            d_q8 = glint_clip_field_q16(q_narrow(q_shift(x, 16)),
                                        q_narrow(q_shift(y, 16)));
            d_q8 = q_shift(d_q8 * clip->field_q16, 24);
        }
        d_q8 *= places;
        if (!r->antialias)
            d_q8 = d_q8 >= 0 ? HALF_Q8 : -HALF_Q8;
        cover_q16 = q_shift(cover_q16 * q_clamp_sat(d_q8 + HALF_Q8, 0, 256), 8);
        if (cover_q16 == 0)
            break;
    }
    return (int32_t)cover_q16;
}

static int32_t energy_of(const struct glint_corners *c, const int32_t *w_q16)
{
    int64_t sum = 0;

    for (int i = 0; i < 4; i++)
        sum += (int64_t)w_q16[i] * c->at[i]->energy_q16;
    return (int32_t)q_shift(sum, 16);
}

/* Adds light times colour at one pixel to its three sums. */
static void add_pixel(int64_t *acc_q20, const int32_t *rgb_q14,
                      int64_t light_q20)
{
    for (int c = 0; c < 3; c++)
        acc_q20[c] += q_shift(light_q20 * rgb_q14[c], 14);
}

static void next_row(struct edges *e)
{
    for (int i = 0; i < 4; i++)
        e->row[i] += e->dy[i];
}

/* Adds all the light of a point to its one pixel. */
static void add_point(const struct glint_cell_raster *raster,
                      const struct glint_primitive *p,
                      const struct glint_corners *c, int64_t *acc_q20)
{
    int64_t energy_q16 = 0;

    for (int i = 0; i < c->n; i++)
        energy_q16 += c->at[i]->energy_q16;
    energy_q16 /= c->n;
    add_pixel(acc_q20, raster->bundle->rgb_q14,
              q_shift(p->irradiance_q20 * energy_q16, 16));
}

/* Returns the light that the primitive adds at the pixel where E stands. */
static int64_t light_at(const struct glint_cell_raster *raster,
                        const struct glint_primitive *p,
                        const struct glint_corners *c,
                        const struct glint_clip *clip, const struct edges *e)
{
    int32_t w_q16[4];
    int64_t light_q20;

    if (!inside(e))
        return 0;
    corner_weights(e, w_q16);
    light_q20 = q_shift((int64_t)p->irradiance_q20 * energy_of(c, w_q16), 16);
    if (p->flags & (GLINT_CUT_STOP | GLINT_CUT_BARREL))
        light_q20 =
            q_shift(light_q20 * cover_of(raster, clip, c, w_q16,
                                         p->flags & GLINT_SAMPLED ? 4 : 1),
                    16);
    return light_q20;
}

/* Returns the mean light over 4 x 4 places of the pixel. */
static int64_t sampled_light(const struct glint_cell_raster *raster,
                             const struct glint_primitive *p,
                             const struct glint_corners *c,
                             const struct glint_clip *clip,
                             const struct edges *e)
{
    struct edges here = *e;
    int64_t sum_q20 = 0;

    for (int k = 0; k < 16; k++) {
        /* Eighths of a pixel from its centre. */
        const int x = 2 * (k & 3) - 3, y = 2 * (k >> 2) - 3;

        for (int i = 0; i < 4; i++)
            here.at[i] = e->at[i] + (e->dx[i] * x + e->dy[i] * y) / 8;
        sum_q20 += light_at(raster, p, c, clip, &here);
    }
    return q_shift(sum_q20, 4);
}

void glint_cell_raster_primitive(const struct glint_cell_raster *raster,
                                 const struct glint_primitive *p)
{
    struct glint_corners c;
    struct glint_clip clip;
    struct glint_box box;
    struct edges e;

    glint_corners_gather(&c, raster->vertex, p->vertex,
                         glint_primitive_corners(p));
    box = glint_primitive_box(p, &c, raster->width, raster->height);
    if (glint_box_empty(box))
        return;
    if (p->flags & GLINT_POINT) {
        add_point(raster, p, &c,
                  raster->acc_q20 + 3 * (box.y0 * raster->width + box.x0));
        return;
    }
    glint_clip_init(&clip, &c, raster->stop, p->flags);
    edges_init(&e, &c, raster->weights, box.x0, box.y0);
    for (int y = box.y0; y < box.y1; y++, next_row(&e)) {
        int64_t *acc = raster->acc_q20 + 3 * (y * raster->width + box.x0);

        for (int i = 0; i < 4; i++)
            e.at[i] = e.row[i];
        for (int x = box.x0; x < box.x1; x++, acc += 3) {
            const int64_t light_q20 =
                p->flags & GLINT_SAMPLED
                    ? sampled_light(raster, p, &c, &clip, &e)
                    : light_at(raster, p, &c, &clip, &e);

            if (light_q20)
                add_pixel(acc, raster->bundle->rgb_q14, light_q20);
            for (int i = 0; i < 4; i++)
                e.at[i] += e.dx[i];
        }
    }
}
