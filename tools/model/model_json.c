/* SPDX-License-Identifier: MIT */
#include "model/model_report.h"

#include <math.h>

#include "model/model_summary.h"
#include "options/json_writer.h"

/* Prints "errors", an object with a member for each output. */
static void json_errors(struct json_writer *json,
                        const struct model_summary *sum)
{
    json_write(json, "errors: {");
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct model_errors *e = &sum->of[kind];

        if (e->n)
            json_write(json,
                       "%s: {terms: %.6g, rms: %.6g, p50: %.6g, p99: %.6g, "
                       "max: %.6g, bound: %.6g, rounding: %.6g}",
                       model_output_names[kind], e->terms, sqrt(e->mean2),
                       e->p50, e->p99, e->max, e->bound, e->rounding);
    }
    json_write(json, "}");
}

/* Prints "misses", a list of the ghosts that miss their targets. */
static void json_misses(struct json_writer *json, const struct glint_lens *lens)
{
    json_write(json, "misses: [");
    for (uint32_t k = 0; k < model_ghost_count(lens); k++) {
        const struct glint_model_ghost *g = &lens->ghost[k];
        const struct model_miss miss = model_miss_of(lens, k);

        if (miss.zones)
            json_write(json,
                       "{ghost: %u, pair: [%u, %u], angle_deg: [%.6f, %.6f], "
                       "zones: %u, output: %s, p99: %.6g, over: %.6g}",
                       k, g->i, g->j, miss.angle_deg[0], miss.angle_deg[1],
                       miss.zones, model_output_names[miss.output], miss.p99,
                       miss.over);
    }
    json_write(json, "]");
}

static void json_header(struct json_writer *json,
                        const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;
    const struct model_summary sum =
        model_summary_of(&model->lens, model_span_of_all(&model->lens));

    json_write(
        json,
        "{name: %s, focal_length_mm: %.6f, back_focal_length_mm: %.6f, "
        "entrance_pupil_radius_mm: %.6f, stop_radius_mm: %.6f, "
        "f_number: %g, film_mm: [%g, %g], surfaces: %u, ghosts: %u, "
        "parts: %u, ghost_pairs: [",
        h->name, model_real_of(h->focal_mm), model_real_of(h->back_focal_mm),
        model_real_of(h->entrance_radius_mm), model_real_of(h->stop_radius_mm),
        model_real_of(h->f_number), model_real_of(h->film_width_mm),
        model_real_of(h->film_height_mm), h->n_surfaces,
        model_ghost_count(&model->lens), h->n_ghosts);
    for (uint32_t k = 0; k < model_ghost_count(&model->lens); k++)
        json_write(json, "[%u, %u]", model->lens.ghost[k].i,
                   model->lens.ghost[k].j);
    json_write(json, "], bytes: %zu, basis: %s", model->bytes,
               model_basis_name(&model->lens));
    if (glint_basis_is_lens(h->basis))
        json_write(json, "mirrors_x: %c, mirrors_y: %c",
                   (h->basis & GLINT_MIRRORS_X) != 0,
                   (h->basis & GLINT_MIRRORS_Y) != 0);
    json_write(json,
               "band_nm: [%.3f, %.3f], max_angle_deg: %.6f, field_mm: %.6f, "
               "systems: %u, mean_terms: %.4f",
               model_nanometres(h->wave_hi_q24),
               model_nanometres(h->wave_lo_q24), model_degrees(h->sine_hi_q30),
               model_real_of(h->field_mm), h->n_systems,
               model_mean_terms(&sum));
    json_errors(json, &sum);
    json_misses(json, &model->lens);
}

static void json_system(struct json_writer *json, const struct glint_lens *lens,
                        uint32_t ghost, uint32_t system)
{
    const struct glint_model_system *s = &lens->system[system];
    const struct model_span span = {system, 1};
    const struct model_summary sum = model_summary_of(lens, span);

    json_write(json,
               "{ghost: %u, angle_deg: [%.6f, %.6f], band_nm: [%.3f, %.3f], "
               "knots: %u, energy_roots: %d, terms: %.0f, bytes: %zu",
               model_ghost_of(lens, ghost), model_degrees(s->sine_lo_q30),
               model_degrees(s->sine_hi_q30), model_nanometres(s->wave_hi_q24),
               model_nanometres(s->wave_lo_q24), s->n_knots,
               model_outputs_of(lens, s)[GLINT_OUT_ENERGY].roots,
               model_terms(&sum), model_span_bytes(lens, span));
    json_errors(json, &sum);
    json_write(json, "}");
}

static void json_systems(struct json_writer *json,
                         const struct glint_lens *lens)
{
    json_write(json, "system_list: [");
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++)
            json_system(json, lens, g, lens->ghost[g].first_system + k);
    json_write(json, "]");
}

void model_json_info(const struct tool *tool, const struct model_file *model)
{
    struct json_writer json = {.to = stdout};

    json_header(&json, model);
    if (model->zoom)
        json_write(&json, "positions: %d, models: %d",
                   model_file_positions(model->zoom), model->zoom->n_models);
    if (tool->verbose)
        json_systems(&json, &model->lens);
    json_write(&json, "}\n");
}

static void json_ghost(struct json_writer *json, const struct glint_lens *lens,
                       uint32_t entry)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    const struct model_span span = model_span_of_ghost(lens, entry);
    const struct model_summary sum = model_summary_of(lens, span);
    double range_deg[2];

    model_span_angles(lens, span, range_deg);
    json_write(json,
               "{ghost: %u, part: %c, pair: [%u, %u], angle_deg: [%.6f, %.6f], "
               "zones: %u, bytes: %zu, met: %c",
               model_ghost_of(lens, entry), entry >= model_ghost_count(lens),
               g->i, g->j, range_deg[0], range_deg[1], span.n,
               model_span_bytes(lens, span), !model_misses(&sum));
    json_errors(json, &sum);
    json_write(json, "}");
}

void model_json_bake(const struct glint_lens *lens, double seconds,
                     const struct glint_bake_report *report)
{
    const struct glint_model_header *h = lens->header;
    const struct model_summary sum =
        model_summary_of(lens, model_span_of_all(lens));
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{seconds: %.3f, bytes: %u, ghosts: %u, parts: %u, zones: %u, "
               "mean_terms: %.4f, unmet_zones: %d, rays: %d, intruders: %d",
               seconds, h->bytes, model_ghost_count(lens), h->n_ghosts,
               h->n_systems, model_mean_terms(&sum), report->unmet,
               report->rays, report->intruders);
    json_errors(&json, &sum);
    json_misses(&json, lens);
    json_write(&json, "by_ghost: [");
    for (uint32_t k = 0; k < h->n_ghosts; k++)
        json_ghost(&json, lens, k);
    json_write(&json, "]}\n");
}
