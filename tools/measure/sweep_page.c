/* SPDX-License-Identifier: MIT
 *
 * The HTML page of a sweep: tables, plots and pictures in one file.
 */
#include <math.h>
#include <stdlib.h>

#include "measure/plots/plot.h"
#include "measure/sweep.h"

static const char head[] =
    "<p>The same frames were drawn with each quality parameter varied "
    "separately (coloured), with several varied together (grey), and along "
    "<code>--quality</code> (diamonds). Each is compared with the exact "
    "picture, which traces every ray in double precision. PSNR, SSIM and the "
    "99th percentile of differences are those of 8-bit sRGB codes, exposed so "
    "that the exact picture's 99.9th percentile is white. Flux is compared in "
    "linear light. The memory floor is the time of adding a small constant "
    "layer to the pixels. The line is the Pareto front: no measured setting is "
    "both "
    "faster and more accurate. Settings whose flux is off by more than 2 "
    "percent are not shown in it. Point at a mark to see its setting.</p>\n";

/* ------------------------------------------------------------------- table */

static void write_quality_names_table(const struct sweep *s, FILE *file)
{
    fputs("<h2>Named qualities</h2>\n<table>", file);
    html_write_table_row(
        file, "th",
        "lens|size|quality|time / memory floor|PSNR dB|SSIM|p99 codes|flux %%|"
        "arena KiB|model KiB");
    for (int i = 0; i < s->n_points; i++) {
        const struct sweep_point *p = &s->point[i];
        const struct sweep_case *c = &s->scase[p->of];
        const double *m = p->metric;
        const int name = sweep_find_quality_name_index(p);

        if (name >= 0)
            html_write_table_row(
                file, "td",
                "%s|%dx%d, %d|%s|%.1f|%.1f|%.4f|%g|%s%+.2f|%.0f|%.0f",
                s->lens[c->lens], c->width, c->height, c->n_lamps,
                glint_quality_name[name], p->metric[SWEEP_RATIO],
                m[SWEEP_PSNR_DB], m[SWEEP_SSIM], m[SWEEP_P99],
                fabs(m[SWEEP_FLUX_ERROR]) > MAX_FLUX_ERROR ? "!" : "",
                100 * m[SWEEP_FLUX_ERROR], floor(m[SWEEP_ARENA_BYTES] / 1024),
                floor(m[SWEEP_MODEL_BYTES] / 1024));
    }
    fputs("</table>\n", file);
}

/* Prints the settings on the Pareto front, which --quality should follow. */
static void write_front_table(const struct sweep *s, FILE *file)
{
    int n;
    struct sweep_mean *const mean = sweep_compute_means(s, &n);

    fputs("<h2>Pareto front, mean of all lenses</h2>\n"
          "<table>",
          file);
    html_write_table_row(file, "th",
                         "setting|cost / default cost|mean PSNR, dB|min PSNR, "
                         "dB|max flux error, %%");
    for (int i = 0; i < n; i++) {
        char words[160];

        if (!mean[i].front)
            continue;
        sweep_describe_setting(mean[i].set, words);
        html_write_table_row(file, "td", "%s|%.3f|%.1f|%.1f|%.2f", words,
                             mean[i].cost, mean[i].psnr_db, mean[i].least_db,
                             100 * mean[i].flux_error);
    }
    fputs("</table>\n", file);
    free(mean);
}

/* ---------------------------------------------------------------- pictures */

static void write_svg_figure(const struct sweep *s, FILE *file,
                             const struct sweep_picture *q, const uint8_t *rgb,
                             const char *what)
{
    const struct sweep_point *p = q->point >= 0 ? &s->point[q->point] : NULL;
    char words[160] = "exact";

    if (p)
        sweep_describe_setting(&p->set, words);
    fputs("<figure><img alt=\"\" src=\"", file);
    html_write_png(file, rgb, q->width, q->height);
    fprintf(file, "\"><figcaption>%s%s", words, what);
    if (p)
        fprintf(file, "<br>%.3g, %.1f dB, flux %+.2f %%",
                p->metric[SWEEP_RATIO], p->metric[SWEEP_PSNR_DB],
                100 * p->metric[SWEEP_FLUX_ERROR]);
    fputs("</figcaption></figure>\n", file);
}

/* Writes a picture of the difference between Q and EXACT, multiplied by 16 and
 * added to grey. */
static void write_difference_picture(const struct sweep *s, FILE *file,
                                     const struct sweep_picture *q,
                                     const struct sweep_picture *exact)
{
    const size_t n = 3 * (size_t)q->width * (size_t)q->height;
    uint8_t *const far = malloc(n);

    for (size_t i = 0; far && exact && i < n; i++) {
        const int d = 128 + 16 * (q->rgb[i] - exact->rgb[i]);

        far[i] = (uint8_t)(d < 0 ? 0 : d > 255 ? 255 : d);
    }
    if (far)
        write_svg_figure(s, file, q, far, ", difference");
    free(far);
}

static void write_picture_strips(const struct sweep *s, FILE *file)
{
    const struct sweep_picture *exact = NULL;

    if (!html_can_write_png()) {
        fputs("<p>Pictures need the image plug-in, which is missing.</p>\n",
              file);
        return;
    }
    fputs("<h2>Pictures</h2>\n"
          "<p>To the right of each picture: its difference from the exact "
          "picture, times 16; grey is no difference.</p>\n",
          file);
    for (int i = 0; i < s->n_pictures; i++) {
        const struct sweep_picture *q = &s->picture[i];
        const struct sweep_case *c = &s->scase[q->of];

        if (q->point < 0) {
            exact = q;
            fprintf(file,
                    "<h3>%s, %dx%d, %d light%s, %g degrees off the axis</h3>\n",
                    s->lens[c->lens], c->width, c->height, c->n_lamps,
                    c->n_lamps > 1 ? "s" : "", c->angle);
        }
        fputs("<div>", file); /* container of two pictures side by side */
        write_svg_figure(s, file, q, q->rgb, "");
        if (q != exact)
            write_difference_picture(s, file, q, exact);
        fputs("</div>\n", file);
    }
}

void sweep_write_page(const struct sweep *s, FILE *file)
{
    html_write_head(file, "What accuracy costs",
                    "figcaption{max-width:320px}img{width:320px}");
    fputs(head, file);
    write_quality_names_table(s, file);
    fputs("<h2>Error against time</h2>\n", file);
    sweep_write_front_svg(s, file);
    write_front_table(s, file);
    fputs("<h2>Each quality parameter separately</h2>\n", file);
    sweep_write_dials_svg(s, file);
    write_picture_strips(s, file);
    html_write_end(file);
}
