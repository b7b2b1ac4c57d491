/* SPDX-License-Identifier: MIT
 *
 * Reports statistics of a drawn frame per ray bundle (one ghost, light and
 * wavelength): whether the bundle was drawn, the reason if it was not, and its
 * cost. No other file of the library calls these functions, so only programs
 * that use them link this file. */
#include "base/q.h"
#include "flare/by_edges.h"
#include "flare/dim.h"
#include "flare/wave_sets.h"

/* Returns the number of the ray bundle of GHOST, LIGHT and wavelength WAVE. All
 * combinations are numbered by light first, then by ghost, then by
 * wavelength. */
static int64_t compute_bundle_number(const struct glint_flare *f, int ghost,
                                     int light, int wave)
{
    const struct glint_flare_frame *r = f->plan.frame;

    return ((int64_t)light * (int)r->lens->header->n_ghosts + ghost) *
               r->n_waves +
           wave;
}

/* Returns the index of the first planned ray bundle whose number is at least
 * NUMBER. Returns n_bundles if all numbers are lower. Planned bundles are
 * sorted by number, so this is a binary search. */
static int find_first_planned_bundle(const struct glint_flare *f,
                                     int64_t number)
{
    int low = 0, high = f->n_bundles;

    while (low < high) {
        const int middle = low + (high - low) / 2;
        const struct glint_bundle_plan *s = &f->planned[middle];

        if (compute_bundle_number(f, s->ghost, s->light, s->wave) < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Returns the index of the planned ray bundle with number NUMBER, or -1 if that
 * bundle was not planned. */
static int find_planned_bundle(const struct glint_flare *f, int64_t number)
{
    const int at = find_first_planned_bundle(f, number);

    if (at == f->n_bundles)
        return -1;
    return compute_bundle_number(f, f->planned[at].ghost, f->planned[at].light,
                                 f->planned[at].wave) == number
               ? at
               : -1;
}

/* Returns the index of the set of wavelengths that the plan chose for GHOST and
 * LIGHT, or 0 if none of their ray bundles was planned. */
static int find_chosen_wave_set(const struct glint_flare *f, int ghost,
                                int light)
{
    const int at =
        find_first_planned_bundle(f, compute_bundle_number(f, ghost, light, 0));
    const struct glint_bundle_plan *s = &f->planned[at];

    return at < f->n_bundles && s->ghost == ghost && s->light == light
               ? glint_wave_sets_find_set_of_wave(f->plan.frame->sets, s->wave)
               : 0;
}

/* Returns the index in the array of max_bundles planned ray bundles that the
 * plan uses to consider this bundle. Without sets of wavelengths it is the
 * bundle's number. With sets the plan first considers all wavelengths of the
 * first set, for each ghost and light, and then chooses a set. The index is
 * then that of the last of these wavelengths. */
static int64_t compute_bundle_slot_index(const struct glint_flare *f, int ghost,
                                         int light, int wave)
{
    const struct glint_flare_frame *r = f->plan.frame;
    const int64_t number = compute_bundle_number(f, ghost, light, wave);

    return r->sets ? (number / r->n_waves + 1) * r->sets->size[0] - 1 : number;
}

static int count_polynomial_terms(const struct glint_transfer *t, int kind)
{
    int n = 0;

    for (int v = 0; v <= t->degree_v[kind]; v++)
        for (int u = 0; u <= t->degree_u[kind]; u++)
            n += t->table[kind][v][u] != 0;
    return n;
}

static void count_transfer_outputs(const struct glint_transfer *t,
                                   struct glint_account *a)
{
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (t->outputs >> kind & 1) {
            a->outputs++;
            a->barrels += kind >= GLINT_OUT_RADIUS;
            a->terms += count_polynomial_terms(t, kind);
        }
}

/* Returns the number of pixel rows of the picture that EDGE crosses. */
static int count_edge_rows(const struct glint_edge *edge, int height)
{
    const int first = edge->y_q8 > 0 ? edge->y_q8 >> 8 : 0;
    const int below = (edge->end_y_q8 + 255) >> 8;
    const int end = below < height ? below : height;

    return end > first ? end - first : 0;
}

static void count_bundle_edges(const struct glint_flare *f,
                               const struct glint_bundle_slot *slot,
                               struct glint_account *a)
{
    const struct glint_edge *edge = glint_flare_get_edges(f)->edge;

    for (int i = slot->first; i < slot->first + slot->n; i++) {
        if (edge[i].patch && edge[i].whole) /* data of the patch before */
            continue;
        a->edges++;
        if (!edge[i].patch)
            a->rows += count_edge_rows(&edge[i], f->cfg.height);
        a->refs = glint_flare_add_needed_count(
            a->refs, glint_edge_count_bin_entries(&edge[i], &f->bins));
    }
}

/* Returns whether LIGHT was merged completely into another light for GHOST. */
static int is_light_merged(const struct glint_flare *f, int ghost, int light)
{
    const struct glint_flare_frame *r = f->plan.frame;

    return f->plan.dims && !r->dim->method->unmerged_fraction_q8(
                               r, &f->plan.light[light], light, ghost);
}

void glint_flare_account(struct glint_flare *flare, int ghost, int light,
                         int wave, struct glint_account *account)
{
    struct glint_plan_scratch *scratch = flare->worker[0].plan;
    const int64_t number = compute_bundle_number(flare, ghost, light, wave);
    const int64_t place = compute_bundle_slot_index(flare, ghost, light, wave);
    const struct glint_wave_sets *sets = flare->plan.frame->sets;
    const int at = find_planned_bundle(flare, number);
    struct glint_bundle_plan planned = {
        .ghost = ghost, .light = light, .wave = wave};
    struct glint_bundle bundle;

    *account = (struct glint_account){.outcome = GLINT_OUTCOME_DRAWN};
    account->outcome = glint_plan_bundle(
        &flare->plan, &flare->plan.light[light], &planned, &bundle, scratch);
    account->probed = scratch->probe.n_rays;
    if (sets && glint_wave_sets_find_set_of_wave(sets, wave) !=
                    find_chosen_wave_set(flare, ghost, light)) {
        account->outcome = GLINT_OUTCOME_OTHER_SET;
        account->probed *= wave < sets->size[0];
        return;
    }
    if (place >= flare->cfg.max_bundles && place < flare->stats.need_bundles) {
        /* This function traced the probe rays; the plan did not. */
        account->probed = 0;
        account->outcome = GLINT_OUTCOME_NO_ROOM;
    } else if (at >= flare->n_drawn)
        account->outcome = GLINT_OUTCOME_NO_ROOM;
    else if (at < 0 && account->outcome == GLINT_OUTCOME_DRAWN &&
             is_light_merged(flare, ghost, light))
        account->outcome = GLINT_OUTCOME_SHARED;
    else if (at < 0 && account->outcome == GLINT_OUTCOME_DRAWN)
        account->outcome = GLINT_OUTCOME_FAINT;
    if (at < 0)
        return;
    account->flux = flare->planned[at].flux;
    account->cells = flare->bundle[at].n_cells;
    account->vertices = (account->cells + 1) * (account->cells + 1);
    glint_plan_set_transfer(&flare->plan, &flare->planned[at],
                            &scratch->transfer);
    count_transfer_outputs(&scratch->transfer, account);
    if (account->outcome == GLINT_OUTCOME_NO_ROOM)
        return;
    count_bundle_edges(flare, &flare->slot[at], account);
    if (account->edges == 0)
        account->outcome = GLINT_OUTCOME_EMPTY;
}

static int is_bundle_selected(const struct glint_flare *f,
                              const struct glint_bundle_plan *s, int ghost,
                              int light, int wave)
{
    const struct glint_model_ghost *of = f->plan.frame->lens->ghost;
    const struct glint_wave_sets *sets = f->plan.frame->sets;
    const struct glint_model_ghost *here = &of[s->ghost];

    return (ghost < 0 || (here->i == of[ghost].i && here->j == of[ghost].j)) &&
           (light < 0 || s->light == light) &&
           (wave < 0 || (sets ? glint_wave_sets_find_set_of_wave(sets, s->wave)
                              : s->wave) == wave);
}

void glint_flare_keep(struct glint_flare *flare, int ghost, int light, int wave)
{
    const struct glint_edge *edge = glint_flare_get_edges(flare)->edge;

    flare->reusable = GLINT_REUSABLE_NOT;
    glint_bins_clear_counts(&flare->bins);
    for (int put = 0; put < 2; put++) {
        for (int i = 0; i < flare->n_drawn; i++) {
            const struct glint_bundle_slot *slot = &flare->slot[i];

            if (!is_bundle_selected(flare, &flare->planned[i], ghost, light,
                                    wave))
                continue;
            for (int k = slot->first; k < slot->first + slot->n; k++)
                if (put)
                    glint_edge_put_into_bins(&edge[k], &flare->bins, k);
                else
                    glint_edge_count_into_bins(&edge[k], &flare->bins);
        }
        if (!put)
            glint_bins_convert_counts_to_starts(&flare->bins);
    }
    glint_bins_reset_starts(&flare->bins);
}

int glint_flare_listed(const struct glint_flare *flare, int tile)
{
    const int32_t *start = flare->bins.start;

    return flare->n_drawn ? start[tile + 1] - start[tile] : 0;
}
