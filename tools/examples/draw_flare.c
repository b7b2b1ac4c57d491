/* SPDX-License-Identifier: MIT
 *
 * draw_flare MODEL IN.ppm X Y STOPS >OUT.ppm - the ghosts of a white lamp at a
 * pixel, so many stops brighter than white. Links of glint what draws a flare
 * of a model into 8-bit pictures, by edges.
 */
#include <math.h>

#include "glint/flare.h"
#include "glint/kernels.h"
#include "model.h"
#include "ppm.h"

enum { WAVES = 3 };

static struct glint_real real_of(double x)
{
    int exponent;
    const double mantissa = frexp(x, &exponent);

    return (struct glint_real){(int32_t)(mantissa * 0x1p31), exponent - 31};
}

static double value_of(struct glint_real x)
{
    return ldexp(x.mantissa, x.exponent);
}

static int32_t q30(double x)
{
    return (int32_t)lrint(x * 0x1p30);
}

/* Red, green and blue, each a wavelength, measured by their direct images. */
static void set_waves(const struct glint_model_header *h,
                      struct glint_wave *wave)
{
    static const double wavelength_um[WAVES] = {0.650, 0.532, 0.450};

    for (int i = 0; i < WAVES; i++) {
        const double wave_q24 = 0x1p24 / (wavelength_um[i] * wavelength_um[i]);
        const double lo = h->wave_lo_q24, hi = h->wave_hi_q24;
        const double w = (2 * wave_q24 - lo - hi) / fmax(1, hi - lo);
        double flux = 0;

        for (int k = 5; k >= 0; k--)
            flux = flux * fmax(-1, fmin(1, w)) + value_of(h->direct_flux[k]);
        wave[i] =
            (struct glint_wave){.wave_q24 = (int32_t)lrint(wave_q24),
                                .weight = real_of(flux > 0 ? 1 / flux : 0)};
        wave[i].rgb_q14[i] = 1 << 14;
    }
}

static double pixels_per_mm(const struct glint_model_header *h,
                            const struct glint_image *image)
{
    return fmax(image->width / value_of(h->film_width_mm),
                image->height / value_of(h->film_height_mm));
}

/* A lamp that is seen at (X, Y). */
static struct glint_light light_at(const struct glint_model_header *h,
                                   const struct glint_image *image, int x,
                                   int y, double power)
{
    const double dx = x + 0.5 - image->width / 2.0;
    const double dy = image->height / 2.0 - y - 0.5;
    const double r = hypot(dx, dy), azimuth = atan2(dy, dx);
    const double angle =
        atan(r / pixels_per_mm(h, image) / value_of(h->focal_mm));

    return (struct glint_light){.sine_q30 = q30(sin(angle)),
                                .cosine_q30 = q30(cos(angle)),
                                .cos_q30 = q30(cos(azimuth)),
                                .sin_q30 = q30(sin(azimuth)),
                                .power = real_of(power),
                                .rgb_q14 = {1 << 14, 1 << 14, 1 << 14}};
}

static int draw(const struct glint_lens *lens, const struct glint_image *image,
                const struct glint_light *light)
{
    struct glint_wave wave[WAVES];
    struct glint_flare_config config;
    struct glint_flare_frame frame;
    struct glint_flare_stats stats;
    struct glint_flare *flare;
    size_t bytes;
    void *mem;

    glint_flare_defaults(&config, image->width, image->height);
    glint_flare_capacities(&config, lens, 1, WAVES);
    config.sets = glint_sets_here();
    glint_flare_frame_defaults(&frame, lens);
    frame.wave = wave;
    frame.n_waves = WAVES;
    frame.pixels_per_mm = real_of(pixels_per_mm(lens->header, image));
    bytes = glint_flare_bytes(&config);
    if (posix_memalign(&mem, 64, bytes) != 0) {
        fprintf(stderr, "out of memory\n");
        return 1;
    }
    set_waves(lens->header, wave);
    if (glint_flare_init(&flare, &config, mem, bytes) != GLINT_OK) {
        fprintf(stderr, "a picture of this size cannot be drawn\n");
        free(mem);
        return 1;
    }
    glint_flare_plan(flare, &frame, light, 1);
    glint_flare_bin(flare, &stats);
    glint_flare_draw(flare, image);
    free(mem);
    return 0;
}

int main(int argc, char **argv)
{
    struct glint_lens lens;
    struct glint_image image;
    void *model;
    int code;

    if (argc != 6 || !(fabs(atof(argv[5])) <= 60)) {
        fprintf(stderr, "draw_flare MODEL IN.ppm X Y STOPS >OUT.ppm\n");
        return 2;
    }
    model = model_read(argv[1], &lens);
    if (!model)
        return 5;
    code = ppm_read(argv[2], &image);
    if (code == 0) {
        const struct glint_light light =
            light_at(lens.header, &image, atoi(argv[3]), atoi(argv[4]),
                     exp2(atof(argv[5])));

        code = draw(&lens, &image, &light);
        if (code == 0)
            code = ppm_write(&image);
        free(image.plane[0]);
    }
    free(model);
    return code;
}
