/* SPDX-License-Identifier: MIT
 *
 * The page of a translucent medium: a table, curves and pictures of all models.
 */
#include "measure/plots/plot.h"
#include "reference/scatter/stone_models.h"

static const char explained[] =
    "RMSE, percentiles of texels and one-way (rms of R'(x, y) - R'(y, x)) are "
    "of the largest entry of the rows. Light is the radiosity under lamps, "
    "shadows and a ramp, its peak is 1. Energy is the largest sum of a row: "
    "above 1 a model makes light. kB as the sources count, 8 bytes a number.";

#define COLUMNS                                                               \
    "model|RMSE|kB|smaller by|entries, dB|light, dB|p50|p95|max|below 0, %%|" \
    "one way|energy|seconds"

/* Half of them are named in each panel. */
static const char *const series[] = {"clustered", "factored", "albedo", "SVD",
                                     "log-SVD",   "Tucker",   "turned", "ALS",
                                     "Peers",     "SubEdit"};

enum { KEYS = 5 };

/* Writes the numbers of J to TEXT[300], after BETWEEN each. */
static void numbers(const struct glint_scatter_judgement *j,
                    const char *between, char *text)
{
    const double x[] = {j->rmse,     j->bytes / 1e3, j->compression,
                        j->entry_db, j->light_db,    j->p50,
                        j->p95,      j->largest,     100 * j->negative,
                        j->one_way,  j->energy,      j->seconds};
    static const int digits[] = {5, 0, 0, 1, 1, 5, 5, 5, 2, 5, 3, 1};
    int at = 0;

    for (int i = 0; i < 12; i++)
        at += snprintf(text + at, 300 - (size_t)at, "%s%.*f", between,
                       digits[i], x[i]);
}

/* What was searched for, of logarithms. */
static const char *found(const struct stone_model *model, char text[60])
{
    const struct glint_scatter_candidate *o = &model->judged.candidate;

    *text = '\0';
    if (o->kind == GLINT_CANDIDATE_LOG_SVD)
        snprintf(text, 60, " (a %g, b %g)", o->a, o->b);
    return text;
}

void stone_page_md(const struct stone_models *m, FILE *file)
{
    char text[300], what[60];

    fprintf(file,
            "# Models of %s\n\n%d x %d texels, kernels of %d. %s\n\n"
            "![curves](curves.svg)\n\n|",
            m->name, m->side, m->side, m->kernel, explained);
    fprintf(file, COLUMNS "|\n|---");
    for (int i = 0; i < 12; i++)
        fprintf(file, "|---:");
    for (int i = 0; i < STONE_MODELS; i++) {
        const struct stone_model *const model = &m->model[i];

        numbers(&model->judged, " | ", text);
        fprintf(file, "|\n| [%s](%s.png)%s%s ", model->words, model->file,
                found(model, what), text);
    }
    fprintf(file, "|\n");
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

void stone_page_html(const struct stone_models *m, FILE *file)
{
    char title[160], text[300], what[60];

    snprintf(title, sizeof title, "Models of %s", m->name);
    html_begin(file, title, "img{width:500px;image-rendering:pixelated}");
    fprintf(file,
            "<p>%d x %d texels, kernels of %d. %s</p>\n<p>Diamonds are what a "
            "frame can draw.</p>\n",
            m->side, m->side, m->kernel, explained);
    stone_page_svg(m, file);
    fprintf(file, "\n<table>");
    html_row(file, "th", COLUMNS);
    for (int i = 0; i < STONE_MODELS; i++) {
        numbers(&m->model[i].judged, "|", text);
        html_row(file, "td", "%s%s%s", m->model[i].words,
                 found(&m->model[i], what), text);
    }
    fprintf(file,
            "</table>\n<h2>Pictures</h2>\n<p>Light of the model, 16 times "
            "its difference to that of the full rows about grey, and the error "
            "of each texel's row, white = the worst of all models.</p>\n");
    for (int i = 0; i < STONE_MODELS; i++)
        fprintf(file,
                "<figure><img src=\"%s.png\" alt=\"\"><figcaption>%s: %.1f "
                "dB</figcaption></figure>\n",
                m->model[i].file, m->model[i].words,
                m->model[i].judged.light_db);
    html_end(file);
}
