/* SPDX-License-Identifier: MIT
 *
 * star_table [--svg FILE] - prints what stars of 1920x1080 pixels are held to,
 * as Markdown tables: number of spikes, first dark ring, energy, PSNR against
 * direct summation, motion, rotation, bytes.
 *
 * Direct summation is this program's own: the transform of a polygon as a sum
 * over its corners, of a circle by Bessel's function of libm, 48 wavelengths
 * and 4 to 1024 points a pixel. FILE receives plots of how the light of a star
 * changes as it moves, and of drawn over direct light by distance.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/setup/spectrum.h"
#include "engine/star/star_tables.h"
#include "glint/flare.h"
#include "glint/view.h"
#include "lab/plots/plot.h"
#include "star/starburst.h"
#include "support/stars/canvas.h"

enum { WIDTH = 1920, HEIGHT = 1080, N = WIDTH * HEIGHT, WAVES = 48 };

double j1(double x); /* POSIX; no part of C99 */

/* What a frame of a video leaves out at default quality: light of a quarter of
 * a code of 8 bits. */
static const double faintest = 0.25 / 255 / 12.92;

static const double at_x = 960.3, at_y = 540.6;

static struct glint_flare *flare;
static struct glint_star *star;
static int32_t linear_q20[3 * N];
static uint8_t codes[3 * N];
static float direct[N][3];

struct stop {
    int n_blades;
    double rotation_deg, airy_px;
};

/* ----------------------------------------------------------------- drawing */

static void *take(size_t bytes)
{
    void *mem = NULL;

    if (bytes == 0 || posix_memalign(&mem, 64, bytes) != 0) {
        fputs("star_table: no memory\n", stderr);
        exit(1);
    }
    return mem;
}

static void open_canvas(void)
{
    const struct glint_star_config c = {1, WIDTH, HEIGHT, 1};
    struct glint_flare_config cfg;
    size_t bytes;

    glint_flare_defaults(&cfg, WIDTH, HEIGHT);
    cfg.max_bundles = cfg.max_primitives = cfg.max_refs = 1;
    bytes = glint_flare_bytes(&cfg);
    if (glint_flare_init(&flare, &cfg, take(bytes), bytes) != GLINT_OK)
        exit(1);
    bytes = glint_star_bytes(&c);
    if (glint_star_init(&star, &c, take(bytes), bytes) != GLINT_OK)
        exit(1);
}

static struct glint_star_tables *tables_of(struct stop s)
{
    const struct glint_star_optics o = {.n_blades = s.n_blades,
                                        .rotation_deg = s.rotation_deg,
                                        .f_number = s.airy_px / 0.55,
                                        .pixel_um = 1};
    struct glint_star_tables *t;

    if (glint_star_tables_make(&t, &o) != GLINT_OK)
        exit(1);
    return t;
}

/* Draws a white light of 2^POWER_LOG2 at (X, Y) into MEM, light below LEAST
 * left out. */
static void draw(const struct glint_star_tables *t, double x, double y,
                 double power_log2, double least,
                 enum glint_pixel_format format, void *mem)
{
    const struct glint_star_light light = {.x_q8 = (int32_t)lrint(256 * x),
                                           .y_q8 = (int32_t)lrint(256 * y),
                                           .radius_q8 = -1,
                                           .power =
                                               glint_real_of(exp2(power_log2)),
                                           .rgb_q14 = {16384, 16384, 16384}};
    struct glint_image image = {
        .format = format, .width = WIDTH, .height = HEIGHT};

    memset(mem, 0, glint_image_bytes(format, WIDTH, HEIGHT));
    glint_image_place(&image, mem);
    glint_star_set(star, t, &light, 1, glint_real_of(least));
    glint_star_draw(star, flare, &image);
}

static double at(double x, double y)
{
    return star_canvas_green(linear_q20, WIDTH, x, y);
}

static double sum_of(int c)
{
    double sum = 0;

    for (int i = c; i < 3 * N; i += 3)
        sum += linear_q20[i] * 0x1p-20;
    return sum;
}

/* ------------------------------------------------------------------- shape */

/* Returns how many peaks above twice the mean there are on a circle of RADIUS
 * pixels about the light. */
static int count_spikes(double radius)
{
    enum { STEPS = 3600 };
    double ring[STEPS], mean = 0;
    int n = 0, is_in = 0;

    for (int i = 0; i < STEPS; i++) {
        const double a = 2 * GLINT_PI * (i + 0.5) / STEPS;

        ring[i] = at(at_x + radius * cos(a), at_y + radius * sin(a));
        mean += ring[i] / STEPS;
    }
    for (int i = 0; i < 2 * STEPS; i++) {
        const int above = ring[i % STEPS] > 2 * mean;

        n += i >= STEPS && above && !is_in;
        is_in = above;
    }
    return n;
}

/* Returns the angle, degrees, of the brightest light on circles of 100 to 400
 * pixels near ANGLE_DEG, y up: the mean, weighted by light. */
static double spike_angle(double angle_deg)
{
    double sum = 0, turn = 0;

    for (double d = -5; d <= 5; d += 0.02) {
        const double a = (angle_deg + d) * GLINT_PI / 180;
        double light = 0;

        for (double r = 100; r < 400; r += 5)
            light += at(at_x + r * cos(a), at_y - r * sin(a));
        sum += light;
        turn += d * light;
    }
    return angle_deg + turn / sum;
}

static void print_shapes(void)
{
    static const int blades[] = {3, 5, 6, 7, 8, 9};

    puts("| blades | spikes | turn of a spike by 1 degree of rotation, degrees "
         "|\n|---|---|---|");
    for (int i = 0; i < 6; i++) {
        const int n = blades[i];
        double angle[2];
        int spikes = 0;

        for (int k = 0; k < 2; k++) {
            struct glint_star_tables *t =
                tables_of((struct stop){n, 20 + k, 0.65});

            draw(t, at_x, at_y, 16, 0, GLINT_LINEAR_Q20, linear_q20);
            spikes = count_spikes(300);
            angle[k] = spike_angle(20.5 + 180.0 / n);
            glint_star_tables_free(t);
        }
        printf("| %d | %d | %.3f |\n", n, spikes, angle[1] - angle[0]);
    }
}

static void print_ring(void)
{
    puts("\n| wavelength times f-number, px | first dark ring of a circle, px "
         "| over 1.22 of that |\n|---|---|---|");
    for (double airy = 3; airy < 13; airy *= 2) {
        struct glint_star_tables *t = tables_of((struct stop){0, 0, airy});
        double dark = 0, least = HUGE_VAL;

        draw(t, at_x, at_y, 10, 0, GLINT_LINEAR_Q20, linear_q20);
        for (double r = airy; r < 1.5 * airy; r += 0.002 * airy) {
            double here = 0;

            for (int i = 0; i < 256; i++)
                here += at(at_x + r * cos(2 * GLINT_PI * i / 256),
                           at_y + r * sin(2 * GLINT_PI * i / 256));
            dark = here < least ? r : dark;
            least = fmin(least, here);
        }
        printf("| %g | %.2f | %.3f |\n", airy, dark, dark / (1.22 * airy));
        glint_star_tables_free(t);
    }
}

/* ------------------------------------------------------------------ energy */

static double area_of(int n_blades)
{
    return n_blades ? 0.5 * n_blades * sin(2 * GLINT_PI / n_blades) : GLINT_PI;
}

/* Returns the share of light that falls beyond the sides of the picture: far
 * out light on a circle of radius r is perimeter / (pi area) times wavelength
 * times f-number over pi r, as if evenly spread over its angles. */
static double beyond(struct stop s)
{
    enum { STEPS = 3600 };
    const double perimeter =
        s.n_blades ? 2 * s.n_blades * sin(GLINT_PI / s.n_blades) : 2 * GLINT_PI;
    double sum = 0;

    for (int i = 0; i < STEPS; i++) {
        const double a = 2 * GLINT_PI * (i + 0.5) / STEPS;
        const double x = cos(a) > 0 ? WIDTH - at_x : at_x;
        const double y = sin(a) > 0 ? HEIGHT - at_y : at_y;

        sum += fmax(fabs(cos(a)) / x, fabs(sin(a)) / y) / STEPS;
    }
    return perimeter / area_of(s.n_blades) * s.airy_px / GLINT_PI / GLINT_PI *
           sum;
}

static void print_energy(void)
{
    static const int blades[] = {0, 5, 6, 8, 64};
    static const double airy_px[] = {0.03, 0.3, 0.65, 2.5};

    puts("\n| light of a star, with what falls beyond the picture | 0.03 px | "
         "0.3 px | 0.65 px | 2.5 px |\n|---|---|---|---|---|");
    for (int i = 0; i < 5; i++) {
        printf(blades[i] ? "| %d blades |" : "| circle |", blades[i]);
        for (int k = 0; k < 4; k++) {
            const struct stop s = {blades[i], 5, airy_px[k]};
            struct glint_star_tables *t = tables_of(s);

            draw(t, at_x, at_y, 10, 0, GLINT_LINEAR_Q20, linear_q20);
            printf(" %.4f |", sum_of(1) / 1024 + beyond(s));
            glint_star_tables_free(t);
        }
        puts("");
    }
}

/* -------------------------------------------------------- direct summation */

static double sinc(double x)
{
    const double t = GLINT_PI * x;

    return fabs(t) < 1e-6 ? 1 : sin(t) / t;
}

/* Returns |F(q)|^2 / A of a stop of radius 1: of a polygon, the sum over its
 * sides, from corner to corner, of the flux of exp(-2 pi i q p) q / |q|^2. */
static double transform(struct stop s, double qx, double qy)
{
    const double q2 = qx * qx + qy * qy;
    double re = 0, im = 0;

    if (q2 < 1e-14)
        return area_of(s.n_blades);
    if (s.n_blades == 0)
        return pow(j1(2 * GLINT_PI * sqrt(q2)), 2) / q2 / GLINT_PI;
    for (int i = 0; i < s.n_blades; i++) {
        const double step = 2 * GLINT_PI / s.n_blades;
        const double a = s.rotation_deg * (GLINT_PI / 180) + i * step;
        const double x0 = cos(a), y0 = sin(a);
        const double dx = cos(a + step) - x0, dy = sin(a + step) - y0;
        const double phase =
            2 * GLINT_PI * (qx * (x0 + 0.5 * dx) + qy * (y0 + 0.5 * dy));

        const double size = (qx * dy - qy * dx) * sinc(qx * dx + qy * dy);

        re += size * cos(phase);
        im += size * sin(phase);
    }
    return (re * re + im * im) / (4 * GLINT_PI * GLINT_PI * q2 * q2) /
           area_of(s.n_blades);
}

static double weight[WAVES][3];

static void set_weights(void)
{
    double sum[3] = {0, 0, 0};

    for (int i = 0; i < WAVES; i++) {
        glint_observer_rgb(400 + 300 * (i + 0.5) / WAVES, weight[i]);
        for (int c = 0; c < 3; c++)
            sum[c] += weight[i][c];
    }
    for (int i = 0; i < WAVES; i++)
        for (int c = 0; c < 3; c++)
            weight[i][c] /= sum[c];
}

/* Sets RGB to the light of the pixel at (X, Y) from the light, over POINTS^2
 * points in it. Wavelengths of each point lie elsewhere within their 48 parts
 * of the spectrum: far out fringes are so narrow that the same ones everywhere
 * would show rings of their own. */
static void sum_pixel(struct stop s, double x, double y, int points,
                      float rgb[3])
{
    double sum[3] = {0, 0, 0};

    for (int p = 0; p < points * points; p++) {
        const double px = x + (p % points + 0.5) / points - 0.5;
        const double py = y + (p / points + 0.5) / points - 0.5;
        const double off = 0.7548777 * x + 0.5698403 * y + 0.6180340 * p;

        for (int i = 0; i < WAVES; i++) {
            const double part = (i + off - floor(off)) / WAVES;
            const double a = s.airy_px * (400 + 300 * part) / 550;
            const double light =
                transform(s, px / (2 * a), -py / (2 * a)) / (4 * a * a);

            for (int c = 0; c < 3; c++)
                sum[c] += weight[i][c] * light;
        }
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sum[c] / (points * points));
}

/* Returns for how many pixels pixel I stands: farther out than 60 pixels one of
 * five is summed, and stands for five; 0: it is not summed. */
static int stands_for(int i)
{
    const int x = i % WIDTH, y = i / WIDTH;

    if (hypot(x + 0.5 - at_x, y + 0.5 - at_y) < 60)
        return 1;
    return (x + 2 * y) % 5 ? 0 : 5;
}

static void set_direct(struct stop s)
{
    for (int i = 0; i < N; i++) {
        const double x = i % WIDTH + 0.5 - at_x, y = i / WIDTH + 0.5 - at_y;
        const double r = hypot(x, y);

        if (stands_for(i))
            sum_pixel(s, x, y,
                      r < 2    ? 32
                      : r < 6  ? 8
                      : r < 40 ? 4
                               : 2,
                      direct[i]);
    }
}

static int code_of(double light)
{
    const double held = fmin(fmax(light, 0), 1);

    return (int)lrint(255 * (held <= 0.0031308
                                 ? 12.92 * held
                                 : 1.055 * pow(held, 1 / 2.4) - 0.055));
}

/* Prints the PSNR of the codes drawn of a light of 2^POWER_LOG2, over all
 * pixels and over those in which either has light, and the largest error. */
static void print_psnr(const struct glint_star_tables *t, double power_log2)
{
    double square = 0;
    int n_lit = 0, most = 0;

    draw(t, at_x, at_y, power_log2, faintest, GLINT_RGB24, codes);
    for (int i = 0; i < 3 * N; i++) {
        const int want =
            code_of((double)direct[i / 3][i % 3] * exp2(power_log2));
        const int off = abs(codes[i] - want), n = stands_for(i / 3);

        if (n == 0)
            continue;
        square += n * off * off;
        n_lit += codes[i] > 0 || want > 0 ? n : 0;
        most = off > most ? off : most;
    }
    printf(" %.1f | %.1f | %d |", 10 * log10(255. * 255 * 3 * N / square),
           10 * log10(255. * 255 * n_lit / square), most);
}

/* --------------------------------------------------------------------- ... */

enum { BANDS = 30, FRAMES = 200 };
struct curve {
    const char *words;
    double ratio[BANDS]; /* by distance, half an octave each from 1.4 px on */
    double light[FRAMES];
};

static double band_px(int i)
{
    return exp2(0.5 + i / 3.0);
}

/* Sets the ratio of drawn to direct light in bands of distance: near the light
 * of a power of 2^20, farther out of 2^26, as 2^-20 is the least light. */
static void set_ratios(const struct glint_star_tables *t, struct curve *to)
{
    for (int far = 0; far < 2; far++) {
        double drawn[BANDS] = {0}, sum[BANDS] = {0};

        draw(t, at_x, at_y, far ? 26 : 20, 0, GLINT_LINEAR_Q20, linear_q20);
        for (int i = 0; i < N; i++) {
            const double x = i % WIDTH + 0.5 - at_x, y = i / WIDTH + 0.5 - at_y;
            const int band = (int)floor(3 * (log2(hypot(x, y)) - 0.5) + 0.5);

            if (band < 0 || band >= BANDS || !stands_for(i) ||
                linear_q20[3 * i + 1] == INT32_MAX)
                continue;
            drawn[band] += linear_q20[3 * i + 1] * (far ? 0x1p-46 : 0x1p-40);
            sum[band] += (double)direct[i][1];
        }
        for (int i = far ? BANDS / 2 : 0; i < BANDS; i++)
            to->ratio[i] = sum[i] > 0 ? drawn[i] / sum[i] : (double)NAN;
    }
}

static void print_direct(struct curve curve[3])
{
    static const struct stop stop[] = {{8, 10, 0.65}, {5, 7, 0.9}, {0, 0, 0.3}};
    static const char *const words[] = {"8 blades, 0.65 px", "5 blades, 0.9 px",
                                        "circle, 0.3 px"};

    puts("\n| PSNR against direct summation, dB: all pixels, those with light; "
         "largest error, codes | 2^4 | | | 2^8 | | | 2^12 | | "
         "|\n|---|---|---|---|---|---|---|---|---|---|");
    for (int s = 0; s < 3; s++) {
        struct glint_star_tables *t = tables_of(stop[s]);

        set_direct(stop[s]);
        printf("| %s |", words[s]);
        for (int p = 4; p <= 12; p += 4)
            print_psnr(t, p);
        puts("");
        curve[s].words = words[s];
        set_ratios(t, &curve[s]);
        glint_star_tables_free(t);
    }
    puts(
        "\n| drawn over direct light by distance, px | 1.4 .. 4 | 4 .. 11 | 11 "
        ".. 32 | 32 .. 90 | 90 .. 260 | 260 .. 1100 |\n|---|---|---|---|---|---"
        "|---|");
    for (int s = 0; s < 3; s++) {
        printf("| %s |", words[s]);
        for (int b = 0; b < 6; b++) {
            double low = 2, high = 0;

            for (int i = 5 * b; i < 5 * b + 5; i++) {
                low = fmin(low, curve[s].ratio[i]);
                high = fmax(high, curve[s].ratio[i]);
            }
            printf(" %.3f .. %.3f |", low, high);
        }
        puts("");
    }
}

/* ------------------------------------------------------------------ motion */

/* Moves a star by 0.05 px a frame and notes the sum of its light, over the mean
 * of all frames. */
static void print_motion(struct curve curve[3])
{
    static const struct stop stop[] = {{8, 10, 0.65}, {5, 7, 0.2}, {0, 0, 0.3}};

    puts("\n| moved by 0.05 px a frame, 200 frames | least light | most | "
         "largest step |\n|---|---|---|---|");
    for (int s = 0; s < 3; s++) {
        struct glint_star_tables *t = tables_of(stop[s]);
        double least = 2, most = 0, mean = 0, step = 0, *light = curve[s].light;

        for (int i = 0; i < FRAMES; i++) {
            draw(t, at_x + 0.05 * i, at_y + 0.013 * i, 10, faintest,
                 GLINT_LINEAR_Q20, linear_q20);
            light[i] = sum_of(1);
            mean += light[i] / FRAMES;
        }
        for (int i = 0; i < FRAMES; i++) {
            light[i] /= mean;
            least = fmin(least, light[i]);
            most = fmax(most, light[i]);
            step = i ? fmax(step, fabs(light[i] - light[i - 1])) : step;
        }
        printf("| %d blades, %g px | %.4f | %.4f | %.5f |\n", stop[s].n_blades,
               stop[s].airy_px, least, most, step);
        glint_star_tables_free(t);
    }
}

static void plot_curves(FILE *file, const struct curve curve[3])
{
    struct plot light, ratio;

    plot_open(file, 2);
    plot_init(&light, file, 0, "A star that moves by 0.05 px a frame");
    plot_init(&ratio, file, 1, "Drawn over direct light");
    light.x.words = "frame";
    light.y.words = "light over its mean";
    ratio.x.words = "distance, px";
    ratio.x.is_log = true;
    ratio.y.words = "drawn over direct, in rings";
    light.y.least_span = 0.004;
    light.x.lo = light.y.lo = ratio.x.lo = ratio.y.lo = 1;
    light.x.hi = light.y.hi = ratio.x.hi = ratio.y.hi = 0;
    for (int s = 0; s < 3; s++) {
        for (int i = 0; i < FRAMES; i++)
            plot_stretch(&light, i, curve[s].light[i]);
        for (int i = 0; i < BANDS; i++)
            plot_stretch(&ratio, band_px(i), curve[s].ratio[i]);
    }
    plot_frame(&light);
    plot_frame(&ratio);
    for (int s = 0; s < 3; s++) {
        for (int i = 1; i < FRAMES; i++)
            plot_line(&light, i - 1, curve[s].light[i - 1], i,
                      curve[s].light[i], plot_colour(s), true);
        for (int i = 1; i < BANDS; i++)
            if (isfinite(curve[s].ratio[i - 1]) && isfinite(curve[s].ratio[i]))
                plot_line(&ratio, band_px(i - 1), curve[s].ratio[i - 1],
                          band_px(i), curve[s].ratio[i], plot_colour(s), true);
        plot_key(&ratio, 'o', plot_colour(s), curve[s].words);
    }
    plot_close(file);
}

static void print_bytes(void)
{
    const struct glint_star_config one = {1, WIDTH, HEIGHT, 1};
    const struct glint_star_config many = {1, WIDTH, HEIGHT, 128};

    puts("\n| bytes of tables | circle | 5 blades | 8 blades | 64 blades "
         "|\n|---|---|---|---|---|");
    printf("| |");
    for (int n = 0; n <= 64; n = n == 0 ? 5 : n == 5 ? 8 : n == 8 ? 64 : 65) {
        struct glint_star_tables *t = tables_of((struct stop){n, 0, 0.5});

        printf(" %zu |", glint_star_tables_bytes(t));
        glint_star_tables_free(t);
    }
    printf("\n\nMemory of a star for 1920x1080, one thread, besides: %zu bytes "
           "for one light, %zu for 128.\n",
           glint_star_bytes(&one), glint_star_bytes(&many));
}

int main(int argc, char **argv)
{
    static struct curve curve[3];
    FILE *file = NULL;

    if (argc == 3 && strcmp(argv[1], "--svg") == 0)
        file = fopen(argv[2], "w");
    if ((argc != 1 && !file)) {
        fputs("star_table [--svg FILE]\n", stderr);
        return 2;
    }
    open_canvas();
    set_weights();
    setvbuf(stdout, NULL, _IOLBF, 0);
    print_shapes();
    print_ring();
    print_energy();
    print_direct(curve);
    print_motion(curve);
    print_bytes();
    if (file)
        plot_curves(file, curve);
    return file && fclose(file) != 0;
}
