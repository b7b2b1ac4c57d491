/* SPDX-License-Identifier: MIT
 *
 * What a sweep of a scene has found: table, plots, page. */
#include <math.h>
#include <stdlib.h>

#include "lab/plots/plot.h"
#include "reference/scenes/scene_sweep.h"
#include "lab/sweep.h"
#include "options/json_writer.h"

#define GREY  "#bbb"
#define FRONT "#222"

static const char *const dial_name[SCENE_DIALS] = {
    "edge_samples", "shadow_points", "shading",    "lookups",
    "levels",       "stone_model",   "planes",     "rank",
    "code_bits",    "tap_bits",      "map_texels", "stone_frames"};
static const char *const kinds[] = {"standard", "alone", "together"};
static const char *const shading[] = {"", "full", "half"};

double scene_sweep_cost(const struct scene_sweep *s,
                        const struct scene_point *p)
{
    return s->by_instructions ? 1e-6 * p->instructions : p->ratio;
}

static void format_point(const struct scene_point *p, char *text, size_t bytes)
{
    char stone[100] = "";

    if (p->value[SCENE_FRAMES])
        stone_sweep_words(p, stone, sizeof stone);
    snprintf(text, bytes, "samples %d, points %d, %s, lookups %d%s%s%s",
             p->value[SCENE_EDGES], p->value[SCENE_SHADOWED],
             shading[p->value[SCENE_SHADING]], p->value[SCENE_LOOKUPS],
             p->value[SCENE_LEVELS] == 1 ? " nearest" : "", *stone ? ", " : "",
             stone);
}

static bool has_stones(const struct scene_sweep *s)
{
    return s->standard[SCENE_FRAMES] > 0;
}

/* How many dials there are. */
static int dials_of(const struct scene_sweep *s)
{
    return has_stones(s) ? SCENE_DIALS : SCENE_MODEL;
}

static const char *cost_words(const struct scene_sweep *s)
{
    return s->by_instructions ? "million instructions" : "times memory floor";
}

/* ------------------------------------------------------------------- table */

/* Prints X, or nothing if it is not finite. */
static void number(FILE *file, double x)
{
    if (isfinite(x))
        fprintf(file, "%.7g", x);
}

void scene_sweep_csv(const struct scene_sweep *s, FILE *file)
{
    fputs("scene,width,height,kind,dial,quality,edge_samples,shadow_points,"
          "shading,lookups,levels,stone_model,planes,rank,code_bits,tap_bits,"
          "map_texels,stone_frames,ms,floor_ms,ratio,instructions,arena_bytes,"
          "model_bytes,"
          "psnr_db,ssim,p99,flux_error,covered_px,minsn_told,front\n",
          file);
    for (int i = 0; i < s->n_points; i++) {
        const struct scene_point *const p = &s->point[i];
        const double floor_ms = p->ms / p->ratio;
        const double measured[] = {p->ms, floor_ms, p->ratio, p->instructions};
        const double error[] = {p->psnr_db, p->ssim, p->p99, p->flux_error};

        fprintf(file, "%s,%d,%d,%s,%s,", s->scene.model.header->name, s->width,
                s->height, kinds[p->kind],
                p->dial >= 0 ? dial_name[p->dial] : "");
        number(file, p->quality >= 0 ? p->quality : (double)NAN);
        fprintf(file, ",%d,%d,%s,%d,%d", p->value[SCENE_EDGES],
                p->value[SCENE_SHADOWED], shading[p->value[SCENE_SHADING]],
                p->value[SCENE_LOOKUPS], p->value[SCENE_LEVELS]);
        fprintf(file, ",%s", stone_sweep_model(p));
        for (int d = SCENE_PLANES; d < SCENE_DIALS; d++)
            fprintf(file, ",%d", p->value[d]);
        for (int k = 0; k < 4; k++)
            fputc(',', file), number(file, measured[k]);
        fprintf(file, ",%zu,%zu", p->trial->frame.bytes, p->scene->bytes);
        for (int k = 0; k < 4; k++)
            fputc(',', file), number(file, error[k]);
        fprintf(file, ",%d,%.4g,%d\n", p->trial->covered_px,
                p->trial->minsn_told, p->front);
    }
}

static void json_point(struct json_writer *json, const struct scene_sweep *s,
                       const struct scene_point *p)
{
    json_write(json,
               "\n{scene: %s, width: %d, height: %d, kind: %s, quality: %.7g, "
               "edge_samples: %d, shadow_points: %d, shading: %s, lookups: %d, "
               "levels: %d, stone_model: %s",
               s->scene.model.header->name, s->width, s->height, kinds[p->kind],
               p->quality >= 0 ? p->quality : (double)NAN,
               p->value[SCENE_EDGES], p->value[SCENE_SHADOWED],
               shading[p->value[SCENE_SHADING]], p->value[SCENE_LOOKUPS],
               p->value[SCENE_LEVELS], stone_sweep_model(p));
    for (int d = SCENE_PLANES; d < SCENE_DIALS; d++)
        json_write(json, "%s: %d", dial_name[d], p->value[d]);
    json_write(json,
               "ms: %.7g, floor_ms: %.7g, ratio: %.7g, instructions: %.7g, "
               "arena_bytes: %.7g, model_bytes: %.7g, psnr_db: %.7g, "
               "ssim: %.7g, p99: %.7g, flux_error: %.7g, covered_px: %d, "
               "minsn_told: %.7g, front: %c}",
               p->ms, p->ms / p->ratio, p->ratio, p->instructions,
               (double)p->trial->frame.bytes, (double)p->scene->bytes,
               p->psnr_db, p->ssim, p->p99, p->flux_error, p->trial->covered_px,
               p->trial->minsn_told, p->front);
}

void scene_sweep_json(const struct scene_sweep *s, FILE *file)
{
    struct json_writer json = {.to = file};

    json_write(&json, "{rounds: %d, points: [", s->rounds);
    for (int i = 0; i < s->n_points; i++)
        json_point(&json, s, &s->point[i]);
    json_write(&json, "\n]}\n");
}

/* Sets ORDER[n_points] to the points, the cheapest first. */
static void sort(const struct scene_sweep *s, int order[SCENE_POINTS])
{
    for (int i = 0; i < s->n_points; i++) {
        const double cost = scene_sweep_cost(s, &s->point[i]);
        int at = i;

        for (; at > 0 && scene_sweep_cost(s, &s->point[order[at - 1]]) > cost;
             at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
}

void scene_sweep_table(const struct scene_sweep *s, FILE *file)
{
    int order[SCENE_POINTS];

    sort(s, order);
    fprintf(file,
            "%s, %dx%d; %s; KiB of arena + scene; what --budget comes by, and "
            "the front%s",
            s->scene.model.header->name, s->width, s->height, cost_words(s),
            has_stones(s) ? ", of stones each dial by itself" : "");
    if (s->exact_db > 0)
        fprintf(file,
                "; balls of stone are exact by a fit that is %.1f dB from all "
                "of their rows",
                s->exact_db);
    fprintf(file,
            "\n\n| edge samples | shadow points | shading | lookups |%s cost | "
            "PSNR dB | p99 codes | flux %% | KiB | |\n"
            "|---|---|---|---|%s---|---|---|---|---|---|\n",
            has_stones(s) ? " stone |" : "", has_stones(s) ? "---|" : "");
    for (int i = 0; i < s->n_points; i++) {
        const struct scene_point *const p = &s->point[order[i]];

        if (!p->front && p->quality < 0 && p->kind != SCENE_STANDARD &&
            p->dial < SCENE_MODEL)
            continue;
        fprintf(file, "| %d | %d | %s | %d%s |", p->value[SCENE_EDGES],
                p->value[SCENE_SHADOWED], shading[p->value[SCENE_SHADING]],
                p->value[SCENE_LOOKUPS],
                p->value[SCENE_LEVELS] == 1 ? " nearest" : "");
        if (has_stones(s)) {
            char words[100];

            stone_sweep_words(p, words, sizeof words);
            fprintf(file, " %s |", words);
        }
        fprintf(file, " %.4g | %.1f | %g | %+.2f | %zu + %zu | ",
                scene_sweep_cost(s, p), p->psnr_db, p->p99, 100 * p->flux_error,
                p->trial->frame.bytes / 1024, p->scene->bytes / 1024);
        fprintf(file, "%s%s", p->front ? "front" : "",
                p->front && p->quality >= 0 ? ", " : "");
        if (p->quality >= 0)
            fprintf(file, "quality %g", p->quality);
        fputs(" |\n", file);
    }
}

/* ------------------------------------------------------------------- plots */

static void open_panel(const struct scene_sweep *s, struct plot *plot,
                       FILE *file, int number, const char *title)
{
    plot_init(plot, file, number, title);
    plot->x.is_log = true;
    plot->x.words = cost_words(s);
    plot->y.words = "PSNR, dB";
    for (int i = 0; i < s->n_points; i++)
        plot_stretch(plot, scene_sweep_cost(s, &s->point[i]),
                     s->point[i].psnr_db);
    plot_frame(plot);
}

static void mark(const struct scene_sweep *s, const struct plot *plot,
                 const struct scene_point *p)
{
    const double cost = scene_sweep_cost(s, p);
    char words[160], tip[200];

    format_point(p, words, sizeof words);
    snprintf(tip, sizeof tip, "%s: %.3g, %.1f dB", words, cost, p->psnr_db);
    plot_mark(plot, cost, p->psnr_db,
              p->kind == SCENE_STANDARD ? 's'
              : p->quality >= 0         ? 'D'
              : p->dial >= 0            ? 'o'
                                        : '.',
              p->kind == SCENE_STANDARD || p->quality >= 0 ? FRONT
              : p->dial >= 0 ? plot_colour(p->dial)
                             : GREY,
              tip);
}

void scene_sweep_front(const struct scene_sweep *s, FILE *file)
{
    const struct scene_point *last = NULL;
    int order[SCENE_POINTS];
    struct plot plot;
    char title[96];

    sort(s, order);
    snprintf(title, sizeof title, "%s, %dx%d", s->scene.model.header->name,
             s->width, s->height);
    plot_open(file, 1);
    open_panel(s, &plot, file, 0, title);
    plot_key(&plot, 'D', FRONT, "--budget");
    plot_key(&plot, '.', GREY, "together");
    for (int d = 0; d < dials_of(s); d++)
        plot_key(&plot, 'o', plot_colour(d), dial_name[d]);
    for (int i = 0; i < s->n_points; i++) {
        const struct scene_point *const p = &s->point[order[i]];

        if (p->front && last)
            plot_line(&plot, scene_sweep_cost(s, last), last->psnr_db,
                      scene_sweep_cost(s, p), p->psnr_db, FRONT, true);
        last = p->front ? p : last;
    }
    for (int i = 0; i < s->n_points; i++)
        mark(s, &plot, &s->point[order[i]]);
    plot_close(file);
}

/* Draws the curve of DIAL, the others as usual, in the order of its values. */
static void dial_curve(const struct scene_sweep *s, const struct plot *plot,
                       int dial)
{
    const struct scene_point *last = NULL;

    for (int value = 1; value <= 256; value++)
        for (int i = 0; i < s->n_points; i++) {
            const struct scene_point *const p = &s->point[i];
            char words[16];

            if ((p->kind != SCENE_STANDARD && p->dial != dial) ||
                p->value[dial] != value)
                continue;
            if (last)
                plot_line(plot, scene_sweep_cost(s, last), last->psnr_db,
                          scene_sweep_cost(s, p), p->psnr_db, plot_colour(dial),
                          false);
            snprintf(words, sizeof words, "%d", value);
            mark(s, plot, p);
            plot_words(plot, scene_sweep_cost(s, p), p->psnr_db,
                       dial == SCENE_SHADING ? shading[value]
                       : dial == SCENE_MODEL ? stone_sweep_model(p)
                                             : words);
            last = p;
        }
}

void scene_sweep_dials(const struct scene_sweep *s, FILE *file)
{
    plot_open(file, dials_of(s));
    for (int d = 0; d < dials_of(s); d++) {
        struct plot plot;

        open_panel(s, &plot, file, d, dial_name[d]);
        dial_curve(s, &plot, d);
    }
    plot_close(file);
}

/* -------------------------------------------------------------------- page */

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<title>scene_sweep</title>\n"
    "<style>body{font:15px/1.45 sans-serif;max-width:1060px;margin:2em "
    "auto;padding:0 1em;color:#222}table{border-collapse:collapse;font-size:"
    "13px}td,th{padding:2px 9px;text-align:right;border-bottom:1px solid "
    "#ddd}figure{display:inline-block;margin:0 8px 14px 0;vertical-align:top;"
    "font-size:12px}figcaption{max-width:320px}img{display:block;width:320px}"
    "svg{max-width:100%;height:auto}</style></head><body>\n"
    "<h1>What accuracy of a scene costs</h1>\n"
    "<p>The same frame with all values of its dials, each by itself "
    "(coloured), together (grey) and as <code>--budget</code> turns them "
    "(diamonds), against the exact picture: rays in double precision, many a "
    "pixel, 16 points of each light. PSNR, SSIM and the 99th percentile of "
    "differences are of sRGB codes, 8 bits, 1 = white, over light grey. The "
    "line is "
    "the front: nothing that was measured is both cheaper and better.</p>\n";

static void table_row(const struct scene_sweep *s, FILE *file,
                      const struct scene_point *p)
{
    char stone[100] = "";

    if (has_stones(s))
        stone_sweep_words(p, stone, sizeof stone);
    fprintf(file,
            "<tr><td>%d</td><td>%d</td><td>%s</td><td>%d%s</td><td>%s</td>"
            "<td>%.4g</td><td>%.1f</td>"
            "<td>%.4f</td><td>%g</td><td>%+.2f</td><td>%zu</td><td>%s</td>"
            "</tr>\n",
            p->value[SCENE_EDGES], p->value[SCENE_SHADOWED],
            shading[p->value[SCENE_SHADING]], p->value[SCENE_LOOKUPS],
            p->value[SCENE_LEVELS] == 1 ? " nearest" : "", stone,
            scene_sweep_cost(s, p), p->psnr_db, p->ssim, p->p99,
            100 * p->flux_error, p->trial->frame.bytes / 1024,
            p->front ? "front" : "");
}

static void figure(const struct scene_sweep *s, FILE *file,
                   const struct scene_point *p, const uint8_t *rgb,
                   const char *what)
{
    char words[160] = "exact";

    if (p)
        format_point(p, words, sizeof words);
    fputs("<figure><img alt=\"\" src=\"", file);
    sweep_png(file, rgb, s->shrunk_width, s->shrunk_height);
    fprintf(file, "\"><figcaption>%s%s", words, what);
    if (p)
        fprintf(file, "<br>%.3g, %.1f dB", scene_sweep_cost(s, p), p->psnr_db);
    fputs("</figcaption></figure>\n", file);
}

void scene_sweep_page(const struct scene_sweep *s, FILE *file)
{
    int order[SCENE_POINTS];

    sort(s, order);
    fputs(head, file);
    scene_sweep_front(s, file);
    fputs("<h2>Each dial by itself</h2>\n", file);
    scene_sweep_dials(s, file);
    fprintf(file,
            "<h2>All points</h2>\n<table><tr><th>edge samples</th><th>shadow "
            "points</th><th>shading</th><th>lookups</th><th>stone</th>"
            "<th>%s</th><th>PSNR "
            "dB</th><th>SSIM"
            "</th><th>p99 codes</th><th>flux %%</th><th>KiB</th><th></th></tr>"
            "\n",
            cost_words(s));
    for (int i = 0; i < s->n_points; i++)
        table_row(s, file, &s->point[order[i]]);
    fputs("</table>\n<h2>Pictures</h2>\n<p>Each beside its difference from "
          "the exact one, 16 times, about grey.</p>\n<div>",
          file);
    figure(s, file, NULL, s->exact_rgb, "");
    fputs("</div>\n", file);
    for (int i = 0; i < s->n_points; i++) {
        const struct scene_point *const p = &s->point[order[i]];

        if (!p->rgb)
            continue;
        fputs("<div>", file);
        figure(s, file, p, p->rgb, "");
        figure(s, file, p, p->difference, ", difference");
        fputs("</div>\n", file);
    }
    fputs("</body></html>\n", file);
}
