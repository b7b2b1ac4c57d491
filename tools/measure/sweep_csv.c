/* SPDX-License-Identifier: MIT
 *
 * Pareto fronts; writes all points as CSV and JSON, and the named qualities as
 * Markdown.
 */
#include <math.h>
#include <string.h>

#include "measure/sweep.h"
#include "options/json_writer.h"

static const char *const kinds[] = {"standard", "alone", "together", "quality"};

static const char *const metrics[SWEEP_METRICS] = {
    "ms",      "floor_ms", "ratio", "arena_bytes", "model_bytes",
    "psnr_db", "ssim",     "p99",   "flux_error",  "ghosts",
    "bundles", "edges",    "tiles"};

/* ------------------------------------------------------------------- front */

/* Returns whether P is measured and its flux error is at most
 * MAX_FLUX_ERROR. */
static bool is_candidate_of_front(const struct sweep_point *p)
{
    return fabs(p->metric[SWEEP_FLUX_ERROR]) <= MAX_FLUX_ERROR &&
           isfinite(p->metric[SWEEP_RATIO]) &&
           isfinite(p->metric[SWEEP_PSNR_DB]);
}

static bool dominates_point(const struct sweep_point *a,
                            const struct sweep_point *b)
{
    const double cheaper = b->metric[SWEEP_RATIO] - a->metric[SWEEP_RATIO];
    const double better = a->metric[SWEEP_PSNR_DB] - b->metric[SWEEP_PSNR_DB];

    return cheaper >= 0 && better >= 0 && cheaper + better > 0;
}

void sweep_mark_fronts(struct sweep *s)
{
    for (int i = 0; i < s->n_points; i++) {
        struct sweep_point *const p = &s->point[i];
        const struct sweep_case *const c = &s->scase[p->of];

        p->front = is_candidate_of_front(p);
        for (int k = c->first; k < c->first + c->n && p->front; k++)
            p->front = !is_candidate_of_front(&s->point[k]) ||
                       !dominates_point(&s->point[k], p);
    }
}

/* ------------------------------------------------------------------ points */

/* A column of the CSV file, and member of the JSON objects. text: NULL for a
 * number. */
struct field {
    const char *name, *text;
    double number;
};

enum { FIELDS = 8 + MAX_PARAMETERS + SWEEP_METRICS };

/* Sets FIELD to all fields of P except whether it is on the front. Returns
 * their number. */
static int list_point_fields(const struct sweep *s, const struct sweep_point *p,
                             struct field field[FIELDS])
{
    const struct sweep_setting *const set = &p->set;
    const struct sweep_case *const c = &s->scase[p->of];
    const struct field own[] = {
        {"lens", s->lens[c->lens], 0},
        {"width", NULL, c->width},
        {"height", NULL, c->height},
        {"lights", NULL, c->n_lamps},
        {"angle", NULL, c->angle},
        {"kind", kinds[set->kind], 0},
        {"dial", set->alone >= 0 ? sweep_parameter[set->alone].name : "", 0},
        {"quality", NULL, set->quality >= 0 ? set->quality : (double)NAN}};
    int n = sizeof own / sizeof *own;

    memcpy(field, own, sizeof own);
    for (int d = 0; d < n_sweep_parameters; d++)
        field[n++] =
            (struct field){sweep_parameter[d].name, NULL, set->value[d]};
    for (int k = 0; k < SWEEP_METRICS; k++)
        field[n++] = (struct field){metrics[k], NULL, p->metric[k]};
    return n;
}

void sweep_write_csv(const struct sweep *s, FILE *file)
{
    struct field field[FIELDS];

    for (int i = 0; i < s->n_points; i++) {
        const int n = list_point_fields(s, &s->point[i], field);

        for (int k = 0; k < n && i == 0; k++)
            fprintf(file, "%s,", field[k].name);
        fputs(i == 0 ? "front,rounds,version,machine\n" : "", file);
        for (int k = 0; k < n; k++)
            if (field[k].text)
                fprintf(file, "%s,", field[k].text);
            else if (isfinite(field[k].number))
                fprintf(file, "%.7g,", field[k].number);
            else
                fputc(',', file);
        fprintf(file, "%d,%d,%s,%s\n", s->point[i].front, s->rounds,
                GLINT_VERSION, canvas_describe_machine());
    }
}

void sweep_write_json(const struct sweep *s, FILE *file)
{
    struct json_writer json = {.to = file};
    struct field field[FIELDS];

    json_write(&json, "{rounds: %d, version: %s, machine: %s, points: [",
               s->rounds, GLINT_VERSION, canvas_describe_machine());
    for (int i = 0; i < s->n_points; i++) {
        const int n = list_point_fields(s, &s->point[i], field);

        json_write(&json, "\n{");
        for (int k = 0; k < n; k++)
            if (field[k].text)
                json_write(&json, "%s: %s", field[k].name, field[k].text);
            else
                json_write(&json, "%s: %.7g", field[k].name, field[k].number);
        json_write(&json, "front: %c}", s->point[i].front);
    }
    json_write(&json, "\n]}\n");
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
}
