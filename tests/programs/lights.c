/* SPDX-License-Identifier: MIT
 *
 * lights PLOT.svg MODEL.glint... - prints what frames with many lights cost and
 * how good they are. Frames are 1920x1080 codes on black, with 1 to 128 lights
 * that were found in night photographs. A row has the quality, of four, that is
 * the fastest at 45 dB or more; its processor milliseconds of a frame on one
 * thread, the least of three, PSNR against the finest quality, which leaves out
 * only what is below 0.01 codes, and the number of bundles; the same with
 * dim_codes 0, which draws the ghosts of each light by themselves; then all
 * four. PLOT.svg receives the milliseconds over the lights.
 *
 * lights -j THREADS QUALITY SCALE ROUNDS MODEL.glint - draws the frame of NIGHT
 * lights ROUNDS times, and prints the scale (that of the table for 0) and the
 * least milliseconds by the clock and of all threads together;
 * tools/report/threads-table counts its instructions.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "lab/plots/plot.h"
#include "options/tool.h"
#include "support/models/street.h"

enum {
    W = 1920,
    H = 1080,
    BYTES = 3 * W * H,
    MOST = 128,
    FRAMES = 3,
    NIGHT = 16
};

static const int qualities_q15[] = {1 << 11, 1 << 12, 1 << 13, 1 << 14};

enum { QUALITIES = sizeof qualities_q15 / sizeof *qualities_q15 };

static struct stage stage;
static struct glint_lamp lamps[MOST];
static uint8_t want[BYTES], got[BYTES];

static double seconds_of(clockid_t clock)
{
    struct timespec t;

    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double seconds(void)
{
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

/* Draws the first N lamps, times SCALE, on black. Returns processor seconds. */
static double draw(int n, double scale, uint8_t *codes)
{
    struct glint_image image = {.format = GLINT_RGB24,
                                .width = W,
                                .height = H,
                                .range = GLINT_RANGE_FULL};
    double from;

    memset(codes, 0, BYTES);
    glint_image_place(&image, codes);
    from = seconds();
    if (glint_frame_draw(&stage.frame, lamps, n, scale, &image, &stage.drawn) !=
        GLINT_OK)
        exit(1);
    return seconds() - from;
}

/* Returns the scale at which all but a ten-thousandth of the samples are at
 * most a quarter of white, about as --strength 0.5 has it. */
static double scale_for(int n)
{
    const int quarter = 137, most = BYTES / 10000;
    double low = -30, high = 30;

    for (int i = 0; i < 14; i++) {
        const double middle = (low + high) / 2;
        int above = 0;

        draw(n, exp2(middle), got);
        for (int k = 0; k < BYTES; k++)
            above += got[k] > quarter;
        if (above > most)
            high = middle;
        else
            low = middle;
    }
    return exp2(low);
}

static double psnr(void)
{
    double sum = 0;

    for (int i = 0; i < BYTES; i++) {
        const double d = (double)want[i] - got[i];

        sum += d * d;
    }
    return sum > 0 ? 10 * log10(255. * 255 * BYTES / sum) : 99;
}

/* What a frame took at one quality. */
struct result {
    double quality, dim, ms, db;
    int bundles;
};

static struct result measure(int n, double scale, int quality_q15, double dim)
{
    struct glint_frame *f = &stage.frame;
    struct result r = {.quality = quality_q15 / 32768., .ms = HUGE_VAL};

    f->dials = glint_dials_at(quality_q15);
    f->dials.dispersion_q8 = 0;
    if (dim >= 0)
        f->dials.dim_codes = dim;
    r.dim = f->dials.dim_codes;
    for (int k = 0; k < FRAMES; k++)
        r.ms = fmin(r.ms, 1e3 * draw(n, scale, got));
    r.db = psnr();
    r.bundles = stage.drawn.stats.bundles;
    return r;
}

/* Draws the first N lamps at each quality; sets RESULT[QUALITIES] and returns
 * the index of the fastest that is at least 45 dB, or of the last. */
static int run(int n, double *scale, struct result *result)
{
    struct glint_frame *f = &stage.frame;
    int best = QUALITIES - 1;

    f->dials = glint_dials_at(1 << 12);
    *scale = scale_for(n);
    f->dials = glint_dials_at(1 << 15);
    f->dials.cull_codes = 0.01;
    f->dials.dispersion_q8 = 0;
    f->dials.max_lights = MOST;
    f->most_minsn = 0;
    draw(n, *scale, want);
    for (int i = QUALITIES - 1; i >= 0; i--) {
        result[i] = measure(n, *scale, qualities_q15[i], -1);
        if (result[i].db >= 45 && result[i].ms <= result[best].ms)
            best = i;
    }
    return best;
}

static const int lights[] = {1, 2, 4, 8, 16, 32, 64, 128};

enum { COUNTS = sizeof lights / sizeof *lights, LENSES = 16 };

/* Sets WORDS, of SIZE bytes, to NAME for the legend, which has room for 15
 * letters: without "-zoom"; of longer ones what is behind the last dash. */
static void key_words(char *words, size_t size, const char *name)
{
    const char *const zoom = strstr(name, "-zoom");
    const char *const dash = strrchr(name, '-');

    if (zoom)
        snprintf(words, size, "%.*s%s", (int)(zoom - name), name, zoom + 5);
    else
        snprintf(words, size, "%s",
                 strlen(name) > 15 && dash ? dash + 1 : name);
}

/* Draws milliseconds over lights, a line a lens, and a line at 66 ms, which two
 * processors work off in 33. */
static void plot(FILE *file, char name[LENSES][64], double ms[LENSES][COUNTS],
                 int n)
{
    struct plot p;

    plot_open(file, 1);
    plot_init(&p, file, 0, "Frames of 1080p at 45 dB or better");
    p.x = (struct plot_axis){"lights", true, 1, 128, 0};
    p.y = (struct plot_axis){"processor ms", true, 1, 66, 0};
    for (int i = 0; i < n; i++)
        for (int k = 0; k < COUNTS; k++)
            plot_stretch(&p, lights[k], ms[i][k]);
    plot_frame(&p);
    plot_line(&p, 1, 66, 128, 66, "#bbb", false);
    for (int i = 0; i < n; i++) {
        /* Colours come again after ten. */
        const char kind = i < 10 ? 'o' : 'd';

        char words[64];

        key_words(words, sizeof words, name[i]);
        plot_key(&p, kind, plot_colour(i), words);
        for (int k = 0; k < COUNTS; k++) {
            char tip[128];

            snprintf(tip, sizeof tip, "%s, %d lights: %.1f ms", name[i],
                     lights[k], ms[i][k]);
            if (k > 0)
                plot_line(&p, lights[k - 1], ms[i][k - 1], lights[k], ms[i][k],
                          plot_colour(i), false);
            plot_mark(&p, lights[k], ms[i][k], kind, plot_colour(i), tip);
        }
    }
    plot_close(file);
}

/* Measures all numbers of lights of the open model, and sets MS. */
static void rows_of_lens(double *ms)
{
    const char *lens = stage.file.lens.header->name;

    for (int k = 0; k < COUNTS; k++) {
        struct result r[QUALITIES], plain;
        double scale;
        const int best = run(lights[k], &scale, r);

        plain = measure(lights[k], scale, qualities_q15[best], 0);
        ms[k] = r[best].ms;
        printf("| %s | %d | %.3g | %.1f | %.1f | %d | %.1f | %.1f | %d |", lens,
               lights[k], r[best].quality, r[best].ms, r[best].db,
               r[best].bundles, plain.ms, plain.db, plain.bundles);
        for (int i = 0; i < QUALITIES; i++)
            printf(" %.1f; %.1f |", r[i].ms, r[i].db);
        puts("");
        fflush(stdout);
    }
}

/* Times the frame of NIGHT lights on several threads; does what the head says
 * of -j. */
static int time_threads(char **argv)
{
    struct tool tool = {.name = "lights", .n_threads = atoi(argv[0])};
    double scale = atof(argv[2]), ms = HUGE_VAL, processor_ms = HUGE_VAL;

    if (tool_start(&tool) != EXIT_OK)
        return 1;
    stage.workers = tool.workers;
    if (!stage_read(&stage, argv[4], W, H))
        return 1;
    street_lamps(&stage, lamps, MOST);
    stage.frame.dials = glint_dials_at((int)lrint(32768 * atof(argv[1])));
    stage.frame.dials.dispersion_q8 = 0;
    if (scale <= 0)
        scale = scale_for(NIGHT);
    for (int i = 0; i < atoi(argv[3]); i++) {
        const double from = seconds_of(CLOCK_MONOTONIC);

        processor_ms = fmin(processor_ms, 1e3 * draw(NIGHT, scale, got));
        ms = fmin(ms, 1e3 * (seconds_of(CLOCK_MONOTONIC) - from));
    }
    printf("%s %.6g %.1f %.1f\n", stage.file.lens.header->name, scale, ms,
           processor_ms);
    stage_close(&stage);
    tool_finish(&tool);
    return 0;
}

int main(int argc, char **argv)
{
    static char name[LENSES][64];
    static double ms[LENSES][COUNTS];
    FILE *file;
    int n = 0;

    if (argc == 7 && strcmp(argv[1], "-j") == 0)
        return time_threads(argv + 2);
    file = argc > 1 ? fopen(argv[1], "w") : NULL;
    if (!file || argc - 2 > LENSES)
        return 2;
    puts("| lens | lights | quality | ms | dB | bundles | dim 0: ms | dB | "
         "bundles | 0.0625: ms; dB | 0.125 | 0.25 | 0.5 |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    fflush(stdout);
    for (int i = 2; i < argc; i++, n++) {
        if (!stage_read(&stage, argv[i], W, H))
            return 1;
        snprintf(name[n], sizeof name[n], "%s", stage.file.lens.header->name);
        street_lamps(&stage, lamps, MOST);
        rows_of_lens(ms[n]);
        stage_close(&stage);
    }
    plot(file, name, ms, n);
    return fclose(file) == 0 ? 0 : 1;
}
