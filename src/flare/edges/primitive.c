/* SPDX-License-Identifier: MIT */
#include "flare/edges/primitive.h"

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"

static int clamp_to_max(int x, int max)
{
    return x < 0 ? 0 : x > max ? max : x;
}

/* Returns the bounding box of CORNERS, in pixels with 8 fraction bits. */
static struct glint_box
compute_bounding_box_q8(const struct glint_corners *corners)
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

int glint_corners_fit_into_pixel_part(const struct glint_corners *corners,
                                      int part)
{
    const struct glint_box e = compute_bounding_box_q8(corners);
    const int64_t x = e.x1 - e.x0, y = e.y1 - e.y0;

    return (x > y ? x : y) * part <= 1 << GLINT_VERTEX_FRAC;
}

int glint_corners_test_thinness(const struct glint_corners *corners)
{
    const struct glint_box e = compute_bounding_box_q8(corners);
    const int64_t x = e.x1 - e.x0, y = e.y1 - e.y0;
    const int64_t area2 =
        corners->area2_q16 < 0 ? -corners->area2_q16 : corners->area2_q16;

    return area2 < 2 * (1 << GLINT_VERTEX_FRAC) / 16 * (x > y ? x : y) ||
           area2 == 0;
}

/* The box is enlarged by half the width of the strip that replaces a thin
 * primitive, and by 1/256 pixel for rounding. */
struct glint_box
glint_corners_compute_pixel_box(const struct glint_corners *corners, int width,
                                int height)
{
    const int grow = (1 << GLINT_VERTEX_FRAC) / 32 + 1;
    const struct glint_box e = compute_bounding_box_q8(corners);

    return (struct glint_box){
        clamp_to_max((e.x0 - grow) >> GLINT_VERTEX_FRAC, width),
        clamp_to_max((e.y0 - grow) >> GLINT_VERTEX_FRAC, height),
        clamp_to_max(((e.x1 + grow) >> GLINT_VERTEX_FRAC) + 1, width),
        clamp_to_max(((e.y1 + grow) >> GLINT_VERTEX_FRAC) + 1, height)};
}

/* Returns the irradiance MANTISSA 2^UP, clamped to LIMIT. Increments *N_HELD if
 * it was clamped. */
static int64_t scale_and_clamp_light(int64_t mantissa, int up, int64_t limit,
                                     int *n_held)
{
    int64_t x;

    if (mantissa == 0 || up < -62)
        return 0;
    if (up > 0 && up + bit_length((uint64_t)mantissa) > 62)
        x = INT64_MAX;
    else
        x = up > 0 ? mantissa << up : q_shift(mantissa, -up);
    *n_held += x > limit;
    return x < limit ? x : limit;
}

int64_t glint_compute_irradiance_q22(const struct glint_bundle *bundle,
                                     int share_log2, int64_t area, int frac,
                                     int32_t limit_q8, int *n_held)
{
    /* The area is normalised to 32 bits before the division. */
    const int up = q_count_normalising_shift((uint64_t)area);
    const uint32_t area_32 = q_shift_to_32_bits((uint64_t)area, up);
    /* The quotient is rounded, so that it is exact if the area is a power of
     * two. */
    const int64_t ratio =
        (int64_t)(((uint64_t)bundle->flux_q31 * q_reciprocal(area_32) +
                   (1 << 30)) >>
                  31);
    /* LIMIT_Q8 applies to a pixel, so for primitives smaller than a pixel it is
     * divided by the area. limit_q8 is below 2^20, the area at least 2^-33. */
    const int64_t limit_q22 =
        (area >> frac ? (int64_t)limit_q8
                      : q_divide((int64_t)limit_q8 << frac, area))
        << 14;

    /* The flux is flux_q31 2^(flux_exponent - 31), the area is area_32 2^(-up -
     * frac), and ratio is the quotient of both mantissas times 2^32; the result
     * is _q22. */
    return scale_and_clamp_light(
        ratio, bundle->flux_exponent - 31 + share_log2 + up + frac - 32 + 22,
        limit_q22, n_held);
}
