/* SPDX-License-Identifier: MIT */
#include "support/finder.h"

#include "support/canvas.h"
#include "support/rng.h"
#include "support/test.h"

struct glint_spot finder_spot[FINDER_SPOTS];
uint32_t finder_seed = 1;

int finder_find_at_most_n_lamps(const struct glint_lamp_finder_config *cfg,
                                const struct glint_image *image, int max,
                                int *dropped)
{
    const size_t bytes = glint_lamp_finder_bytes(cfg);
    struct glint_lamp_finder *finder;
    void *mem;
    int n;

    assert_true(bytes > 0);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    memset(mem, rng_int_below(&finder_seed, 256), bytes);
    assert_ok(glint_lamp_finder_init(&finder, cfg, mem, bytes));
    n = glint_lamp_finder_find(finder, image, finder_spot, max);
    if (dropped)
        *dropped = glint_lamp_finder_dropped(finder);
    else
        assert_int_equal(glint_lamp_finder_dropped(finder), 0);
    free(mem);
    return n;
}

int finder_find_lamps(const struct glint_lamp_finder_config *cfg,
                      const struct glint_image *image)
{
    return finder_find_at_most_n_lamps(cfg, image, FINDER_SPOTS, NULL);
}

int32_t finder_threshold_stops_q8(int code)
{
    return (int32_t)floor(
        256 * log2((canvas_decode_srgb(code - 1) + canvas_decode_srgb(code)) /
                   2) +
        0.5);
}

struct glint_lamp_finder_config
finder_config_without_filters(const struct glint_image *image, int low,
                              int high)
{
    return (struct glint_lamp_finder_config){
        .width = image->width,
        .height = image->height,
        .threshold_low_q8 = finder_threshold_stops_q8(low),
        .threshold_high_q8 = finder_threshold_stops_q8(high),
        .white_code = 255,
        .min_area = 1,
        .max_share_q15 = 1 << 15};
}

struct finder_case finder_open_case(enum glint_pixel_format format, int width,
                                    int height, int low, int high)
{
    const struct glint_image image =
        canvas_allocate_image(format, width, height);

    return (struct finder_case){
        image, finder_config_without_filters(&image, low, high)};
}

struct glint_lamp_finder_config
finder_default_config(const struct glint_image *image)
{
    struct glint_lamp_finder_config cfg;

    glint_lamp_finder_defaults(&cfg, image->width, image->height);
    return cfg;
}

double finder_centroid_x_of_spot(int i)
{
    return finder_spot[i].x_q8 / 256.0;
}

double finder_centroid_y_of_spot(int i)
{
    return finder_spot[i].y_q8 / 256.0;
}
