/* SPDX-License-Identifier: MIT */
#include "reference/cells/clip.h"

#include <stddef.h>

#include "base/compiler.h"
#include "base/q.h"

enum { FAR_Q8 = 1 << 30, MARGIN_Q8 = 192 };

static uint64_t magnitude(int64_t x)
{
    return x < 0 ? (uint64_t)-x : (uint64_t)x;
}

/* A number, mantissa * 2^exponent, with the mantissa below 2^28. */
struct scale {
    int64_t mantissa;
    int exponent;
};

/* Returns NUMERATOR / DENOMINATOR, both positive, to 27 bits. */
static struct scale scale_of(uint64_t numerator, uint64_t denominator)
{
    const int up = 62 - bit_length(numerator);
    const int down =
        bit_length(denominator) > 31 ? bit_length(denominator) - 31 : 0;
    uint64_t q = (numerator << up) / (denominator >> down);
    const int extra = bit_length(q) > 28 ? bit_length(q) - 28 : 0;

    q >>= extra;
    return (struct scale){(int64_t)q, extra - up - down};
}

/* Returns VALUE, within +-2^34, times SCALE, clamped far from any cut. */
static int32_t scaled(int64_t value, struct scale scale)
{
    const int64_t x = value * scale.mantissa;

    if (x == 0 || scale.exponent < -62)
        return 0;
    if (scale.exponent <= 0)
        return q_clamp_sat(q_shift(x, -scale.exponent), -FAR_Q8, FAR_Q8);
    if (bit_length(magnitude(x)) + scale.exponent > 30)
        return x < 0 ? -FAR_Q8 : FAR_Q8;
    return (int32_t)(x * (INT64_C(1) << scale.exponent));
}

/* Turns values of a linear function at the corners into distances in pixels:
 * divides them by the slope, which follows from the two diagonals (or sides).
 */
static void to_pixels(const struct glint_corners *c, const int64_t *value_q16,
                      int32_t *at_q8)
{
    const int last = c->n == 4;
    const int i0 = 0, i1 = last ? 2 : 1, j0 = last ? 1 : 0, j1 = last ? 3 : 2;
    const int64_t f = value_q16[i1] - value_q16[i0];
    const int64_t g = value_q16[j1] - value_q16[j0];
    const int64_t fx = c->at[i1]->x_q8 - c->at[i0]->x_q8;
    const int64_t fy = c->at[i1]->y_q8 - c->at[i0]->y_q8;
    const int64_t gx = c->at[j1]->x_q8 - c->at[j0]->x_q8;
    const int64_t gy = c->at[j1]->y_q8 - c->at[j0]->y_q8;
    /* |f|, |g| < 2^33 and |fx| ... < 2^29: sums below 2^63 */
    const uint64_t nx = magnitude(f * gy - g * fy);
    const uint64_t ny = magnitude(g * fx - f * gx);
    const int wide = bit_length(nx | ny);
    const int down = wide > 31 ? wide - 31 : 0;
    const uint64_t slope = (uint64_t)q_root((nx >> down) * (nx >> down) +
                                            (ny >> down) * (ny >> down));
    struct scale scale;

    /* The function is constant: all is inside or all is outside. */
    if (slope == 0) {
        for (int i = 0; i < 4; i++)
            at_q8[i] = value_q16[i] >= 0 ? FAR_Q8 : -FAR_Q8;
        return;
    }
    scale = scale_of((uint64_t)c->area2_q16, slope);
    scale.exponent -= down;
    for (int i = 0; i < 4; i++)
        at_q8[i] = scaled(value_q16[i], scale);
}

static void side_values(const struct glint_corners *c,
                        const struct glint_stop *stop, int side,
                        int64_t *value_q16)
{
    const int64_t nx = stop->normal_q30[side][0];
    const int64_t ny = stop->normal_q30[side][1];

    for (int i = 0; i < 4; i++)
        value_q16[i] =
            stop->apothem_q16 - (q_shift(nx * c->at[i]->stop_x_q16, 30) +
                                 q_shift(ny * c->at[i]->stop_y_q16, 30));
}

static void barrel_values(const struct glint_corners *c, int barrel,
                          int64_t *value_q16)
{
    for (int i = 0; i < 4; i++)
        value_q16[i] = (INT64_C(1) << 16) - c->at[i]->barrel_q16[barrel];
}

static int64_t lowest(const int64_t *v)
{
    int64_t low = v[0];

    for (int i = 1; i < 4; i++)
        low = v[i] < low ? v[i] : low;
    return low;
}

static int64_t highest(const int64_t *v)
{
    int64_t high = v[0];

    for (int i = 1; i < 4; i++)
        high = v[i] > high ? v[i] : high;
    return high;
}

enum side { OUTSIDE, CUT, INSIDE };

/* Returns MARGIN over the primitive's narrowest width, q8, from its area and
 * extent. A cut whose values stay farther from 0 than this many times their
 * span cannot reach it. */
static int64_t reach_q8(const struct glint_corners *c)
{
    int64_t x[4], y[4], extent_q8;

    for (int i = 0; i < 4; i++) {
        x[i] = c->at[i]->x_q8;
        y[i] = c->at[i]->y_q8;
    }
    extent_q8 = (highest(x) - lowest(x)) + (highest(y) - lowest(y));
    /* width >= area2 / (2 extent); all in q8 pixels */
    return 2 * MARGIN_Q8 * 256 * extent_q8 / c->area2_q16 + 1;
}

/* Returns on which side of a linear cut the primitive lies; CUT if the cut
 * comes within three quarters of a pixel, as pixels may straddle it. */
static enum side side_of(const struct glint_corners *c,
                         const int64_t *value_q16, int64_t reach)
{
    const int64_t low = lowest(value_q16), high = highest(value_q16);
    const int64_t near = low > 0 ? low : high < 0 ? -high : 0;
    int32_t at_q8[4];

    if (near == 0)
        return CUT;
    /* Values are below 2^34 in magnitude; REACH is below 2^29 or not used. */
    if (reach >= INT64_C(1) << 29 || near * 256 < (high - low) * reach) {
        to_pixels(c, value_q16, at_q8);
        for (int i = 0; i < 4; i++)
            if (at_q8[i] > -MARGIN_Q8 && at_q8[i] < MARGIN_Q8)
                return CUT;
    }
    return low > 0 ? INSIDE : OUTSIDE;
}

/* Returns pixels per stop radius, from the ratio of the areas on the screen and
 * in the stop. */
static int32_t field_scale_q16(const struct glint_corners *c)
{
    const int last = c->n == 4;
    const int i1 = last ? 2 : 1, j0 = last ? 1 : 0, j1 = last ? 3 : 2;
    const int64_t ax = (int64_t)c->at[i1]->stop_x_q16 - c->at[0]->stop_x_q16;
    const int64_t ay = (int64_t)c->at[i1]->stop_y_q16 - c->at[0]->stop_y_q16;
    const int64_t bx = (int64_t)c->at[j1]->stop_x_q16 - c->at[j0]->stop_x_q16;
    const int64_t by = (int64_t)c->at[j1]->stop_y_q16 - c->at[j0]->stop_y_q16;
    const int64_t limit = INT64_C(1) << 30; /* products below 2^61 */
    uint64_t area_q32, ratio_q16;
    int up;

    if (magnitude(ax) > (uint64_t)limit || magnitude(ay) > (uint64_t)limit ||
        magnitude(bx) > (uint64_t)limit || magnitude(by) > (uint64_t)limit)
        return 1;
    area_q32 = magnitude(ax * by - ay * bx);
    if (area_q32 == 0)
        return INT32_MAX;
    /* area2_q16 / area_q32 is a q-16: lift it to q32, pixels^2; the root is q16
     */
    up = 62 - bit_length((uint64_t)c->area2_q16);
    ratio_q16 = ((uint64_t)c->area2_q16 << up) / area_q32;
    up -= 48;
    if (up >= 0)
        ratio_q16 = up > 62 ? 0 : ratio_q16 >> up;
    else if (bit_length(ratio_q16) - up > 61)
        return INT32_MAX;
    else
        ratio_q16 <<= -up;
    return q_clamp_sat((int64_t)q_root(ratio_q16), 1, INT32_MAX);
}

int32_t glint_clip_field_q16(int32_t x_q16, int32_t y_q16)
{
    /* (1 - r^2) / 2, which is 1 - r near r = 1 */
    const int64_t x = x_q16 / 2, y = y_q16 / 2;

    return q_clamp_sat((INT64_C(1) << 15) - q_shift(x * x + y * y, 15), -FAR_Q8,
                       FAR_Q8);
}

/* The bounding box of the stop positions at the corners. */
struct extent {
    int64_t x0, x1, y0, y1;
};

static struct extent stop_extent(const struct glint_corners *c, int64_t grow)
{
    int64_t x[4], y[4];

    for (int i = 0; i < 4; i++) {
        x[i] = c->at[i]->stop_x_q16;
        y[i] = c->at[i]->stop_y_q16;
    }
    return (struct extent){lowest(x) - grow, highest(x) + grow,
                           lowest(y) - grow, highest(y) + grow};
}

/* Returns on which side of the unit disc the primitive lies. The disc is
 * convex: outside if it misses the box, inside if all corners are in it. */
static enum side circle_side(struct extent e, int64_t low, int64_t pixel_q16)
{
    const int64_t one = INT64_C(1) << 16;
    const int64_t x = e.x0 > 0 ? e.x0 : e.x1 < 0 ? -e.x1 : 0;
    const int64_t y = e.y0 > 0 ? e.y0 : e.y1 < 0 ? -e.y1 : 0;

    if (x > one || y > one || x * x + y * y > one * one)
        return OUTSIDE;
    return low > pixel_q16 ? INSIDE : CUT;
}

/* Returns on which side of a circle the primitive lies. */
static enum side field_side(const struct glint_corners *c)
{
    const int64_t pixel_q16 = ((INT64_C(1) << 32) / field_scale_q16(c)) + 1;
    const struct extent e = stop_extent(c, pixel_q16);
    int64_t value[4];

    for (int i = 0; i < 4; i++)
        value[i] =
            glint_clip_field_q16(c->at[i]->stop_x_q16, c->at[i]->stop_y_q16);
    return circle_side(e, lowest(value), pixel_q16);
}

static enum side stop_side(const struct glint_corners *c,
                           const struct glint_stop *stop, int64_t reach)
{
    enum side all = INSIDE;
    int64_t value[4];

    if (stop->n_blades == 0)
        return field_side(c);
    for (int side = 0; side < stop->n_blades; side++) {
        enum side s;

        side_values(c, stop, side, value);
        s = side_of(c, value, reach);
        all = s < all ? s : all;
        if (all == OUTSIDE)
            break;
    }
    return all;
}

int glint_clip_classify(const struct glint_corners *corners,
                        const struct glint_stop *stop)
{
    int64_t value[4];
    const int64_t reach = reach_q8(corners);
    enum side at_barrel = INSIDE, at_stop;

    for (int barrel = 0; barrel < 2; barrel++) {
        enum side s;

        barrel_values(corners, barrel, value);
        s = side_of(corners, value, reach);
        if (s == OUTSIDE)
            return -1;
        at_barrel = s < at_barrel ? s : at_barrel;
    }
    at_stop = stop_side(corners, stop, reach);
    if (at_stop == OUTSIDE)
        return -1;
    return (at_stop == CUT ? GLINT_CUT_STOP : 0) |
           (at_barrel == CUT ? GLINT_CUT_BARREL : 0);
}

static int64_t mean(const int64_t *v, int n)
{
    int64_t sum = 0;

    for (int i = 0; i < n; i++)
        sum += v[i];
    return sum / n;
}

int glint_clip_middle(const struct glint_corners *corners,
                      const struct glint_stop *stop)
{
    int64_t value[4], x[4], y[4];

    for (int barrel = 0; barrel < 2; barrel++) {
        barrel_values(corners, barrel, value);
        if (mean(value, corners->n) < 0)
            return 0;
    }
    for (int i = 0; i < 4; i++) {
        x[i] = corners->at[i]->stop_x_q16;
        y[i] = corners->at[i]->stop_y_q16;
    }
    if (stop->n_blades == 0)
        return glint_clip_field_q16(q_narrow(mean(x, corners->n)),
                                    q_narrow(mean(y, corners->n))) >= 0;
    for (int side = 0; side < stop->n_blades; side++) {
        side_values(corners, stop, side, value);
        if (mean(value, corners->n) < 0)
            return 0;
    }
    return 1;
}

static void add_linear(struct glint_clip *clip, const struct glint_corners *c,
                       const int64_t *value_q16, int64_t reach)
{
    if (side_of(c, value_q16, reach) != INSIDE)
        to_pixels(c, value_q16, clip->at_q8[clip->n++]);
}

void glint_clip_init(struct glint_clip *clip,
                     const struct glint_corners *corners,
                     const struct glint_stop *stop, int cut)
{
    const int64_t reach = reach_q8(corners);
    int64_t value[4];

    clip->n = 0;
    clip->field = 0;
    for (int barrel = 0; cut & GLINT_CUT_BARREL && barrel < 2; barrel++) {
        barrel_values(corners, barrel, value);
        add_linear(clip, corners, value, reach);
    }
    if (!(cut & GLINT_CUT_STOP))
        return;
    if (stop->n_blades == 0) {
        clip->field = 1;
        clip->field_q16 = field_scale_q16(corners);
        return;
    }
    for (int side = 0; side < stop->n_blades; side++) {
        side_values(corners, stop, side, value);
        add_linear(clip, corners, value, reach);
    }
}
