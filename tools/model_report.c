/* SPDX-License-Identifier: MIT */
#include "model_report.h"

#include <math.h>
#include <stdio.h>

static const char *const names[GLINT_OUT_KINDS] = {
    "sensor_x", "sensor_y", "stop_x",   "stop_y",   "energy",
    "radius",   "barrel_0", "barrel_1", "barrel_2", "barrel_3"};
static const char *const units[GLINT_OUT_KINDS] = {
    "px", "px", "stop radii", "stop radii", "of itself", "", "", "", "", ""};

/* Errors at the 99th percentile beyond which a ghost is pointed out: a quarter
 * of a pixel of 1920, and what is worth as much elsewhere. */
static const double targets[GLINT_OUT_KINDS] = {
    0.25, 0.25, 0.0024, 0.0024, 0.05, 0.005, 0.005, 0.005, 0.005, 0.005};

/* Errors over a number of systems: worst, but for the root mean square. */
struct sum {
    int n;
    double mean2, p50, p99, max;
    long terms;
};

static const struct glint_model_output *
outputs_of(const struct glint_lens *lens, const struct glint_model_system *s)
{
    return (const void *)((const char *)lens->header + s->output_at);
}

static void add(struct sum *sum, const struct glint_model_output *o)
{
    const double rms = o->rms_q20 * 0x1p-20;

    sum->n++;
    sum->mean2 += (rms * rms - sum->mean2) / sum->n;
    sum->p50 += (o->p50_q20 * 0x1p-20 - sum->p50) / sum->n;
    sum->p99 = fmax(sum->p99, o->p99_q20 * 0x1p-20);
    sum->max = fmax(sum->max, o->max_q20 * 0x1p-20);
    sum->terms += o->n_terms;
}

static void sum_systems(const struct glint_lens *lens, uint32_t first,
                        uint32_t n, struct sum sum[GLINT_OUT_KINDS])
{
    for (uint32_t k = first; k < first + n; k++) {
        const struct glint_model_system *s = &lens->system[k];
        const struct glint_model_output *o = outputs_of(lens, s);

        for (uint32_t i = 0; i < s->n_outputs; i++)
            add(&sum[o[i].kind], &o[i]);
    }
}

static size_t bytes_of(const struct glint_lens *lens, uint32_t first,
                       uint32_t n)
{
    size_t bytes = 0;

    for (uint32_t k = first; k < first + n; k++) {
        const struct glint_model_system *s = &lens->system[k];
        const struct glint_model_output *o = outputs_of(lens, s);
        const uint32_t sets = s->n_knots ? s->n_knots : 1;

        bytes += sizeof *s + 4 * s->n_knots +
                 (s->n_knots ? 12 * s->n_knots : 12 * GLINT_BOX_POWERS) +
                 s->n_outputs * sizeof *o;
        for (uint32_t i = 0; i < s->n_outputs; i++)
            bytes += (2 * o[i].n_terms + 3) / 4 * 4 + 4 * sets * o[i].n_terms;
    }
    return bytes;
}

static double mean_terms(const struct sum sum[GLINT_OUT_KINDS])
{
    long terms = 0, n = 0;

    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        terms += sum[k].terms;
        n += sum[k].n;
    }
    return n ? (double)terms / (double)n : 0;
}

static double degrees(int32_t sine_q30)
{
    return asin(fmin(1, sine_q30 * 0x1p-30)) * 57.29577951308232;
}

/* ------------------------------------------------------------------- people */

static void print_errors(const struct sum sum[GLINT_OUT_KINDS])
{
    printf("\n%-10s %8s %10s %10s %10s %10s\n", "output", "terms", "rms",
           "median", "worst p99", "max");
    for (int k = 0; k < GLINT_OUT_KINDS; k++)
        if (sum[k].n)
            printf("%-10s %8.1f %10.2g %10.2g %10.2g %10.2g  %s\n", names[k],
                   (double)sum[k].terms / sum[k].n, sqrt(sum[k].mean2),
                   sum[k].p50, sum[k].p99, sum[k].max, units[k]);
}

static bool misses(const struct sum sum[GLINT_OUT_KINDS])
{
    for (int k = 0; k < GLINT_OUT_KINDS; k++)
        if (sum[k].p99 > targets[k])
            return true;
    return false;
}

static void print_ghost(const struct glint_lens *lens, int ghost,
                        const struct sum sum[GLINT_OUT_KINDS])
{
    const struct glint_model_ghost *g = &lens->ghost[ghost];
    const uint32_t last = g->first_system + g->n_systems - 1;

    printf("ghost %3d %2u-%-2u %5.2f to %5.2f deg %3u zones %6zu bytes  p99",
           ghost, g->i, g->j,
           degrees(lens->system[g->first_system].sine_lo_q30),
           degrees(lens->system[last].sine_hi_q30), g->n_systems,
           bytes_of(lens, g->first_system, g->n_systems));
    for (int k = 0; k < GLINT_OUT_KINDS; k++)
        if (sum[k].n)
            printf(" %s %.2g (%.0f)", names[k], sum[k].p99,
                   (double)sum[k].terms / sum[k].n);
    printf("%s\n", misses(sum) ? "  MISSES THE TARGET" : "");
}

static void print_unseen(const struct glint_lens *lens)
{
    bool any = false;

    for (uint32_t k = 0; k < lens->header->n_ghosts; k++)
        if (lens->ghost[k].n_systems == 0) {
            printf("%s %u", any ? "" : "never seen:", k);
            any = true;
        }
    if (any)
        printf("\n");
}

void model_report_text(const struct glint_lens *lens, double seconds,
                       const struct glint_bake_report *report, bool all)
{
    const struct glint_model_header *h = lens->header;
    struct sum total[GLINT_OUT_KINDS] = {{0}};
    int missed = 0;

    sum_systems(lens, 0, h->n_systems, total);
    for (uint32_t k = 0; k < h->n_ghosts; k++) {
        struct sum sum[GLINT_OUT_KINDS] = {{0}};

        sum_systems(lens, lens->ghost[k].first_system, lens->ghost[k].n_systems,
                    sum);
        missed += misses(sum);
        if (lens->ghost[k].n_systems && (all || misses(sum)))
            print_ghost(lens, (int)k, sum);
    }
    print_unseen(lens);
    printf("%s: %u bytes, %u ghosts, %u zones, %.1f terms an output, %.1f s\n",
           h->name, h->bytes, h->n_ghosts, h->n_systems, mean_terms(total),
           seconds);
    print_errors(total);
    printf("\n%d of %u ghosts miss the target somewhere; %d of %d rays pass "
           "where they are cut\n",
           missed, h->n_ghosts, report->intruders, report->rays);
}

/* ----------------------------------------------------------------- programs */

static void json_errors(const struct sum sum[GLINT_OUT_KINDS])
{
    bool any = false;

    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        if (!sum[k].n)
            continue;
        printf("%s\"%s\": {\"terms\": %.2f, \"rms\": %.6g, \"p50\": %.6g, "
               "\"p99\": %.6g, \"max\": %.6g}",
               any ? ", " : "", names[k], (double)sum[k].terms / sum[k].n,
               sqrt(sum[k].mean2), sum[k].p50, sum[k].p99, sum[k].max);
        any = true;
    }
}

static void json_ghost(const struct glint_lens *lens, uint32_t k)
{
    const struct glint_model_ghost *g = &lens->ghost[k];
    struct sum sum[GLINT_OUT_KINDS] = {{0}};

    sum_systems(lens, g->first_system, g->n_systems, sum);
    printf("%s{\"ghost\": %u, \"pair\": [%u, %u], \"zones\": %u, "
           "\"bytes\": %zu, \"met\": %s, \"errors\": {",
           k ? ", " : "", k, g->i, g->j, g->n_systems,
           bytes_of(lens, g->first_system, g->n_systems),
           misses(sum) ? "false" : "true");
    json_errors(sum);
    printf("}}");
}

void model_report_json(const struct glint_lens *lens, double seconds,
                       const struct glint_bake_report *report)
{
    const struct glint_model_header *h = lens->header;
    struct sum total[GLINT_OUT_KINDS] = {{0}};

    sum_systems(lens, 0, h->n_systems, total);
    printf("{\"seconds\": %.3f, \"bytes\": %u, \"ghosts\": %u, \"zones\": %u, "
           "\"mean_terms\": %.2f, \"unmet_zones\": %d, \"rays\": %d, "
           "\"intruders\": %d, \"errors\": {",
           seconds, h->bytes, h->n_ghosts, h->n_systems, mean_terms(total),
           report->unmet, report->rays, report->intruders);
    json_errors(total);
    printf("}, \"by_ghost\": [");
    for (uint32_t k = 0; k < h->n_ghosts; k++)
        json_ghost(lens, k);
    printf("]}\n");
}
