/* SPDX-License-Identifier: MIT */
#include "engine/seen.h"

#include <math.h>
#include <stddef.h>

/* Number of histogram bins: eight per stop, from 2^-40 to 2^40. */
enum { STEPS = 8, OCTAVES = 40, BINS = 2 * OCTAVES * STEPS };

void glint_ground_sample_picture(struct glint_ground *ground,
                                 const struct glint_image *image)
{
    glint_image_sample(image, GLINT_GROUND_COLUMNS, GLINT_GROUND_ROWS,
                       ground->rgb[0][0]);
}

static double decode_srgb(int code)
{
    const double v = code / 255.0;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* For each 8-bit code of the picture, factors that convert added linear light.
 * visible: 1 / the light whose addition is just visible. white: 1 / the light
 * whose addition turns the code white. Both are 0 if that is impossible, or if
 * the code is ignored. */
struct slopes {
    double visible[256], white[256];
};

static void tabulate_inverse_light_steps(struct slopes *slope)
{
    *slope = (struct slopes){{0}, {0}};
    for (int code = 0; code + GLINT_SEEN_CODES <= 255; code++)
        slope->visible[code] =
            1 / (decode_srgb(code + GLINT_SEEN_CODES) - decode_srgb(code));
    for (int code = GLINT_SEEN_BRIGHT; code < GLINT_SEEN_WHITE; code++)
        slope->white[code] = 1 / (1 - decode_srgb(code));
}

/* Returns the light that the flare adds to a pixel, LIGHT, divided by the min
 * visible light; max over the channels. */
static double compute_pixel_visibility(const float light[3],
                                       const uint8_t code[3],
                                       const struct slopes *slope)
{
    double most = 0;

    for (int c = 0; c < 3; c++)
        most = fmax(most, (double)light[c] * slope->visible[code[c]]);
    return most;
}

/* Returns the light that the flare adds to a pixel, LIGHT, divided by the light
 * that turns the channel white; min over the channels. Returns 0 if a channel
 * is below GLINT_SEEN_BRIGHT. Channels from GLINT_SEEN_WHITE on are ignored. */
static double compute_pixel_white_ratio(const float light[3],
                                        const uint8_t code[3],
                                        const struct slopes *slope)
{
    double least = HUGE_VAL;

    for (int c = 0; c < 3; c++)
        if (code[c] < GLINT_SEEN_BRIGHT)
            return 0;
        else if (slope->white[code[c]] > 0)
            least = fmin(least, (double)light[c] * slope->white[code[c]]);
    return least < HUGE_VAL ? least : 0;
}

static void add_value_to_histogram(int count[BINS], double x)
{
    if (x > 0)
        count[(int)fmin(fmax((log2(x) + OCTAVES) * STEPS, 0), BINS - 1)]++;
}

/* Returns the max value that at least N pixels of the histogram reach or
 * exceed. Returns 0 if the histogram has fewer than N pixels. */
static double find_value_reached_by_pixels(const int count[BINS], int n)
{
    for (int bin = BINS - 1, sum = 0; bin >= 0; bin--) {
        sum += count[bin];
        if (sum >= n)
            return exp2((double)bin / STEPS - OCTAVES);
    }
    return 0;
}

void glint_seen_measure_visibility(struct glint_seen *seen,
                                   const struct glint_ground *ground,
                                   const float *rgb, int width, int height)
{
    int visible[BINS] = {0}, white[BINS] = {0};
    struct slopes slope;

    tabulate_inverse_light_steps(&slope);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, rgb += 3) {
            const uint8_t *const code =
                ground->rgb[y * GLINT_GROUND_ROWS / height]
                           [x * GLINT_GROUND_COLUMNS / width];

            add_value_to_histogram(visible,
                                   compute_pixel_visibility(rgb, code, &slope));
            add_value_to_histogram(
                white, compute_pixel_white_ratio(rgb, code, &slope));
        }
    seen->few = find_value_reached_by_pixels(
        visible, width * height / GLINT_SEEN_FEW + 1);
    seen->many = find_value_reached_by_pixels(
        visible, width * height / GLINT_SEEN_MANY + 1);
    seen->white = find_value_reached_by_pixels(
        white, width * height / GLINT_SEEN_DISC + 1);
}
