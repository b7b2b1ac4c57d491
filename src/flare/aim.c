/* SPDX-License-Identifier: MIT
 *
 * Converts pixel positions to directions of light, in integers, for programs
 * without floating point. glint/view.h has the same conversion in doubles. */
#include "base/real.h"
#include "glint/flare.h"

enum { HALF_PIXEL_Q8 = 128, LIMIT_Q8 = 1 << 30 };

struct glint_real glint_flare_pixels_per_mm(const struct glint_lens *lens,
                                            int width, int height)
{
    const struct glint_real across =
        real_over(real_of(width, 0), lens->header->film_width_mm);
    const struct glint_real down =
        real_over(real_of(height, 0), lens->header->film_height_mm);

    return real_less(across, down) ? down : across;
}

/* Returns SMALL / LARGE, clamped to 1. Returns 0 if SMALL is 0, even if LARGE
 * is 0, too. */
static int32_t compute_clamped_ratio_q30(struct glint_real small,
                                         struct glint_real large)
{
    if (small.mantissa == 0)
        return 0;
    return (int32_t)real_integer(real_over(small, large), 30, 1 << 30);
}

/* Sets COSINE and SINE to those of the angle between the x axis and the vector
 * (X, Y). X and Y must be 0 or more. For (0, 0) the angle is 0. */
static void compute_unit_direction(struct glint_real x, struct glint_real y,
                                   int32_t *cosine_q30, int32_t *sine_q30)
{
    const int steep = real_less(x, y);
    const int64_t ratio_q30 = steep ? compute_clamped_ratio_q30(x, y)
                                    : compute_clamped_ratio_q30(y, x);
    const int64_t length_q30 =
        q_root((UINT64_C(1) << 60) + (uint64_t)(ratio_q30 * ratio_q30));
    const int32_t large_q30 = q_narrow(q_divide(INT64_C(1) << 60, length_q30));
    const int32_t small_q30 = q_mul((int32_t)ratio_q30, large_q30, 30);

    *cosine_q30 = steep ? small_q30 : large_q30;
    *sine_q30 = steep ? large_q30 : small_q30;
}

struct glint_light glint_light_from_pixel(const struct glint_lens *lens,
                                          int width, int height, int32_t x_q8,
                                          int32_t y_q8)
{
    const struct glint_real one = {1 << 30, -30};
    const struct glint_real focal = real_times(
        lens->header->focal_mm, glint_flare_pixels_per_mm(lens, width, height));
    const int side = focal.mantissa < 0 ? -1 : 1;
    const int32_t x = side * q_clamp_sat(x_q8 - (int64_t)width * HALF_PIXEL_Q8,
                                         -LIMIT_Q8, LIMIT_Q8);
    const int32_t y = side * q_clamp_sat((int64_t)height * HALF_PIXEL_Q8 - y_q8,
                                         -LIMIT_Q8, LIMIT_Q8);
    struct glint_light light = {.power = one,
                                .rgb_q14 = {1 << 14, 1 << 14, 1 << 14}};
    int64_t distance_q38;

    compute_unit_direction(real_of(x < 0 ? -x : x, -8),
                           real_of(y < 0 ? -y : y, -8), &light.cos_q30,
                           &light.sin_q30);
    light.cos_q30 = x < 0 ? -light.cos_q30 : light.cos_q30;
    light.sin_q30 = y < 0 ? -light.sin_q30 : light.sin_q30;
    distance_q38 = (int64_t)x * light.cos_q30 + (int64_t)y * light.sin_q30;
    compute_unit_direction(
        (struct glint_real){side * focal.mantissa, focal.exponent},
        real_of(distance_q38, -38), &light.cosine_q30, &light.sine_q30);
    return light;
}
