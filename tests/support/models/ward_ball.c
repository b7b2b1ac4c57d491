/* SPDX-License-Identifier: MIT */
#include "support/models/ward_ball.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/view.h"

static const double toward_eye[3] = {0, 0, -1};

static double dot_product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

int ward_build_frame(int i, double frame[3][3])
{
    const int row = i / WARD_BALL;
    const double x = (i % WARD_BALL + .5) / (WARD_BALL / 2.) - 1;
    const double y = 1 - (row + .5) / (WARD_BALL / 2.), z2 = 1 - x * x - y * y;
    double length;

    if (z2 <= .01)
        return 0;
    frame[2][0] = x;
    frame[2][1] = y;
    frame[2][2] = -sqrt(z2);
    length = sqrt(x * x + z2);
    frame[0][0] = frame[2][2] / length;
    frame[0][1] = 0;
    frame[0][2] = -x / length;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;

        frame[1][k] = frame[2][a] * frame[0][b] - frame[2][b] * frame[0][a];
    }
    return 1;
}

double ward_evaluate_lobe(const double frame[3][3], const double view[3],
                          const double alpha[2], int norm, const double in[3])
{
    const double ni = dot_product(frame[2], in),
                 no = dot_product(frame[2], view);
    double h[3], hn, ht, hb, slope, square, ho, weight;

    if (ni <= 0 || no <= 0)
        return 0;
    for (int k = 0; k < 3; k++)
        h[k] = in[k] + view[k];
    ht = dot_product(h, frame[0]) / alpha[0];
    hb = dot_product(h, frame[1]) / alpha[1];
    hn = dot_product(h, frame[2]);
    slope = (ht * ht + hb * hb) / (hn * hn);
    if (slope > 16)
        return 0;
    square = sqrt(dot_product(h, h));
    ho = dot_product(h, view) / square;
    hn /= square;
    weight = norm == GLINT_WARD_BOUNDED ? ni / (ho * hn)
                                        : ho * hn * hn * hn * sqrt(ni / no);
    /* The lobe is limited to 8 times the sampling density of IN. */
    return fmin(weight, 8) * exp(-slope) /
           (4 * GLINT_PI * alpha[0] * alpha[1] * ho * hn * hn * hn);
}

void ward_render_by_texel_sums(const struct glint_sphere *s,
                               const double alpha[2], ward_picture to)
{
    for (int i = 0; i < WARD_PIXELS; i++) {
        double frame[3][3];

        memset(to[i], 0, sizeof to[i]);
        if (!ward_build_frame(i, frame))
            continue;
        for (int t = 0; t < s->side * s->side; t++) {
            const double w =
                ward_evaluate_lobe((const double(*)[3])frame, toward_eye, alpha,
                                   GLINT_WARD_BOUNDED, s->texel[t].toward) *
                s->texel[t].weight;

            for (int c = 0; c < 3 && w > 0; c++)
                to[i][c] += w * s->texel[t].light[c];
        }
    }
}

void ward_render_by_lookups(const struct glint_environment *e,
                            const struct glint_ward_material *material,
                            const struct glint_ward_options *options,
                            ward_picture to)
{
    struct glint_ward_lobe l;

    glint_ward_prepare(&l, e, material, options);
    for (int i = 0; i < WARD_PIXELS; i++) {
        double frame[3][3];
        int32_t frame_q14[3][3], rgb_q15[3];
        const int32_t view_q14[3] = {0, 0, -(1 << 14)};

        memset(to[i], 0, sizeof to[i]);
        if (!ward_build_frame(i, frame))
            continue;
        for (int k = 0; k < 9; k++)
            frame_q14[k / 3][k % 3] =
                (int32_t)lrint(0x1p14 * frame[k / 3][k % 3]);
        glint_ward_light(&l, e, (const int32_t(*)[3])frame_q14, view_q14,
                         rgb_q15);
        for (int c = 0; c < 3; c++)
            to[i][c] = rgb_q15[c] * 0x1p-15;
    }
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static double clamp_linear_light(double x)
{
    return x;
}

static double encode_srgb(double x)
{
    return x <= .0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - .055;
}

static double compute_psnr(ward_picture want, ward_picture got,
                           double (*of)(double))
{
    double sorted[WARD_PIXELS], exposure, sum = 0, frame[3][3];
    int n = 0;

    for (int i = 0; i < WARD_PIXELS; i++)
        if (ward_build_frame(i, frame))
            sorted[n++] = glint_luminance(want[i]);
    qsort(sorted, (size_t)n, sizeof *sorted, compare_doubles);
    exposure = .25 / sorted[n / 2];
    for (int i = 0; i < WARD_PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            const double d = of(fmin(exposure * want[i][c], 1)) -
                             of(fmin(exposure * got[i][c], 1));

            sum += d * d;
        }
    return -10 * log10(sum / (3 * n));
}

double ward_compute_psnr(ward_picture want, ward_picture got)
{
    return compute_psnr(want, got, clamp_linear_light);
}

double ward_compute_psnr_of_codes(ward_picture want, ward_picture got)
{
    return compute_psnr(want, got, encode_srgb);
}
