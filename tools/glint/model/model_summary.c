/* SPDX-License-Identifier: MIT */
#include "model/model_summary.h"

#include <math.h>

const char *const model_output_names[GLINT_OUT_KINDS] = {
    "sensor_x", "sensor_y", "stop_x",   "stop_y",   "energy",
    "radius",   "barrel_0", "barrel_1", "barrel_2", "barrel_3"};
const char *const model_output_units[GLINT_OUT_KINDS] = {
    "px of 1920", "px of 1920", "stop radii", "stop radii", "share",
    "radii",      "radii",      "radii",      "radii",      "radii"};

const double model_output_targets[GLINT_OUT_KINDS] = {
    0.25, 0.25, 0.0024, 0.0024, 0.05, 0.005, 0.005, 0.005, 0.005, 0.005};

const char *model_get_basis_name(const struct glint_lens *lens)
{
    return glint_basis_is_lens(lens->header->basis) ? "lens" : "auto";
}

/* --------------------------------------------------------------- quantities */

double model_convert_sine_to_deg(int32_t sine_q30)
{
    return asin(fmin(1, ldexp(sine_q30, -30))) * (180 / GLINT_PI);
}

double model_convert_wave_to_nm(int32_t wave_q24)
{
    return 1e3 / sqrt(ldexp(wave_q24, -24));
}

struct model_span model_get_full_span(const struct glint_lens *lens)
{
    return (struct model_span){0, lens->header->n_systems};
}

struct model_span model_measure_ghost_span(const struct glint_lens *lens,
                                           uint32_t ghost)
{
    return (struct model_span){lens->ghost[ghost].first_system,
                               lens->ghost[ghost].n_systems};
}

const struct glint_model_output *
model_outputs_of(const struct glint_lens *lens,
                 const struct glint_model_system *s)
{
    const char *base = (const char *)lens->header;

    return (const void *)(base + s->output_at);
}

/* Returns the number of 32-bit words that the bounding box of system S
 * occupies. */
static size_t count_box_words(const struct glint_model_system *s)
{
    size_t n = 0;

    for (int k = 0; k < GLINT_BOX_TERMS; k++)
        n += 3 * (s->box_terms >> k & 1U);
    return n;
}

size_t model_count_span_bytes(const struct glint_lens *lens,
                              struct model_span span)
{
    size_t sum = 0;

    for (uint32_t k = span.first; k < span.first + span.n; k++) {
        const struct glint_model_system *s = &lens->system[k];
        const struct glint_model_output *o = model_outputs_of(lens, s);

        sum += sizeof *s + s->n_outputs * sizeof *o + 4 * count_box_words(s);
        for (uint32_t m = 0; m < s->n_outputs; m++)
            sum += 4 * (size_t)o[m].n_terms + (o[m].n_terms + 1U) / 2 * 4 -
                   2 * (o[m].n_narrow & ~1U);
    }
    return sum;
}

void model_find_span_angles(const struct glint_lens *lens,
                            struct model_span span, double range_deg[2])
{
    int32_t lo_q30 = INT32_MAX, hi_q30 = 0;

    for (uint32_t k = span.first; k < span.first + span.n; k++) {
        const struct glint_model_system *s = &lens->system[k];

        lo_q30 = s->sine_lo_q30 < lo_q30 ? s->sine_lo_q30 : lo_q30;
        hi_q30 = s->sine_hi_q30 > hi_q30 ? s->sine_hi_q30 : hi_q30;
    }
    range_deg[0] = span.n ? model_convert_sine_to_deg(lo_q30) : 0;
    range_deg[1] = model_convert_sine_to_deg(hi_q30);
}

static double convert_stored_error_to_double(uint16_t stored)
{
    return ldexp((double)glint_model_error_q20(stored), -20);
}

static void add_system_errors_to_summary(struct model_errors *e,
                                         const struct glint_model_output *o,
                                         double unit)
{
    const double rms = convert_stored_error_to_double(o->rms);
    const double step = ldexp(unit, o->exponent);

    e->n++;
    e->terms += (o->n_terms - e->terms) / e->n;
    e->mean2 += (rms * rms - e->mean2) / e->n;
    e->p50 += (convert_stored_error_to_double(o->p50) - e->p50) / e->n;
    e->p99 = fmax(e->p99, convert_stored_error_to_double(o->p99));
    e->max = fmax(e->max, convert_stored_error_to_double(o->max));
    e->bound = fmax(e->bound, o->bound * step);
    e->rounding = fmax(e->rounding, ldexp(o->rounding_q8 * step, -8));
}

struct model_summary model_compute_summary(const struct glint_lens *lens,
                                           struct model_span span)
{
    const double px =
        1920 / model_convert_real_to_double(lens->header->film_width_mm);
    struct model_summary sum = {{{0}}};

    for (uint32_t k = span.first; k < span.first + span.n; k++) {
        const struct glint_model_system *s = &lens->system[k];
        const struct glint_model_output *o = model_outputs_of(lens, s);

        for (uint32_t m = 0; m < s->n_outputs; m++)
            add_system_errors_to_summary(&sum.of[o[m].kind], &o[m],
                                         o[m].kind <= GLINT_OUT_SENSOR_Y ? px
                                                                         : 1);
    }
    return sum;
}

double model_count_terms(const struct model_summary *sum)
{
    double terms = 0;

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        terms += sum->of[kind].n * sum->of[kind].terms;
    return terms;
}

double model_compute_mean_terms(const struct model_summary *sum)
{
    uint32_t n = 0;

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        n += sum->of[kind].n;
    return n ? model_count_terms(sum) / n : 0;
}

bool model_misses_error_target(const struct model_summary *sum)
{
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (sum->of[kind].p99 > model_output_targets[kind])
            return true;
    return false;
}

uint32_t model_count_ghosts(const struct glint_lens *lens)
{
    return lens->header->n_ghosts - lens->header->n_parts;
}

uint32_t model_find_ghost_of_entry(const struct glint_lens *lens,
                                   uint32_t entry)
{
    const struct glint_model_ghost *g = &lens->ghost[entry];
    uint32_t k = 0;

    while (k < entry && (g->i != lens->ghost[k].i || g->j != lens->ghost[k].j))
        k++;
    return k;
}

static bool is_model_entry_of_ghost(const struct glint_lens *lens,
                                    uint32_t entry, uint32_t ghost)
{
    return lens->ghost[entry].i == lens->ghost[ghost].i &&
           lens->ghost[entry].j == lens->ghost[ghost].j;
}

/* Updates MISS if the error of an output exceeds its target in zone (range of
 * angles) number ZONE, whose polynomials are lens->system[ZONE]. */
static void add_zone_if_target_missed(const struct glint_lens *lens,
                                      uint32_t zone, struct model_miss *miss)
{
    const struct model_span span = {zone, 1};
    const struct model_summary sum = model_compute_summary(lens, span);
    double range_deg[2];

    if (!model_misses_error_target(&sum))
        return;
    model_find_span_angles(lens, span, range_deg);
    miss->angle_deg[0] =
        miss->zones ? fmin(miss->angle_deg[0], range_deg[0]) : range_deg[0];
    miss->angle_deg[1] = fmax(miss->angle_deg[1], range_deg[1]);
    miss->zones++;
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const double over = sum.of[kind].p99 / model_output_targets[kind];

        if (over <= miss->over)
            continue;
        miss->output = kind;
        miss->p99 = sum.of[kind].p99;
        miss->over = over;
    }
}

struct model_miss model_find_missed_zones(const struct glint_lens *lens,
                                          uint32_t ghost)
{
    struct model_miss miss = {.zones = 0};

    for (uint32_t entry = ghost; entry < lens->header->n_ghosts; entry++) {
        const struct model_span span = model_measure_ghost_span(lens, entry);

        for (uint32_t k = 0;
             is_model_entry_of_ghost(lens, entry, ghost) && k < span.n; k++)
            add_zone_if_target_missed(lens, span.first + k, &miss);
    }
    return miss;
}

unsigned model_count_ghosts_with_missed_targets(const struct glint_lens *lens)
{
    unsigned n = 0;

    for (uint32_t k = 0; k < model_count_ghosts(lens); k++)
        n += model_find_missed_zones(lens, k).zones > 0;
    return n;
}
