/* SPDX-License-Identifier: MIT
 *
 * hue_steps A.ppm B.ppm - prints how far B is from A, a picture of the same
 * size: PSNR of codes, dB, and the hue step, codes. The hue step of two
 * neighbouring pixels is by how much R - G or B - G changes between them in B
 * otherwise than in A; printed is the step that a thousandth of all pairs
 * exceed.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/image.h"
#include "formats/picture.h"

static long pairs_of[2 * 255 * 2 + 1]; /* pairs by hue step, 0 .. 1020 */

static int hue_of(const struct glint_image *a, const struct glint_image *b,
                  int x, int y, int c)
{
    const uint8_t *p = a->plane[0] + y * a->stride_bytes[0] + 3 * x;
    const uint8_t *q = b->plane[0] + y * b->stride_bytes[0] + 3 * x;

    return (q[c] - q[1]) - (p[c] - p[1]);
}

static void count(const struct glint_image *a, const struct glint_image *b,
                  int x, int y, int dx, int dy)
{
    int most = 0;

    if (x + dx >= a->width || y + dy >= a->height)
        return;
    for (int c = 0; c < 3; c += 2) {
        const int step =
            abs(hue_of(a, b, x + dx, y + dy, c) - hue_of(a, b, x, y, c));

        most = step > most ? step : most;
    }
    pairs_of[most]++;
}

static double squares(const struct glint_image *a, const struct glint_image *b)
{
    double sum = 0;

    for (int y = 0; y < a->height; y++)
        for (int i = 0; i < 3 * a->width; i++) {
            const double e = a->plane[0][y * a->stride_bytes[0] + i] -
                             b->plane[0][y * b->stride_bytes[0] + i];

            sum += e * e;
        }
    return sum;
}

int main(int argc, char **argv)
{
    struct glint_image a, b;
    struct glint_error error = {""};
    long n = 0, above = 0;
    int step = 2 * 255 * 2;

    if (argc != 3 || glint_picture_load(argv[1], &a, &error) != GLINT_OK ||
        glint_picture_load(argv[2], &b, &error) != GLINT_OK ||
        a.width != b.width || a.height != b.height || a.format != GLINT_RGB24 ||
        b.format != GLINT_RGB24) {
        fprintf(stderr, "hue_steps: takes two PPM of a size: %s\n", error.text);
        return 2;
    }
    for (int y = 0; y < a.height; y++)
        for (int x = 0; x < a.width; x++) {
            count(&a, &b, x, y, 1, 0);
            count(&a, &b, x, y, 0, 1);
            n += 2;
        }
    while (step > 0 && above + pairs_of[step] < n / 1000)
        above += pairs_of[step--];
    printf("%.1f %d\n",
           10 * log10(255. * 255 * 3 * a.width * a.height /
                      fmax(squares(&a, &b), 1e-9)),
           step);
    return 0;
}
