/* SPDX-License-Identifier: MIT */
#include "glint/measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t count_rgb_samples(const struct glint_float_image *image)
{
    return 3 * (size_t)image->width * (size_t)image->height;
}

/* Returns an integer key that sorts pixels by luminance, also if it is
 * negative. The key is made of the bits of the float, changed such that the
 * order of keys is that of the floats. */
static uint32_t encode_luminance_key(const float rgb[3])
{
    const float y = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    uint32_t bits;

    memcpy(&bits, &y, sizeof bits);
    return bits >> 31 ? ~bits : bits | UINT32_C(1) << 31;
}

static double decode_luminance_key(uint32_t key)
{
    const uint32_t bits = key >> 31 ? key & INT32_MAX : ~key;
    float y;

    memcpy(&y, &bits, sizeof y);
    return (double)y;
}

/* Returns the luminance of rank RANK among the pixels of IMAGE, sorted by
 * rising luminance. A radix selection finds the key of that pixel byte by byte,
 * without allocating memory. */
static double find_luminance_of_rank(const struct glint_float_image *image,
                                     size_t rank)
{
    const size_t n = count_rgb_samples(image) / 3;
    uint32_t key = 0, known = 0;

    for (int shift = 24; shift >= 0; shift -= 8) {
        size_t count[256] = {0};
        uint32_t byte = 0;

        for (size_t i = 0; i < n; i++) {
            const uint32_t k = encode_luminance_key(image->rgb + 3 * i);

            count[k >> shift & 255] += (k & known) == key;
        }
        for (; byte < 255 && rank >= count[byte]; byte++)
            rank -= count[byte];
        key |= byte << shift;
        known |= UINT32_C(255) << shift;
    }
    return decode_luminance_key(key);
}

double glint_measure_exposure(const struct glint_float_image *image)
{
    const size_t n = count_rgb_samples(image) / 3;
    const double at =
        find_luminance_of_rank(image, (size_t)((double)(n - 1) * 0.999));

    return at > 0 ? 1 / at : 1;
}

double glint_measure_code(double light)
{
    const double v = fmin(1, fmax(0, light));

    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055);
}

/* The light at which one code ends and the next one begins, and the code of
 * every multiple of 1 / STEPS */
enum { STEPS = 4096 };
struct code_table {
    double end[256];
    uint8_t first[STEPS + 1];
};

/* Light this close to the end of a code is encoded by glint_measure_code(). */
#define NEAR_END 1e-12

static void init_code_table(struct code_table *t)
{
    int code = 0;

    for (int k = 0; k < 255; k++) {
        const double v = (k + 0.5) / 255;

        t->end[k] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    }
    t->end[255] = 2;
    for (int i = 0; i <= STEPS; i++) {
        while ((double)i / STEPS > t->end[code] + NEAR_END)
            code++;
        t->first[i] = (uint8_t)code;
    }
}

/* Returns glint_measure_code(LIGHT), rounded. */
static uint8_t encode_light(const struct code_table *t, double light)
{
    const double v = fmin(1, fmax(0, light));
    int code = t->first[(int)(v * STEPS)];

    while (v > t->end[code] + NEAR_END)
        code++;
    return (uint8_t)(v < t->end[code] - NEAR_END
                         ? code
                         : lrint(glint_measure_code(v)));
}

uint8_t *glint_measure_encode(const struct glint_float_image *image,
                              double exposure)
{
    const size_t n = count_rgb_samples(image);
    uint8_t *codes = calloc(n, 1);
    struct code_table table;

    init_code_table(&table);
    for (size_t i = 0; codes && i < n; i++)
        codes[i] = encode_light(&table, (double)image->rgb[i] * exposure);
    return codes;
}

static double fit_factor_between_pictures(const struct glint_float_image *a,
                                          const struct glint_float_image *b)
{
    double ab = 0, bb = 0;

    for (size_t i = 0; i < count_rgb_samples(a); i++) {
        ab += (double)a->rgb[i] * (double)b->rgb[i];
        bb += (double)b->rgb[i] * (double)b->rgb[i];
    }
    return bb > 0 ? ab / bb : 1;
}

static double sum_rgb_samples(const struct glint_float_image *image)
{
    double s = 0;

    for (size_t i = 0; i < count_rgb_samples(image); i++)
        s += (double)image->rgb[i];
    return s;
}

static void measure_code_difference(const uint8_t *a, const uint8_t *b,
                                    size_t n, struct glint_measure *m)
{
    size_t count[256] = {0}, seen = 0;
    double squares = 0;
    int d = 0;

    for (size_t i = 0; i < n; i++) {
        const int e = abs(a[i] - b[i]);

        count[e]++;
        squares += (double)e * e;
    }
    m->psnr_db =
        squares > 0 ? 10 * log10(255.0 * 255.0 * (double)n / squares) : 999;
    for (; d < 255; d++) {
        seen += count[d];
        if ((double)seen >= 0.99 * (double)n)
            break;
    }
    m->p99 = d;
}

static double compute_luma(const uint8_t *p)
{
    /* NOLINTNEXTLINE: the caller guarantees that the picture is not empty */
    return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
}

/* Returns the structural similarity (SSIM) of the luma of one 8 x 8 block
 * [Wang04], with a uniform window instead of a Gaussian. */
static double compute_block_ssim(const uint8_t *a, const uint8_t *b, int stride)
{
    double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0, va, vb, ab;
    const double c1 = 6.5025, c2 = 58.5225, n = 64;

    for (int k = 0; k < 64; k++) {
        const int at = (k / 8 * stride + k % 8) * 3;
        const double x = compute_luma(a + at), y = compute_luma(b + at);

        sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
    }
    sa /= n, sb /= n;
    va = saa / n - sa * sa, vb = sbb / n - sb * sb, ab = sab / n - sa * sb;
    return (2 * sa * sb + c1) * (2 * ab + c2) /
           ((sa * sa + sb * sb + c1) * (va + vb + c2));
}

static double compute_ssim(const uint8_t *a, const uint8_t *b, int width,
                           int height)
{
    double total = 0;
    int n = 0;

    for (int y = 0; y + 8 <= height; y += 4)
        for (int x = 0; x + 8 <= width; x += 4, n++) {
            const size_t at = ((size_t)y * (size_t)width + (size_t)x) * 3;

            total += compute_block_ssim(a + at, b + at, width);
        }
    return n ? total / n : 1;
}

void glint_measure_codes(const uint8_t *reference, const uint8_t *test,
                         int width, int height, struct glint_measure *result)
{
    measure_code_difference(reference, test, 3 * (size_t)width * (size_t)height,
                            result);
    result->ssim = compute_ssim(reference, test, width, height);
}

/* Returns the PSNR, dB, of two pictures with equal 8-bit codes, computed from
 * the codes before they are rounded. */
static double
compute_unrounded_psnr_db(const struct glint_float_image *reference,
                          const struct glint_float_image *test,
                          const struct glint_measure *m)
{
    const size_t n = count_rgb_samples(reference);
    double squares = 0;

    for (size_t i = 0; i < n; i++) {
        const double e =
            glint_measure_code((double)reference->rgb[i] * m->exposure) -
            glint_measure_code((double)test->rgb[i] * m->exposure * m->factor);

        squares += e * e;
    }
    return squares > 0 ? 10 * log10(255.0 * 255.0 * (double)n / squares) : 999;
}

bool glint_measure_at(const struct glint_float_image *reference,
                      const struct glint_float_image *test, bool fit,
                      double exposure, struct glint_measure *result)
{
    const double total = sum_rgb_samples(reference);
    uint8_t *a, *b;

    result->exposure = exposure;
    result->factor = fit ? fit_factor_between_pictures(reference, test) : 1;
    result->flux =
        total > 0 ? result->factor * sum_rgb_samples(test) / total : 1;
    a = glint_measure_encode(reference, result->exposure);
    b = glint_measure_encode(test, result->exposure * result->factor);
    if (a && b)
        glint_measure_codes(a, b, reference->width, reference->height, result);
    result->same_codes = a && b && result->psnr_db == 999;
    if (result->same_codes)
        result->psnr_db = compute_unrounded_psnr_db(reference, test, result);
    free(a);
    free(b);
    return a && b;
}

bool glint_measure_compare(const struct glint_float_image *reference,
                           const struct glint_float_image *test, bool fit,
                           struct glint_measure *result)
{
    return glint_measure_at(reference, test, fit,
                            glint_measure_exposure(reference), result);
}
