/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/plots/plot.h"
#include "lab/sweep.h"

#define GREY  "#bbb"
#define FRONT "#222"

static const char *cost_words(const struct sweep *s)
{
    return s->by_instructions ? "million instructions" : "times memory floor";
}

/* ------------------------------------------------------------------- front */

/* A point of a front plot. */
struct dot {
    const struct sweep_setting *set;
    double cost, psnr_db;
    bool front;
};

static int by_cost(const void *a, const void *b)
{
    const struct dot *x = a, *y = b;

    return (x->cost > y->cost) - (x->cost < y->cost);
}

/* Draws the marks of DOT[N], combinations first, so that other marks lie on top
 * of them. */
static void draw_dots(const struct plot *p, const struct dot *dot, int n,
                      bool tips)
{
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < n; i++) {
            const struct sweep_setting *set = dot[i].set;
            const bool together = set->kind == SWEEP_TOGETHER;
            char words[160], tip[240];

            sweep_words(set, words, sizeof words);
            snprintf(tip, sizeof tip, "%s: %.3g, %.1f dB", words, dot[i].cost,
                     dot[i].psnr_db);
            if (together == (pass == 0))
                plot_mark(p, dot[i].cost, dot[i].psnr_db,
                          together                      ? '.'
                          : set->kind == SWEEP_QUALITY  ? 'D'
                          : set->kind == SWEEP_STANDARD ? 's'
                                                        : 'o',
                          together                   ? GREY
                          : set->kind == SWEEP_ALONE ? plot_colour(set->dial)
                                                     : FRONT,
                          tips ? tip : NULL);
        }
}

/* Draws a line along the front of DOT[N], which is sorted by cost. */
static void draw_front(const struct plot *p, const struct dot *dot, int n)
{
    const struct dot *last = NULL;

    for (int i = 0; i < n; i++)
        if (dot[i].front) {
            if (last)
                plot_line(p, last->cost, last->psnr_db, dot[i].cost,
                          dot[i].psnr_db, FRONT, true);
            last = &dot[i];
        }
}

static void front_panel(FILE *file, int number, const char *title,
                        const char *words, struct dot *dot, int n, bool tips)
{
    struct plot p;
    bool seen[MAX_DIALS] = {false};

    if (n > 0)
        qsort(dot, (size_t)n, sizeof *dot, by_cost);
    plot_init(&p, file, number, title);
    p.x.is_log = true;
    p.x.words = words;
    p.y.words = "PSNR, dB";
    for (int i = 0; i < n; i++)
        plot_stretch(&p, dot[i].cost, dot[i].psnr_db);
    plot_frame(&p);
    plot_key(&p, 'D', FRONT, "--quality");
    plot_key(&p, '.', GREY, "together");
    for (int i = 0; i < n; i++)
        if (dot[i].set->dial >= 0 && !seen[dot[i].set->dial]) {
            seen[dot[i].set->dial] = true;
            plot_key(&p, 'o', plot_colour(dot[i].set->dial),
                     dials[dot[i].set->dial].name);
        }
    draw_front(&p, dot, n);
    draw_dots(&p, dot, n, tips);
}

/* Plots the means over all cases that are swept together, and each of these
 * cases. */
void sweep_svg_front(const struct sweep *s, FILE *file)
{
    const size_t most = (size_t)s->n_points + 1;
    struct sweep_mean *mean = malloc(most * sizeof *mean);
    struct dot *dot = malloc(most * sizeof *dot);
    int n_panels = 1, n_dots = 0, n;
    char title[160];

    for (int c = 0; c < s->n_cases; c++)
        n_panels += s->scase[c].together;
    plot_open(file, n_panels);
    n = mean && dot ? sweep_means(s, mean, s->n_points) : 0;
    for (int i = 0; i < n; i++)
        if (mean[i].flux_error < MAX_FLUX_ERROR)
            dot[n_dots++] = (struct dot){mean[i].set, mean[i].cost,
                                         mean[i].psnr_db, mean[i].front};
    front_panel(file, 0, "All lenses: mean error and relative cost",
                "times the default's", dot, n_dots, true);
    n_panels = 1;
    for (int c = 0; c < s->n_cases && dot; c++) {
        const struct sweep_case *k = &s->scase[c];

        if (!k->together)
            continue;
        n_dots = 0;
        for (int i = 0; i < k->n; i++) {
            const struct sweep_point *p = &s->point[k->first + i];

            if (fabs(p->flux_error) < MAX_FLUX_ERROR)
                dot[n_dots++] = (struct dot){&p->set, sweep_cost(s, p),
                                             p->psnr_db, p->front};
        }
        snprintf(title, sizeof title, "%s, %dx%d", s->lens[k->lens], k->width,
                 k->height);
        front_panel(file, n_panels++, title, cost_words(s), dot, n_dots, true);
    }
    plot_close(file);
    free(mean);
    free(dot);
}

/* ------------------------------------------------------------------- means */

/* Draws the means of dial D turned by itself as a curve through the standard,
 * in the order of its values. */
static void mean_curve(const struct plot *p, const struct sweep_mean *mean,
                       int n, int d)
{
    const struct sweep_mean *last = NULL;

    for (int v = 0; v < dials[d].n_values; v++)
        for (int i = 0; i < n; i++) {
            const struct sweep_setting *set = mean[i].set;

            if ((set->dial != d && set->kind != SWEEP_STANDARD) ||
                set->value[d] != dials[d].value[v])
                continue;
            if (last)
                plot_line(p, last->cost, last->psnr_db, mean[i].cost,
                          mean[i].psnr_db, plot_colour(d), false);
            plot_mark(p, mean[i].cost, mean[i].psnr_db, 'o', plot_colour(d),
                      NULL);
            last = &mean[i];
        }
}

/* Plots all dials in one panel, whose axes leave out means of more than six
 * times the default's cost. */
static void dials_panel(FILE *file, int number, const struct sweep_mean *mean,
                        int n)
{
    bool seen[MAX_DIALS] = {false};
    struct plot p;

    plot_init(&p, file, number, "Each dial by itself");
    p.x.is_log = true;
    p.x.words = "times the default's";
    p.y.words = "PSNR, dB";
    for (int i = 0; i < n; i++)
        if (mean[i].set->dial >= 0 && mean[i].flux_error < MAX_FLUX_ERROR &&
            mean[i].cost < 6) {
            plot_stretch(&p, mean[i].cost, mean[i].psnr_db);
            seen[mean[i].set->dial] = true;
        }
    plot_frame(&p);
    for (int d = 0; d < n_dials; d++)
        if (seen[d]) {
            plot_key(&p, 'o', plot_colour(d), dials[d].name);
            mean_curve(&p, mean, n, d);
        }
}

void sweep_svg_trade(const struct sweep *s, FILE *file)
{
    const size_t most = (size_t)s->n_points + 1;
    struct sweep_mean *mean = malloc(most * sizeof *mean);
    struct dot *dot = malloc(most * sizeof *dot);
    const int n = mean && dot ? sweep_means(s, mean, s->n_points) : 0;
    int n_near = 0;

    for (int i = 0; i < n; i++)
        if (mean[i].flux_error < MAX_FLUX_ERROR && mean[i].cost < 8)
            dot[n_near++] = (struct dot){mean[i].set, mean[i].cost,
                                         mean[i].psnr_db, mean[i].front};
    plot_open(file, 2);
    front_panel(file, 0, "Error against cost, all lenses",
                "times the default's", dot, n_near, false);
    dials_panel(file, 1, mean, n);
    plot_close(file);
    free(mean);
    free(dot);
}

/* ------------------------------------------------------------------- dials */

static bool is_of(const struct sweep_point *p, int dial)
{
    return p->set.kind == SWEEP_STANDARD || p->set.dial == dial;
}

/* Draws DIAL in case C as a curve, in the order of its values. */
static void dial_curve(const struct sweep *s, const struct plot *p, int c,
                       int dial)
{
    const struct sweep_case *k = &s->scase[c];
    const struct sweep_point *at = NULL, *last = NULL;

    for (int v = 0; v < dials[dial].n_values; v++) {
        char words[32];

        at = NULL;
        for (int i = 0; i < k->n; i++) {
            const struct sweep_point *q = &s->point[k->first + i];

            if (is_of(q, dial) && q->set.value[dial] == dials[dial].value[v])
                at = q;
        }
        if (!at)
            continue;
        if (last)
            plot_line(p, sweep_cost(s, last), last->psnr_db, sweep_cost(s, at),
                      at->psnr_db, plot_colour(k->lens), false);
        snprintf(words, sizeof words, "%g", dials[dial].value[v]);
        plot_mark(p, sweep_cost(s, at), at->psnr_db,
                  at->set.kind == SWEEP_STANDARD ? 's' : 'o',
                  plot_colour(k->lens), words);
        plot_words(p, sweep_cost(s, at), at->psnr_db, words);
        last = at;
    }
}

/* Checks whether any case turned DIAL by itself. */
static bool is_swept(const struct sweep *s, int dial)
{
    for (int i = 0; i < s->n_points; i++)
        if (s->point[i].set.dial == dial)
            return true;
    return false;
}

static void dial_panel(const struct sweep *s, FILE *file, int number, int dial)
{
    struct plot p;

    plot_init(&p, file, number, dials[dial].name);
    p.x.is_log = true;
    p.x.words = cost_words(s);
    p.y.words = "PSNR, dB";
    for (int i = 0; i < s->n_points; i++)
        if (is_of(&s->point[i], dial))
            plot_stretch(&p, sweep_cost(s, &s->point[i]), s->point[i].psnr_db);
    plot_frame(&p);
    for (int c = 0; c < s->n_cases; c++)
        if (s->scase[c].together || dials[dial].many_lights)
            dial_curve(s, &p, c, dial);
    for (int i = 0; i < s->n_lenses; i++) {
        char name[16];

        snprintf(name, sizeof name, "%s", s->lens[i]);
        plot_key(&p, 'o', plot_colour(i), name);
    }
}

void sweep_svg_dials(const struct sweep *s, FILE *file)
{
    int n_panels = 0;

    for (int d = 0; d < n_dials; d++)
        n_panels += is_swept(s, d);
    plot_open(file, n_panels);
    n_panels = 0;
    for (int d = 0; d < n_dials; d++)
        if (is_swept(s, d))
            dial_panel(s, file, n_panels++, d);
    plot_close(file);
}

/* ------------------------------------------------------------------ growth */

enum against { PIXELS, LIGHTS, GHOSTS, N_AGAINST };

static double growth_of(const struct sweep *s, const struct sweep_point *p,
                        enum against what)
{
    const struct sweep_case *c = &s->scase[p->of];

    return what == PIXELS   ? 1e-6 * c->width * c->height
           : what == LIGHTS ? c->n_lamps
                            : p->report.ghosts;
}

/* Checks whether P differs from PLAIN in nothing but what the panel plots
 * against. */
static bool is_in_series(const struct sweep *s, const struct sweep_point *p,
                         const struct sweep_case *plain, enum against what)
{
    const struct sweep_case *c = &s->scase[p->of];

    return p->set.kind == SWEEP_GROWTH && c->lens == plain->lens &&
           (what == PIXELS || c->width == plain->width) &&
           (what == LIGHTS || c->n_lamps == plain->n_lamps) &&
           (what == GHOSTS || c->angle == plain->angle);
}

static double spent(const struct sweep *s, const struct sweep_point *p)
{
    return s->by_instructions ? 1e-6 * p->instructions : p->ms;
}

static void growth_panel(const struct sweep *s, FILE *file, enum against what)
{
    static const char *const titles[] = {"A frame against pixels",
                                         "A frame against lights",
                                         "A frame against ghosts"};
    static const char *const words[] = {"megapixels", "lights",
                                        "ghosts drawn, by angle"};
    struct plot p;

    plot_init(&p, file, (int)what, titles[what]);
    p.x.is_log = p.y.is_log = true;
    p.x.words = words[what];
    p.y.words = s->by_instructions ? "million instructions" : "ms";
    for (int pass = 0; pass < 2; pass++) {
        int lens = -1;

        for (int c = 0; c < s->n_cases; c++) {
            if (!s->scase[c].growth || s->scase[c].lens == lens)
                continue;
            lens = s->scase[c].lens;
            for (int i = 0; i < s->n_points; i++) {
                const struct sweep_point *q = &s->point[i];
                const double x = growth_of(s, q, what);

                if (!is_in_series(s, q, &s->scase[c], what))
                    continue;
                if (pass == 0)
                    plot_stretch(&p, x, spent(s, q));
                else
                    plot_mark(&p, x, spent(s, q), 'o', plot_colour(lens), NULL);
            }
        }
        if (pass == 0)
            plot_frame(&p);
    }
    for (int i = 0; i < s->n_lenses; i++) {
        char name[16];

        snprintf(name, sizeof name, "%s", s->lens[i]);
        plot_key(&p, 'o', plot_colour(i), name);
    }
}

bool sweep_has_growth(const struct sweep *s)
{
    return s->n_points > 0 &&
           s->point[s->n_points - 1].set.kind == SWEEP_GROWTH;
}

void sweep_svg_growth(const struct sweep *s, FILE *file)
{
    plot_open(file, N_AGAINST);
    for (int what = 0; what < N_AGAINST; what++)
        growth_panel(s, file, (enum against)what);
    plot_close(file);
}
