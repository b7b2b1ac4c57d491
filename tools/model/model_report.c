/* SPDX-License-Identifier: MIT */
#include "model/model_report.h"

#include <math.h>

static const char *const kind_names[GLINT_OUT_KINDS] = {
    "sensor_x", "sensor_y", "stop_x",   "stop_y",   "energy",
    "radius",   "barrel_0", "barrel_1", "barrel_2", "barrel_3"};
static const char *const units[GLINT_OUT_KINDS] = {
    "px of 1920", "px of 1920", "stop radii", "stop radii", "share",
    "radii",      "radii",      "radii",      "radii",      "radii"};

/* Errors at the 99th percentile beyond which a ghost is pointed out: a quarter
 * of a pixel of 1920, and what is worth as much elsewhere. */
static const double targets[GLINT_OUT_KINDS] = {
    0.25, 0.25, 0.0024, 0.0024, 0.05, 0.005, 0.005, 0.005, 0.005, 0.005};

static const char *basis_name(const struct glint_lens *lens)
{
    return lens->header->basis == GLINT_BASIS_SPARSE ? "sparse" : "auto";
}

/* --------------------------------------------------------------- quantities */

static double degrees(int32_t sine_q30)
{
    return asin(fmin(1, ldexp(sine_q30, -30))) * (180 / 3.14159265358979323846);
}

static double nanometres(int32_t wave_q24)
{
    return 1e3 / sqrt(ldexp(wave_q24, -24));
}

/* Systems that follow each other. */
struct span {
    uint32_t first, n;
};

static struct span span_of_all(const struct glint_lens *lens)
{
    return (struct span){0, lens->header->n_systems};
}

static struct span span_of_ghost(const struct glint_lens *lens, uint32_t ghost)
{
    return (struct span){lens->ghost[ghost].first_system,
                         lens->ghost[ghost].n_systems};
}

static const struct glint_model_output *
outputs_of(const struct glint_lens *lens, const struct glint_model_system *s)
{
    const char *base = (const char *)lens->header;

    return (const void *)(base + s->output_at);
}

/* Words of a system's box and knots. */
static size_t box_words(const struct glint_model_system *s)
{
    size_t n = 4 * (size_t)s->n_knots;

    for (int k = 0; k < GLINT_BOX_TERMS; k++)
        n += 3 * (s->box_terms >> k & 1U);
    return n;
}

/* What a span takes in the file, without regard to sharing. */
static size_t bytes_of(const struct glint_lens *lens, struct span span)
{
    size_t sum = 0;

    for (uint32_t k = span.first; k < span.first + span.n; k++) {
        const struct glint_model_system *s = &lens->system[k];
        const struct glint_model_output *o = outputs_of(lens, s);
        const size_t sets = s->n_knots ? s->n_knots : 1;

        sum += sizeof *s + s->n_outputs * sizeof *o + 4 * box_words(s);
        for (uint32_t m = 0; m < s->n_outputs; m++)
            sum += 4 * sets * o[m].n_terms + (o[m].n_terms + 1U) / 2 * 4 -
                   2 * (o[m].n_narrow & ~1U);
    }
    return sum;
}

/* Angles that a span covers. */
static void angles_of(const struct glint_lens *lens, struct span span,
                      double range_deg[2])
{
    int32_t lo_q30 = INT32_MAX, hi_q30 = 0;

    for (uint32_t k = span.first; k < span.first + span.n; k++) {
        const struct glint_model_system *s = &lens->system[k];

        lo_q30 = s->sine_lo_q30 < lo_q30 ? s->sine_lo_q30 : lo_q30;
        hi_q30 = s->sine_hi_q30 > hi_q30 ? s->sine_hi_q30 : hi_q30;
    }
    range_deg[0] = span.n ? degrees(lo_q30) : 0;
    range_deg[1] = degrees(hi_q30);
}

/* An output over the systems of a span that have it. */
struct errors {
    uint32_t n;
    double terms, mean2, p50;         /* means */
    double p99, max, bound, rounding; /* worst; all in the unit of errors */
};

struct summary {
    struct errors of[GLINT_OUT_KINDS];
};

static double error_of(uint16_t stored)
{
    return ldexp((double)glint_model_error_q20(stored), -20);
}

static void add(struct errors *e, const struct glint_model_output *o,
                double unit)
{
    const double rms = error_of(o->rms);
    const double step = ldexp(unit, o->exponent);

    e->n++;
    e->terms += (o->n_terms - e->terms) / e->n;
    e->mean2 += (rms * rms - e->mean2) / e->n;
    e->p50 += (error_of(o->p50) - e->p50) / e->n;
    e->p99 = fmax(e->p99, error_of(o->p99));
    e->max = fmax(e->max, error_of(o->max));
    e->bound = fmax(e->bound, o->bound * step);
    e->rounding = fmax(e->rounding, ldexp(o->rounding_q8 * step, -8));
}

static struct summary summary_of(const struct glint_lens *lens,
                                 struct span span)
{
    const double px = 1920 / model_real_of(lens->header->film_width_mm);
    struct summary sum = {{{0}}};

    for (uint32_t k = span.first; k < span.first + span.n; k++) {
        const struct glint_model_system *s = &lens->system[k];
        const struct glint_model_output *o = outputs_of(lens, s);

        for (uint32_t m = 0; m < s->n_outputs; m++)
            add(&sum.of[o[m].kind], &o[m],
                o[m].kind <= GLINT_OUT_SENSOR_Y ? px : 1);
    }
    return sum;
}

static double terms_of(const struct summary *sum)
{
    double terms = 0;

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        terms += sum->of[kind].n * sum->of[kind].terms;
    return terms;
}

/* Of an output. */
static double mean_terms(const struct summary *sum)
{
    uint32_t n = 0;

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        n += sum->of[kind].n;
    return n ? terms_of(sum) / n : 0;
}

static bool misses(const struct summary *sum)
{
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (sum->of[kind].p99 > targets[kind])
            return true;
    return false;
}

/* Ghosts without the further parts of their pupils. */
static uint32_t count_ghosts(const struct glint_lens *lens)
{
    return lens->header->n_ghosts - lens->header->n_parts;
}

/* The number of the ghost that ENTRY is, or is a part of. */
static uint32_t ghost_of(const struct glint_lens *lens, uint32_t entry)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    uint32_t k = 0;

    while (k < entry && (g->i != lens->ghost[k].i || g->j != lens->ghost[k].j))
        k++;
    return k;
}

/* Ghosts of which some part misses. */
static unsigned count_missed(const struct glint_lens *lens)
{
    bool missed[GLINT_MAX_GHOSTS] = {false};
    unsigned n = 0;

    for (uint32_t k = 0; k < lens->header->n_ghosts; k++) {
        const struct summary sum = summary_of(lens, span_of_ghost(lens, k));
        const uint32_t ghost = ghost_of(lens, k);

        if (ghost < GLINT_MAX_GHOSTS && misses(&sum) && !missed[ghost]) {
            missed[ghost] = true;
            n++;
        }
    }
    return n;
}

/* --------------------------------------------------------------------- text */

static void print_header(const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;
    const struct summary sum =
        summary_of(&model->lens, span_of_all(&model->lens));

    printf("%s\nbaked model, %zu bytes, %s basis, key %08lx%08lx\n\n", h->name,
           model->bytes, basis_name(&model->lens), (unsigned long)h->key[1],
           (unsigned long)h->key[0]);
    printf("focal length        %10.3f mm\n", model_real_of(h->focal_mm));
    printf("back focal length   %10.3f mm\n", model_real_of(h->back_focal_mm));
    printf("entrance pupil      %10.3f mm radius\n",
           model_real_of(h->entrance_radius_mm));
    printf("stop                %10.4f mm radius at f/%g\n",
           model_real_of(h->stop_radius_mm), model_real_of(h->f_number));
    printf("front               %10.3f mm radius\n",
           model_real_of(h->front_mm));
    printf("film                %6gx%g mm\n", model_real_of(h->film_width_mm),
           model_real_of(h->film_height_mm));
    printf("field               %10.3f mm from the middle\n",
           model_real_of(h->field_mm));
    printf("band                %6.0f to %.0f nm\n", nanometres(h->wave_hi_q24),
           nanometres(h->wave_lo_q24));
    printf("largest angle       %10.3f degrees\n", degrees(h->sine_hi_q30));
    printf("surfaces            %6lu\n", (unsigned long)h->n_surfaces);
    printf("ghosts              %6lu in %lu parts, %lu zones, "
           "%.1f terms an output\n",
           (unsigned long)count_ghosts(&model->lens),
           (unsigned long)h->n_ghosts, (unsigned long)h->n_systems,
           mean_terms(&sum));
}

static void print_errors(const struct summary *sum)
{
    printf("\noutput    in          terms       rms       p50 worst p99       "
           "max     bound  rounding\n");
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct errors *e = &sum->of[kind];

        if (e->n)
            printf("%-9s %-10s %6.1f %9.3g %9.3g %9.3g %9.3g %9.3g %9.2g\n",
                   kind_names[kind], units[kind], e->terms, sqrt(e->mean2),
                   e->p50, e->p99, e->max, e->bound, e->rounding);
    }
}

static void print_title(const char *more)
{
    printf("ghost  surfaces   zones       degrees         terms      bytes%s\n",
           more);
}

/* Leaves the line open; a part has a plus behind the ghost's number. */
static void print_ghost(const struct glint_lens *lens, uint32_t entry,
                        const struct summary *sum)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    const struct span span = span_of_ghost(lens, entry);
    double range_deg[2];
    char pair[32];

    angles_of(lens, span, range_deg);
    snprintf(pair, sizeof pair, "%lu-%lu", (unsigned long)g->i,
             (unsigned long)g->j);
    printf("%5lu%c %-8s %7lu  %7.3f .. %-7.3f %7.0f  %9zu",
           (unsigned long)ghost_of(lens, entry),
           entry < count_ghosts(lens) ? ' ' : '+', pair,
           (unsigned long)g->n_systems, range_deg[0], range_deg[1],
           terms_of(sum), bytes_of(lens, span));
}

static void print_unseen(const struct glint_lens *lens)
{
    bool any = false;

    for (uint32_t k = 0; k < lens->header->n_ghosts; k++) {
        const struct glint_model_ghost *g = &lens->ghost[k];

        if (g->n_systems)
            continue;
        printf("%s %lu:%lu-%lu", any ? "" : "never seen:", (unsigned long)k,
               (unsigned long)g->i, (unsigned long)g->j);
        any = true;
    }
    if (any)
        printf("\n");
}

static void print_ghosts(const struct glint_lens *lens)
{
    printf("\n");
    print_title("");
    for (uint32_t k = 0; k < lens->header->n_ghosts; k++) {
        const struct summary sum = summary_of(lens, span_of_ghost(lens, k));

        if (lens->ghost[k].n_systems == 0)
            continue;
        print_ghost(lens, k, &sum);
        printf("\n");
    }
    print_unseen(lens);
}

static void print_systems(const struct glint_lens *lens)
{
    printf("\n zone   ghost       degrees               nm      knots  terms  "
           "sensor px: rms  p99  max\n");
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++) {
            const uint32_t n = lens->ghost[g].first_system + k;
            const struct glint_model_system *s = &lens->system[n];
            const struct summary sum = summary_of(lens, (struct span){n, 1});
            const struct errors *x = &sum.of[GLINT_OUT_SENSOR_X];

            printf("%6lu %6lu  %7.3f .. %-7.3f  %4.0f .. %-4.0f %6lu %6.0f  "
                   "%9.3g %9.3g %9.3g\n",
                   (unsigned long)n, (unsigned long)ghost_of(lens, g),
                   degrees(s->sine_lo_q30), degrees(s->sine_hi_q30),
                   nanometres(s->wave_hi_q24), nanometres(s->wave_lo_q24),
                   (unsigned long)s->n_knots, terms_of(&sum), sqrt(x->mean2),
                   x->p99, x->max);
        }
}

static void print_info(const struct tool *tool, const struct model_file *model)
{
    const struct summary sum =
        summary_of(&model->lens, span_of_all(&model->lens));

    print_header(model);
    print_ghosts(&model->lens);
    print_errors(&sum);
    if (tool->verbose)
        print_systems(&model->lens);
}

/* Behind the line of a ghost: what misses its target. */
static void print_misses(const struct summary *sum)
{
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (sum->of[kind].p99 > targets[kind])
            printf("  %s %.2g", kind_names[kind], sum->of[kind].p99);
    printf("\n");
}

/* Below it: everything. */
static void print_details(const struct summary *sum)
{
    printf("\n");
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct errors *e = &sum->of[kind];

        if (e->n)
            printf("       %-9s %5.1f terms  rms %-8.3g p50 %-8.3g p99 %-8.3g "
                   "max %.3g%s\n",
                   kind_names[kind], e->terms, sqrt(e->mean2), e->p50, e->p99,
                   e->max, e->p99 > targets[kind] ? "  misses" : "");
    }
}

/* Ghosts that miss the target, or ALL. */
static void print_fits(const struct glint_lens *lens, bool all)
{
    bool titled = false;

    for (uint32_t k = 0; k < lens->header->n_ghosts; k++) {
        const struct summary sum = summary_of(lens, span_of_ghost(lens, k));

        if (lens->ghost[k].n_systems == 0 || (!all && !misses(&sum)))
            continue;
        if (!titled)
            print_title(all ? "" : "  misses the target by p99");
        titled = true;
        print_ghost(lens, k, &sum);
        (all ? print_details : print_misses)(&sum);
    }
}

static void print_bake(const struct tool *tool, const struct glint_lens *lens,
                       double seconds, const struct glint_bake_report *report)
{
    const struct glint_model_header *h = lens->header;
    const struct summary sum = summary_of(lens, span_of_all(lens));

    print_fits(lens, tool->verbose > 0);
    print_unseen(lens);
    print_errors(&sum);
    printf("\n%s: %lu bytes, %lu ghosts in %lu parts, %lu zones, "
           "%.1f terms an output, %.1f s\n",
           h->name, (unsigned long)h->bytes, (unsigned long)count_ghosts(lens),
           (unsigned long)h->n_ghosts, (unsigned long)h->n_systems,
           mean_terms(&sum), seconds);
    printf("%u of %lu ghosts miss the target somewhere; %d of %d rays pass "
           "where they are cut; the tolerance was too tight for %d zones\n",
           count_missed(lens), (unsigned long)count_ghosts(lens),
           report->intruders, report->rays, report->unmet);
}

/* --------------------------------------------------------------------- JSON */

/* "errors": an object by output. */
static void json_errors(const struct summary *sum)
{
    const char *comma = "";

    printf("\"errors\": {");
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct errors *e = &sum->of[kind];

        if (!e->n)
            continue;
        printf("%s\"%s\": {\"terms\": %.6g, \"rms\": %.6g, \"p50\": %.6g, "
               "\"p99\": %.6g, \"max\": %.6g, \"bound\": %.6g, "
               "\"rounding\": %.6g}",
               comma, kind_names[kind], e->terms, sqrt(e->mean2), e->p50,
               e->p99, e->max, e->bound, e->rounding);
        comma = ", ";
    }
    printf("}");
}

static void json_header(const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;
    const struct summary sum =
        summary_of(&model->lens, span_of_all(&model->lens));

    printf("{\"name\": ");
    tool_json_string(stdout, h->name);
    printf(
        ", \"focal_length_mm\": %.6f, \"back_focal_length_mm\": %.6f, "
        "\"entrance_pupil_radius_mm\": %.6f, \"stop_radius_mm\": %.6f, "
        "\"f_number\": %g, \"film_mm\": [%g, %g], \"surfaces\": %lu, "
        "\"ghosts\": %lu, \"parts\": %lu, \"ghost_pairs\": [",
        model_real_of(h->focal_mm), model_real_of(h->back_focal_mm),
        model_real_of(h->entrance_radius_mm), model_real_of(h->stop_radius_mm),
        model_real_of(h->f_number), model_real_of(h->film_width_mm),
        model_real_of(h->film_height_mm), (unsigned long)h->n_surfaces,
        (unsigned long)count_ghosts(&model->lens), (unsigned long)h->n_ghosts);
    for (uint32_t k = 0; k < count_ghosts(&model->lens); k++)
        printf("%s[%lu, %lu]", k ? ", " : "",
               (unsigned long)model->lens.ghost[k].i,
               (unsigned long)model->lens.ghost[k].j);
    printf("], \"bytes\": %zu, \"basis\": \"%s\", \"band_nm\": [%.3f, %.3f], "
           "\"max_angle_deg\": %.6f, \"field_mm\": %.6f, \"systems\": %lu, "
           "\"mean_terms\": %.4f, ",
           model->bytes, basis_name(&model->lens), nanometres(h->wave_hi_q24),
           nanometres(h->wave_lo_q24), degrees(h->sine_hi_q30),
           model_real_of(h->field_mm), (unsigned long)h->n_systems,
           mean_terms(&sum));
    json_errors(&sum);
}

static void json_system(const struct glint_lens *lens, uint32_t ghost,
                        uint32_t system)
{
    const struct glint_model_system *s = &lens->system[system];
    const struct span span = {system, 1};
    const struct summary sum = summary_of(lens, span);

    printf(
        "{\"ghost\": %lu, \"angle_deg\": [%.6f, %.6f], \"band_nm\": "
        "[%.3f, %.3f], \"knots\": %lu, \"energy_roots\": %d, \"terms\": %.0f, "
        "\"bytes\": %zu, ",
        (unsigned long)ghost_of(lens, ghost), degrees(s->sine_lo_q30),
        degrees(s->sine_hi_q30), nanometres(s->wave_hi_q24),
        nanometres(s->wave_lo_q24), (unsigned long)s->n_knots,
        outputs_of(lens, s)[GLINT_OUT_ENERGY].roots, terms_of(&sum),
        bytes_of(lens, span));
    json_errors(&sum);
    printf("}");
}

static void json_systems(const struct glint_lens *lens)
{
    const char *comma = "";

    printf(", \"system_list\": [");
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++) {
            printf("%s", comma);
            json_system(lens, g, lens->ghost[g].first_system + k);
            comma = ", ";
        }
    printf("]");
}

static void json_info(const struct tool *tool, const struct model_file *model)
{
    json_header(model);
    if (tool->verbose)
        json_systems(&model->lens);
    printf("}\n");
}

static void json_ghost(const struct glint_lens *lens, uint32_t entry)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    const struct span span = span_of_ghost(lens, entry);
    const struct summary sum = summary_of(lens, span);
    double range_deg[2];

    angles_of(lens, span, range_deg);
    printf("{\"ghost\": %lu, \"part\": %s, \"pair\": [%lu, %lu], "
           "\"angle_deg\": "
           "[%.6f, %.6f], \"zones\": %lu, \"bytes\": %zu, \"met\": %s, ",
           (unsigned long)ghost_of(lens, entry),
           entry < count_ghosts(lens) ? "false" : "true", (unsigned long)g->i,
           (unsigned long)g->j, range_deg[0], range_deg[1],
           (unsigned long)span.n, bytes_of(lens, span),
           misses(&sum) ? "false" : "true");
    json_errors(&sum);
    printf("}");
}

static void json_bake(const struct glint_lens *lens, double seconds,
                      const struct glint_bake_report *report)
{
    const struct glint_model_header *h = lens->header;
    const struct summary sum = summary_of(lens, span_of_all(lens));

    printf("{\"seconds\": %.3f, \"bytes\": %lu, \"ghosts\": %lu, "
           "\"parts\": %lu, \"zones\": %lu, \"mean_terms\": %.4f, "
           "\"unmet_zones\": %d, "
           "\"rays\": %d, \"intruders\": %d, ",
           seconds, (unsigned long)h->bytes, (unsigned long)count_ghosts(lens),
           (unsigned long)h->n_ghosts, (unsigned long)h->n_systems,
           mean_terms(&sum), report->unmet, report->rays, report->intruders);
    json_errors(&sum);
    printf(", \"by_ghost\": [");
    for (uint32_t k = 0; k < h->n_ghosts; k++) {
        printf("%s", k ? ", " : "");
        json_ghost(lens, k);
    }
    printf("]}\n");
}

/* ---------------------------------------------------------------------- all */

void model_report_info(const struct tool *tool, const struct model_file *model)
{
    (tool->json ? json_info : print_info)(tool, model);
}

void model_report_bake(const struct tool *tool, const struct glint_lens *lens,
                       double seconds, const struct glint_bake_report *report)
{
    if (tool->json)
        json_bake(lens, seconds, report);
    else if (!tool->quiet)
        print_bake(tool, lens, seconds, report);
}
