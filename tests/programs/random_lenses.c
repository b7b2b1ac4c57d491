/* SPDX-License-Identifier: MIT
 *
 * random_lenses [--seed S] [--first N] [--count N] [--jobs N] [--seconds S]
 *               [--out DIR]
 *
 * Bakes random but valid lenses (support/random_lens.h) as drafts and compares
 * pictures of their models, in linear light and in codes, with the exact
 * picture. Each lens has a process and a number of CPU seconds of its own: a
 * trap ends this lens only, and is counted. DIR gets the tables of the ten
 * worst lenses. After SIGINT no lens is begun, and the finished ones are
 * reported.
 * Exit code 1: a trap, no lens that was drawn, or one below 20 dB.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/extreme.h"
#include "support/random_lens.h"
#include "support/stage.h"
#include "options/command_line.h"

enum { WIDTH = 144, HEIGHT = 96, WORST = 10, MAX_JOBS = 16, MANY_GHOSTS = 60 };

enum { TRAP = -2, SKIPPED_TIME = -1, NOT_BEGUN = 0, DRAWN, DARK, REFUSED };

struct outcome {
    int state, tries, n_surfaces, n_ghosts, grid, seconds;
    double focal_mm, f_number, theta_deg, psnr_db, flux, p99;
    char why[200];
};

struct options {
    uint64_t seed;
    int first, count, jobs, seconds;
    const char *out;
};

/* ---------------------------------------------------------------- one lens */

/* Returns a lamp of power 1 in the picture or somewhat outside. */
static struct glint_lamp lamp_for(const struct stage *s, uint64_t seed,
                                  int number)
{
    uint64_t r = ~seed * UINT64_C(0xd1342543de82ef95) + (uint64_t)number;
    const double half =
        0.5 * hypot(s->lens.film_width_mm, s->lens.film_height_mm);
    const double corner =
        atan(half / s->setup.optics.focal_mm) * 57.29577951308232;
    const double theta = fmin(60, corner * stage_uniform(&r, 0, 1.2));

    return stage_lamp(theta, stage_uniform(&r, -180, 180), 1);
}

static bool is_dark(const struct stage *s, const float *rgb)
{
    return stage_flux(s, rgb) <= 0;
}

static void compare(struct outcome *o, struct stage *s,
                    const struct glint_lamp *lamp, const float *model)
{
    static float exact[3 * WIDTH * HEIGHT];
    struct glint_measure m;

    o->grid = o->n_ghosts > MANY_GHOSTS ? 64 : 128;
    if (!stage_exact(s, lamp, 1, o->grid, exact))
        return;
    m = stage_compare(s, exact, model);
    if (m.psnr_db < 45 && stage_exact(s, lamp, 1, 2 * o->grid, exact)) {
        o->grid *= 2; /* shows whether the exact one was at fault */
        m = stage_compare(s, exact, model);
    }
    o->psnr_db = m.psnr_db;
    o->flux = m.flux;
    o->p99 = m.p99;
    o->state = is_dark(s, exact) && is_dark(s, model) ? DARK : DRAWN;
}

static void run_one(struct outcome *o, const struct options *options,
                    int number)
{
    static struct stage s;
    static char text[RANDOM_LENS_TEXT];
    static float model[3 * WIDTH * HEIGHT];
    static uint8_t codes[3 * WIDTH * HEIGHT];
    struct glint_lamp lamp, bright;
    uint64_t r = options->seed + (uint64_t)number;
    const int blades =
        stage_random(&r) % 4 ? 3 + (int)(stage_random(&r) % 62) : 0;

    o->tries = random_lens(&s.lens, options->seed, number, text);
    o->n_surfaces = s.lens.n_surfaces;
    o->f_number = s.lens.f_number;
    o->n_ghosts = glint_ghost_list(&s.lens, NULL, 0);
    o->state = SKIPPED_TIME; /* stays if the time ends before the picture */
    if (o->tries < 0 || !stage_prepare(&s, blades)) {
        o->state = REFUSED;
        return;
    }
    o->focal_mm = s.setup.optics.focal_mm;
    lamp = lamp_for(&s, options->seed, number);
    o->theta_deg = lamp.theta_deg;
    if (!stage_bake(&s, 4, fmin(89, lamp.theta_deg + 0.5))) {
        o->state = REFUSED;
        return;
    }
    stage_view(&s, WIDTH, HEIGHT, 0);
    if (!stage_linear(&s, &lamp, 1, model))
        return;
    bright = lamp;
    bright.power = 1e9; /* Codes saturate; nothing must trap here. */
    memset(codes, 0, sizeof codes);
    if (!stage_codes(&s, &bright, 1, codes))
        return;
    compare(o, &s, &lamp, model);
    stage_close(&s);
}

/* -------------------------------------------------------------- all lenses */

static volatile sig_atomic_t stopped;

static void stop(int signal)
{
    (void)signal;
    stopped = 1;
}

static pid_t start(struct outcome *o, const struct options *options, int number)
{
    const pid_t pid = fork();

    if (pid == 0) {
        signal(SIGINT, SIG_IGN);
        const rlim_t s = (rlim_t)options->seconds;
        const struct rlimit limit = {s, s + 2};
        struct rusage used;

        setrlimit(RLIMIT_CPU, &limit);
        if (!freopen("/dev/null", "w", stderr))
            _exit(1);
        run_one(o, options, number);
        getrusage(RUSAGE_SELF, &used);
        o->seconds = (int)used.ru_utime.tv_sec;
        _exit(0);
    }
    return pid;
}

static void end(struct outcome *o, int status)
{
    if (WIFSIGNALED(status)) {
        const bool late =
            WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL;

        o->state = late ? SKIPPED_TIME : TRAP;
        snprintf(o->why, sizeof o->why, "signal %d", WTERMSIG(status));
    } else if (o->state == NOT_BEGUN)
        o->state = TRAP;
}

static void run_all(struct outcome *o, struct options *options)
{
    pid_t pid[MAX_JOBS] = {0};
    int number[MAX_JOBS], next = 0, done = 0;

    while (done < options->count) {
        int status = 0;
        pid_t ended;

        if (stopped)
            options->count = next;
        for (int j = 0; j < options->jobs && next < options->count; j++)
            if (pid[j] <= 0) {
                number[j] = next;
                pid[j] = start(&o[next], options, options->first + next);
                next++;
            }
        ended = wait(&status);
        for (int j = 0; j < options->jobs; j++)
            if (pid[j] == ended) {
                end(&o[number[j]], status);
                pid[j] = 0;
                done++;
                if (isatty(2) || done % 10 == 0 || done == options->count)
                    fprintf(stderr, "\r%d of %d lenses%s", done, options->count,
                            isatty(2) && done < options->count ? "" : "\n");
            }
        if (ended < 0 && errno != EINTR)
            return;
    }
}

/* ------------------------------------------------------------------ report */

static int by_psnr(const void *a, const void *b)
{
    const struct outcome *const *x = a, *const *y = b;

    return ((*x)->psnr_db > (*y)->psnr_db) - ((*x)->psnr_db < (*y)->psnr_db);
}

static void write_table(const struct options *options, int rank, int number)
{
    static struct glint_prescription lens;
    static char text[RANDOM_LENS_TEXT];
    char path[512];
    FILE *file;

    random_lens(&lens, options->seed, number, text);
    snprintf(path, sizeof path, "%s/worst-%d.lens", options->out, rank);
    file = fopen(path, "w");
    if (!file)
        return;
    fprintf(file, "# seed %llu, lens %d\n%s", (unsigned long long)options->seed,
            number, text);
    fclose(file);
}

static void print_one(const struct outcome *o, int number)
{
    printf("  lens %d: %d surfaces, %d ghosts, f %.4g mm, f/%.3g, light at "
           "%.3g deg: %.1f dB, flux x %.4f, p99 %.0f codes (grid %d)\n",
           number, o->n_surfaces, o->n_ghosts, o->focal_mm, o->f_number,
           o->theta_deg, o->psnr_db, o->flux, o->p99, o->grid);
}

static int report(struct outcome *o, const struct options *options)
{
    struct outcome **ranked = calloc((size_t)options->count, sizeof *ranked);
    int n = 0, count[8] = {0}, thrown = 0, n_worst;
    double flux = 0;

    for (int i = 0; ranked && i < options->count; i++) {
        count[o[i].state + 2]++;
        thrown += o[i].tries;
        if (o[i].state == TRAP)
            printf("  lens %d: trap, %s\n", options->first + i, o[i].why);
        if (o[i].state == DRAWN) {
            ranked[n++] = &o[i];
            flux = fmax(flux, fabs(o[i].flux - 1));
        }
    }
    if (!ranked || n == 0)
        return 1;
    qsort(ranked, (size_t)n, sizeof *ranked, by_psnr);
    n_worst = n < WORST ? n : WORST;
    printf("%d lenses of seed %llu: %d drawn, %d dark both ways, %d left out "
           "after %d s, %d refused by the bake; %d tables were thrown away\n",
           options->count, (unsigned long long)options->seed, n,
           count[DARK + 2], count[SKIPPED_TIME + 2], options->seconds,
           count[REFUSED + 2], thrown);
    for (int i = 0; i < n_worst; i++)
        print_one(ranked[i], options->first + (int)(ranked[i] - o));
    printf("  median %.1f dB, a tenth below %.1f dB\n", ranked[n / 2]->psnr_db,
           ranked[n / 10]->psnr_db);
    if (options->out && mkdir(options->out, 0777) && errno != EEXIST)
        return 1;
    for (int i = 0; i < n_worst && options->out; i++)
        write_table(options, i + 1, options->first + (int)(ranked[i] - o));
    extreme_at_most("random lenses: traps", count[TRAP + 2], 0, "lenses");
    /* The median is 54 dB. A few are far below: large, straight ghosts get 8
     * cells a side, by which a round stop has corners. */
    extreme_at_least("random lenses: worst against exact", ranked[0]->psnr_db,
                     20, "dB");
    extreme_at_most("random lenses: flux against exact", flux, 0.05, "");
    flux = ranked[0]->psnr_db;
    free(ranked);
    return count[TRAP + 2] > 0 || flux < 20;
}

static bool parse(struct options *o, int argc, char **argv)
{
    static const struct option names[] = {
        {"seed", required_argument, NULL, 's'},
        {"first", required_argument, NULL, 'f'},
        {"count", required_argument, NULL, 'n'},
        {"jobs", required_argument, NULL, 'j'},
        {"seconds", required_argument, NULL, 't'},
        {"out", required_argument, NULL, 'o'},
        {NULL, 0, NULL, 0}};
    int c;

    while ((c = getopt_long(argc, argv, "", names, NULL)) != -1)
        switch (c) {
        case 's':
            o->seed = strtoull(optarg, NULL, 10);
            break;
        case 'f':
            o->first = atoi(optarg);
            break;
        case 'n':
            o->count = atoi(optarg);
            break;
        case 'j':
            o->jobs = atoi(optarg);
            break;
        case 't':
            o->seconds = atoi(optarg);
            break;
        case 'o':
            o->out = optarg;
            break;
        default:
            return false;
        }
    return optind == argc && o->count > 0 && o->jobs > 0 &&
           o->jobs <= MAX_JOBS && o->seconds > 0 && o->first >= 0;
}

int main(int argc, char **argv)
{
    struct options options = {
        .seed = 1, .count = 500, .jobs = 2, .seconds = 20};
    struct outcome *o;

    if (!parse(&options, argc, argv)) {
        fprintf(stderr, "random_lenses [--seed S] [--first N] [--count N] "
                        "[--jobs N] [--seconds S] [--out DIR]\n");
        return 2;
    }
    o = mmap(NULL, (size_t)options.count * sizeof *o, PROT_READ | PROT_WRITE,
             MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (o == MAP_FAILED) {
        perror("random_lenses");
        return 1;
    }
    sigaction(SIGINT, &(struct sigaction){.sa_handler = stop}, NULL);
    run_all(o, &options);
    return report(o, &options);
}
