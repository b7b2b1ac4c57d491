/* SPDX-License-Identifier: MIT
 *
 * Writes all points as CSV and JSON, and the named qualities as Markdown.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/sweep.h"
#include "options/json_writer.h"

static const char *const kinds[] = {"standard", "alone", "together", "quality"};

static const char *const metrics[SWEEP_METRICS] = {
    "ms",      "floor_ms", "ratio", "arena_bytes", "model_bytes",
    "psnr_db", "ssim",     "p99",   "flux_error",  "ghosts",
    "bundles", "edges",    "tiles"};

/* Prints a comma, and then X unless it is infinite or NAN. */
static void print_csv_number(FILE *file, double x)
{
    fputc(',', file);
    if (isfinite(x))
        fprintf(file, "%.7g", x);
}

void sweep_write_csv(const struct sweep *s, FILE *file)
{
    fputs("lens,width,height,lights,angle,kind,dial,quality", file);
    for (int d = 0; d < n_sweep_parameters; d++)
        fprintf(file, ",%s", sweep_parameter[d].name);
    for (int k = 0; k < SWEEP_METRICS; k++)
        fprintf(file, ",%s", metrics[k]);
    fputs(",front,rounds,version,machine\n", file);
    for (int i = 0; i < s->n_points; i++) {
        const struct sweep_point *const p = &s->point[i];
        const struct sweep_setting *const set = &p->set;
        const struct sweep_case *const c = &s->scase[p->of];

        fprintf(file, "%s,%d,%d,%d,%g,%s,%s", s->lens[c->lens], c->width,
                c->height, c->n_lamps, c->angle, kinds[set->kind],
                set->alone >= 0 ? sweep_parameter[set->alone].name : "");
        print_csv_number(file, set->quality >= 0 ? set->quality : (double)NAN);
        for (int d = 0; d < n_sweep_parameters; d++)
            print_csv_number(file, set->value[d]);
        for (int k = 0; k < SWEEP_METRICS; k++)
            print_csv_number(file, p->metric[k]);
        fprintf(file, ",%d,%d,%s,%s\n", p->front, s->rounds, GLINT_VERSION,
                canvas_describe_machine());
    }
}

void sweep_write_json(const struct sweep *s, FILE *file)
{
    struct json_writer json = {.to = file};

    json_write(&json, "{rounds: %d, version: %s, machine: %s, points: [",
               s->rounds, GLINT_VERSION, canvas_describe_machine());
    for (int i = 0; i < s->n_points; i++) {
        const struct sweep_point *const p = &s->point[i];
        const struct sweep_case *const c = &s->scase[p->of];

        json_write(&json,
                   "\n{lens: %s, width: %d, height: %d, lights: %d, angle: %g, "
                   "kind: %s, quality: %.7g",
                   s->lens[c->lens], c->width, c->height, c->n_lamps, c->angle,
                   kinds[p->set.kind],
                   p->set.quality >= 0 ? p->set.quality : (double)NAN);
        for (int d = 0; d < n_sweep_parameters; d++)
            json_write(&json, "%s: %.7g", sweep_parameter[d].name,
                       p->set.value[d]);
        for (int k = 0; k < SWEEP_METRICS; k++)
            json_write(&json, "%s: %.7g", metrics[k], p->metric[k]);
        json_write(&json, "front: %c}", p->front);
    }
    json_write(&json, "\n]}\n");
}

/* Prints the settings of a single parameter whose PSNR is at least 0.1 dB
 * better than that of --quality at the same cost. */
static void print_settings_above_front(const struct sweep *s, FILE *file)
{
    int n, n_alone = 0, n_above = 0;
    struct sweep_mean *const mean = sweep_compute_means(s, &n);

    for (int i = 0; i < n; i++) {
        const double above = sweep_compute_gain_above_front(mean, n, i);
        char words[160];

        if (mean[i].set->kind != SWEEP_ALONE ||
            mean[i].flux_error > MAX_FLUX_ERROR)
            continue;
        n_alone++;
        if (above < 0.1)
            continue;
        sweep_describe_setting(mean[i].set, words);
        fprintf(file, "%s%s by %.1f dB",
                n_above++ ? ", " : "\nAbove --quality: ", words, above);
    }
    if (n_alone > 0)
        fprintf(file,
                "%s%d of %d settings that vary one parameter are better than "
                "--quality.\n",
                n_above ? "; " : "\n", n_above, n_alone);
    free(mean);
}

void sweep_write_name_table(const struct sweep *s, FILE *file)
{
    fputs("Each entry: time / memory floor; PSNR, dB; KiB of arena + model\n"
          "\n"
          "| lens, size, lights |",
          file);
    for (int i = 0; i < GLINT_QUALITY_NAMES; i++)
        fprintf(file, " %s |", glint_quality_name[i]);
    fputs("\n|---|---|---|---|---|---|\n", file);
    for (int c = 0; c < s->n_cases; c++) {
        const struct sweep_case *const k = &s->scase[c];

        fprintf(file, "| %s, %dx%d, %d |", s->lens[k->lens], k->width,
                k->height, k->n_lamps);
        for (int i = k->first; i < k->first + k->n; i++) {
            const struct sweep_point *const p = &s->point[i];

            if (sweep_find_quality_name_index(p) >= 0)
                fprintf(file, " %.1f; %.1f; %.0f + %.0f |",
                        p->metric[SWEEP_RATIO], p->metric[SWEEP_PSNR_DB],
                        floor(p->metric[SWEEP_ARENA_BYTES] / 1024),
                        floor(p->metric[SWEEP_MODEL_BYTES] / 1024));
        }
        fputc('\n', file);
    }
    print_settings_above_front(s, file);
}
