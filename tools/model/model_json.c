/* SPDX-License-Identifier: MIT */
#include "model/model_json.h"

#include <math.h>

#include "model/model_summary.h"

/* Prints "errors", an object with a member for each output. */
static void json_errors(const struct model_summary *sum)
{
    const char *comma = "";

    printf("\"errors\": {");
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct model_errors *e = &sum->of[kind];

        if (!e->n)
            continue;
        printf("%s\"%s\": {\"terms\": %.6g, \"rms\": %.6g, \"p50\": %.6g, "
               "\"p99\": %.6g, \"max\": %.6g, \"bound\": %.6g, "
               "\"rounding\": %.6g}",
               comma, model_output_names[kind], e->terms, sqrt(e->mean2),
               e->p50, e->p99, e->max, e->bound, e->rounding);
        comma = ", ";
    }
    printf("}");
}

/* Prints "misses", a list of the ghosts that miss their targets. */
static void json_misses(const struct glint_lens *lens)
{
    const char *comma = "";

    printf(", \"misses\": [");
    for (uint32_t k = 0; k < model_ghost_count(lens); k++) {
        const struct glint_model_ghost *g = &lens->ghost[k];
        const struct model_miss miss = model_miss_of(lens, k);

        if (!miss.zones)
            continue;
        printf("%s{\"ghost\": %lu, \"pair\": [%lu, %lu], \"angle_deg\": "
               "[%.6f, %.6f], \"zones\": %lu, \"output\": \"%s\", "
               "\"p99\": %.6g, \"over\": %.6g}",
               comma, (unsigned long)k, (unsigned long)g->i,
               (unsigned long)g->j, miss.angle_deg[0], miss.angle_deg[1],
               (unsigned long)miss.zones, model_output_names[miss.output],
               miss.p99, miss.over);
        comma = ", ";
    }
    printf("]");
}

static void json_header(const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;
    const struct model_summary sum =
        model_summary_of(&model->lens, model_span_of_all(&model->lens));

    printf("{\"name\": ");
    tool_json_string(stdout, h->name);
    printf(", \"focal_length_mm\": %.6f, \"back_focal_length_mm\": %.6f, "
           "\"entrance_pupil_radius_mm\": %.6f, \"stop_radius_mm\": %.6f, "
           "\"f_number\": %g, \"film_mm\": [%g, %g], \"surfaces\": %lu, "
           "\"ghosts\": %lu, \"parts\": %lu, \"ghost_pairs\": [",
           model_real_of(h->focal_mm), model_real_of(h->back_focal_mm),
           model_real_of(h->entrance_radius_mm),
           model_real_of(h->stop_radius_mm), model_real_of(h->f_number),
           model_real_of(h->film_width_mm), model_real_of(h->film_height_mm),
           (unsigned long)h->n_surfaces,
           (unsigned long)model_ghost_count(&model->lens),
           (unsigned long)h->n_ghosts);
    for (uint32_t k = 0; k < model_ghost_count(&model->lens); k++)
        printf("%s[%lu, %lu]", k ? ", " : "",
               (unsigned long)model->lens.ghost[k].i,
               (unsigned long)model->lens.ghost[k].j);
    printf("], \"bytes\": %zu, \"basis\": \"%s\", ", model->bytes,
           model_basis_name(&model->lens));
    if (glint_basis_is_lens(h->basis))
        printf("\"mirrors_x\": %s, \"mirrors_y\": %s, ",
               h->basis & GLINT_MIRRORS_X ? "true" : "false",
               h->basis & GLINT_MIRRORS_Y ? "true" : "false");
    printf("\"band_nm\": [%.3f, %.3f], "
           "\"max_angle_deg\": %.6f, \"field_mm\": %.6f, \"systems\": %lu, "
           "\"mean_terms\": %.4f, ",
           model_nanometres(h->wave_hi_q24), model_nanometres(h->wave_lo_q24),
           model_degrees(h->sine_hi_q30), model_real_of(h->field_mm),
           (unsigned long)h->n_systems, model_mean_terms(&sum));
    json_errors(&sum);
    json_misses(&model->lens);
}

static void json_system(const struct glint_lens *lens, uint32_t ghost,
                        uint32_t system)
{
    const struct glint_model_system *s = &lens->system[system];
    const struct model_span span = {system, 1};
    const struct model_summary sum = model_summary_of(lens, span);

    printf(
        "{\"ghost\": %lu, \"angle_deg\": [%.6f, %.6f], \"band_nm\": "
        "[%.3f, %.3f], \"knots\": %lu, \"energy_roots\": %d, \"terms\": %.0f, "
        "\"bytes\": %zu, ",
        (unsigned long)model_ghost_of(lens, ghost),
        model_degrees(s->sine_lo_q30), model_degrees(s->sine_hi_q30),
        model_nanometres(s->wave_hi_q24), model_nanometres(s->wave_lo_q24),
        (unsigned long)s->n_knots,
        model_outputs_of(lens, s)[GLINT_OUT_ENERGY].roots, model_terms(&sum),
        model_span_bytes(lens, span));
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

void model_json_info(const struct tool *tool, const struct model_file *model)
{
    json_header(model);
    if (model->zoom)
        printf(", \"positions\": %d, \"models\": %d",
               model_file_positions(model->zoom), model->zoom->n_models);
    if (tool->verbose)
        json_systems(&model->lens);
    printf("}\n");
}

static void json_ghost(const struct glint_lens *lens, uint32_t entry)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    const struct model_span span = model_span_of_ghost(lens, entry);
    const struct model_summary sum = model_summary_of(lens, span);
    double range_deg[2];

    model_span_angles(lens, span, range_deg);
    printf("{\"ghost\": %lu, \"part\": %s, \"pair\": [%lu, %lu], "
           "\"angle_deg\": "
           "[%.6f, %.6f], \"zones\": %lu, \"bytes\": %zu, \"met\": %s, ",
           (unsigned long)model_ghost_of(lens, entry),
           entry < model_ghost_count(lens) ? "false" : "true",
           (unsigned long)g->i, (unsigned long)g->j, range_deg[0], range_deg[1],
           (unsigned long)span.n, model_span_bytes(lens, span),
           model_misses(&sum) ? "false" : "true");
    json_errors(&sum);
    printf("}");
}

void model_json_bake(const struct glint_lens *lens, double seconds,
                     const struct glint_bake_report *report)
{
    const struct glint_model_header *h = lens->header;
    const struct model_summary sum =
        model_summary_of(lens, model_span_of_all(lens));

    printf("{\"seconds\": %.3f, \"bytes\": %lu, \"ghosts\": %lu, "
           "\"parts\": %lu, \"zones\": %lu, \"mean_terms\": %.4f, "
           "\"unmet_zones\": %d, "
           "\"rays\": %d, \"intruders\": %d, ",
           seconds, (unsigned long)h->bytes,
           (unsigned long)model_ghost_count(lens), (unsigned long)h->n_ghosts,
           (unsigned long)h->n_systems, model_mean_terms(&sum), report->unmet,
           report->rays, report->intruders);
    json_errors(&sum);
    json_misses(lens);
    printf(", \"by_ghost\": [");
    for (uint32_t k = 0; k < h->n_ghosts; k++) {
        printf("%s", k ? ", " : "");
        json_ghost(lens, k);
    }
    printf("]}\n");
}
