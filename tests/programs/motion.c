/* SPDX-License-Identifier: MIT
 *
 * motion LENS [--from DEG] [--to DEG] [--step DEG] [--azimuth DEG]
 *             [--size WxH] [--reference exact|finest] [--grid N]
 *             [--steps N] [--fineness N] [--csv OUT] [--svg OUT]
 *             [--before CSV] [--jump CODES] [--flux SHARE] [--crawl CODES]
 *
 * Moves a light slowly across the frame and measures by how much the picture in
 * codes changes from frame to frame beyond the true change. The true change is
 * that of the reference: of the exact renderer, or of the model with grids four
 * times as fine, irradiance without steps and nothing left out.
 *
 *   jump   the largest change of the mean of any 8 x 8 block, codes: popping
 *   flux   the change of the sum of all codes, over that sum
 *   crawl  99.9th percentile of the change of pixels, codes: crawling edges
 *
 * The error of a frame is its codes minus those of the reference, which are not
 * rounded; the measures say how much the error changes. For jump and flux the
 * picture is dithered, so that means of blocks are right to 1/64 of a code:
 * without dither, a flat part that grows brighter changes by a whole code at
 * once, for which the format is to blame. Exit code 1: a measure exceeded its
 * bound (--jump, --flux, --crawl).
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/extreme.h"
#include "support/stage.h"
#include "options/command_line.h"

enum { MAX_STEPS = 20000 };

struct options {
    const char *lens, *csv, *svg, *before;
    double from, to, step, azimuth, jump, flux, crawl;
    int width, height, grid, steps, fineness;
    bool exact;
};

struct sample {
    double theta, jump, flux, crawl;
};

struct sweep {
    struct options o;
    struct stage test, finest;
    float *linear;
    float *error[2][2]; /* [frame & 1][0: dithered, 1: as drawn] */
    uint8_t *codes;
    double exposure, power;
    double sum; /* codes: sum of the reference's last frame */
    struct sample sample[MAX_STEPS];
    int n;
};

/* ------------------------------------------------------------------ frames */

/* Returns the code of light X as the run time encodes it, but not rounded. */
static double code_of(double x)
{
    const double v = fmin(1, fmax(0, x));

    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055);
}

static bool reference(struct sweep *s, const struct glint_lamp *lamp)
{
    return s->o.exact ? stage_exact(&s->test, lamp, 1, s->o.grid, s->linear)
                      : stage_linear(&s->finest, lamp, 1, s->linear);
}

/* Sets ERROR to the codes of the picture, with dither or not, minus those of
 * the reference in LINEAR. */
static bool add_error(struct sweep *s, const struct glint_lamp *lamp,
                      int dither, float *error)
{
    const size_t n = 3 * (size_t)s->o.width * (size_t)s->o.height;

    s->test.frame.cfg.dither = dither;
    glint_frame_retune(&s->test.frame);
    memset(s->codes, 0, n);
    if (!stage_codes(&s->test, lamp, 1, s->codes))
        return false;
    s->sum = 0;
    for (size_t i = 0; i < n; i++) {
        const double code = code_of((double)s->linear[i]);

        s->sum += code;
        error[i] = (float)((double)s->codes[i] - code);
    }
    return true;
}

static bool frame_error(struct sweep *s, double theta, float *const error[2])
{
    const struct glint_lamp lamp = stage_lamp(theta, s->o.azimuth, s->power);

    return reference(s, &lamp) && add_error(s, &lamp, 1, error[0]) &&
           add_error(s, &lamp, 0, error[1]);
}

/* ---------------------------------------------------------------- measures */

static double block_jump(const struct options *o, const float *a,
                         const float *b)
{
    double worst = 0;

    for (int y = 0; y + 8 <= o->height; y += 8)
        for (int x = 0; x + 8 <= o->width; x += 8)
            for (int c = 0; c < 3; c++) {
                double sum = 0;

                for (int k = 0; k < 64; k++) {
                    const int at = 3 * ((y + k / 8) * o->width + x + k % 8) + c;

                    sum += (double)a[at] - (double)b[at];
                }
                worst = fmax(worst, fabs(sum) / 64);
            }
    return worst;
}

static double flux_jump(const struct sweep *s, const float *a, const float *b)
{
    double sum = 0;

    for (int i = 0; i < 3 * s->o.width * s->o.height; i++)
        sum += (double)a[i] - (double)b[i];
    return s->sum > 0 ? fabs(sum) / s->sum : 0;
}

static double crawl(const struct options *o, const float *a, const float *b)
{
    enum { BINS = 4096 };
    static int count[BINS];
    const int n = 3 * o->width * o->height;
    int seen = 0, at = BINS - 1;

    memset(count, 0, sizeof count);
    for (int i = 0; i < n; i++) {
        const int bin = (int)(fabs((double)a[i] - (double)b[i]) * 16);

        count[bin < BINS ? bin : BINS - 1]++;
    }
    while (at > 0 && (seen += count[at]) < n / 1000)
        at--;
    return at / 16.0;
}

static bool run(struct sweep *s)
{
    const int steps = (int)lrint((s->o.to - s->o.from) / s->o.step);

    for (int k = 0; k <= steps && k < MAX_STEPS; k++) {
        const double theta = s->o.from + k * s->o.step;
        float *const *here = s->error[k & 1];
        float *const *before = s->error[~k & 1];

        if (!frame_error(s, theta, here))
            return false;
        if (k > 0)
            s->sample[s->n++] =
                (struct sample){theta, block_jump(&s->o, here[0], before[0]),
                                flux_jump(s, here[0], before[0]),
                                crawl(&s->o, here[1], before[1])};
        if (k % 20 == 0)
            fprintf(stderr, "\r%s: %d of %d frames ", s->o.lens, k, steps);
    }
    fprintf(stderr, "\r%s: %d frames          \n", s->o.lens, s->n + 1);
    return s->n > 0;
}

/* ------------------------------------------------------------------- plots */

enum { PLOT_W = 860, PLOT_H = 150, LEFT = 70, TOP = 30, PANEL = 190 };

struct panel {
    const char *title;
    double most, bound;
};

static double value_of(const struct sample *p, int panel)
{
    return panel == 0 ? p->jump : panel == 1 ? 100 * p->flux : p->crawl;
}

static void plot_line(FILE *f, const struct sweep *s, const struct sample *p,
                      int n, int panel, double most, const char *colour)
{
    fprintf(f,
            "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1\" "
            "points=\"",
            colour);
    for (int i = 0; i < n; i++)
        fprintf(f, "%.1f,%.1f ",
                LEFT +
                    PLOT_W * (p[i].theta - s->o.from) / (s->o.to - s->o.from),
                TOP + panel * PANEL +
                    PLOT_H * (1 - fmin(1, value_of(&p[i], panel) / most)));
    fprintf(f, "\"/>\n");
}

/* Draws ticks below panel PANEL at angles where zones of the model meet. */
static void plot_zones(FILE *f, const struct sweep *s, int panel)
{
    const struct glint_lens *lens = &s->test.file.lens;
    const int y = TOP + panel * PANEL + PLOT_H;

    for (uint32_t k = 0; k < lens->header->n_systems; k++) {
        const double at =
            asin(lens->system[k].sine_lo_q30 * 0x1p-30) * 57.29577951308232;

        if (at > s->o.from && at < s->o.to)
            fprintf(f, "<path stroke=\"#999\" d=\"M%.1f %d v6\"/>\n",
                    LEFT + PLOT_W * (at - s->o.from) / (s->o.to - s->o.from),
                    y);
    }
}

static void plot_panel(FILE *f, const struct sweep *s, int panel,
                       const struct panel *p, const struct sample *before,
                       int n_before)
{
    const int y = TOP + panel * PANEL;

    fprintf(f,
            "<text x=\"%d\" y=\"%d\">%s</text>\n"
            "<path fill=\"none\" stroke=\"#333\" d=\"M%d %d v%d h%d\"/>\n"
            "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%.3g</text>\n"
            "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">0</text>\n",
            LEFT, y - 6, p->title, LEFT, y, PLOT_H, PLOT_W, LEFT - 6, y + 10,
            p->most, LEFT - 6, y + PLOT_H);
    if (p->bound > 0 && p->bound < p->most)
        fprintf(f,
                "<path stroke=\"#c80\" stroke-dasharray=\"4 4\" d=\"M%d %.1f "
                "h%d\"/>\n",
                LEFT, y + PLOT_H * (1 - p->bound / p->most), PLOT_W);
    plot_zones(f, s, panel);
    plot_line(f, s, before, n_before, panel, p->most, "#e09090");
    plot_line(f, s, s->sample, s->n, panel, p->most, "#2060b0");
}

static int read_csv(const char *path, struct sample *p)
{
    FILE *f = path ? fopen(path, "r") : NULL;
    char line[200];
    int n = 0;

    while (f && n < MAX_STEPS && fgets(line, sizeof line, f))
        n += sscanf(line, "%lf,%lf,%lf,%lf", &p[n].theta, &p[n].jump,
                    &p[n].flux, &p[n].crawl) == 4;
    if (f)
        fclose(f);
    return n;
}

static void write_svg(const struct sweep *s)
{
    static struct sample before[MAX_STEPS];
    const int n_before = read_csv(s->o.before, before);
    struct panel panel[3] = {
        {"largest jump of an 8 x 8 block's mean, codes", 0.1, s->o.jump},
        {"jump of the sum of all codes, percent", 0.01, 100 * s->o.flux},
        {"crawl: 99.9th percentile of pixels, codes", 0.1, s->o.crawl}};
    FILE *f = fopen(s->o.svg, "w");

    if (!f)
        return;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < s->n; i++)
            panel[k].most = fmax(panel[k].most, value_of(&s->sample[i], k));
        for (int i = 0; i < n_before; i++)
            panel[k].most = fmax(panel[k].most, value_of(&before[i], k));
    }
    fprintf(f,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" "
            "height=\"%d\" font-family=\"sans-serif\" font-size=\"12\">\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            LEFT + PLOT_W + 20, TOP + 3 * PANEL + 10);
    for (int k = 0; k < 3; k++)
        plot_panel(f, s, k, &panel[k], before, n_before);
    fprintf(f,
            "<text x=\"%d\" y=\"%d\">%s, light from %g to %g degrees in steps "
            "of %g; ticks: zones meet%s</text>\n</svg>\n",
            LEFT, TOP + 3 * PANEL - 8, s->o.lens, s->o.from, s->o.to, s->o.step,
            n_before ? "; red: before" : "");
    fclose(f);
}

static void write_csv(const struct sweep *s)
{
    FILE *f = fopen(s->o.csv, "w");

    if (!f)
        return;
    fprintf(f, "theta_deg,jump_codes,flux_share,crawl_codes\n");
    for (int i = 0; i < s->n; i++)
        fprintf(f, "%.4f,%.4f,%.6f,%.4f\n", s->sample[i].theta,
                s->sample[i].jump, s->sample[i].flux, s->sample[i].crawl);
    fclose(f);
}

/* ----------------------------------------------------------------- the run */

static bool open_stage(struct stage *stage, const struct options *o)
{
    const bool ok = stage_load(stage, o->lens) && stage_prepare(stage, 8) &&
                    stage_model(stage, 1, 60);

    if (ok)
        stage_view(stage, o->width, o->height, 0);
    return ok;
}

static bool open_sweep(struct sweep *s)
{
    const size_t n = 3 * (size_t)s->o.width * (size_t)s->o.height;
    const struct glint_lamp middle =
        stage_lamp((s->o.from + s->o.to) / 2, s->o.azimuth, 1);

    s->linear = malloc(n * sizeof *s->linear);
    s->codes = malloc(n);
    for (int i = 0; i < 4; i++)
        if (!(s->error[i / 2][i % 2] = malloc(n * sizeof(float))))
            return false;
    if (!s->linear || !s->codes || !open_stage(&s->test, &s->o) ||
        !open_stage(&s->finest, &s->o))
        return false;
    s->finest.frame.dials.fineness = 256;
    s->finest.frame.dials.irradiance_steps = 0;
    s->test.frame.dials.irradiance_steps = s->o.steps;
    s->test.frame.dials.fineness = s->o.fineness;
    s->power = stage_power(&s->test, &middle);
    return true;
}

static bool judge(const struct sweep *s)
{
    const double bound[3] = {s->o.jump, s->o.flux, s->o.crawl};
    static const char *const what[3] = {"block mean", "sum of codes", "crawl"};
    struct sample worst = {0, 0, 0, 0};
    bool ok = true;

    for (int i = 0; i < s->n; i++) {
        worst.jump = fmax(worst.jump, s->sample[i].jump);
        worst.flux = fmax(worst.flux, s->sample[i].flux);
        worst.crawl = fmax(worst.crawl, s->sample[i].crawl);
    }
    for (int k = 0; k < 3; k++) {
        const double got[3] = {worst.jump, worst.flux, worst.crawl};
        char name[200];

        snprintf(name, sizeof name, "motion: %s, %s, %g deg a frame (%s)",
                 s->o.lens, what[k], s->o.step,
                 s->o.exact ? "exact" : "finest");
        ok &= extreme_at_most(name, got[k], bound[k], k == 1 ? "" : "codes");
    }
    return ok;
}

static bool take(struct options *o, int c)
{
    char *end = optarg;

    if (c == 'c' || c == 'v' || c == 'b') {
        *(c == 'c' ? &o->csv : c == 'v' ? &o->svg : &o->before) = optarg;
        return true;
    }
    if (c == 'W')
        return sscanf(optarg, "%dx%d", &o->width, &o->height) == 2 &&
               o->width >= 8 && o->height >= 8 && o->width <= 4096 &&
               o->height <= 4096;
    if (c == 'r') {
        o->exact = strcmp(optarg, "exact") == 0;
        return o->exact || strcmp(optarg, "finest") == 0;
    }
    if (c == 'g')
        return (o->grid = atoi(optarg)) >= 8;
    if (c == 'q')
        return (o->steps = atoi(optarg)) >= 0;
    if (c == 'n')
        return (o->fineness = atoi(optarg)) >= 4;
    *(c == 'f'   ? &o->from
      : c == 't' ? &o->to
      : c == 's' ? &o->step
      : c == 'a' ? &o->azimuth
      : c == 'j' ? &o->jump
      : c == 'u' ? &o->flux
                 : &o->crawl) = strtod(optarg, &end);
    return c != '?' && end != optarg;
}

static bool parse(struct options *o, int argc, char **argv)
{
    static const struct option names[] = {
        {"from", required_argument, NULL, 'f'},
        {"to", required_argument, NULL, 't'},
        {"step", required_argument, NULL, 's'},
        {"azimuth", required_argument, NULL, 'a'},
        {"size", required_argument, NULL, 'W'},
        {"reference", required_argument, NULL, 'r'},
        {"grid", required_argument, NULL, 'g'},
        {"steps", required_argument, NULL, 'q'},
        {"fineness", required_argument, NULL, 'n'},
        {"csv", required_argument, NULL, 'c'},
        {"svg", required_argument, NULL, 'v'},
        {"before", required_argument, NULL, 'b'},
        {"jump", required_argument, NULL, 'j'},
        {"flux", required_argument, NULL, 'u'},
        {"crawl", required_argument, NULL, 'w'},
        {NULL, 0, NULL, 0}};
    int c;

    while ((c = getopt_long(argc, argv, "", names, NULL)) != -1)
        if (!optarg || !take(o, c))
            return false;
    o->lens = optind + 1 == argc ? argv[optind] : NULL;
    return o->lens && o->step > 0 && o->to > o->from;
}

int main(int argc, char **argv)
{
    static struct sweep s = {.o = {.from = 2,
                                   .to = 12,
                                   .step = 0.02,
                                   .azimuth = 33,
                                   .jump = 6.7,
                                   .flux = 0.002,
                                   .crawl = 12,
                                   .width = 320,
                                   .height = 216,
                                   .grid = 192,
                                   .steps = 69,
                                   .fineness = 64,
                                   .exact = true}};

    if (!parse(&s.o, argc, argv)) {
        fprintf(stderr,
                "motion LENS [--from DEG] [--to DEG] [--step DEG] ...\n");
        return 2;
    }
    if (!open_sweep(&s) || !run(&s))
        return 1;
    if (s.o.csv)
        write_csv(&s);
    if (s.o.svg)
        write_svg(&s);
    return !judge(&s);
}
