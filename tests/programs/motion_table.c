/* SPDX-License-Identifier: MIT
 *
 * motion_table FRAMES - prints the errors of localisation (a body's pose from
 * the observed positions of foods, its landmarks), by method and motion.
 *
 * The methods run alternately on blocks of frames, so that a varying machine
 * load affects all of their times alike.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "reference/motion/four.h"
#include "support/tracks/tracks.h"

enum { CHUNK = 1000, BINS = 100, MOST_METHODS = 6, SEED = 163635 };

/* A method of localisation: the least-squares fit of glint bake to all foods
 * (landmarks), with or without averaging; or a fit to four foods. */
struct method {
    const char *name;
    bool all, average;
    enum four_fit fit;
    enum four_arithmetic arithmetic;
};

/* Accuracy of a method on one track; errors are distances between estimated and
 * true body positions. */
struct result {
    struct glint_localiser all;
    struct four four;
    const char *wrong;
    double square[BINS], worst, last_worst, seconds, residual[BINS];
    int count[BINS];
    /* sums for the correlation of x, the error, with y, the mean distance of
     * the foods (landmarks): x, y, x^2, y^2, x y */
    double sums[5];
};

static const struct method exact_input[] = {
    {"first4, float32", false, false, FOUR_FIRST, FOUR_FLOAT32},
    {"best4, float32", false, false, FOUR_BEST, FOUR_FLOAT32},
    {"chain, float32", false, false, FOUR_CHAIN, FOUR_FLOAT32},
    {"first4, double", false, false, FOUR_FIRST, FOUR_DOUBLE},
    {"chain, double", false, false, FOUR_CHAIN, FOUR_DOUBLE},
    {"all, double", .all = true}};

static const struct method rounded_input[] = {
    {"first4, float32", false, false, FOUR_FIRST, FOUR_FLOAT32},
    {"first4, double", false, false, FOUR_FIRST, FOUR_DOUBLE},
    {"best4, double", false, false, FOUR_BEST, FOUR_DOUBLE},
    {"all", .all = true},
    {"all, life mean", .all = true, .average = true}};

static const char *const motions[TRACK_MOTIONS] = {
    "straight with turns", "spiral along x", "straight, turned at random",
    "random steps and turns"};

static struct track_frame chunk[CHUNK];

static void add_pose_error(struct result *r,
                           const struct glint_located *located,
                           const struct track_frame *f, int bin, bool is_last)
{
    double square = 0, x, y = f->food_distance;

    for (int k = 0; k < 3; k++)
        square += (located->pose.at[k] - f->pose.at[k]) *
                  (located->pose.at[k] - f->pose.at[k]);
    x = sqrt(square);
    r->square[bin] += square;
    r->count[bin]++;
    r->worst = fmax(r->worst, x);
    r->residual[bin] = fmax(r->residual[bin], located->residual);
    if (is_last)
        r->last_worst = fmax(r->last_worst, x);
    r->sums[0] += x;
    r->sums[1] += y;
    r->sums[2] += x * x;
    r->sums[3] += y * y;
    r->sums[4] += x * y;
}

static const char *localise_track(const struct method *method, struct result *r,
                                  int n, const struct track_frame *f,
                                  struct glint_located *located)
{
    const double(*const seen)[3] = (const double(*)[3])f->seen;

    return method->all
               ? glint_localise_body(&r->all, n, seen, f->is_new, located)
               : four_localise_by_landmarks(&r->four, n, seen, f->is_new,
                                            located);
}

static void localise_by_all_methods(const struct track_options *options,
                                    const struct method *method, int n,
                                    struct result *result)
{
    struct track track;

    track_begin_motion(&track, options);
    for (int i = 0; i < n; i++) {
        memset(&result[i], 0, sizeof *result);
        glint_localiser_init(&result[i].all, method[i].average);
        four_init_localiser(&result[i].four, method[i].fit,
                            method[i].arithmetic);
    }
    for (int first = 0; first < options->n_frames; first += CHUNK) {
        for (int k = 0; k < CHUNK; k++)
            track_next_frame(&track, &chunk[k]);
        for (int i = 0; i < n; i++) {
            static struct glint_located located[CHUNK];
            struct result *r = &result[i];
            const clock_t start = clock();

            for (int k = 0; k < CHUNK && !r->wrong; k++)
                r->wrong = localise_track(&method[i], r, options->n_foods,
                                          &chunk[k], &located[k]);
            r->seconds += (double)(clock() - start) / CLOCKS_PER_SEC;
            for (int k = 0; k < CHUNK && !r->wrong; k++) {
                const int frame = first + k;

                add_pose_error(
                    r, &located[k], &chunk[k],
                    (int)((long long)frame * BINS / options->n_frames),
                    frame >= options->n_frames / 10 * 9);
            }
        }
    }
}

/* Returns the RMS position error over the bins FIRST .. END - 1; a bin is a
 * fixed fraction of the track. */
static double compute_rms(const struct result *r, int first, int end)
{
    double square = 0;
    int count = 0;

    for (int i = first; i < end; i++) {
        square += r->square[i];
        count += r->count[i];
    }
    return sqrt(square / (count ? count : 1));
}

static double compute_correlation(const struct result *r, int n)
{
    const double *s = r->sums;
    const double x = s[2] - s[0] * s[0] / n, y = s[3] - s[1] * s[1] / n;

    return (s[4] - s[0] * s[1] / n) / sqrt(x * y);
}

static void print_errors_of_method(const struct method *method, int n,
                                   int n_frames, const struct result *result)
{
    for (int i = 0; i < n; i++) {
        const struct result *r = &result[i];

        if (r->wrong)
            printf("| | %s | %s | | | |\n", method[i].name, r->wrong);
        else
            printf("| | %s | %.1e | %.1e | %.1e | %.2f |\n", method[i].name,
                   compute_rms(r, 0, BINS / 10),
                   compute_rms(r, BINS * 9 / 10, BINS), r->last_worst,
                   compute_correlation(r, n_frames));
    }
}

/* ------------------------------------------------------------------ tables */

static void compare_localisers(int reset_every, int digits,
                               const struct method *method, int n, int n_frames)
{
    static struct result result[MOST_METHODS];

    printf("| motion | method | first tenth | last tenth | worst of that | "
           "correlation |\n|---|---|---|---|---|---|\n");
    for (int m = 0; m < TRACK_MOTIONS; m++) {
        const struct track_options options = {
            m, n_frames, 5, reset_every, digits, (uint32_t)(SEED + m)};

        localise_by_all_methods(&options, method, n, result);
        printf("| %s | | | | | |\n", motions[m]);
        print_errors_of_method(method, n, n_frames, result);
    }
}

static void time_localisers(void)
{
    static const int lengths[3] = {10000, 100000, 200000};
    static struct result result[MOST_METHODS];
    double first = 0;

    printf("| frames | first4, float32 | chain, float32 | all, double | "
           "all, life mean |\n|---|---|---|---|---|\n");
    for (int i = 0; i < 3; i++) {
        const struct method method[4] = {exact_input[0], exact_input[2],
                                         rounded_input[3], rounded_input[4]};
        const struct track_options options = {0, lengths[i], 5, 0, 0, SEED};

        localise_by_all_methods(&options, method, 4, result);
        first = i ? first : result[0].seconds;
        printf("| %d |", lengths[i]);
        for (int k = 0; k < 4; k++)
            printf(" %.1f |", result[k].seconds / first);
        printf("\n");
    }
}

int main(int argc, char **argv)
{
    const int n = argc == 2 ? atoi(argv[1]) / CHUNK * CHUNK : 0;

    if (n < 10 * CHUNK) {
        fprintf(stderr, "motion_table FRAMES: 10000 frames or more\n");
        return 2;
    }
    printf("### Foods that stay, all digits, %d frames\n\n", n);
    compare_localisers(0, 0, exact_input, 6, n);
    printf("\n### A food ends every 200 frames, %d times; text of six "
           "digits\n\n",
           (n - 1) / 200);
    compare_localisers(200, 6, rounded_input, 5, n);
    printf("\n### Times, in those of first4 for 10000 frames\n\n");
    time_localisers();
    return 0;
}
