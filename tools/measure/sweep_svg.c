/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/plots/plot.h"
#include "measure/sweep.h"

#define GREY  "#bbb"
#define FRONT "#222"
#define COST  "times memory floor"

static struct plot begin_plot_panel(FILE *file, int number, const char *title,
                                    const char *words)
{
    struct plot p;

    plot_init(&p, file, number, title);
    p.x.is_log = true;
    p.x.words = words;
    p.y.words = "PSNR, dB";
    return p;
}

/* ------------------------------------------------------------------- front */

/* Draws the marks of DOT[N], combinations first, so that other marks lie on top
 * of them. */
static void draw_setting_dots(const struct plot *p,
                              const struct sweep_mean *dot, int n)
{
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < n; i++) {
            /* mark of each kind of setting, by enum sweep_kind */
            static const char mark[] = "so.D";
            const struct sweep_setting *set = dot[i].set;
            char words[160], tip[240];

            if ((set->kind == SWEEP_TOGETHER) != (pass == 0))
                continue;
            sweep_describe_setting(set, words);
            snprintf(tip, sizeof tip, "%s: %.3g, %.1f dB", words, dot[i].cost,
                     dot[i].psnr_db);
            plot_draw_mark(p, dot[i].cost, dot[i].psnr_db, mark[set->kind],
                           pass == 0 ? GREY
                           : set->alone >= 0
                               ? plot_get_colour_of_series(set->alone)
                               : FRONT,
                           tip);
        }
}

/* Plots DOT[N], which must be sorted by cost, and a line along their Pareto
 * front. */
static void draw_front_panel(struct plot *p, const struct sweep_mean *dot,
                             int n)
{
    const struct sweep_mean *last = NULL;
    bool seen[MAX_PARAMETERS] = {false};

    for (int i = 0; i < n; i++)
        plot_extend_axes(p, dot[i].cost, dot[i].psnr_db);
    plot_draw_frame(p);
    plot_draw_legend_entry(p, 'D', FRONT, "--quality");
    plot_draw_legend_entry(p, '.', GREY, "together");
    for (int i = 0; i < n; i++) {
        const int d = dot[i].set->alone;

        if (d >= 0 && !seen[d]) {
            seen[d] = true;
            plot_draw_legend_entry(p, 'o', plot_get_colour_of_series(d),
                                   sweep_parameter[d].name);
        }
        if (dot[i].front) {
            if (last)
                plot_draw_line(p, last->cost, last->psnr_db, dot[i].cost,
                               dot[i].psnr_db, FRONT, true);
            last = &dot[i];
        }
    }
    draw_setting_dots(p, dot, n);
}

/* Plots the means over all cases with combined parameters, and each of these
 * cases, without settings whose flux error reaches MAX_FLUX_ERROR. */
void sweep_write_front_svg(const struct sweep *s, FILE *file)
{
    int n_panels = 1, n, n_dots = 0;
    struct sweep_mean *const dot = sweep_compute_means(s, &n);
    struct plot p;
    char title[160];

    for (int c = 0; c < s->n_cases; c++)
        n_panels += s->scase[c].together;
    plot_open(file, n_panels);
    for (int i = 0; i < n; i++)
        if (dot[i].flux_error < MAX_FLUX_ERROR)
            dot[n_dots++] = dot[i];
    p = begin_plot_panel(file, 0, "All lenses: mean error and relative cost",
                         "times the default's");
    draw_front_panel(&p, dot, n_dots);
    n_panels = 1;
    for (int c = 0; c < s->n_cases && dot; c++) {
        const struct sweep_case *k = &s->scase[c];

        if (!k->together)
            continue;
        n_dots = 0;
        for (int i = k->first; i < k->first + k->n; i++) {
            const struct sweep_point *q = &s->point[i];

            if (fabs(q->metric[SWEEP_FLUX_ERROR]) < MAX_FLUX_ERROR)
                dot[n_dots++] =
                    (struct sweep_mean){.set = &q->set,
                                        .cost = q->metric[SWEEP_RATIO],
                                        .psnr_db = q->metric[SWEEP_PSNR_DB],
                                        .front = q->front};
        }
        sweep_sort_means(dot, n_dots);
        snprintf(title, sizeof title, "%s, %dx%d", s->lens[k->lens], k->width,
                 k->height);
        p = begin_plot_panel(file, n_panels++, title, COST);
        draw_front_panel(&p, dot, n_dots);
    }
    plot_close(file);
    free(dot);
}

/* ------------------------------------------------------- single parameters */

static bool is_point_of_parameter(const struct sweep_point *p, int d)
{
    return p->set.kind == SWEEP_STANDARD || p->set.alone == d;
}

/* Draws parameter D in case K as a curve, in the order of its values. */
static void draw_parameter_curve(const struct sweep *s, const struct plot *p,
                                 const struct sweep_case *k, int d)
{
    const struct sweep_parameter *const parameter = &sweep_parameter[d];
    double x = (double)NAN, y = (double)NAN;

    for (int v = 0; v < parameter->n_values; v++)
        for (int i = k->first; i < k->first + k->n; i++) {
            const struct sweep_point *const q = &s->point[i];
            const double cost = q->metric[SWEEP_RATIO],
                         db = q->metric[SWEEP_PSNR_DB];
            char words[32];

            if (!is_point_of_parameter(q, d) ||
                q->set.value[d] != parameter->value[v])
                continue;
            plot_draw_line(p, x, y, cost, db,
                           plot_get_colour_of_series(k->lens), false);
            snprintf(words, sizeof words, "%g", parameter->value[v]);
            plot_draw_mark(p, cost, db,
                           q->set.kind == SWEEP_STANDARD ? 's' : 'o',
                           plot_get_colour_of_series(k->lens), words);
            plot_draw_label(p, cost, db, words);
            x = cost;
            y = db;
        }
}

static void draw_parameter_panel(const struct sweep *s, FILE *file, int number,
                                 int d)
{
    struct plot p =
        begin_plot_panel(file, number, sweep_parameter[d].name, COST);

    for (int i = 0; i < s->n_points; i++)
        if (is_point_of_parameter(&s->point[i], d))
            plot_extend_axes(&p, s->point[i].metric[SWEEP_RATIO],
                             s->point[i].metric[SWEEP_PSNR_DB]);
    plot_draw_frame(&p);
    for (int c = 0; c < s->n_cases; c++)
        if (s->scase[c].together || sweep_parameter[d].many_lights)
            draw_parameter_curve(s, &p, &s->scase[c], d);
    for (int i = 0; i < s->n_lenses; i++) {
        char name[16];

        snprintf(name, sizeof name, "%s", s->lens[i]);
        plot_draw_legend_entry(&p, 'o', plot_get_colour_of_series(i), name);
    }
}

void sweep_write_dials_svg(const struct sweep *s, FILE *file)
{
    bool swept[MAX_PARAMETERS] = {false};
    int n_panels = 0;

    for (int i = 0; i < s->n_points; i++)
        if (s->point[i].set.alone >= 0)
            swept[s->point[i].set.alone] = true;
    for (int d = 0; d < n_sweep_parameters; d++)
        n_panels += swept[d];
    plot_open(file, n_panels);
    n_panels = 0;
    for (int d = 0; d < n_sweep_parameters; d++)
        if (swept[d])
            draw_parameter_panel(s, file, n_panels++, d);
    plot_close(file);
}
