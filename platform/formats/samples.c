/* SPDX-License-Identifier: MIT */
#include "formats/samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

float glint_half_decode(uint16_t half)
{
    const uint32_t sign = (uint32_t)(half & 0x8000) << 16;
    const uint32_t rest = half & 0x7fff;
    const uint32_t exponent =
        rest >= 0x7c00 ? UINT32_C(224) << 23 : UINT32_C(112) << 23;
    const uint32_t bits = (sign | (rest << 13)) + exponent;
    float value;

    if (rest < 0x400) { /* 0 or subnormal: the value is a multiple of 2^-24 */
        value = (float)rest * 0x1p-24F;
        return sign ? -value : value;
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Returns MANTISSA / 2^N, N >= 1, rounded to nearest, ties to even. */
static uint32_t round_off_bits(uint32_t mantissa, int n)
{
    const uint32_t half = UINT32_C(1) << (n - 1);
    const uint32_t kept = mantissa >> n, rest = mantissa & (2 * half - 1);

    return kept + (rest > half || (rest == half && (kept & 1)));
}

uint16_t glint_half_encode(float value)
{
    uint32_t bits, sign, size;
    int exponent;

    memcpy(&bits, &value, sizeof bits);
    sign = bits >> 16 & 0x8000;
    size = bits & 0x7fffffff;
    exponent = (int)(size >> 23) - 127;
    if (size > 0x7f800000) /* NaN stays NaN */
        return (uint16_t)(sign | 0x7e00 | (size >> 13 & 0x1ff));
    if (exponent > 15)
        return (uint16_t)(sign | 0x7c00);
    /* Rounding may carry into the exponent, up to infinity. */
    if (exponent >= -14)
        return (uint16_t)(sign |
                          (round_off_bits(size, 13) - (UINT32_C(112) << 10)));
    if (exponent < -25)
        return (uint16_t)sign;
    return (uint16_t)(sign | round_off_bits((size & 0x7fffff) | 0x800000,
                                            -1 - exponent));
}

size_t glint_sample_get_bytes(enum glint_sample sample)
{
    static const uint8_t bytes[] = {1, 2, 4, 2, 4, 8};

    return bytes[sample];
}

bool glint_sample_is_float(enum glint_sample sample)
{
    return sample >= GLINT_SAMPLE_HALF;
}

/* ---------------------------------------------------------------- positions */

static bool does_orientation_swap_sides(const struct glint_samples *s)
{
    return s->orientation >= 5;
}

int glint_samples_get_width(const struct glint_samples *samples)
{
    return does_orientation_swap_sides(samples) ? samples->window_height
                                                : samples->window_width;
}

int glint_samples_get_height(const struct glint_samples *samples)
{
    return does_orientation_swap_sides(samples) ? samples->window_width
                                                : samples->window_height;
}

/* Returns the address of the pixel at (X, Y) of the upright display window, or
 * NULL if the file has no pixel there. */
static uint8_t *find_upright_pixel(const struct glint_samples *s, int x, int y)
{
    const int right = s->window_width - 1, bottom = s->window_height - 1;
    /* 64 bits, as a file may place its window at any position */
    int64_t column = does_orientation_swap_sides(s) ? y : x,
            row = does_orientation_swap_sides(s) ? x : y;

    if (s->orientation == 2 || s->orientation == 3 || s->orientation == 7 ||
        s->orientation == 8)
        column = right - column;
    if (s->orientation == 3 || s->orientation == 4 || s->orientation == 6 ||
        s->orientation == 7)
        row = bottom - row;
    column -= s->x;
    row -= s->y;
    if (column < 0 || row < 0 || column >= s->width || row >= s->height)
        return NULL;
    return s->mem +
           ((size_t)row * (size_t)s->width + (size_t)column) * s->pixel_bytes;
}

bool glint_samples_get_image(const struct glint_samples *samples,
                             struct glint_image *image)
{
    const struct glint_samples *const s = samples;

    if (!s->colours.is_srgb || s->n_colours != 3 || s->has_alpha ||
        s->pixel_bytes != 3 || s->colour[0].sample != GLINT_SAMPLE_U8 ||
        s->colour[0].offset != 0 || s->colour[1].offset != 1 ||
        s->colour[2].offset != 2 || s->maximum != 255 || s->orientation != 1 ||
        s->x || s->y || s->width != s->window_width ||
        s->height != s->window_height)
        return false;
    *image = (struct glint_image){.format = GLINT_RGB24,
                                  .width = s->width,
                                  .height = s->height,
                                  .range = GLINT_RANGE_FULL,
                                  .transfer = GLINT_TONE_SRGB};
    glint_image_place(image, s->mem);
    return true;
}

/* ----------------------------------------------------------------- samples */

static uint32_t read_integer_sample(const struct glint_sample_place *c,
                                    const uint8_t *pixel)
{
    uint16_t wide;
    uint32_t long_;

    switch (c->sample) {
    case GLINT_SAMPLE_U8:
        return pixel[c->offset];
    case GLINT_SAMPLE_U16:
        memcpy(&wide, pixel + c->offset, sizeof wide);
        return wide;
    default:
        memcpy(&long_, pixel + c->offset, sizeof long_);
        return long_;
    }
}

static void write_integer_sample(const struct glint_sample_place *c,
                                 uint8_t *pixel, uint32_t code)
{
    const uint16_t wide = (uint16_t)code;

    if (c->sample == GLINT_SAMPLE_U8)
        pixel[c->offset] = (uint8_t)code;
    else if (c->sample == GLINT_SAMPLE_U16)
        memcpy(pixel + c->offset, &wide, sizeof wide);
    else
        memcpy(pixel + c->offset, &code, sizeof code);
}

static double read_float_sample(const struct glint_sample_place *c,
                                const uint8_t *pixel)
{
    uint16_t half;
    float single;
    double value;

    switch (c->sample) {
    case GLINT_SAMPLE_HALF:
        memcpy(&half, pixel + c->offset, sizeof half);
        return (double)glint_half_decode(half);
    case GLINT_SAMPLE_FLOAT:
        memcpy(&single, pixel + c->offset, sizeof single);
        return (double)single;
    default:
        memcpy(&value, pixel + c->offset, sizeof value);
        return value;
    }
}

static void write_float_sample(const struct glint_sample_place *c,
                               uint8_t *pixel, double value)
{
    const float single = (float)value;
    const uint16_t half =
        glint_half_encode(value > 65504 ? 65504.0F : single); /* clamped to the
                                                                 largest finite
                                                                 half */

    if (c->sample == GLINT_SAMPLE_HALF)
        memcpy(pixel + c->offset, &half, sizeof half);
    else if (c->sample == GLINT_SAMPLE_FLOAT)
        memcpy(pixel + c->offset, &single, sizeof single);
    else
        memcpy(pixel + c->offset, &value, sizeof value);
}

static uint32_t get_max_sample_code(enum glint_sample sample)
{
    return sample == GLINT_SAMPLE_U8    ? UINT8_MAX
           : sample == GLINT_SAMPLE_U16 ? UINT16_MAX
                                        : UINT32_MAX;
}

/* Returns sample C (type and offset) of PIXEL. Integers are divided by MAXIMUM,
 * floats are unchanged. */
static double read_scaled_sample(const struct glint_sample_place *c,
                                 uint32_t maximum, const uint8_t *pixel)
{
    if (glint_sample_is_float(c->sample))
        return read_float_sample(c, pixel);
    return (double)read_integer_sample(c, pixel) / maximum;
}

static void write_scaled_sample(const struct glint_sample_place *c,
                                uint32_t maximum, uint8_t *pixel, double value)
{
    if (glint_sample_is_float(c->sample))
        write_float_sample(c, pixel, value);
    else if (!(value > 0))
        write_integer_sample(c, pixel, 0);
    else
        write_integer_sample(
            c, pixel, value >= 1 ? maximum : (uint32_t)(value * maximum + 0.5));
}

static double read_pixel_alpha(const struct glint_samples *s,
                               const uint8_t *pixel)
{
    const double alpha =
        s->has_alpha
            ? read_scaled_sample(&s->alpha,
                                 get_max_sample_code(s->alpha.sample), pixel)
            : 1;

    return alpha > 0 ? fmin(alpha, 1) : 0;
}

/* ------------------------------------------------------------ linear light */

/* Decodes samples to linear light. entries[c] is a table from the codes of
 * colour c to light. It is NULL if samples are floats, if their max is above
 * 65535, or if there was no memory for the table; then the curve is evaluated
 * for each sample. */
struct decoder {
    const struct glint_samples *samples;
    float *entries[3];
};

static void open_sample_decoder(struct decoder *d,
                                const struct glint_samples *s)
{
    const size_t n = (size_t)s->maximum + 1;

    *d = (struct decoder){.samples = s};
    if (glint_sample_is_float(s->colour[0].sample) || s->maximum > UINT16_MAX)
        return;
    for (int c = 0; c < 3; c++) {
        d->entries[c] = malloc(n * sizeof *d->entries[c]);
        for (size_t i = 0; i < n && d->entries[c]; i++)
            d->entries[c][i] = (float)glint_tone_curve_decode(
                &s->colours.transfer[c], (double)i / s->maximum);
    }
}

static void close_sample_decoder(struct decoder *d)
{
    for (int c = 0; c < 3; c++)
        free(d->entries[c]);
}

static double decode_channel_to_light(const struct decoder *d, int c,
                                      const uint8_t *pixel)
{
    const struct glint_samples *const s = d->samples;
    const struct glint_sample_place *const from = &s->colour[c];
    uint32_t code;

    if (!d->entries[c])
        return glint_tone_curve_decode(
            &s->colours.transfer[c],
            read_scaled_sample(from, s->maximum, pixel));
    code = read_integer_sample(from, pixel);
    return (double)d->entries[c][code < s->maximum ? code : s->maximum];
}

static void multiply_matrix(const double m[3][3], const double from[3],
                            double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = m[i][0] * from[0] + m[i][1] * from[1] + m[i][2] * from[2];
}

/* Returns VALUE if it is finite. Returns 65504, the largest half, for infinity,
 * and 0 for minus infinity and NaN. */
static double clamp_to_finite(double value)
{
    return isnan(value) ? 0 : isinf(value) ? (value > 0 ? 65504 : 0) : value;
}

/* Sets RGB to the linear light of PIXEL, BT.709 primaries. The light is
 * multiplied by alpha, unless STRAIGHT is set. */
static void decode_pixel_light(const struct decoder *d, const uint8_t *pixel,
                               bool straight, double rgb[3])
{
    const struct glint_samples *const s = d->samples;
    const double alpha = read_pixel_alpha(s, pixel);
    double own[3], factor = 1;

    if (s->has_alpha && s->is_premultiplied && straight)
        factor = alpha > 0 ? 1 / alpha : 0;
    else if (s->has_alpha && !s->is_premultiplied && !straight)
        factor = alpha;
    for (int c = 0; c < 3; c++)
        own[c] = clamp_to_finite(decode_channel_to_light(d, c, pixel)) * factor;
    multiply_matrix(s->colours.to_bt709, own, rgb);
}

void glint_samples_get_light(const struct glint_samples *samples, int x, int y,
                             float rgb[3])
{
    const struct decoder by_formula = {.samples = samples};
    const uint8_t *const pixel = find_upright_pixel(samples, x, y);
    double light[3] = {0, 0, 0};

    if (pixel)
        decode_pixel_light(&by_formula, pixel, false, light);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)light[c];
}

/* ------------------------------------------------------------------- proxy */

/* number of histogram bins: eight per octave of light, from 2^-8 to 2^24 */
#define BINS 256

/* Returns the white level of D's picture: the light that the largest channel
 * exceeds in 1 % of the pixels. It is rounded up to an eighth of an octave, and
 * is at least 1. It is 1 if samples are not floats. */
static double find_white_level(const struct decoder *d)
{
    const struct glint_samples *const s = d->samples;
    const size_t n = (size_t)s->width * (size_t)s->height;
    uint32_t bins[BINS] = {0};
    size_t above = 0;
    int bin = BINS;

    if (!glint_sample_is_float(s->colour[0].sample))
        return 1;
    for (size_t i = 0; i < n; i++) {
        double rgb[3], most;

        decode_pixel_light(d, s->mem + i * s->pixel_bytes, false, rgb);
        most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
        if (most > 1)
            bins[(int)fmin(log2(most) * 8 + 64, BINS - 1)]++;
    }
    while (bin > 64 && above * 100 <= n)
        above += bins[--bin];
    return bin <= 64 ? 1 : exp2((bin - 63) / 8.0);
}

#define STEPS 65536

static uint8_t *fill_proxy_code_table(void)
{
    struct glint_tone_curve srgb;
    uint8_t *const codes = malloc(STEPS);

    glint_tone_curve_set(&srgb, GLINT_TONE_IS_SRGB, 0);
    for (int i = 0; i < STEPS && codes; i++)
        codes[i] =
            (uint8_t)(glint_tone_curve_encode(&srgb, i / (STEPS - 1.0)) * 255 +
                      0.5);
    return codes;
}

static void fill_proxy_pixels(const struct decoder *d,
                              const struct glint_image *proxy, double white,
                              const uint8_t *codes)
{
    for (int y = 0; y < proxy->height; y++) {
        uint8_t *at = proxy->plane[0] + y * proxy->stride_bytes[0];

        for (int x = 0; x < proxy->width; x++, at += 3) {
            const uint8_t *const pixel = find_upright_pixel(d->samples, x, y);
            double rgb[3] = {0, 0, 0};

            if (pixel)
                decode_pixel_light(d, pixel, false, rgb);
            for (int c = 0; c < 3; c++) {
                const double light = rgb[c] / white;

                at[c] = !(light > 0)
                            ? 0
                            : codes[(int)(fmin(light, 1) * (STEPS - 1) + 0.5)];
            }
        }
    }
}

enum glint_status glint_samples_make_proxy(const struct glint_samples *samples,
                                           struct glint_image *proxy,
                                           double *white)
{
    struct glint_image made = {.format = GLINT_RGB24,
                               .width = glint_samples_get_width(samples),
                               .height = glint_samples_get_height(samples),
                               .range = GLINT_RANGE_FULL,
                               .transfer = GLINT_TONE_SRGB};
    uint8_t *const mem =
        malloc(glint_image_bytes(GLINT_RGB24, made.width, made.height));
    uint8_t *const codes = fill_proxy_code_table();
    struct decoder d;

    if (!mem || !codes) {
        free(mem);
        free(codes);
        return GLINT_E_MEMORY;
    }
    glint_image_place(&made, mem);
    open_sample_decoder(&d, samples);
    *white = find_white_level(&d);
    fill_proxy_pixels(&d, &made, *white, codes);
    close_sample_decoder(&d);
    free(codes);
    *proxy = made;
    return GLINT_OK;
}

/* ------------------------------------------------------------------ adding */

static void add_light_to_channel(const struct decoder *d, int c, uint8_t *pixel,
                                 double light)
{
    const struct glint_samples *const s = d->samples;
    const struct glint_sample_place *const at = &s->colour[c];
    const struct glint_tone_curve *const transfer = &s->colours.transfer[c];
    const double sum = decode_channel_to_light(d, c, pixel) + light;
    uint32_t code, lit;

    if (!(light > 0) || !isfinite(sum))
        return;
    if (glint_sample_is_float(at->sample)) {
        write_float_sample(at, pixel, glint_tone_curve_encode(transfer, sum));
        return;
    }
    code = read_integer_sample(at, pixel);
    lit = (uint32_t)(fmin(glint_tone_curve_encode(transfer, sum), 1) *
                         s->maximum +
                     0.5);
    if (lit > code)
        write_integer_sample(at, pixel, lit);
}

static void add_light_to_pixel(const struct decoder *d, uint8_t *pixel,
                               const float *layer)
{
    const struct glint_samples *const s = d->samples;
    const double light[3] = {(double)layer[0], (double)layer[1],
                             (double)layer[2]};
    double own[3];

    if (s->n_colours == 1) {
        add_light_to_channel(d, 0, pixel,
                             0.2126 * light[0] + 0.7152 * light[1] +
                                 0.0722 * light[2]);
        return;
    }
    multiply_matrix(s->colours.from_bt709, light, own);
    for (int c = 0; c < 3; c++)
        add_light_to_channel(d, c, pixel, own[c]);
}

void glint_samples_add_light(struct glint_samples *samples, const float *layer)
{
    const int width = glint_samples_get_width(samples);
    const int height = glint_samples_get_height(samples);
    struct decoder d;

    open_sample_decoder(&d, samples);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, layer += 3) {
            const bool lit = layer[0] > 0 || layer[1] > 0 || layer[2] > 0;
            uint8_t *const pixel =
                lit ? find_upright_pixel(samples, x, y) : NULL;

            if (pixel)
                add_light_to_pixel(&d, pixel, layer);
        }
    close_sample_decoder(&d);
}

/* Sets the colours of PIXEL to RGB / SHARE, linear light. SHARE: alpha of
 * straight colours, else 1. */
static void write_light_to_pixel(const struct glint_samples *s, uint8_t *pixel,
                                 const double rgb[3], double share)
{
    double own[3] = {0, 0, 0};

    multiply_matrix(s->colours.from_bt709, rgb, own);
    if (s->n_colours == 1)
        own[0] = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    for (int c = 0; c < s->n_colours && c < 3; c++)
        write_scaled_sample(
            &s->colour[c], s->maximum, pixel,
            glint_tone_curve_encode(&s->colours.transfer[c], own[c] / share));
}

void glint_samples_set_pixel(struct glint_samples *samples, int x, int y,
                             const double rgb[3], double cover)
{
    uint8_t *const pixel = find_upright_pixel(samples, x, y);
    double alpha;

    if (!pixel)
        return;
    alpha = 1 - (1 - read_pixel_alpha(samples, pixel)) * (1 - cover);
    write_light_to_pixel(samples, pixel, rgb,
                         samples->is_premultiplied || !(alpha > 0) ? 1 : alpha);
    if (samples->has_alpha)
        write_scaled_sample(&samples->alpha,
                            get_max_sample_code(samples->alpha.sample), pixel,
                            alpha);
}

/* -------------------------------------------------------------- converting */

static void convert_pixel(const struct glint_samples *to, uint8_t *dst,
                          const struct decoder *from, const uint8_t *src)
{
    const bool straight = to->has_alpha && !to->is_premultiplied;
    double rgb[3] = {0, 0, 0};

    if (src)
        decode_pixel_light(from, src, straight, rgb);
    write_light_to_pixel(to, dst, rgb, 1);
    if (to->has_alpha)
        write_scaled_sample(&to->alpha, get_max_sample_code(to->alpha.sample),
                            dst,
                            src ? read_pixel_alpha(from->samples, src) : 0);
}

void glint_samples_convert(struct glint_samples *to,
                           const struct glint_samples *from)
{
    struct decoder d;
    uint8_t *dst = to->mem;

    open_sample_decoder(&d, from);
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++, dst += to->pixel_bytes)
            convert_pixel(to, dst, &d, find_upright_pixel(from, x, y));
    close_sample_decoder(&d);
}
