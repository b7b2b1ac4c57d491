/* SPDX-License-Identifier: MIT */
#include "info_model.h"

#include <math.h>

#include "model_file.h"

static const char *const kind_names[GLINT_OUT_KINDS] = {
    "sensor_x", "sensor_y", "stop_x",   "stop_y",   "energy",
    "radius",   "barrel_0", "barrel_1", "barrel_2", "barrel_3"};

static const char *basis_name(const struct glint_lens *lens)
{
    return lens->header->basis == GLINT_BASIS_SPARSE ? "sparse" : "auto";
}

/* ----------------------------------------------------------------- quantities
 */

static double degrees(int32_t sine_q30)
{
    return asin(ldexp(sine_q30, -30)) * (180 / 3.14159265358979323846);
}

static double nanometres(int32_t wave_q24)
{
    return 1e3 / sqrt(ldexp(wave_q24, -24));
}

static double unit_q20(uint32_t x_q20)
{
    return ldexp(x_q20, -20);
}

static const struct glint_model_output *
outputs_of(const struct glint_lens *lens, const struct glint_model_system *s)
{
    const char *base = (const char *)lens->header;

    return (const void *)(base + s->output_at);
}

/* Terms of all polynomials of a system. */
static uint32_t terms_of(const struct glint_lens *lens,
                         const struct glint_model_system *s)
{
    const struct glint_model_output *o = outputs_of(lens, s);
    uint32_t sum = 0;

    for (uint32_t k = 0; k < s->n_outputs; k++)
        sum += o[k].n_terms;
    return sum;
}

/* What a system takes in the file, without regard to sharing. */
static double bytes_of(const struct glint_lens *lens,
                       const struct glint_model_system *s)
{
    const struct glint_model_output *o = outputs_of(lens, s);
    const double n_sets = s->n_knots ? s->n_knots : 1;
    double sum = sizeof *s + (double)s->n_outputs * sizeof *o;

    sum += s->n_knots ? 4 * (1 + 3) * n_sets : 4 * 3 * GLINT_BOX_POWERS;
    for (uint32_t k = 0; k < s->n_outputs; k++)
        sum += 4 * n_sets * o[k].n_terms + (o[k].n_terms + 1) / 2 * 4;
    return sum;
}

/* An output's errors over all systems that have it. */
struct errors {
    uint32_t n;
    double square, p50, p99, max; /* sums of the first two */
    double bound, rounding;       /* worst, in the unit of the errors */
};

static void worst(double *most, double x)
{
    *most = x > *most ? x : *most;
}

static struct errors errors_of(const struct glint_lens *lens, uint32_t kind)
{
    const double film_mm = model_real_of(lens->header->film_width_mm);
    const double unit = kind <= GLINT_OUT_SENSOR_Y ? 1920 / film_mm : 1;
    struct errors e = {0};

    for (uint32_t k = 0; k < lens->header->n_systems; k++) {
        const struct glint_model_system *s = &lens->system[k];
        const struct glint_model_output *o = outputs_of(lens, s);

        for (uint32_t m = 0; m < s->n_outputs; m++) {
            const double step = ldexp(unit, o[m].exponent);

            if (o[m].kind != kind)
                continue;
            e.n++;
            e.square += unit_q20(o[m].rms_q20) * unit_q20(o[m].rms_q20);
            e.p50 += unit_q20(o[m].p50_q20);
            worst(&e.p99, unit_q20(o[m].p99_q20));
            worst(&e.max, unit_q20(o[m].max_q20));
            worst(&e.bound, o[m].bound * step);
            worst(&e.rounding, ldexp(o[m].rounding_q8 * step, -8));
        }
    }
    return e;
}

static double mean_terms(const struct glint_lens *lens)
{
    double terms = 0, polynomials = 0;

    for (uint32_t k = 0; k < lens->header->n_systems; k++) {
        terms += terms_of(lens, &lens->system[k]);
        polynomials += lens->system[k].n_outputs;
    }
    return polynomials > 0 ? terms / polynomials : 0;
}

/* ----------------------------------------------------------------------- text
 */

static void print_header(const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;

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
    printf("ghosts              %6lu, %lu systems, %.1f terms a polynomial\n",
           (unsigned long)h->n_ghosts, (unsigned long)h->n_systems,
           mean_terms(&model->lens));
}

static void print_ghost(const struct glint_lens *lens, uint32_t ghost)
{
    const struct glint_model_ghost *g = &lens->ghost[ghost];
    int32_t lo_q30 = INT32_MAX, hi_q30 = 0;
    uint32_t terms = 0;
    double bytes = 0;
    char pair[32];

    for (uint32_t k = 0; k < g->n_systems; k++) {
        const struct glint_model_system *s = &lens->system[g->first_system + k];

        lo_q30 = s->sine_lo_q30 < lo_q30 ? s->sine_lo_q30 : lo_q30;
        hi_q30 = s->sine_hi_q30 > hi_q30 ? s->sine_hi_q30 : hi_q30;
        terms += terms_of(lens, s);
        bytes += bytes_of(lens, s);
    }
    snprintf(pair, sizeof pair, "%lu-%lu", (unsigned long)g->i,
             (unsigned long)g->j);
    printf("%5lu  %-8s %7lu  %7.3f .. %-7.3f %7lu  %9.0f\n",
           (unsigned long)ghost, pair, (unsigned long)g->n_systems,
           degrees(lo_q30), degrees(hi_q30), (unsigned long)terms, bytes);
}

static void print_ghosts(const struct glint_lens *lens)
{
    const uint32_t n = lens->header->n_ghosts;
    uint32_t unseen = 0;

    printf("\nghost  surfaces systems       degrees         terms      "
           "bytes\n");
    for (uint32_t k = 0; k < n; k++) {
        if (lens->ghost[k].n_systems)
            print_ghost(lens, k);
        else
            unseen++;
    }
    if (!unseen)
        return;
    printf("never seen:");
    for (uint32_t k = 0; k < n; k++)
        if (lens->ghost[k].n_systems == 0)
            printf(" %lu:%lu-%lu", (unsigned long)k,
                   (unsigned long)lens->ghost[k].i,
                   (unsigned long)lens->ghost[k].j);
    printf("\n");
}

static void print_errors(const struct glint_lens *lens)
{
    static const char *const units[] = {"px of 1920", "px of 1920",
                                        "stop radii", "stop radii", "share"};

    printf("\noutput    in              rms       p50       p99       max "
           "     bound  rounding\n");
    for (uint32_t kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct errors e = errors_of(lens, kind);

        if (e.n)
            printf("%-9s %-11s %9.3g %9.3g %9.3g %9.3g %9.3g %9.2g\n",
                   kind_names[kind],
                   kind < GLINT_OUT_RADIUS ? units[kind] : "radii",
                   sqrt(e.square / e.n), e.p50 / e.n, e.p99, e.max, e.bound,
                   e.rounding);
    }
}

static void print_systems(const struct glint_lens *lens)
{
    printf("\nsystem  ghost       degrees               nm      knots  terms  "
           "sensor px: rms  p99  max\n");
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++) {
            const uint32_t n = lens->ghost[g].first_system + k;
            const struct glint_model_system *s = &lens->system[n];
            const struct glint_model_output *x = outputs_of(lens, s);

            printf("%6lu %6lu  %7.3f .. %-7.3f  %4.0f .. %-4.0f %6lu %6lu  "
                   "%9.3g %9.3g %9.3g\n",
                   (unsigned long)n, (unsigned long)g, degrees(s->sine_lo_q30),
                   degrees(s->sine_hi_q30), nanometres(s->wave_hi_q24),
                   nanometres(s->wave_lo_q24), (unsigned long)s->n_knots,
                   (unsigned long)terms_of(lens, s), unit_q20(x->rms_q20),
                   unit_q20(x->p99_q20), unit_q20(x->max_q20));
        }
}

static void print_text(const struct tool *tool, const struct model_file *model)
{
    print_header(model);
    print_ghosts(&model->lens);
    print_errors(&model->lens);
    if (tool->verbose)
        print_systems(&model->lens);
}

/* ----------------------------------------------------------------------- JSON
 */

static void json_header(const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;

    printf("{\"name\": ");
    tool_json_string(stdout, h->name);
    printf(", \"focal_length_mm\": %.6f, \"back_focal_length_mm\": %.6f, "
           "\"entrance_pupil_radius_mm\": %.6f, \"stop_radius_mm\": %.6f, "
           "\"f_number\": %g, \"film_mm\": [%g, %g], \"surfaces\": %lu, "
           "\"ghosts\": %lu, \"ghost_pairs\": [",
           model_real_of(h->focal_mm), model_real_of(h->back_focal_mm),
           model_real_of(h->entrance_radius_mm),
           model_real_of(h->stop_radius_mm), model_real_of(h->f_number),
           model_real_of(h->film_width_mm), model_real_of(h->film_height_mm),
           (unsigned long)h->n_surfaces, (unsigned long)h->n_ghosts);
    for (uint32_t k = 0; k < h->n_ghosts; k++)
        printf("%s[%lu, %lu]", k ? ", " : "",
               (unsigned long)model->lens.ghost[k].i,
               (unsigned long)model->lens.ghost[k].j);
    printf("], \"bytes\": %zu, \"basis\": \"%s\", \"band_nm\": [%.3f, %.3f], "
           "\"max_angle_deg\": %.6f, \"field_mm\": %.6f, \"systems\": %lu, "
           "\"mean_terms\": %.4f",
           model->bytes, basis_name(&model->lens), nanometres(h->wave_hi_q24),
           nanometres(h->wave_lo_q24), degrees(h->sine_hi_q30),
           model_real_of(h->field_mm), (unsigned long)h->n_systems,
           mean_terms(&model->lens));
}

static void json_errors(const struct glint_lens *lens)
{
    const char *comma = "";

    printf(", \"errors\": {");
    for (uint32_t kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct errors e = errors_of(lens, kind);

        if (!e.n)
            continue;
        printf("%s\"%s\": {\"rms\": %.6g, \"p50\": %.6g, \"p99\": %.6g, "
               "\"max\": %.6g, \"bound\": %.6g, \"rounding\": %.6g}",
               comma, kind_names[kind], sqrt(e.square / e.n), e.p50 / e.n,
               e.p99, e.max, e.bound, e.rounding);
        comma = ", ";
    }
    printf("}");
}

static void json_system(const struct glint_lens *lens, uint32_t ghost,
                        const struct glint_model_system *s)
{
    const struct glint_model_output *o = outputs_of(lens, s);

    printf("{\"ghost\": %lu, \"angle_deg\": [%.6f, %.6f], \"band_nm\": "
           "[%.3f, %.3f], \"knots\": %lu, \"terms\": %lu, \"bytes\": %.0f, "
           "\"errors\": {",
           (unsigned long)ghost, degrees(s->sine_lo_q30),
           degrees(s->sine_hi_q30), nanometres(s->wave_hi_q24),
           nanometres(s->wave_lo_q24), (unsigned long)s->n_knots,
           (unsigned long)terms_of(lens, s), bytes_of(lens, s));
    for (uint32_t k = 0; k < s->n_outputs; k++)
        printf("%s\"%s\": {\"terms\": %lu, \"rms\": %.6g, \"p50\": %.6g, "
               "\"p99\": %.6g, \"max\": %.6g}",
               k ? ", " : "", kind_names[o[k].kind],
               (unsigned long)o[k].n_terms, unit_q20(o[k].rms_q20),
               unit_q20(o[k].p50_q20), unit_q20(o[k].p99_q20),
               unit_q20(o[k].max_q20));
    printf("}}");
}

static void json_systems(const struct glint_lens *lens)
{
    const char *comma = "";

    printf(", \"system_list\": [");
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++) {
            printf("%s", comma);
            json_system(lens, g,
                        &lens->system[lens->ghost[g].first_system + k]);
            comma = ", ";
        }
    printf("]");
}

static void print_json(const struct tool *tool, const struct model_file *model)
{
    json_header(model);
    json_errors(&model->lens);
    if (tool->verbose)
        json_systems(&model->lens);
    printf("}\n");
}

int info_model(const struct tool *tool, const char *path)
{
    struct model_file model;
    const int code = tool_model(tool, path, &model);

    if (code != EXIT_OK)
        return code;
    (tool->json ? print_json : print_text)(tool, &model);
    model_file_close(&model);
    return EXIT_OK;
}
