/* SPDX-License-Identifier: MIT
 *
 * motion LENS [--from DEG] [--to DEG] [--csv OUT]
 *             [--jump CODES] [--flux SHARE] [--crawl CODES]
 *
 * Moves a light slowly across the frame and compares the change of the image
 * from frame to frame, in codes, with the change of a reference. The reference
 * is the same model, drawn with grids four times as fine, without rounding
 * irradiance to steps, and with all ghosts. Three measures are printed:
 *
 *   jump   max change of the mean of any 8 x 8 block, codes: popping
 *   flux   change of the sum of all codes, as a fraction of that sum
 *   crawl  99.9th percentile of the change of pixels, codes: crawling edges
 *
 * The error of a frame is its codes minus the unrounded codes of the reference.
 * Each measure is a change of this error between frames. For jump and flux the
 * image is dithered, so that means of blocks are accurate to 1/64 code. Without
 * dither, a uniform area that becomes brighter would change by a complete code
 * at once, because codes are integers. Exit code 1: a measure exceeded its
 * limit (--jump, --flux, --crawl).
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/extreme.h"
#include "support/stage.h"
#include "options/command_line.h"

enum { WIDTH = 320, HEIGHT = 216, SAMPLES = 3 * WIDTH * HEIGHT };
#define STEP_DEG 0.02
#define AZIMUTH  33

struct sample {
    double jump, flux, crawl;
};

struct sweep {
    const char *lens, *csv;
    double from, to;
    struct sample bound;
    struct stage test, finest;
    float linear[SAMPLES];
    /* code errors of the current and the previous frame; first index: frame &
     * 1; second index: 0 dithered, 1 not dithered */
    float error[2][2][SAMPLES];
    uint8_t codes[SAMPLES];
    double power;
    double sum; /* sum over the pixels of the last reference frame, codes */
    struct sample worst;
};

/* ------------------------------------------------------------------ frames */

/* Sets ERROR to the codes of the image minus the codes of the reference in
 * s->linear. DITHER: dithers the image. */
static bool measure_code_errors(struct sweep *s, const struct glint_lamp *lamp,
                                int dither, float *error)
{
    s->test.frame.cfg.dither = dither;
    glint_frame_apply_config(&s->test.frame);
    memset(s->codes, 0, sizeof s->codes);
    if (!stage_draw_codes(&s->test, lamp, 1, s->codes))
        return false;
    s->sum = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const double code = glint_measure_code((double)s->linear[i]);

        s->sum += code;
        error[i] = (float)((double)s->codes[i] - code);
    }
    return true;
}

static bool measure_frame_errors(struct sweep *s, double theta,
                                 float error[2][SAMPLES])
{
    const struct glint_lamp lamp = stage_make_lamp(theta, AZIMUTH, s->power);

    return stage_draw_linear(&s->finest, &lamp, 1, s->linear) &&
           measure_code_errors(s, &lamp, 1, error[0]) &&
           measure_code_errors(s, &lamp, 0, error[1]);
}

/* ------------------------------------------------------ measures of change */

static double compute_max_block_mean_change(const float *a, const float *b)
{
    double worst = 0;

    for (int y = 0; y + 8 <= HEIGHT; y += 8)
        for (int x = 0; x + 8 <= WIDTH; x += 8)
            for (int c = 0; c < 3; c++) {
                double sum = 0;

                for (int k = 0; k < 64; k++) {
                    const int at = 3 * ((y + k / 8) * WIDTH + x + k % 8) + c;

                    sum += (double)a[at] - (double)b[at];
                }
                worst = fmax(worst, fabs(sum) / 64);
            }
    return worst;
}

static double compute_relative_flux_change(const struct sweep *s,
                                           const float *a, const float *b)
{
    double sum = 0;

    for (int i = 0; i < SAMPLES; i++)
        sum += (double)a[i] - (double)b[i];
    return s->sum > 0 ? fabs(sum) / s->sum : 0;
}

static double measure_edge_crawl(const float *a, const float *b)
{
    enum { BINS = 4096 };
    static int count[BINS];
    int seen = 0, at = BINS - 1;

    memset(count, 0, sizeof count);
    for (int i = 0; i < SAMPLES; i++) {
        const int bin = (int)(fabs((double)a[i] - (double)b[i]) * 16);

        count[bin < BINS ? bin : BINS - 1]++;
    }
    while (at > 0 && (seen += count[at]) < SAMPLES / 1000)
        at--;
    return at / 16.0;
}

static bool measure_light_sweep(struct sweep *s)
{
    const int steps = (int)lrint((s->to - s->from) / STEP_DEG);
    FILE *const csv = s->csv ? fopen(s->csv, "w") : NULL;
    bool ok = true;

    if (csv)
        fprintf(csv, "theta_deg,jump_codes,flux_share,crawl_codes\n");
    for (int k = 0; k <= steps && ok; k++) {
        const double theta = s->from + k * STEP_DEG;
        float(*here)[SAMPLES] = s->error[k & 1];
        float(*before)[SAMPLES] = s->error[~k & 1];
        struct sample now;

        ok = measure_frame_errors(s, theta, here);
        if (k == 0 || !ok)
            continue;
        now =
            (struct sample){compute_max_block_mean_change(here[0], before[0]),
                            compute_relative_flux_change(s, here[0], before[0]),
                            measure_edge_crawl(here[1], before[1])};
        s->worst.jump = fmax(s->worst.jump, now.jump);
        s->worst.flux = fmax(s->worst.flux, now.flux);
        s->worst.crawl = fmax(s->worst.crawl, now.crawl);
        if (csv)
            fprintf(csv, "%.4f,%.4f,%.6f,%.4f\n", theta, now.jump, now.flux,
                    now.crawl);
        if (k % 20 == 0)
            fprintf(stderr, "\r%s: %d of %d frames ", s->lens, k, steps);
    }
    fprintf(stderr, "\r%s: %d frames          \n", s->lens, steps + 1);
    if (csv)
        fclose(csv);
    return ok && steps > 0;
}

/* ------------------------------------------------------------ command line */

static bool open_light_sweep(struct sweep *s)
{
    const struct glint_lamp middle =
        stage_make_lamp((s->from + s->to) / 2, AZIMUTH, 1);

    if (!stage_open_lens(&s->test, s->lens, WIDTH, HEIGHT) ||
        !stage_open_lens(&s->finest, s->lens, WIDTH, HEIGHT))
        return false;
    s->finest.frame.dials.fineness = 256;
    s->finest.frame.dials.irradiance_steps = 0;
    s->power = stage_find_exposed_power(&s->test, &middle);
    return true;
}

static bool check_error_limit(const struct sweep *s, const char *what,
                              double worst, double bound, const char *unit)
{
    char name[200];

    snprintf(name, sizeof name, "motion: %s, %s, %g deg a frame (finest)",
             s->lens, what, STEP_DEG);
    return extreme_check_at_most(name, worst, bound, unit);
}

static bool parse_options(struct sweep *s, int argc, char **argv)
{
    static const struct option names[] = {{"from", required_argument, NULL, 0},
                                          {"to", required_argument, NULL, 1},
                                          {"jump", required_argument, NULL, 2},
                                          {"flux", required_argument, NULL, 3},
                                          {"crawl", required_argument, NULL, 4},
                                          {"csv", required_argument, NULL, 'c'},
                                          {NULL, 0, NULL, 0}};
    double *const value[] = {&s->from, &s->to, &s->bound.jump, &s->bound.flux,
                             &s->bound.crawl};
    int c;

    while ((c = getopt_long(argc, argv, "", names, NULL)) != -1)
        if (c == 'c')
            s->csv = optarg;
        else if (c == '?' || !tool_parse_number(optarg, value[c]))
            return false;
    s->lens = optind + 1 == argc ? argv[optind] : NULL;
    return s->lens && s->to > s->from;
}

int main(int argc, char **argv)
{
    static struct sweep s = {.from = 2, .to = 12, .bound = {6.7, 0.002, 12}};
    bool ok;

    if (!parse_options(&s, argc, argv)) {
        fprintf(stderr, "motion LENS [--from DEG] [--to DEG] [--csv OUT] "
                        "[--jump CODES] [--flux SHARE] [--crawl CODES]\n");
        return 2;
    }
    if (!open_light_sweep(&s) || !measure_light_sweep(&s))
        return 1;
    ok = check_error_limit(&s, "block mean", s.worst.jump, s.bound.jump,
                           "codes");
    ok &= check_error_limit(&s, "sum of codes", s.worst.flux, s.bound.flux, "");
    return !(
        check_error_limit(&s, "crawl", s.worst.crawl, s.bound.crawl, "codes") &&
        ok);
}
