/* SPDX-License-Identifier: MIT
 *
 * Tests the random parameters of synthetic data sets. The line of an item must
 * restore all its numbers, and numbers must be in their ranges and independent
 * of one another.
 */
#include "support/test.h"
#include "synth/draw.h"

static struct synth_ranges ranges;

static const struct synth_item named = {.width = 64,
                                        .height = 48,
                                        .glint = "0",
                                        .background = "a \"quoted\" name.ppm",
                                        .background_key = "0123456789abcdef",
                                        .lens = "heliar-tronnier",
                                        .coating = "mixed",
                                        .quality = 0.3};

static double read_json_field(const struct synth_item *item, int k)
{
    return *(const double *)(const void *)((const char *)item +
                                           synth_field[k].at);
}

TEST(lines_contain_all_fields)
{
    static const struct synth_result none;

    synth_ranges_set_defaults(&ranges);
    for (int i = 0; i < 500; i++) {
        struct synth_item item = named, back;
        struct glint_error error = {""};
        char *line;

        synth_item_randomise(&item, &ranges, 2147483647 - i, i);
        line = synth_item_format_json(&item, &none);
        assert_non_null(line);
        if (synth_item_parse_json(&back, line, &error) == GLINT_E_UNSUPPORTED) {
            free(line);
            skip(); /* needs jansson */
        }
        assert_string_equal(error.text, "");
        for (int k = 0; k < SYNTH_FIELDS; k++)
            if (synth_field[k].text_bytes)
                assert_string_equal((char *)&item + synth_field[k].at,
                                    (char *)&back + synth_field[k].at);
            else
                assert_true(read_json_field(&item, k) ==
                            read_json_field(&back, k));
        for (int k = 0; k < (int)item.n_lights; k++)
            assert_memory_equal(&item.light[k], &back.light[k],
                                sizeof item.light[k]);
        free(line);
    }
}

TEST(random_numbers_stay_in_range)
{
    double low[SYNTH_FIELDS], high[SYNTH_FIELDS];
    int zeros = 0;

    synth_ranges_set_defaults(&ranges);
    for (int k = 0; k < SYNTH_FIELDS; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (int i = 0; i < 4000; i++) {
        struct synth_item item = named;

        synth_item_randomise(&item, &ranges, 1, i);
        zeros += item.dust == 0;
        assert_true(item.light[0].power == 1);
        for (int k = 0; k < SYNTH_FIELDS; k++)
            if (synth_field[k].law > SYNTH_COUNTED &&
                read_json_field(&item, k) != 0) {
                low[k] = fmin(low[k], read_json_field(&item, k));
                high[k] = fmax(high[k], read_json_field(&item, k));
            }
    }
    /* The expected number is 2000; five standard deviations are 158. */
    assert_in_range(zeros, 1850, 2150);
    for (int k = 0; k < SYNTH_FIELDS; k++) {
        const double span = synth_field[k].high - synth_field[k].low;

        if (synth_field[k].law <= SYNTH_COUNTED || span == 0)
            continue;
        assert_true(low[k] >= synth_field[k].low - 1e-6);
        assert_true(high[k] <= synth_field[k].high + 1e-6);
        assert_true(high[k] > synth_field[k].high - 0.02 * span);
    }
}

/* Checks that changing the range of one number does not change the others. */
TEST(random_numbers_are_independent)
{
    struct synth_item a = named, b = named;
    struct glint_error why = {""};

    synth_ranges_set_defaults(&ranges);
    synth_item_randomise(&a, &ranges, 3, 14);
    /* numbers whose names have the same length are independent, too */
    assert_true(a.crop_x != a.crop_y);
    assert_true(synth_ranges_parse(&ranges, "level=0.5", &why));
    synth_item_randomise(&b, &ranges, 3, 14);
    assert_true(b.level == 0.5);
    b.level = a.level;
    assert_memory_equal(&a, &b, sizeof a);
    synth_item_randomise(&b, &ranges, 3, 15);
    assert_true(a.crop_x != b.crop_x);
    synth_item_randomise(&b, &ranges, 4, 14);
    assert_true(a.crop_x != b.crop_x);
    assert_false(synth_ranges_parse(&ranges, "level=1,-1", &why));
    assert_false(synth_ranges_parse(&ranges, "levels=1", &why));
    assert_false(synth_ranges_parse(&ranges, "width=64", &why));
    assert_false(synth_ranges_parse(&ranges, "star=0,1", &why));
    assert_true(synth_ranges_parse(&ranges, "star=0", &why));
}

TEST(noise_is_photon_and_read_noise)
{
    enum { SIDE = 256, N = 3 * SIDE * SIDE };
    struct synth_item item = {
        .width = SIDE, .height = SIDE, .read_noise = 0.01, .full_well = 1000};
    float *const rgb = test_free_later(malloc(N * sizeof *rgb));
    const double light[] = {0, 0.1, 0.8};

    for (int k = 0; k < 3; k++) {
        double sum = 0, squares = 0, wanted = light[k] / 1000 + 1e-4;

        for (int i = 0; i < N; i++)
            rgb[i] = (float)light[k];
        synth_add_noise(&item, rgb);
        for (int i = 0; i < N; i++) {
            const double off = (double)rgb[i] - light[k];

            sum += off;
            squares += off * off;
        }
        assert_true(fabs(sum / N) < 5 * sqrt(wanted / N));
        assert_true(fabs(squares / N / wanted - 1) < 0.02);
    }
}
