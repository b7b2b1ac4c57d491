/* SPDX-License-Identifier: MIT */
#include "model/model_report.h"

#include <math.h>

#include "model/model_summary.h"
#include "options/json_writer.h"

/* -------------------------------------------------------------------- JSON */

/* Writes the JSON member "errors": an object with the errors of each output. */
static void write_errors_json(struct json_writer *json,
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

/* Writes the JSON member "misses": a list of the ghosts whose error exceeds a
 * target. */
static void write_missed_targets_json(struct json_writer *json,
                                      const struct glint_lens *lens)
{
    json_write(json, "misses: [");
    for (uint32_t k = 0; k < model_count_ghosts(lens); k++) {
        const struct glint_model_ghost *g = &lens->ghost[k];
        const struct model_miss miss = model_find_missed_zones(lens, k);

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

/* Writes the light with the lowest PSNR, PSNR_DB, of N whose pictures were
 * compared. */
static void write_picture_check_json(struct json_writer *json, int n,
                                     double psnr_db, double angle_deg)
{
    json_write(json, "pictures: %d", n);
    if (n > 0 && psnr_db < PICTURE_IDENTICAL_DB)
        json_write(json, "worst_db: %.2f, worst_deg: %.4f", psnr_db, angle_deg);
}

static void write_header_json(struct json_writer *json,
                              const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;
    const struct glint_model_note *const note = model_get_note(&model->lens);
    const struct model_summary sum =
        model_compute_summary(&model->lens, model_get_full_span(&model->lens));

    json_write(json,
               "{name: %s, focal_length_mm: %.6f, back_focal_length_mm: %.6f, "
               "entrance_pupil_radius_mm: %.6f, stop_radius_mm: %.6f, "
               "f_number: %g, film_mm: [%g, %g], surfaces: %u, ghosts: %u, "
               "parts: %u, ghost_pairs: [",
               h->name, model_convert_real_to_double(h->focal_mm),
               model_convert_real_to_double(h->back_focal_mm),
               model_convert_real_to_double(h->entrance_radius_mm),
               model_convert_real_to_double(h->stop_radius_mm),
               model_convert_real_to_double(h->f_number),
               model_convert_real_to_double(h->film_width_mm),
               model_convert_real_to_double(h->film_height_mm), h->n_surfaces,
               model_count_ghosts(&model->lens), h->n_ghosts);
    for (uint32_t k = 0; k < model_count_ghosts(&model->lens); k++)
        json_write(json, "[%u, %u]", model->lens.ghost[k].i,
                   model->lens.ghost[k].j);
    json_write(json, "], bytes: %zu, basis: %s", model->bytes,
               model_get_basis_name(&model->lens));
    if (glint_basis_is_lens(h->basis))
        json_write(json, "mirrors_x: %c, mirrors_y: %c",
                   (h->basis & GLINT_MIRRORS_X) != 0,
                   (h->basis & GLINT_MIRRORS_Y) != 0);
    json_write(json,
               "band_nm: [%.3f, %.3f], max_angle_deg: %.6f, field_mm: %.6f, "
               "systems: %u, mean_terms: %.4f",
               model_convert_wave_to_nm(h->wave_hi_q24),
               model_convert_wave_to_nm(h->wave_lo_q24),
               model_convert_sine_to_deg(h->sine_hi_q30),
               model_convert_real_to_double(h->field_mm), h->n_systems,
               model_compute_mean_terms(&sum));
    if (note)
        json_write(json, "coating: %s", note->coating);
    write_picture_check_json(json, note ? (int)note->n : 0,
                             note ? ldexp(note->psnr_q8, -8) : 0,
                             note ? ldexp(note->angle_q8, -8) : 0);
    write_errors_json(json, &sum);
    write_missed_targets_json(json, &model->lens);
}

static void write_system_json(struct json_writer *json,
                              const struct glint_lens *lens, uint32_t ghost,
                              uint32_t system)
{
    const struct glint_model_system *s = &lens->system[system];
    const struct model_span span = {system, 1};
    const struct model_summary sum = model_compute_summary(lens, span);

    json_write(json,
               "{ghost: %u, angle_deg: [%.6f, %.6f], band_nm: [%.3f, %.3f], "
               "energy_roots: %d, terms: %.0f, bytes: %zu",
               model_find_ghost_of_entry(lens, ghost),
               model_convert_sine_to_deg(s->sine_lo_q30),
               model_convert_sine_to_deg(s->sine_hi_q30),
               model_convert_wave_to_nm(s->wave_hi_q24),
               model_convert_wave_to_nm(s->wave_lo_q24),
               model_outputs_of(lens, s)[GLINT_OUT_ENERGY].roots,
               model_count_terms(&sum), model_count_span_bytes(lens, span));
    write_errors_json(json, &sum);
    json_write(json, "}");
}

static void write_systems_json(struct json_writer *json,
                               const struct glint_lens *lens)
{
    json_write(json, "system_list: [");
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++)
            write_system_json(json, lens, g, lens->ghost[g].first_system + k);
    json_write(json, "]");
}

static void write_info_json(const struct tool *tool,
                            const struct model_file *model)
{
    struct json_writer json = {.to = stdout};

    write_header_json(&json, model);
    if (model->zoom)
        json_write(&json, "positions: %d, models: %d",
                   model_file_count_positions(model->zoom),
                   model->zoom->n_models);
    if (tool->verbose)
        write_systems_json(&json, &model->lens);
    json_write(&json, "}\n");
}

static void write_ghost_json(struct json_writer *json,
                             const struct glint_lens *lens, uint32_t entry)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    const struct model_span span = model_measure_ghost_span(lens, entry);
    const struct model_summary sum = model_compute_summary(lens, span);
    double range_deg[2];

    model_find_span_angles(lens, span, range_deg);
    json_write(json,
               "{ghost: %u, part: %c, pair: [%u, %u], angle_deg: [%.6f, %.6f], "
               "zones: %u, bytes: %zu, met: %c",
               model_find_ghost_of_entry(lens, entry),
               entry >= model_count_ghosts(lens), g->i, g->j, range_deg[0],
               range_deg[1], span.n, model_count_span_bytes(lens, span),
               !model_misses_error_target(&sum));
    write_errors_json(json, &sum);
    json_write(json, "}");
}

static void write_bake_json(const struct glint_lens *lens, double seconds,
                            const struct glint_bake_report *report,
                            const struct picture_check *check)
{
    const struct glint_model_header *h = lens->header;
    const struct model_summary sum =
        model_compute_summary(lens, model_get_full_span(lens));
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{seconds: %.3f, bytes: %u, ghosts: %u, parts: %u, zones: %u, "
               "mean_terms: %.4f, unmet_zones: %d, rays: %d, intruders: %d",
               seconds, h->bytes, model_count_ghosts(lens), h->n_ghosts,
               h->n_systems, model_compute_mean_terms(&sum), report->unmet,
               report->rays, report->intruders);
    write_picture_check_json(&json, check->n, check->psnr_db, check->angle_deg);
    write_errors_json(&json, &sum);
    write_missed_targets_json(&json, lens);
    json_write(&json, "by_ghost: [");
    for (uint32_t k = 0; k < h->n_ghosts; k++)
        write_ghost_json(&json, lens, k);
    json_write(&json, "]}\n");
}

/* Prints the coating and the comparison of pictures that the file of LENS
 * contains. */
static void print_model_note(const struct glint_lens *lens)
{
    const struct glint_model_note *const note = model_get_note(lens);

    printf("coating             %s\n", note ? note->coating : "not recorded");
    if (!note)
        puts("pictures            not checked; bake again");
    else if (note->n == 0)
        puts("pictures            not checked against exact rays");
    else if (note->psnr_q8 >= PICTURE_IDENTICAL_DB << 8)
        puts("pictures            identical to those by exact rays");
    else
        printf("pictures            %6.1f dB PSNR against exact rays at worst, "
               "with the light %.1f degrees off the axis\n",
               ldexp(note->psnr_q8, -8), ldexp(note->angle_q8, -8));
}

static void print_model_header(const struct model_file *model)
{
    const struct glint_model_header *h = model->lens.header;
    const struct model_summary sum =
        model_compute_summary(&model->lens, model_get_full_span(&model->lens));

    static const char *const lights[] = {
        "all", "those with x >= 0; the others are mirrored",
        "those with y >= 0; the others are mirrored",
        "those with x and y >= 0; the others are mirrored"};

    printf("%s\nbaked model, %zu bytes, for %s lenses, key %08lx%08lx\n\n",
           h->name, model->bytes,
           glint_basis_is_lens(h->basis) ? "asymmetric" : "round",
           (unsigned long)h->key[1], (unsigned long)h->key[0]);
    if (glint_basis_is_lens(h->basis))
        printf("directions baked    %s\n", lights[h->basis & 3U]);
    printf("focal length        %10.3f mm\n",
           model_convert_real_to_double(h->focal_mm));
    printf("back focal length   %10.3f mm\n",
           model_convert_real_to_double(h->back_focal_mm));
    printf("entrance pupil      %10.3f mm radius\n",
           model_convert_real_to_double(h->entrance_radius_mm));
    printf("stop                %10.4f mm radius at f/%g, the widest of the "
           "model\n",
           model_convert_real_to_double(h->stop_radius_mm),
           model_convert_real_to_double(h->f_number));
    printf("front element       %10.3f mm semi-diameter\n",
           model_convert_real_to_double(h->front_mm));
    printf("film                %6gx%g mm\n",
           model_convert_real_to_double(h->film_width_mm),
           model_convert_real_to_double(h->film_height_mm));
    printf("field               %10.3f mm from the centre of the sensor\n",
           model_convert_real_to_double(h->field_mm));
    printf("band                %6.0f to %.0f nm\n",
           model_convert_wave_to_nm(h->wave_hi_q24),
           model_convert_wave_to_nm(h->wave_lo_q24));
    printf("largest angle       %10.3f degrees\n",
           model_convert_sine_to_deg(h->sine_hi_q30));
    printf("surfaces            %6lu\n", (unsigned long)h->n_surfaces);
    printf("ghosts              %6lu in %lu pupil regions, %lu zones, "
           "%.1f terms per output\n",
           (unsigned long)model_count_ghosts(&model->lens),
           (unsigned long)h->n_ghosts, (unsigned long)h->n_systems,
           model_compute_mean_terms(&sum));
    print_model_note(&model->lens);
    if (model->zoom)
        printf("positions           %6d with all ghosts, %d more with some of "
               "them; all other values are those of the first\n",
               model_file_count_positions(model->zoom),
               model->zoom->n_models - model_file_count_positions(model->zoom));
}

static void print_model_errors(const struct model_summary *sum)
{
    printf("\noutput    in          terms       rms       p50 worst p99       "
           "max     bound  rounding\n");
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct model_errors *e = &sum->of[kind];

        if (e->n)
            printf("%-9s %-10s %6.1f %9.3g %9.3g %9.3g %9.3g %9.3g %9.2g\n",
                   model_output_names[kind], model_output_units[kind], e->terms,
                   sqrt(e->mean2), e->p50, e->p99, e->max, e->bound,
                   e->rounding);
    }
}

static void print_ghost_table_title(const char *more)
{
    printf("ghost  surfaces   zones       degrees         terms      bytes%s\n",
           more);
}

/* Prints the table row of a ghost, or of a further part of the ghost's pupil,
 * whose number is followed by a plus. Prints no line feed. */
static void print_ghost_row(const struct glint_lens *lens, uint32_t entry,
                            const struct model_summary *sum)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    const struct model_span span = model_measure_ghost_span(lens, entry);
    double range_deg[2];
    char pair[32];

    model_find_span_angles(lens, span, range_deg);
    snprintf(pair, sizeof pair, "%lu-%lu", (unsigned long)g->i,
             (unsigned long)g->j);
    printf("%5lu%c %-8s %7lu  %7.3f .. %-7.3f %7.0f  %9zu",
           (unsigned long)model_find_ghost_of_entry(lens, entry),
           entry < model_count_ghosts(lens) ? ' ' : '+', pair,
           (unsigned long)g->n_systems, range_deg[0], range_deg[1],
           model_count_terms(sum), model_count_span_bytes(lens, span));
}

static void print_ghosts_without_zones(const struct glint_lens *lens)
{
    bool any = false;

    for (uint32_t k = 0; k < lens->header->n_ghosts; k++) {
        const struct glint_model_ghost *g = &lens->ghost[k];

        if (g->n_systems)
            continue;
        printf("%s %lu:%lu-%lu",
               any ? ""
                   : "ghosts that never reach the film, by number and "
                     "surfaces:",
               (unsigned long)k, (unsigned long)g->i, (unsigned long)g->j);
        any = true;
    }
    if (any)
        printf("\n");
}

static void print_ghost_table(const struct glint_lens *lens)
{
    printf("\n");
    print_ghost_table_title("");
    for (uint32_t k = 0; k < lens->header->n_ghosts; k++) {
        const struct model_summary sum =
            model_compute_summary(lens, model_measure_ghost_span(lens, k));

        if (lens->ghost[k].n_systems == 0)
            continue;
        print_ghost_row(lens, k, &sum);
        printf("\n");
    }
    print_ghosts_without_zones(lens);
}

static void print_system_table(const struct glint_lens *lens)
{
    printf("\n zone   ghost       degrees               nm       terms  "
           "sensor px: rms  p99  max\n");
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++) {
            const uint32_t n = lens->ghost[g].first_system + k;
            const struct glint_model_system *s = &lens->system[n];
            const struct model_summary sum =
                model_compute_summary(lens, (struct model_span){n, 1});
            const struct model_errors *x = &sum.of[GLINT_OUT_SENSOR_X];

            printf("%6lu %6lu  %7.3f .. %-7.3f  %4.0f .. %-4.0f %6.0f  "
                   "%9.3g %9.3g %9.3g\n",
                   (unsigned long)n,
                   (unsigned long)model_find_ghost_of_entry(lens, g),
                   model_convert_sine_to_deg(s->sine_lo_q30),
                   model_convert_sine_to_deg(s->sine_hi_q30),
                   model_convert_wave_to_nm(s->wave_hi_q24),
                   model_convert_wave_to_nm(s->wave_lo_q24),
                   model_count_terms(&sum), sqrt(x->mean2), x->p99, x->max);
        }
}

static void print_model_info(const struct tool *tool,
                             const struct model_file *model)
{
    const struct model_summary sum =
        model_compute_summary(&model->lens, model_get_full_span(&model->lens));

    print_model_header(model);
    print_ghost_table(&model->lens);
    print_model_errors(&sum);
    if (tool->verbose)
        print_system_table(&model->lens);
}

/* Completes the table row of a ghost by the names of the outputs whose error
 * exceeds their target. */
static void print_missed_targets_of_ghost(const struct model_summary *sum)
{
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (sum->of[kind].p99 > model_output_targets[kind])
            printf("  %s %.2g", model_output_names[kind], sum->of[kind].p99);
    printf("\n");
}

/* Ends the line of a ghost and prints a line for each output. */
static void print_output_details(const struct model_summary *sum)
{
    printf("\n");
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const struct model_errors *e = &sum->of[kind];

        if (e->n)
            printf("       %-9s %5.1f terms  rms %-8.3g p50 %-8.3g p99 %-8.3g "
                   "max %-8.3g %s%s\n",
                   model_output_names[kind], e->terms, sqrt(e->mean2), e->p50,
                   e->p99, e->max, model_output_units[kind],
                   e->p99 > model_output_targets[kind]
                       ? "  misses the error target"
                       : "");
    }
}

/* Prints the ghosts whose error exceeds a target, or all ghosts if ALL. */
static void print_fit_table(const struct glint_lens *lens, bool all)
{
    bool titled = false;

    for (uint32_t k = 0; k < lens->header->n_ghosts; k++) {
        const struct model_summary sum =
            model_compute_summary(lens, model_measure_ghost_span(lens, k));

        if (lens->ghost[k].n_systems == 0 ||
            (!all && !model_misses_error_target(&sum)))
            continue;
        if (!titled)
            print_ghost_table_title(all ? "" : "  misses the error target");
        titled = true;
        print_ghost_row(lens, k, &sum);
        (all ? print_output_details : print_missed_targets_of_ghost)(&sum);
    }
}

static void print_bake_statistics(const struct tool *tool,
                                  const struct glint_lens *lens, double seconds,
                                  const struct glint_bake_report *report)
{
    const struct glint_model_header *h = lens->header;
    const struct model_summary sum =
        model_compute_summary(lens, model_get_full_span(lens));

    print_fit_table(lens, tool->verbose > 0);
    print_ghosts_without_zones(lens);
    print_model_errors(&sum);
    printf("\n%s: %lu bytes, %lu ghosts in %lu pupil regions, %lu zones, "
           "%.1f terms per output, %.1f s\n",
           h->name, (unsigned long)h->bytes,
           (unsigned long)model_count_ghosts(lens), (unsigned long)h->n_ghosts,
           (unsigned long)h->n_systems, model_compute_mean_terms(&sum),
           seconds);
    printf("%u of %lu ghosts miss the error target at some angle; %d of %lu "
           "zones exceed the tolerance of the fit (--tolerance)\n",
           model_count_ghosts_with_missed_targets(lens),
           (unsigned long)model_count_ghosts(lens), report->unmet,
           (unsigned long)h->n_systems);
    printf("%d rays were compared", report->rays);
    if (report->intruders > 0)
        printf("; %d more pass the model although the lens blocks them",
               report->intruders);
    printf("\n");
}

/* Prints the lowest PSNR of the compared pictures, and a remedy if it is below
 * PICTURE_CHECK_DB. */
static void print_picture_check(const struct picture_check *check)
{
    if (check->n == 0)
        return;
    if (check->psnr_db >= PICTURE_IDENTICAL_DB)
        printf("%d pictures of the model are identical to those by exact "
               "rays\n",
               check->n);
    else
        printf("%d pictures of the model against exact rays: worst PSNR %.1f "
               "dB, with the light %.1f degrees off the axis\n",
               check->n, check->psnr_db, check->angle_deg);
    if (check->psnr_db < PICTURE_CHECK_DB)
        printf("this is below %g dB: bake with a smaller --tolerance, or draw "
               "stills with --rays exact\n",
               PICTURE_CHECK_DB);
}

void model_report_print_info(const struct tool *tool,
                             const struct model_file *model)
{
    struct model_file shown = *model;

    /* Only a baked position has polynomial systems, so those of the first
     * position are reported. */
    if (shown.zoom)
        shown.lens = shown.zoom->model[0];
    (tool->json ? write_info_json : print_model_info)(tool, &shown);
}

void model_report_print_bake(const struct tool *tool,
                             const struct glint_lens *lens, double seconds,
                             const struct glint_bake_report *report,
                             const struct picture_check *check)
{
    if (tool->json)
        write_bake_json(lens, seconds, report, check);
    else if (!tool->quiet) {
        print_bake_statistics(tool, lens, seconds, report);
        print_picture_check(check);
    }
}
