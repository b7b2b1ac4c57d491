/* SPDX-License-Identifier: MIT
 *
 * The page of a stone: a table, curves and pictures of all models.
 */
#include "lab/plots/plot.h"
#include "lab/scenes/stone_models.h"

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<title>glint: models of a stone</title>\n"
    "<style>body{font:15px/1.45 sans-serif;max-width:1060px;margin:2em auto;"
    "padding:0 1em;color:#222}table{border-collapse:collapse;font-size:13px}"
    "td,th{padding:2px 9px;text-align:right;border-bottom:1px solid #ddd}"
    "td:first-child,th:first-child{text-align:left}figure{display:inline-block;"
    "margin:0 8px 14px 0;font-size:12px}img{display:block;width:500px;"
    "image-rendering:pixelated}</style></head><body>\n";

static const char explained[] =
    "RMSE, percentiles of texels and one-way (rms of R'(x, y) - R'(y, x)) are "
    "of the largest entry of the rows. Light is the radiosity under lamps, "
    "shadows and a ramp, its peak is 1. Energy is the largest sum of a row: "
    "above 1 a model makes light. kB as the sources count, 8 bytes a number.";

static const char *const columns[] = {
    "model",     "RMSE",   "kB",     "smaller by", "entries, dB",
    "light, dB", "p50",    "p95",    "max",        "below 0, %",
    "one way",   "energy", "seconds"};

/* Half of them are named in each panel. */
static const char *const series[] = {"clustered", "factored", "albedo", "SVD",
                                     "log-SVD",   "Tucker",   "turned", "ALS",
                                     "Peers",     "SubEdit"};

enum { KEYS = 5 };

enum { COLUMNS = sizeof columns / sizeof *columns };

/* Prints a row of numbers with BETWEEN. */
static void numbers(const struct glint_scatter_judgement *j,
                    const char *between, FILE *file)
{
    fprintf(file, "%.5f%s%.0f%s%.0f%s%.1f%s%.1f%s", j->rmse, between,
            j->bytes / 1e3, between, j->compression, between, j->entry_db,
            between, j->light_db, between);
    fprintf(file, "%.5f%s%.5f%s%.5f%s%.2f%s%.5f%s%.3f%s%.1f", j->p50, between,
            j->p95, between, j->largest, between, 100 * j->negative, between,
            j->one_way, between, j->energy, between, j->seconds);
}

/* What was searched for, of logarithms. */
static void found(const struct stone_model *model, FILE *file)
{
    const struct glint_scatter_candidate *o = &model->judged.candidate;

    if (o->kind == GLINT_CANDIDATE_LOG_SVD)
        fprintf(file, " (a %g, b %g)", o->a, o->b);
}

void stone_page_md(const struct stone_models *m, FILE *file)
{
    fprintf(file,
            "# Models of %s\n\n%d x %d texels, kernels of %d. %s\n\n"
            "![curves](curves.svg)\n\n|",
            m->name, m->side, m->side, m->kernel, explained);
    for (int i = 0; i < COLUMNS; i++)
        fprintf(file, " %s |", columns[i]);
    fprintf(file, "\n|---|");
    for (int i = 1; i < COLUMNS; i++)
        fprintf(file, "---:|");
    for (int i = 0; i < STONE_MODELS; i++) {
        fprintf(file, "\n| [%s](%s.png)", m->model[i].words, m->model[i].file);
        found(&m->model[i], file);
        fprintf(file, " | ");
        numbers(&m->model[i].judged, " | ", file);
        fprintf(file, " |");
    }
    fprintf(file, "\n");
}

/* Curves of A by bytes: RMSE, or decibels of light. */
static void panel(const struct stone_models *m, FILE *file, int number)
{
    struct plot plot;

    plot_init(&plot, file, number,
              number ? "Light under lamps and shadows" : "Entries of rows");
    plot.x.words = "kB";
    plot.x.is_log = true;
    plot.y.words = number ? "PSNR, dB" : "RMSE, the largest entry = 1";
    plot.y.is_log = !number;
    for (int i = 0; i < STONE_MODELS; i++) {
        const struct glint_scatter_judgement *j = &m->model[i].judged;

        plot_stretch(&plot, j->bytes / 1e3, number ? j->light_db : j->rmse);
    }
    plot_frame(&plot);
    for (int i = 0; i < STONE_MODELS; i++) {
        const struct stone_model *now = &m->model[i];
        const struct glint_scatter_judgement *j = &now->judged;
        const double x = j->bytes / 1e3, y = number ? j->light_db : j->rmse;
        const char kind = now->asked.kind <= GLINT_CANDIDATE_ALBEDO ? 'd' : 'o';

        plot_mark(&plot, x, y, kind, plot_colour(now->series), now->words);
        if (i > 0 && now[-1].series == now->series) {
            const struct glint_scatter_judgement *last = &now[-1].judged;

            plot_line(&plot, last->bytes / 1e3,
                      number ? last->light_db : last->rmse, x, y,
                      plot_colour(now->series), false);
        } else if (now->series / KEYS == number) {
            plot_key(&plot, kind, plot_colour(now->series),
                     series[now->series]);
        }
    }
}

void stone_page_svg(const struct stone_models *m, FILE *file)
{
    plot_open(file, 2);
    panel(m, file, 0);
    panel(m, file, 1);
    plot_close(file);
}

/* NAME comes from a path. */
static void escaped(const char *words, FILE *file)
{
    for (; *words; words++)
        if (*words == '<' || *words == '&' || *words == '>')
            fprintf(file, "&#%d;", *words);
        else
            fputc(*words, file);
}

void stone_page_html(const struct stone_models *m, FILE *file)
{
    fputs(head, file);
    fprintf(file, "<h1>Models of ");
    escaped(m->name, file);
    fprintf(file, "</h1>\n<p>%d x %d texels, kernels of %d. %s</p>\n", m->side,
            m->side, m->kernel, explained);
    fprintf(file, "<p>Diamonds are what a frame can draw.</p>\n");
    stone_page_svg(m, file);
    fprintf(file, "\n<table><tr>");
    for (int i = 0; i < COLUMNS; i++)
        fprintf(file, "<th>%s</th>", columns[i]);
    for (int i = 0; i < STONE_MODELS; i++) {
        fprintf(file, "</tr>\n<tr><td>%s", m->model[i].words);
        found(&m->model[i], file);
        fprintf(file, "</td><td>");
        numbers(&m->model[i].judged, "</td><td>", file);
        fprintf(file, "</td>");
    }
    fprintf(file,
            "</tr></table>\n<h2>Pictures</h2>\n<p>Light of the model, 16 times "
            "its difference to that of the full rows about grey, and the error "
            "of each texel's row, white = the worst of all models.</p>\n");
    for (int i = 0; i < STONE_MODELS; i++)
        fprintf(file,
                "<figure><img src=\"%s.png\" alt=\"\"><figcaption>%s: %.1f "
                "dB</figcaption></figure>\n",
                m->model[i].file, m->model[i].words,
                m->model[i].judged.light_db);
    fprintf(file, "</body></html>\n");
}
