/* SPDX-License-Identifier: MIT */
#include "engine/seen.h"

#include <math.h>
#include <stddef.h>

/* Bins of light / the least visible light, an eighth of a stop each, around 1.
 * */
enum { STEPS = 8, OCTAVES = 40, BINS = 2 * OCTAVES * STEPS };

void glint_ground_take(struct glint_ground *ground,
                       const struct glint_image *image)
{
    glint_image_sample(image, GLINT_GROUND_COLUMNS, GLINT_GROUND_ROWS,
                       ground->rgb[0][0]);
}

static double decode(int code)
{
    const double v = code / 255.0;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* Sets SLOPE[code] to 1 / the light that must be added to be visible; 0 if no
 * light is. */
static void list_slopes(double slope[256])
{
    for (int code = 0; code < 256; code++)
        slope[code] =
            code + GLINT_SEEN_CODES > 255
                ? 0
                : 1 / (decode(code + GLINT_SEEN_CODES) - decode(code));
}

/* Returns the bin of a pixel, or -1 if it gets no light that can be seen. */
static int bin_of(const float light[3], const uint8_t code[3],
                  const double slope[256])
{
    double most = 0;

    for (int c = 0; c < 3; c++)
        most = fmax(most, (double)light[c] * slope[code[c]]);
    if (!(most > 0))
        return -1;
    return (int)fmin(fmax((log2(most) + OCTAVES) * STEPS, 0), BINS - 1);
}

/* Returns the light that N of the counted pixels reach, or 0. */
static double reached_by(const int count[BINS], int n)
{
    for (int bin = BINS - 1, sum = 0; bin >= 0; bin--) {
        sum += count[bin];
        if (sum >= n)
            return exp2((double)bin / STEPS - OCTAVES);
    }
    return 0;
}

void glint_seen_on(struct glint_seen *seen, const struct glint_ground *ground,
                   const float *rgb, int width, int height)
{
    double slope[256];
    int count[BINS] = {0};

    list_slopes(slope);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, rgb += 3) {
            const int bin =
                bin_of(rgb,
                       ground->rgb[y * GLINT_GROUND_ROWS / height]
                                  [x * GLINT_GROUND_COLUMNS / width],
                       slope);

            if (bin >= 0)
                count[bin]++;
        }
    seen->few = reached_by(count, width * height / GLINT_SEEN_FEW + 1);
    seen->many = reached_by(count, width * height / GLINT_SEEN_MANY + 1);
}
