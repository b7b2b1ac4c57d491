/* SPDX-License-Identifier: MIT
 *
 * power_table [PANORAMA.pfm ...] - prints the data to which tests/power-fit
 * fits the power of clipped lamps. Each line describes one image of a clipped
 * lamp: its group, true power, visible light, light of the clipped core, and
 * features.
 *
 * Lamps are rendered or cut from HDR panoramas. Each is exposed ten times, at
 * exposures that are halved from image to image. Images have 8-bit codes, but
 * every fourth one is RGB565. The lamp finder measures the lamp in each. Every
 * second lamp and panorama is held out for validation.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/picture.h"
#include "lamps/profile.h"
#include "lamps/unclip.h"
#include "glint/glint.h"
#include "support/power_picture.h"
#include "support/rng.h"

enum {
    EXPOSURES = 10,
    LAMPS = 720,
    VIEWS = 48,
    PANORAMA = 10000, /* group number of the first panorama */
    MAX_SPOTS = 64
};

/* -------------------------------------------------------- simulated camera */

struct camera {
    /* image: the camera's image as RGB24; coarse: the same image as RGB565 */
    struct glint_image image, coarse;
    /* the image that the finder receives: image or coarse */
    const struct glint_image *seen;
    struct glint_lamp_finder *finder;
    struct glint_profile *profile;
    struct glint_spot spot[MAX_SPOTS];
    int n;
    void *mem[2];
    uint8_t *mask;
    int *stack;
};

static void open_simulated_camera(struct camera *c, int width, int height)
{
    struct glint_lamp_finder_config cfg;
    size_t bytes;

    glint_lamp_finder_defaults(&cfg, width, height);
    bytes = glint_lamp_finder_bytes(&cfg);
    c->image = (struct glint_image){
        .format = GLINT_RGB24, .width = width, .height = height};
    glint_image_place(&c->image, malloc((size_t)(3 * width * height)));
    c->coarse = c->image;
    c->coarse.format = GLINT_RGB565;
    glint_image_place(&c->coarse, malloc((size_t)(2 * width * height)));
    c->mask = malloc((size_t)(width * height));
    c->stack = malloc(sizeof *c->stack * (size_t)(width * height));
    if (posix_memalign(&c->mem[0], 64, bytes) ||
        posix_memalign(&c->mem[1], 64, glint_profile_bytes()) ||
        glint_lamp_finder_init(&c->finder, &cfg, c->mem[0], bytes) ||
        glint_profile_init(&c->profile, c->mem[1], glint_profile_bytes()))
        exit(1);
}

static void close_simulated_camera(struct camera *c)
{
    free(c->image.plane[0]);
    free(c->coarse.plane[0]);
    free(c->mem[0]);
    free(c->mem[1]);
    free(c->mask);
    free(c->stack);
}

static int is_bright_pixel(const struct camera *c, int i)
{
    const uint8_t *px = c->image.plane[0] + 3 * i;

    return px[0] >= 240 || px[1] >= 240 || px[2] >= 240;
}

/* Multiplies SCENE by GAIN and measures the bright region connected to pixel
 * (CX, CY). Returns the sum of its luminance; sets SPOT to the values that an
 * ideal lamp finder would report. */
static double measure_bright_region(struct camera *c,
                                    const struct power_picture *scene,
                                    double gain, int cx, int cy,
                                    struct glint_spot *spot)
{
    static const double weight[3] = {0.2126, 0.7152, 0.0722};
    const int width = c->image.width, height = c->image.height;
    double light = 0, sx = 0, sy = 0, s2 = 0;
    int n = 0, area = 0;

    memset(c->mask, 0, (size_t)(width * height));
    for (int dy = -3; dy <= 3; dy++)
        for (int dx = -3; dx <= 3; dx++) {
            const int x = cx + dx, y = cy + dy;

            if (x >= 0 && y >= 0 && x < width && y < height &&
                is_bright_pixel(c, y * width + x)) {
                c->mask[y * width + x] = 1;
                c->stack[n++] = y * width + x;
            }
        }
    while (n > 0) {
        const int i = c->stack[--n];

        area++;
        sx += i % width;
        sy += (double)(i / width);
        s2 += (double)(i % width) * (i % width) +
              (double)(i / width) * (i / width);
        for (int k = 0; k < 3; k++)
            light += weight[k] * gain * (double)scene->rgb[3 * i + k];
        for (int k = 0; k < 9; k++) {
            const int x = i % width + k % 3 - 1, y = i / width + k / 3 - 1;

            if (x < 0 || y < 0 || x >= width || y >= height ||
                c->mask[y * width + x] || !is_bright_pixel(c, y * width + x))
                continue;
            c->mask[y * width + x] = 1;
            c->stack[n++] = y * width + x;
        }
    }
    if (area) {
        sx /= area;
        sy /= area;
        s2 = s2 / area - sx * sx - sy * sy;
        *spot = (struct glint_spot){.x_q8 = (int)(256 * (sx + 0.5)),
                                    .y_q8 = (int)(256 * (sy + 0.5)),
                                    .size_q8 = (int)(256 * sqrt(fmax(s2, 0))),
                                    .area = area,
                                    .rgb_q15 = {32768, 32768, 32768}};
    }
    return area ? light : 0;
}

/* Returns the position of SPOT among all spots of the image, counted from left
 * to right. */
static int find_spot_rank(const struct camera *c, const struct glint_spot *spot)
{
    int i = 0;

    while (&c->spot[c->profile->rings.by_x[i]] != spot)
        i++;
    return i;
}

static void print_spot_features(struct camera *c, int id, double power,
                                const struct glint_spot *spot)
{
    struct glint_profile_sums sums;
    int32_t feature_q16[GLINT_UNCLIP_FEATURES];
    int64_t seen_q16, core_q16;

    glint_rings_sum_spot_light(&sums, &c->profile->rings, c->spot, c->n,
                               find_spot_rank(c, spot));
    glint_unclip_compute_shown_light(&seen_q16, &core_q16, spot, &sums);
    glint_unclip_compute_features(feature_q16, spot, &sums);
    printf("%d %.6g %.6g %.6g", id, power, (double)seen_q16 / 65536,
           (double)core_q16 / 65536);
    for (int i = 0; i < GLINT_UNCLIP_FEATURES; i++)
        printf(" %.4f", feature_q16[i] / 65536.0);
    printf("\n");
}

/* Renders SCENE, multiplied by GAIN, as the camera's image, with noise of
 * standard deviation SIGMA codes. If the image number K is a multiple of 4, the
 * image is RGB565. */
static void render_camera_image(struct camera *c,
                                const struct power_picture *scene, double gain,
                                double sigma, int k, uint32_t *seed)
{
    uint8_t *px = c->image.plane[0], *to = c->coarse.plane[0];

    power_expose_codes(px, scene, gain, sigma, seed);
    c->seen = &c->image;
    if (k % 4 != 3)
        return;
    c->seen = &c->coarse;
    for (int i = 0; i < scene->width * scene->height; i++) {
        const int bits =
            px[3 * i] >> 3 << 11 | px[3 * i + 1] >> 2 << 5 | px[3 * i + 2] >> 3;

        to[2 * i] = (uint8_t)(bits & 255);
        to[2 * i + 1] = (uint8_t)(bits >> 8);
    }
}

/* ---------------------------------------------------------- rendered lamps */

static double random_number_between(double low, double high, uint32_t *seed)
{
    return low + (high - low) * rng_unit(seed);
}

/* Sets RGB to the colour of a random lamp, luminance 1: white, tungsten,
 * sodium, blue, warm white or green. */
static void choose_random_lamp_colour(double *rgb, uint32_t *seed)
{
    static const double colours[6][3] = {{1, 1, 1},      {1, 0.55, 0.18},
                                         {1, 0.4, 0.02}, {0.35, 0.55, 1},
                                         {1, 0.82, 0.6}, {0.15, 1, 0.35}};
    const double *from = colours[(int)(6 * rng_unit(seed))];
    double y;

    for (int i = 0; i < 3; i++)
        rgb[i] = from[i] * random_number_between(0.9, 1.1, seed);
    y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    for (int i = 0; i < 3; i++)
        rgb[i] /= y;
}

static struct power_lamp make_random_lamp(int i, int width, int height,
                                          uint32_t *seed)
{
    struct power_lamp l = {.shape = (enum power_shape)(i % POWER_SHAPES)};

    l.radius = 0.3 * pow(100, rng_unit(seed));
    l.x = width / 2 + random_number_between(-1, 1, seed);
    l.y = height / 2 + random_number_between(-1, 1, seed);
    l.angle = random_number_between(0, 3.14, seed);
    l.sigma = random_number_between(0.5, 1.3, seed);
    l.glare = 0.01 * pow(8, rng_unit(seed));
    l.reach = random_number_between(1, 3, seed);
    l.fall = random_number_between(2.3, 3.3, seed);
    choose_random_lamp_colour(l.rgb, seed);
    return l;
}

static int is_validation_sample(int i)
{
    return (i / 4 + i) & 1;
}

static void print_rendered_lamps(int i)
{
    enum { W = 288, H = 224 };
    struct power_picture scene = {W, H, malloc(sizeof(double) * 3 * W * H)};
    double *light = malloc(sizeof *light * W * H);
    uint32_t seed = (uint32_t)i * 7919 + 17;
    struct camera c;
    struct power_lamp lamp;
    double power, black, slope, noise;

    for (int k = 0; k < 5; k++)
        rng_unit(&seed);
    lamp = make_random_lamp(i, W, H, &seed);
    power = exp2(random_number_between(9, 16, &seed));
    black = i % 4 == 3 ? random_number_between(0.1, 0.6, &seed)
                       : 0.001 * pow(50, rng_unit(&seed));
    slope = random_number_between(0, 0.6, &seed);
    noise = random_number_between(0, 3, &seed);
    power_draw_lamp(light, W, H, &lamp);
    open_simulated_camera(&c, W, H);
    for (int k = 0; k < EXPOSURES; k++) {
        const double gain = exp2(-k - rng_unit(&seed));

        /* The gain changes only the lamp, not the background, so that lamps by
         * day and by night are included. */
        for (int p = 0; p < W * H; p++)
            for (int j = 0; j < 3; j++)
                scene.rgb[3 * p + j] =
                    ((double)light[p] * power * lamp.rgb[j] * gain +
                     black * (1 + slope * (p % W - W / 2) / W));
        render_camera_image(&c, &scene, 1, noise, k, &seed);
        if (measure_bright_region(&c, &scene, 1, (int)lamp.x, (int)lamp.y,
                                  c.spot) > 0 &&
            c.spot->area >= 2 && c.spot->area < W * H / 5) {
            c.n = 1;
            glint_profile_measure(c.profile, c.seen, c.spot, c.n);
            print_spot_features(&c, i, power * gain, c.spot);
        }
    }
    close_simulated_camera(&c);
    free(light);
    free(scene.rgb);
}

/* ---------------------------------------------------------------- panoramas */

static void cut_panorama_view(struct power_picture *s,
                              const struct glint_float_image *p, double yaw,
                              double pitch)
{
    const double half = tan(30 * 3.14159265 / 180), pi = 3.14159265358979;

    for (int i = 0; i < s->width * s->height; i++) {
        const double u = half * (2 * (i % s->width + 0.5) / s->width - 1);
        const double v =
            half * ((i / s->width + 0.5) * 2 - s->height) / s->width;
        const double z = cos(pitch) + v * sin(pitch);
        const double up = sin(pitch) - v * cos(pitch);
        const double lon = yaw + atan2(u, z), lat = atan2(up, hypot(u, z));
        const double x = (lon / (2 * pi) + 3) * p->width - 0.5;
        const double y = fmin(fmax((0.5 - lat / pi) * p->height - 0.5, 0),
                              p->height - 1.001);
        const int x0 = (int)x, y0 = (int)y;

        for (int c = 0; c < 3; c++) {
            double sum = 0;

            for (int k = 0; k < 4; k++)
                sum += (double)p->rgb[3 * ((y0 + k / 2) * p->width +
                                           (x0 + k % 2) % p->width) +
                                      c] *
                       (k % 2 ? x - x0 : 1 - x + x0) *
                       (k / 2 ? y - y0 : 1 - y + y0);
            s->rgb[3 * i + c] = sum;
        }
    }
}

static double compute_mean(const struct power_picture *s)
{
    double sum = 0;

    for (int i = 0; i < 3 * s->width * s->height; i++)
        sum += fmin(s->rgb[i], 4);
    return sum / (3 * s->width * s->height);
}

/* Applies a random lens to the image: pixels brighter than OVER produce
 * glare. */
static void apply_random_lens(struct power_picture *s, double over,
                              uint32_t *seed)
{
    const int n = s->width * s->height;
    double *light = malloc(sizeof *light * (size_t)n);
    const struct power_lamp lens =
        make_random_lamp(0, s->width, s->height, seed);

    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < n; i++)
            light[i] = s->rgb[3 * i + c];
        power_apply_lens(light, s->width, s->height, &lens, over);
        for (int i = 0; i < n; i++)
            s->rgb[3 * i + c] = light[i];
    }
    free(light);
}

/* Renders one view of panorama P at all exposures and prints the lamps found.
 * Their true power is the light that enters the lens, without glare. */
static void print_view_lamps(const struct glint_float_image *p, int id,
                             double yaw, double pitch)
{
    const int width = p->width * 2 / 9, height = width * 9 / 16;
    const size_t bytes = sizeof(double) * 3 * (size_t)(width * height);
    struct power_picture scene = {width, height, malloc(bytes)};
    struct power_picture truth = {width, height, malloc(bytes)};
    uint32_t seed = 99u + (uint32_t)id * 31;
    struct camera c;
    double base;

    cut_panorama_view(&scene, p, yaw, pitch);
    memcpy(truth.rgb, scene.rgb, bytes);
    base = 0.7 / fmax(compute_mean(&scene), 1e-4);
    apply_random_lens(&scene, 8 / base, &seed);
    open_simulated_camera(&c, width, height);
    for (int k = 0; k < EXPOSURES; k++) {
        const double gain = base * exp2(-k);

        render_camera_image(&c, &scene, gain,
                            random_number_between(0, 3, &seed), k, &seed);
        c.n = glint_lamp_finder_find(c.finder, c.seen, c.spot, MAX_SPOTS);
        glint_profile_measure(c.profile, c.seen, c.spot, c.n);
        for (int i = 0; i < c.n; i++) {
            struct glint_spot ideal;
            const double power =
                measure_bright_region(&c, &truth, gain, c.spot[i].x_q8 >> 8,
                                      c.spot[i].y_q8 >> 8, &ideal);

            if (power > 0 && !c.spot[i].faint)
                print_spot_features(&c, PANORAMA + id / 100, power, &c.spot[i]);
        }
    }
    close_simulated_camera(&c);
    free(scene.rgb);
    free(truth.rgb);
}

static void print_panorama_lamps(const char *path, int id)
{
    struct glint_float_image p = {0};
    struct glint_error error = {""};

    if (glint_picture_load_float(path, &p, &error) != GLINT_OK) {
        fprintf(stderr, "power_table: %s\n", error.text);
        return;
    }
    for (int i = 0; i < 3 * p.width * p.height; i++)
        if (!(p.rgb[i] > 0))
            p.rgb[i] = 0;
    for (int k = 0; k < VIEWS; k++)
        print_view_lamps(&p, 100 * id + k,
                         (k % 8 + k / 16 / 3.0) * 3.14159265 / 4,
                         (k / 8 % 2 - 0.3) * 0.6);
    free(p.rgb);
}

int main(int argc, char **argv)
{
    for (int i = 0; i < LAMPS; i++)
        if (!is_validation_sample(i))
            print_rendered_lamps(i);
    for (int i = 2; i < argc; i += 2)
        print_panorama_lamps(argv[i], i);
    return 0;
}
