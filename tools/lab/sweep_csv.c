/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/sweep.h"
#include "options/json_writer.h"

static const char *const kinds[] = {"standard", "alone", "together", "quality",
                                    "growth"};

/* Prints X, or nothing if it is not finite. */
static void number(FILE *file, double x)
{
    if (isfinite(x))
        fprintf(file, "%.7g", x);
}

void sweep_csv(const struct sweep *s, FILE *file)
{
    fputs("lens,width,height,lights,angle,kind,dial,quality", file);
    for (int d = 0; d < n_dials; d++)
        fprintf(file, ",%s", dials[d].name);
    fputs(
        ",ms,floor_ms,ratio,instructions,arena_bytes,model_bytes,psnr_db,"
        "ssim,p99,flux_error,ghosts,bundles,edges,tiles,"
        "vertices,edges_told,rows_told,parts_told,lit_told,minsn_told,front\n",
        file);
    for (int i = 0; i < s->n_points; i++) {
        const struct sweep_point *p = &s->point[i];
        const struct sweep_case *c = &s->scase[p->of];
        const double measured[] = {p->ms, p->floor_ms, p->ratio,
                                   p->instructions};
        const double quality[] = {p->psnr_db, p->ssim, p->p99, p->flux_error};

        fprintf(file, "%s,%d,%d,%d,%g,%s,%s,", s->lens[c->lens], c->width,
                c->height, c->n_lamps, c->angle, kinds[p->set.kind],
                p->set.dial >= 0 ? dials[p->set.dial].name : "");
        number(file, p->set.quality >= 0 ? p->set.quality : (double)NAN);
        for (int d = 0; d < n_dials; d++)
            fprintf(file, ",%.7g", p->set.value[d]);
        for (int k = 0; k < 4; k++)
            fputc(',', file), number(file, measured[k]);
        fprintf(file, ",%zu,%zu", p->arena_bytes, p->model_bytes);
        for (int k = 0; k < 4; k++)
            fputc(',', file), number(file, quality[k]);
        fprintf(file, ",%d,%d,%d,%d", p->report.ghosts, p->report.stats.bundles,
                p->report.stats.primitives, p->report.tiles);
        for (int k = GLINT_COST_VERTICES; k < GLINT_COST_STAR; k++)
            fprintf(file, ",%.0f", p->cost.count[k]);
        fprintf(file, ",%.4g,%d\n", glint_cost_minsn(&p->cost), p->front);
    }
}

static void json_point(struct json_writer *json, const struct sweep *s,
                       const struct sweep_point *p)
{
    const struct sweep_case *c = &s->scase[p->of];

    json_write(json,
               "\n{lens: %s, width: %d, height: %d, lights: %d, angle: %g, "
               "kind: %s, quality: %.7g",
               s->lens[c->lens], c->width, c->height, c->n_lamps, c->angle,
               kinds[p->set.kind],
               p->set.quality >= 0 ? p->set.quality : (double)NAN);
    for (int d = 0; d < n_dials; d++)
        json_write(json, "%s: %.7g", dials[d].name, p->set.value[d]);
    json_write(json,
               "ms: %.7g, floor_ms: %.7g, ratio: %.7g, instructions: %.7g, "
               "arena_bytes: %.7g, model_bytes: %.7g, psnr_db: %.7g, "
               "ssim: %.7g, p99: %.7g, flux_error: %.7g, front: %c}",
               p->ms, p->floor_ms, p->ratio, p->instructions,
               (double)p->arena_bytes, (double)p->model_bytes, p->psnr_db,
               p->ssim, p->p99, p->flux_error, p->front);
}

void sweep_json(const struct sweep *s, FILE *file)
{
    struct json_writer json = {.to = file};

    json_write(&json, "{rounds: %d, points: [", s->rounds);
    for (int i = 0; i < s->n_points; i++)
        json_point(&json, s, &s->point[i]);
    json_write(&json, "\n]}\n");
}

/* Prints the row of case C: its points with a named quality, the coarsest
 * first. */
static void names_row(const struct sweep *s, int c, FILE *file)
{
    const struct sweep_case *k = &s->scase[c];

    fprintf(file, "| %s, %dx%d, %d |", s->lens[k->lens], k->width, k->height,
            k->n_lamps);
    for (int i = 0; i < k->n; i++) {
        const struct sweep_point *p = &s->point[k->first + i];
        const double at = p->set.quality * (GLINT_QUALITY_NAMES - 1);

        if (p->set.kind == SWEEP_QUALITY && at == floor(at))
            fprintf(file, " %.1f; %.1f; %zu + %zu |", sweep_cost(s, p),
                    p->psnr_db, p->arena_bytes / 1024, p->model_bytes / 1024);
    }
    fputc('\n', file);
}

/* Prints the settings of one dial that lie at least 0.1 dB above --quality. */
static void beyond_ladder(const struct sweep *s, FILE *file)
{
    struct sweep_mean *mean = malloc(((size_t)s->n_points + 1) * sizeof *mean);
    const int n = mean ? sweep_means(s, mean, s->n_points) : 0;
    int n_alone = 0, n_above = 0;

    for (int i = 0; i < n; i++) {
        const double above = sweep_above(mean, n, i);
        char words[160];

        if (mean[i].set->kind != SWEEP_ALONE ||
            mean[i].flux_error > MAX_FLUX_ERROR)
            continue;
        n_alone++;
        if (above < 0.1)
            continue;
        sweep_words(mean[i].set, words, sizeof words);
        fprintf(file, "%s%s by %.1f dB",
                n_above++ ? ", " : "\nAbove --quality: ", words, above);
    }
    if (n_alone > 0)
        fprintf(file, "%s%d of %d settings of one dial lie above --quality.\n",
                n_above ? "; " : "\n", n_above, n_alone);
    free(mean);
}

void sweep_names(const struct sweep *s, FILE *file)
{
    fprintf(file,
            "%s; PSNR, dB; KiB of arena + model\n\n| lens, size, lights |",
            s->by_instructions ? "Million instructions" : "Times memory floor");
    for (int i = 0; i < GLINT_QUALITY_NAMES; i++)
        fprintf(file, " %s |", glint_quality_name[i]);
    fputs("\n|---|---|---|---|---|---|\n", file);
    for (int c = 0; c < s->n_cases; c++)
        if (!s->scase[c].growth)
            names_row(s, c, file);
    beyond_ladder(s, file);
}

int sweep_read_counts(const char *path, int n_points, double *instructions)
{
    FILE *file = fopen(path, "r");
    char line[80];
    int n = 0;

    if (!file) {
        fprintf(stderr, "glint sweep: %s: %s\n", path, strerror(errno));
        return EXIT_INPUT;
    }
    while (fgets(line, sizeof line, file)) {
        double v[2];
        char *space = strchr(line, ' ');

        line[strcspn(line, "\n")] = '\0';
        n++;
        if (space)
            *space = ',';
        if (tool_numbers(line, v, 2) != 2 || v[0] != floor(v[0]) || v[0] < 0 ||
            v[0] >= n_points || v[1] < 0) {
            fclose(file);
            fprintf(stderr,
                    "glint sweep: %s:%d: not a point of this sweep and its "
                    "instructions\n",
                    path, n);
            return EXIT_INPUT;
        }
        instructions[(int)v[0]] = v[1];
    }
    fclose(file);
    return EXIT_OK;
}
